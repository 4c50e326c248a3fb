#include <dmumps_c.h>

#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "ranks/mpi_ranks.h"

namespace mortier {
namespace {

/// The words of the manual of MUMPS.
enum Job { begin = -1, end = -2, analysis = 1, factorisation = 2, solution = 3 };
enum Failure { noMemory = -13, singularStructure = -6, singularMatrix = -10, notPositive = -40 };
constexpr int commWorld = -987654;

/// Whether work space that the analysis foresaw is too small: pivots are delayed.
bool wantsMoreSpace(int code) {
  return code == -8 || code == -9 || (code <= -14 && code >= -20 && code != -16);
}

/// All that a call may use, as it may outlive who made it.
struct Instance {
  DMUMPS_STRUC_C id{};
  std::vector<MUMPS_INT> rows;  ///< of the entries of this rank, from 1
  std::vector<MUMPS_INT> columns;
  std::vector<double> values;
  std::vector<MUMPS_INT> kept;  ///< from 1
  // On the first rank:
  std::vector<double> schur;  ///< by rows, its lower triangle where symmetric
  std::vector<double> right;  ///< over all equations
  std::vector<double> reduced;

  MUMPS_INT& icntl(int number) { return id.icntl[number - 1]; }
  [[nodiscard]] MUMPS_INT infog(int number) const { return id.infog[number - 1]; }
};

class Mumps final : public Skeleton {
 public:
  Mumps(const SkeletonShape& shape, MpiRanks& ranks)
      : ranks_(ranks), shape_(shape), instance_(std::make_shared<Instance>()) {
    Instance& mumps = *instance_;
    mumps.id.par = 1;
    mumps.id.sym = shape_.symmetric ? 1 : 0;  // positive definite, or unsymmetric
    mumps.id.comm_fortran = commWorld;
    call(Job::begin);
    for (const int number : {1, 2, 3}) mumps.icntl(number) = -1;  // where it prints
    mumps.icntl(4) = 0;                                           // what
    mumps.icntl(6) = 0;                                           // no permutation to a large diagonal
    mumps.icntl(7) = 0;                                           // minimum degree: fronts are cliques
    mumps.icntl(8) = 0;                                           // no scaling: one kind of equation
    mumps.icntl(18) = 3;                                          // entries of every rank
    mumps.id.n = shape_.size;
    if (shape_.kept > 0) {
      for (int i = shape_.size - shape_.kept; i < shape_.size; ++i) mumps.kept.push_back(i + 1);
      mumps.icntl(19) = 1;  // by rows on the first rank
      mumps.id.size_schur = shape_.kept;
      mumps.id.listvar_schur = mumps.kept.data();
    }
    giveEntries(nullptr);
    call(Job::analysis);
    analysed_ = mumps.infog(1) != singularStructure;
    if (analysed_) expectSuccess();
    dropEntries();
  }
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;
  /// All ranks destroy it, unless what ends one of them is thrown.
  ~Mumps() override {
    if (std::uncaught_exceptions() > 0) return;
    try {
      call(Job::end);
    } catch (const std::exception&) {  // the end of another rank, which the next exchange reports again
    }
  }

  bool factorise(Matrix own, bool regular, Threads& /*threads*/) override {
    double failed = regular && own.allFinite() ? 0 : 1;
    ranks_.sum(&failed, 1);
    if (failed > 0 || !analysed_) return false;
    Instance& mumps = *instance_;
    giveEntries(&own);
    own.resize(0, 0);
    const auto kept = static_cast<size_t>(shape_.kept);
    if (ranks_.first()) mumps.schur.resize(kept * kept);
    mumps.id.schur = mumps.schur.data();
    call(Job::factorisation);
    for (int more = 0; more < 8 && wantsMoreSpace(mumps.infog(1)); ++more) {
      mumps.icntl(14) = 2 * mumps.icntl(14) + 20;  // percent
      call(Job::factorisation);
    }
    dropEntries();
    if (mumps.infog(1) == singularMatrix || mumps.infog(1) == notPositive) return false;
    expectSuccess();
    if (shape_.symmetric && mumps.infog(12) > 0) return false;  // negative pivots
    if (mumps.infog(25) > 0) return false;                      // tiny ones, that were replaced
    takeSchur();
    return true;
  }

  [[nodiscard]] const Matrix& schurComplement() const override { return schur_; }
  [[nodiscard]] Matrix takeSchurComplement() override { return std::move(schur_); }

  void condense(Vector& f) const override {
    ranks_.sum(f.data(), f.size());
    if (shape_.kept == 0) return;  // expand() does it all
    Instance& mumps = *instance_;
    mumps.reduced.resize(shape_.kept);
    mumps.id.redrhs = mumps.reduced.data();
    mumps.id.lredrhs = shape_.kept;
    mumps.icntl(26) = 1;
    solve(f);
    const std::vector<double> reduced = ofFirst(mumps.reduced);
    f.tail(shape_.kept) = Eigen::Map<const Vector>(reduced.data(), shape_.kept);
  }

  void expand(Vector& f) const override {
    Instance& mumps = *instance_;
    if (shape_.kept > 0) {
      Eigen::Map<Vector>(mumps.reduced.data(), shape_.kept) = f.tail(shape_.kept);
      mumps.icntl(26) = 2;
    }
    solve(f);
    const std::vector<double> all = ofFirst(mumps.right);
    f.head(shape_.size - shape_.kept) = Eigen::Map<const Vector>(all.data(), shape_.size - shape_.kept);
  }

 private:
  void call(Job job) const {
    instance_->id.job = job;
    ranks_.call([instance = instance_] { dmumps_c(&instance->id); });
  }

  void solve(const Vector& f) const {
    Instance& mumps = *instance_;
    mumps.right.assign(f.begin(), f.end());
    mumps.id.rhs = mumps.right.data();
    mumps.id.nrhs = 1;
    mumps.id.lrhs = shape_.size;
    call(Job::solution);
    expectSuccess();
  }

  void expectSuccess() const {
    const int code = instance_->infog(1);
    if (code >= 0) return;
    if (code == noMemory) throw std::bad_alloc();
    throw std::runtime_error("MUMPS cannot factorise what lies between the ranks: INFOG(1) = " +
                             std::to_string(code) + ", INFOG(2) = " + std::to_string(instance_->infog(2)));
  }

  /// Those of `own`, or their places only.
  void giveEntries(const Matrix* own) {
    Instance& mumps = *instance_;
    const std::vector<int>& places = shape_.places;
    const size_t n = places.size();
    const size_t entries = shape_.symmetric ? n * (n + 1) / 2 : n * n;
    for (auto* list : {&mumps.rows, &mumps.columns}) list->reserve(entries);
    if (own != nullptr) mumps.values.reserve(entries);
    for (size_t j = 0; j < n; ++j)
      for (size_t i = shape_.symmetric ? j : 0; i < n; ++i) {
        mumps.rows.push_back(places[i] + 1);
        mumps.columns.push_back(places[j] + 1);
        if (own != nullptr)
          mumps.values.push_back((*own)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      }
    mumps.id.nnz_loc = static_cast<MUMPS_INT8>(entries);
    mumps.id.irn_loc = mumps.rows.data();
    mumps.id.jcn_loc = mumps.columns.data();
    mumps.id.a_loc = mumps.values.data();
  }

  void dropEntries() {
    std::vector<MUMPS_INT>().swap(instance_->rows);
    std::vector<MUMPS_INT>().swap(instance_->columns);
    std::vector<double>().swap(instance_->values);
  }

  /// Values of the first rank, on all of them.
  [[nodiscard]] std::vector<double> ofFirst(const std::vector<double>& values) const {
    std::vector<size_t> sizes(ranks_.count(), 0);
    sizes.front() = values.size();
    std::vector<double> all(values.size());
    ranks_.gather(ranks_.first() ? values : std::vector<double>(), sizes, all.data());
    return all;
  }

  void takeSchur() {
    const Eigen::Index m = shape_.kept;
    Instance& mumps = *instance_;
    mumps.schur.resize(static_cast<size_t>(m * m));
    const std::vector<double> byRows = ofFirst(mumps.schur);
    std::vector<double>().swap(mumps.schur);
    schur_ = Eigen::Map<const Matrix>(byRows.data(), m, m).transpose();
    if (shape_.symmetric) schur_.triangularView<Eigen::StrictlyUpper>() = schur_.transpose();
  }

  MpiRanks& ranks_;
  SkeletonShape shape_;
  std::shared_ptr<Instance> instance_;
  bool analysed_ = false;  ///< whether the pattern can be regular
  Matrix schur_;
};

}  // namespace

std::unique_ptr<Skeleton> mumpsSkeleton(const SkeletonShape& shape, Ranks& ranks) {
  return std::make_unique<Mumps>(shape, dynamic_cast<MpiRanks&>(ranks));
}

}  // namespace mortier
