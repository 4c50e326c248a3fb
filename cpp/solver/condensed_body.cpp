#include "solver/condensed_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "base/blocks.h"
#include "base/interrupt.h"
#include "base/worst.h"

namespace mortier {

CondensedBody::CondensedBody(const Model& model, int body, const std::vector<int>& firstRow,
                             const SolverOptions& options, Threads& threads, bool whole)
    : body_(model.bodies[body]),
      contact_(model, body, firstRow),
      engine_(options.linear),
      reduce_(options.reduce),
      whole_(whole),
      threads_(threads) {
  law_ = body_.material().room(body_.points());
  if (whole_) return;
  solver_ = engine_ == LinearEngine::multifrontal ? multifrontalSolver(body_.pattern(), contact_.equations)
                                                  : suiteSparseSolver(body_.pattern(), contact_.equations);
  solver_->use(threads);
}

double CondensedBody::linearise(const Matrix& stress0, const Matrix* shift, BodyIterate& iterate,
                                const BodyLaw& law) {
  iterate.strain.resizeLike(iterate.stress);
  law_.elastic = 0;
  std::mutex lock;
  Worst residual;
  forEachBlock(body_.points(), threads_, [&](int begin, int end) {
    stopIfInterrupted();
    body_.strain(iterate.increment, shift, iterate.strain, begin, end);
    if (!law.inBlock) return;
    const LawReport report = law.inBlock(iterate, law_, begin, end);
    const std::scoped_lock locked(lock);
    residual.add(report.change);
    law_.elastic += report.elastic;
  });
  if (law.everywhere) law.everywhere(iterate, law_);
  return residual.value() == 0 ? 0 : residual.value() / residualScale(stress0, iterate);
}

double CondensedBody::residualScale(const Matrix& stress0, const BodyIterate& iterate) const {
  // The rounding of the law is a part of the stresses that are there, which may be far beyond yield.
  const double before = stress0.cwiseAbs().maxCoeff();
  if (const double scale = body_.material().stressScale(); scale > 0)
    return std::max({scale, before, iterate.stress.cwiseAbs().maxCoeff()});
  // What rounding of the displacement makes of a rigid motion: tolerances of 1e-10 times this part are 1e-14
  // of E |du|/L.
  constexpr double rigidPart = 1e-4;
  const double rigid =
      law_.moduli.cwiseAbs().maxCoeff() * iterate.increment.high.cwiseAbs().maxCoeff() / extent(body_.mesh());
  return std::max({before, law_.predictor.cwiseAbs().maxCoeff(), rigidPart * rigid});
}

std::pair<int, double> CondensedBody::furthest(const Matrix& stress0, const BodyIterate& iterate) const {
  int point = -1;
  double largest = 0;
  for (int i = 0; i < body_.points(); ++i) {
    const double change = (law_.predictor.col(i) - iterate.stress.col(i)).norm();
    if (!std::isfinite(change) || change <= largest) continue;
    largest = change;
    point = i;
  }
  const double relative = largest / residualScale(stress0, iterate);
  return {point, std::isfinite(relative) ? relative : std::numeric_limits<double>::max()};
}

double CondensedBody::rounding(const Matrix& stress0, const BodyIterate& iterate,
                               const Vector& displacement) const {
  const double strain = std::numeric_limits<double>::epsilon() * body_.largestGradient() *
                        displacement.lpNorm<Eigen::Infinity>();
  const double scale = residualScale(stress0, iterate);
  // A body that was moved before the step and is free of stress has none that could be wrong.
  return strain == 0 || scale == 0 ? 0 : strain * law_.moduli.lpNorm<Eigen::Infinity>() / scale;
}

CondensedBody::Factors CondensedBody::factorise() {
  factorisedElastic_ = law_.elastic;
  const bool elastic = law_.elastic == body_.points();
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
  if (!factorised_ && engine_ == LinearEngine::multifrontal && !body_.pattern().symmetric) {
    // UMFPACK pivots in the whole matrix.
    useLibraries();
    factorised_ = solver_->factorise(values_);
  }
  if (!factorised_)
    result.failure = "body " + body_.name() + ": its tangent is singular with its contact nodes held";
  if (!factorised_ || contact_.none()) return result;
  // Rigid motions get a stiffness of their own; as z carries them it never acts. It is taken from the
  // tangent: where few nodes are in contact the Schur complement itself may be nothing but rounding.
  Matrix S = solver_->takeSchurComplement();
  if (contact_.R.cols() > 0) {
    double stiffness = 0;
    for (const double value : values_) stiffness = std::max(stiffness, std::abs(value));
    S.noalias() += stiffness * contact_.R * contact_.R.transpose();
  }
  const bool symmetric = body_.pattern().symmetric;
  factorised_ = schurFactor_.factorise(std::move(S), symmetric) || !symmetric;
  if (!factorised_) result.failure = "body " + body_.name() + ": its tangent is not positive definite";
  return result;
}

void CondensedBody::addCompliance(Matrix& W) const {
  constexpr int atOnce = 128;
  const Eigen::SparseMatrix<double> columns = contact_.C.transpose();  // contact dofs x contact rows
  for (Eigen::Index begin = 0; begin < columns.cols(); begin += atOnce) {
    stopIfInterrupted();
    const Eigen::Index count = std::min<Eigen::Index>(atOnce, columns.cols() - begin);
    Matrix x = columns.middleCols(begin, count);
    if (x.isZero(0)) continue;
    schurFactor_.solve(x);
    W.middleCols(begin, count) += contact_.C * x;
  }
}

void CondensedBody::useLibraries() {
  if (engine_ == LinearEngine::suitesparse) return;
  engine_ = LinearEngine::suitesparse;
  if (whole_) return;
  solver_ = suiteSparseSolver(body_.pattern(), contact_.equations);
  factorised_ = false;
}

Vector CondensedBody::solveSchur(const Vector& f) const {
  Matrix x = f;
  schurFactor_.solve(x);
  return x;
}

Vector CondensedBody::condense(const Vector& force) {
  residual_ = body_.gather(force);
  solver_->condense(residual_);
  contactForce_ = residual_(contact_.equations);
  return contact_.none() ? contactForce_ : solveSchur(contactForce_);
}

Vector CondensedBody::expand(const Vector& forceChange, const Vector& z) {
  if (!contact_.none()) {
    Vector x = solveSchur(contactForce_ - contact_.C.transpose() * forceChange);
    if (contact_.R.cols() > 0) x += contact_.R * (z - contact_.R.transpose() * x);
    residual_(contact_.equations) = x;
  }
  solver_->expand(residual_);
  return body_.spread(residual_);
}

}  // namespace mortier
