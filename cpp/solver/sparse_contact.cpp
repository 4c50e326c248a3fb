#include "solver/sparse_contact.h"

#include <algorithm>
#include <cmath>

#include "base/dense_templates.h"
#include "base/interrupt.h"
#include "solver/contact_sets.h"

namespace mortier {
namespace {

/// Penalties over the stiffness of the nodes that a condition acts on: a repetition divides an error by about
/// it, and rounding grows by this factor.
constexpr double penaltyRatio = 1e4;

/// Smaller entries of a row are the rounding of larger ones, over its largest [-].
constexpr double roundingOfRows = 1e-14;

Eigen::SparseMatrix<double, Eigen::RowMajor> pruned(const Eigen::SparseMatrix<double, Eigen::RowMajor>& A) {
  Triplets entries;
  using Row = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;
  for (int i = 0; i < A.outerSize(); ++i) {
    double largest = 0;
    for (Row a(A, i); a; ++a) largest = std::max(largest, std::abs(a.value()));
    for (Row a(A, i); a; ++a)
      if (std::abs(a.value()) > roundingOfRows * largest)
        entries.emplace_back(i, static_cast<int>(a.col()), a.value());
  }
  return assembled<Eigen::SparseMatrix<double, Eigen::RowMajor>>(A.rows(), A.cols(), entries);
}

}  // namespace

SparseContact::SparseContact(const Model& model, const std::vector<CondensedBody>& bodies,
                             const std::vector<int>& firstRow, LinearEngine engine, Threads& threads)
    : engine_(engine == LinearEngine::single ? LinearEngine::multifrontal : engine), threads_(threads) {
  for (const Body& body : model.bodies) {
    first_.push_back(first_.back() + body.freeDofs());
    patterns_.push_back(&body.pattern());
    pattern_.symmetric = pattern_.symmetric && body.pattern().symmetric;
  }
  findRows(model, bodies, firstRow);
  findSprings(model, bodies);
  findPattern();
  solver_ = newSolver(engine_, pattern_, {}, threads_);
}

void SparseContact::findRows(const Model& model, const std::vector<CondensedBody>& bodies,
                             const std::vector<int>& firstRow) {
  const int conditions = firstRow.back();
  Triplets entries;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const ContactDofs& dofs = bodies[b].contact();
    forEachEntry(dofs.C, [&](int row, int column, double value) {
      entries.emplace_back(row, first_[b] + dofs.equations[column], value);
    });
  }
  C_ = assembled<Rows>(conditions, first_.back(), entries);
  entries.clear();
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const bool local = interface.pair().coupling != CouplingKind::mortar;
    const Vector length = interface.mass() * Vector::Ones(interface.rows());
    for (int j = 0; j < interface.rows() && local; ++j)
      entries.emplace_back(firstRow[k] + j, firstRow[k] + j, 1);
    if (local) continue;
    forEachEntry(interface.mass(), [&](int row, int column, double value) {
      entries.emplace_back(firstRow[k] + row, firstRow[k] + column, value / length[row]);
    });
  }
  T_ = assembled<Rows>(conditions, conditions, entries);
  entries.clear();
  const Rows B = pruned(T_ * C_);
  const auto add = [&](const Rows& A, int offset, double sign) {
    forEachEntry(A, [&](int row, int column, double value) {
      entries.emplace_back(row, offset + column, sign * value);
    });
  };
  add(B, 0, 1);
  add(T_, first_.back(), -1);
  E_ = assembled<Rows>(conditions, first_.back() + conditions, entries);
}

void SparseContact::findSprings(const Model& model, const std::vector<CondensedBody>& bodies) {
  Eigen::Index motions = 0;
  for (const CondensedBody& body : bodies) motions += body.contact().R.cols();
  springMotions_ = Matrix::Zero(motions, motions);
  motions_ = Matrix::Zero(first_.back(), motions);
  Eigen::Index column = 0;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const Matrix& R = bodies[b].contact().R;
    if (R.cols() == 0) continue;
    for (Eigen::Index i = 0; i < R.cols(); ++i)
      motions_.block(first_[b], column + i, first_[b + 1] - first_[b], 1) =
          model.bodies[b].gather(bodies[b].contact().motions.col(i));
    const Eigen::ColPivHouseholderQR<Matrix> independent(R.transpose());
    for (Eigen::Index i = 0; i < R.cols(); ++i) {
      const int dof = independent.colsPermutation().indices()[i];
      springs_.push_back(first_[b] + bodies[b].contact().equations[dof]);
      springMotions_.block(column + i, column, 1, R.cols()) = R.row(dof);
    }
    column += R.cols();
  }
  toMotions_.compute(springMotions_);
  motionsInRows_ = E_.leftCols(first_.back()) * motions_;
}

/// Calls visit(condition, row, column, product) for the products in E' E that H holds.
template <class Visit>
void SparseContact::forEachPair(Visit visit) const {
  for (int i = 0; i < E_.outerSize(); ++i)
    for (Rows::InnerIterator a(E_, i); a; ++a)
      for (Rows::InnerIterator b(E_, i); b; ++b)
        if (!pattern_.symmetric || a.col() >= b.col())
          visit(i, static_cast<int>(a.col()), static_cast<int>(b.col()), a.value() * b.value());
}

/// Calls visit(body, place, row, column) for the entries of K that H holds, with their place in the tangent
/// of their body.
template <class Visit>
void SparseContact::forEachTangentEntry(Visit visit) const {
  for (size_t b = 0; b < patterns_.size(); ++b) {
    const SparsePattern& own = *patterns_[b];
    for (int j = 0; j < own.size; ++j)
      for (int k = own.columnStart[j]; k < own.columnStart[j + 1]; ++k) {
        visit(b, k, first_[b] + own.rows[k], first_[b] + j);
        if (own.symmetric && !pattern_.symmetric && own.rows[k] != j)
          visit(b, k, first_[b] + j, first_[b] + own.rows[k]);
      }
  }
}

void SparseContact::findPattern() {
  const int size = first_.back() + static_cast<int>(C_.rows());
  const auto forEachEntry = [&](auto visit) {
    forEachTangentEntry([&](size_t, int, int row, int column) { visit(row, column); });
    forEachPair([&](int, int row, int column, double) { visit(row, column); });
  };
  std::vector<int> start(size + 1, 0);
  forEachEntry([&](int, int column) { ++start[column + 1]; });
  for (int j = 0; j < size; ++j) start[j + 1] += start[j];
  std::vector<int> rows(start.back());
  std::vector<int> next(start.begin(), start.end() - 1);
  forEachEntry([&](int row, int column) { rows[next[column]++] = row; });
  pattern_.size = size;
  pattern_.columnStart.assign(1, 0);
  pattern_.rows.clear();
  for (int j = 0; j < size; ++j) {
    const auto begin = rows.begin() + start[j];
    const auto end = rows.begin() + start[j + 1];
    std::sort(begin, end);
    pattern_.rows.insert(pattern_.rows.end(), begin, std::unique(begin, end));
    pattern_.columnStart.push_back(pattern_.entries());
  }
  pattern_.rows.shrink_to_fit();
  forEachTangentEntry([&](size_t, int, int row, int column) { tangentEntry_.push_back(entry(row, column)); });
  forEachPair([&](int, int row, int column, double) { pairEntry_.push_back(entry(row, column)); });
}

int SparseContact::entry(int row, int column) const {
  const auto begin = pattern_.rows.begin() + pattern_.columnStart[column];
  const auto end = pattern_.rows.begin() + pattern_.columnStart[column + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - pattern_.rows.begin());
}

void SparseContact::useSuiteSparse() {
  if (engine_ == LinearEngine::suitesparse) return;
  engine_ = LinearEngine::suitesparse;
  active_.clear();
  solver_ = newSolver(engine_, pattern_, {}, threads_);
}

void SparseContact::take(const std::vector<CondensedBody>& bodies) {
  active_.clear();
  K_.clear();
  diagonal_.resize(first_.back());
  for (size_t b = 0; b < bodies.size(); ++b) {
    K_.push_back(&bodies[b].tangent());
    const SparsePattern& own = *patterns_[b];
    for (int j = 0; j < own.size; ++j)
      for (int k = own.columnStart[j]; k < own.columnStart[j + 1]; ++k)
        if (own.rows[k] == j) diagonal_[first_[b] + j] = std::abs((*K_[b])[k]);
  }
  const Rows squares = C_.cwiseProduct(C_);
  compliance_ = squares * diagonal_.cwiseInverse();
  penalty_ = Vector::Zero(E_.rows());
  for (int i = 0; i < E_.outerSize(); ++i) {
    double local = 0;
    for (Rows::InnerIterator e(E_, i); e && e.col() < first_.back(); ++e)
      local += e.value() * e.value() / diagonal_[e.col()];
    if (local > 0) penalty_[i] = penaltyRatio / local;
  }
  const double largest = penalty_.size() > 0 ? penalty_.maxCoeff() : 0;
  for (double& rho : penalty_)
    if (rho == 0) rho = largest > 0 ? largest : 1;  // both sides are held there
}

void SparseContact::setSprings(double weight) {
  if (weight == springWeight_) return;
  springWeight_ = weight;
  active_.clear();
}

double SparseContact::stiffnessAtSprings() const {
  return springs_.empty() ? 0 : Vector(diagonal_(springs_)).minCoeff();
}

bool SparseContact::factorise(const std::vector<char>& active) {
  if (active == active_ && !active_.empty()) return true;
  stopIfInterrupted();
  const int w = first_.back();
  values_.assign(pattern_.rows.size(), 0);
  const int* at = tangentEntry_.data();
  forEachTangentEntry([&](size_t b, int k, int, int) { values_[*at++] += (*K_[b])[k]; });
  for (const int dof : springs_) values_[entry(dof, dof)] += springWeight_ * diagonal_[dof];
  at = pairEntry_.data();
  const auto fixed = [&](int column) { return column >= w && active[column - w] != 0; };
  forEachPair([&](int i, int row, int column, double product) {
    double& value = values_[*at++];
    if (!fixed(row) && !fixed(column)) value += penalty_[i] * product;
  });
  for (size_t i = 0; i < active.size(); ++i)
    if (active[i] != 0) values_[entry(w + static_cast<int>(i), w + static_cast<int>(i))] = penalty_[i];
  ++factorisations_;
  active_ = active;
  if (solver_->factorise(values_)) return true;
  if (!pattern_.symmetric && engine_ != LinearEngine::suitesparse) {
    useSuiteSparse();  // UMFPACK pivots in the whole matrix
    active_ = active;
    if (solver_->factorise(values_)) return true;
  }
  active_.clear();
  return false;
}

Vector SparseContact::stiffnessTimes(const Vector& d) const {
  Vector f = Vector::Zero(d.size());
  threads_.forEach(static_cast<int>(patterns_.size()), [&](int b) {
    const SparsePattern& own = *patterns_[b];
    const Eigen::Map<const Eigen::SparseMatrix<double>> K(
        own.size, own.size, own.entries(), own.columnStart.data(), own.rows.data(), K_[b]->data());
    const auto x = d.segment(first_[b], own.size);
    auto y = f.segment(first_[b], own.size);
    if (own.symmetric)
      y = K.selfadjointView<Eigen::Lower>() * x;
    else
      y = K * x;
  });
  return f;
}

SparseContact::Solution SparseContact::solve(const Vector& force, const Vector& p0, const Vector& slack,
                                             const Vector& anchors, bool exact) const {
  constexpr int repetitions = 40;
  const double enough = exact ? 4 * std::numeric_limits<double>::epsilon() : 1e-6;
  const Eigen::Index n = first_.back();
  const Eigen::Index rows = E_.rows();
  Vector x = Vector::Zero(n + rows);
  for (Eigen::Index i = 0; i < rows; ++i)
    if (active_[i] != 0) x[n + i] = slack[i];
  Vector q = Vector::Zero(rows);
  Solution solution;
  solution.change = Vector::Zero(rows);
  for (Eigen::Index i = 0; i < rows; ++i)
    if (active_[i] == 0) solution.change[i] = -p0[i];
  solution.rigid = Vector::Zero(motions_.cols());
  const double given = slack.size() > 0 ? slack.cwiseAbs().maxCoeff() : 0;
  const Matrix motionsAcross = C_ * motions_;
  double before = INFINITY;
  int stalled = 0;  // rounding, or a correction that was made worse by the next
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    stopIfInterrupted();
    const Vector off = -(E_ * x) - motionsInRows_ * solution.rigid;
    Vector step = E_.transpose() * Vector(penalty_.cwiseProduct(off) - q);
    step.head(n) += force - stiffnessTimes(x.head(n));
    const Vector stretch = anchors - springMotions_ * solution.rigid;
    for (size_t k = 0; k < springs_.size(); ++k)
      step[springs_[k]] += springWeight_ * diagonal_[springs_[k]] * stretch[static_cast<Eigen::Index>(k)];
    for (Eigen::Index i = 0; i < rows; ++i) step[n + i] = active_[i] != 0 ? 0 : step[n + i] + p0[i];
    solver_->condense(step);
    solver_->expand(step);
    const Vector dq = penalty_.cwiseProduct(E_ * step - off);
    const Vector moved = C_ * step.head(n);
    if (motions_.cols() > 0) {
      const Vector dz = toMotions_.solve(Vector(step(springs_)));
      step.head(n) -= motions_ * dz;
      step(springs_).setZero();
      solution.rigid += dz;
    }
    x += step;
    q += dq;
    Vector dp = T_.transpose() * dq;
    for (Eigen::Index i = 0; i < rows; ++i)
      if (active_[i] == 0) dp[i] = 0;
    solution.change += dp;
    const auto largest = [](const Vector& v) { return v.lpNorm<Eigen::Infinity>(); };
    solution.forceNoise = largest(dp);
    solution.motionNoise = largest(moved);
    const double length = given + largest(x.head(n)) + largest(motionsAcross * solution.rigid);
    const double change = ratio(solution.forceNoise, largest(p0) + largest(p0 + solution.change)) +
                          ratio(solution.motionNoise, length);
    if (!(change < before / 2)) ++stalled;
    if (!(change > enough) || stalled > 2) break;
    before = std::min(before, change);
  }
  solution.motion = x.head(n);
  return solution;
}

}  // namespace mortier
