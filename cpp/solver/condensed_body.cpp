#include "solver/condensed_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "base/interrupt.h"
#include "base/worst.h"

namespace mortier {
namespace {

/// The largest |entry|.
double largestOf(const Eigen::Ref<const Matrix>& columns, Threads& threads) {
  const auto count = static_cast<int>(columns.cols());
  std::vector<double> largest(blocksOf(count), 0);
  forEachBlock(count, threads, [&](int begin, int end) {
    const Eigen::Index rows = columns.rows();
    const double* first = columns.data() + rows * begin;
    largest[begin / itemsOfBlock] =
        Eigen::Map<const Eigen::ArrayXd>(first, rows * (end - begin)).abs().maxCoeff();
  });
  return largest.empty() ? 0 : *std::max_element(largest.begin(), largest.end());
}

/// Of a rigid body: what its motions have in place of a compliance, so that no condition is without one. As z
/// carries them it never acts. Its material is as stiff as what it touches.
double softnessOf(const Body& body) {
  Matrix stress = Matrix::Zero(body.material().components(), 1);
  stress(1, 0) = 1;
  Matrix strain;
  body.material().elasticStrain(stress, strain);
  return strain.norm();
}

}  // namespace

CondensedBody::CondensedBody(const Model& model, int body, const std::vector<int>& firstRow,
                             const SolverOptions& options, Threads& threads, bool whole)
    : body_(model.bodies[body]),
      contact_(model, body, firstRow),
      engine_(engineOf(model, body_, options)),
      reduce_(options.reduce),
      whole_(whole),
      threads_(threads) {
  law_ = body_.material().room(body_.points());
  if (!whole_ && !body_.rigid()) solver_ = newSolver(engine_, body_.pattern(), contact_.equations, threads_);
}

void CondensedBody::linearise(const Matrix* explicitStrain, BodyIterate& iterate, const BodyLaw& law) {
  iterate.strain.resizeLike(iterate.stress);
  law_.elastic = 0;
  std::mutex lock;
  Worst change;
  forEachBlock(body_.points(), threads_, [&](int begin, int end) {
    stopIfInterrupted();
    body_.strain(iterate.increment, explicitStrain, iterate.strain, begin, end);
    if (!law.inBlock) return;
    const LawReport report = law.inBlock(iterate, law_, begin, end);
    const std::scoped_lock locked(lock);
    change.add(report.change);
    law_.elastic += report.elastic;
  });
  if (law.everywhere) law.everywhere(iterate, law_);
  stressChange_ = change.value();
}

// In plane strain and about an axis the trace of the strain is a difference of two components. What flowed at
// constant volume leaves its rounding there, and elasticity makes a stress of it, which no solve takes away.
double CondensedBody::residual(const Matrix& stress0, const BodyIterate& iterate, double motion) const {
  constexpr Eigen::Index acrossPlane = 3;
  constexpr Eigen::Index inSpace = 6;
  constexpr double roundings = 2;  // one of each of the two
  if (stressChange_ == 0) return 0;
  double rounded = 0;
  if (iterate.strain.rows() > acrossPlane && iterate.strain.rows() < inSpace && !body_.material().linear())
    rounded = roundings * std::numeric_limits<double>::epsilon() * largestModulus() *
              iterate.strain.row(acrossPlane).cwiseAbs().maxCoeff();
  if (stressChange_ <= rounded) return 0;
  return (stressChange_ - rounded) / residualScale(stress0, iterate, motion);
}

double CondensedBody::largestModulus() const {
  return largestOf(law_.moduli, threads_);
}

double CondensedBody::residualScale(const Matrix& stress0, const BodyIterate& iterate, double motion) const {
  const double before = largestOf(stress0, threads_);
  // The rounding of the law is a part of the stresses that are there, which may be far beyond yield.
  if (const double scale = body_.material().stressScale(); scale > 0)
    return std::max({scale, before, largestOf(iterate.stress, threads_)});
  // What rounding of the displacement makes of a rigid motion: tolerances of 1e-10 times this part are 1e-14
  // of E |du|/L.
  constexpr double rigidPart = 1e-4;
  const double rigid = largestModulus() * motion / body_.extent();
  return std::max({before, largestOf(law_.predictor, threads_), rigidPart * rigid});
}

std::pair<int, double> CondensedBody::worstPoint(const Matrix& stress0, const BodyIterate& iterate,
                                                 double motion) const {
  int point = -1;
  double largest = 0;
  for (int i = 0; i < body_.points(); ++i) {
    double change = (law_.predictor.col(i) - iterate.stress.col(i)).norm();
    if (std::isnan(change)) change = std::numeric_limits<double>::infinity();  // the law has no rate there
    if (change <= largest) continue;
    largest = change;
    point = i;
  }
  const double relative = largest / residualScale(stress0, iterate, motion);
  return {point, std::isfinite(relative) ? relative : std::numeric_limits<double>::max()};
}

double CondensedBody::rounding(const Matrix& stress0, const BodyIterate& iterate, double motion,
                               const Vector& displacement) const {
  constexpr double nothing = 1e-14;
  const double moved = displacement.lpNorm<Eigen::Infinity>();
  const double strain = std::numeric_limits<double>::epsilon() * body_.largestGradient() * moved;
  const double scale = residualScale(stress0, iterate, motion);
  // A body that was moved before the step and is free of stress has none that could be wrong.
  if (scale <= nothing * largestModulus() * moved / body_.extent()) return 0;
  return strain * largestModulus() / scale;
}

CondensedBody::Factors CondensedBody::factorise() {
  if (body_.rigid()) return {};
  factorisedElastic_ = law_.elastic;
  const bool elastic = this->elastic();
  if (reduce_ && factorised_ && elastic && elasticFactors_) return {};
  Factors result;
  result.changed = !(std::exchange(counted_, false) && elastic);
  elasticFactors_ = elastic;
  schurFactor_.clear();
  body_.tangent(law_, values_, threads_);
  if (whole_) {
    factorised_ = true;
    return result;
  }
  factorised_ = solver_->factorise(values_);
  useSchurComplement(result);
  return result;
}

void CondensedBody::useSchurComplement(Factors& factors) {
  if (!factorised_ && (engine_ == LinearEngine::single ||
                       (engine_ == LinearEngine::multifrontal && !body_.material().symmetricTangent()))) {
    // UMFPACK pivots in the whole matrix.
    useNextEngine();
    factorised_ = solver_->factorise(values_);
  }
  if (!factorised_)
    factors.failure = "body " + body_.name() + ": its tangent is singular with its contact nodes held";
  if (!factorised_ || contact_.none()) return;
  // Rigid motions get a stiffness of their own; as z carries them it never acts. It is taken from the
  // tangent: where few nodes are in contact the Schur complement itself may be nothing but rounding.
  Matrix S = solver_->takeSchurComplement();
  if (contact_.R.cols() > 0) {
    const auto entries = static_cast<Eigen::Index>(values_.size());
    const double stiffness = largestOf(Eigen::Map<const Matrix>(values_.data(), 1, entries), threads_);
    S.noalias() += stiffness * contact_.R * contact_.R.transpose();
  }
  const bool symmetric = body_.material().symmetricTangent();
  factorised_ = schurFactor_.factorise(std::move(S), symmetric);
  if (!factorised_)
    factors.failure =
        "body " + body_.name() + ": its tangent is " + (symmetric ? "not positive definite" : "singular");
}

void CondensedBody::addCompliance(Matrix& W) const {
  if (body_.rigid()) {
    const Matrix G = contact_.C * contact_.R;
    W += softnessOf(body_) * G * G.transpose();
    return;
  }
  constexpr Eigen::Index atOnce = 64;
  const Eigen::SparseMatrix<double> columns = contact_.C.transpose();  // contact dofs x contact rows
  threads_.forEach(static_cast<int>((columns.cols() + atOnce - 1) / atOnce), [&](int i) {
    stopIfInterrupted();
    const Eigen::Index begin = atOnce * i;
    const Eigen::Index count = std::min(atOnce, columns.cols() - begin);
    Matrix x = columns.middleCols(begin, count);
    if (x.isZero(0)) return;
    schurFactor_.solve(x);
    W.middleCols(begin, count) += contact_.C * x;
  });
}

void CondensedBody::useNextEngine() {
  if (engine_ == LinearEngine::suitesparse) return;
  engine_ = engine_ == LinearEngine::single ? LinearEngine::multifrontal : LinearEngine::suitesparse;
  ++enginesGivenUp_;
  if (whole_ || body_.rigid()) return;
  solver_ = newSolver(engine_, body_.pattern(), contact_.equations, threads_);
  factorised_ = false;
}

Vector CondensedBody::solveSchur(const Vector& f) const {
  Matrix x = f;
  schurFactor_.solve(x);
  return x;
}

Vector CondensedBody::condense(const Vector& force) {
  if (body_.rigid()) {
    contactForce_ = contact_.motions.transpose() * force;
    return softnessOf(body_) * (contact_.R * contactForce_);
  }
  residual_ = body_.gather(force);
  solver_->condense(residual_);
  contactForce_ = residual_(contact_.equations);
  return contact_.none() ? contactForce_ : solveSchur(contactForce_);
}

Vector CondensedBody::expand(const Vector& forceChange, const Vector& z) {
  if (body_.rigid()) return contact_.motions * z;
  if (!contact_.none()) {
    Vector x = solveSchur(contactForce_ - contact_.C.transpose() * forceChange);
    if (contact_.R.cols() > 0) x += contact_.R * (z - contact_.R.transpose() * x);
    residual_(contact_.equations) = x;
  }
  solver_->expand(residual_);
  return body_.spread(residual_);
}

}  // namespace mortier
