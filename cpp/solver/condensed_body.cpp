#include "solver/condensed_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "base/interrupt.h"
#include "base/worst.h"

namespace mortier {

CondensedBody::CondensedBody(const Model& model, int body, const std::vector<int>& firstRow,
                             const SolverOptions& options, Threads& threads, bool whole)
    : body_(model.bodies[body]),
      contact_(model, body, firstRow),
      engine_(options.linear),
      reduce_(options.reduce),
      distributedFrom_(options.distributedFrom),
      whole_(whole),
      threads_(threads) {
  law_ = body_.material().room(body_.points());
  if (whole_) return;
  if (Ranks::all().shared()) share_.emplace(model, body, Ranks::all());
  solver_ = newSolver();
  if (share_) clearLawOfOthers();
}

std::unique_ptr<CondensingSolver> CondensedBody::newSolver() const {
  const CondensingSolverFactory engine =
      engine_ == LinearEngine::multifrontal ? multifrontalSolver : suiteSparseSolver;
  auto solver = share_ ? sharedSolver(body_.pattern(), contact_.equations, share_->equations(), engine,
                                      share_->ranks(), distributedFrom_)
                       : engine(body_.pattern(), contact_.equations);
  solver->use(threads_);
  return solver;
}

void CondensedBody::linearise(const Matrix* shift, BodyIterate& iterate, const BodyLaw& law) {
  iterate.strain.resizeLike(iterate.stress);
  law_.elastic = 0;
  if (share_ && lawComplete_) clearLawOfOthers();
  std::mutex lock;
  Worst change;
  const auto strain = [&](int begin, int end) {
    body_.strain(iterate.increment, shift, iterate.strain, begin, end);
  };
  const auto linearise = [&](int begin, int end) {
    if (!law.inBlock) return;
    const LawReport report = law.inBlock(iterate, law_, begin, end);
    const std::scoped_lock locked(lock);
    change.add(report.change);
    law_.elastic += report.elastic;
  };
  if (!share_ || law.everywhere) {
    forEachBlock(body_.points(), threads_, [&](int begin, int end) {
      stopIfInterrupted();
      strain(begin, end);
      linearise(begin, end);
    });
  } else {
    forEachBlock(body_.points(), threads_, strain);
    forEachOwnBlock(linearise);
  }
  if (law.everywhere) law.everywhere(iterate, law_);
  facts_ = {change.value(), 0, 0, law_.elastic};
  if (!share_) return;
  if (law.everywhere) clearLawOfOthers();
  if (law.everywhere && !share_->ranks().first()) facts_.elastic = 0;  // one of them counts
  if (std::isnan(facts_.change)) facts_.change = std::numeric_limits<double>::infinity();
  if (body_.material().stressScale() <= 0) facts_.predictor = share_->largest(law_.predictor);
  facts_.modulus = share_->largest(law_.moduli);
}

void CondensedBody::clearLawOfOthers() {
  for (Matrix* part : {&law_.predictor, &law_.moduli, &law_.beyond})
    if (part->size() > 0) share_->clearOthers(*part);
  lawComplete_ = false;
}

void CondensedBody::take(const LawFacts& facts) {
  facts_ = facts;
  if (std::isinf(facts_.change)) facts_.change = std::numeric_limits<double>::quiet_NaN();
  law_.elastic = facts.elastic;
}

double CondensedBody::residual(const Matrix& stress0, const BodyIterate& iterate) const {
  return facts_.change == 0 ? 0 : facts_.change / residualScale(stress0, iterate);
}

void CondensedBody::completeLaw() {
  if (!share_ || lawComplete_) return;
  share_->gather(law_.predictor);
  share_->gather(law_.moduli);
  if (law_.beyond.size() > 0) share_->gather(law_.beyond);
  lawComplete_ = true;
}

double CondensedBody::residualScale(const Matrix& stress0, const BodyIterate& iterate) const {
  // The rounding of the law is a part of the stresses that are there, which may be far beyond yield.
  const double before = stress0.cwiseAbs().maxCoeff();
  if (const double scale = body_.material().stressScale(); scale > 0)
    return std::max({scale, before, iterate.stress.cwiseAbs().maxCoeff()});
  // What rounding of the displacement makes of a rigid motion: tolerances of 1e-10 times this part are 1e-14
  // of E |du|/L.
  constexpr double rigidPart = 1e-4;
  const double rigid = largestModulus() * iterate.increment.high.cwiseAbs().maxCoeff() / extent(body_.mesh());
  const double predictor = share_ ? facts_.predictor : law_.predictor.cwiseAbs().maxCoeff();
  return std::max({before, predictor, rigidPart * rigid});
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
  return strain == 0 || scale == 0 ? 0 : strain * largestModulus() / scale;
}

CondensedBody::Factors CondensedBody::factorise() {
  factorisedElastic_ = law_.elastic;
  const bool elastic = law_.elastic == body_.points();
  if (reduce_ && factorised_ && elastic && elasticFactors_) return {};
  Factors result;
  result.begun = true;
  result.changed = !(std::exchange(counted_, false) && elastic);
  elasticFactors_ = elastic;
  schurFactor_.clear();
  if (share_ && lawComplete_) clearLawOfOthers();
  body_.tangent(law_, values_, threads_);
  if (whole_) {
    factorised_ = true;
    return result;
  }
  factorised_ = solver_->factorise(values_);
  if (!share_) useSchurComplement(result);
  return result;
}

void CondensedBody::join(Factors& factors) {
  if (!factors.begun) return;
  factorised_ = solver_->join(factorised_);
  useSchurComplement(factors);
}

void CondensedBody::useSchurComplement(Factors& factors) {
  if (!factorised_ && engine_ == LinearEngine::multifrontal && !body_.pattern().symmetric) {
    // UMFPACK pivots in the whole matrix.
    useLibraries();
    factorised_ = solver_->join(solver_->factorise(values_));
  }
  if (!factorised_)
    factors.failure = "body " + body_.name() + ": its tangent is singular with its contact nodes held";
  if (!factorised_ || contact_.none()) return;
  // Rigid motions get a stiffness of their own; as z carries them it never acts. It is taken from the
  // tangent: where few nodes are in contact the Schur complement itself may be nothing but rounding.
  Matrix S = solver_->takeSchurComplement();
  if (contact_.R.cols() > 0) {
    double stiffness = 0;
    for (const double value : values_) stiffness = std::max(stiffness, std::abs(value));
    if (share_) share_->ranks().largest(&stiffness, 1);
    S.noalias() += stiffness * contact_.R * contact_.R.transpose();
  }
  const bool symmetric = body_.pattern().symmetric;
  factorised_ = schurFactor_.factorise(std::move(S), symmetric) || !symmetric;
  if (!factorised_) factors.failure = "body " + body_.name() + ": its tangent is not positive definite";
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
  solver_ = newSolver();
  factorised_ = false;
}

Vector CondensedBody::solveSchur(const Vector& f) const {
  Matrix x = f;
  schurFactor_.solve(x);
  return x;
}

double CondensedBody::largestModulus() const {
  return share_ ? facts_.modulus : law_.moduli.cwiseAbs().maxCoeff();
}

Vector CondensedBody::leftOver(const Vector& load, const Matrix& stress) {
  if (!share_) return load - body_.internalForce(stress);
  if (lawComplete_) clearLawOfOthers();
  ownForce_ = body_.internalForce(stress);
  return load;
}

void CondensedBody::condense(const Vector& force) {
  if (share_) {
    ownForce_ = -ownForce_;
    for (int node = 0; node < body_.nodes(); ++node)
      if (share_->responsible(node)) ownForce_.segment<2>(2 * node) += force.segment<2>(2 * node);
  }
  residual_ = body_.gather(share_ ? ownForce_ : force);
  solver_->condense(residual_);
}

Vector CondensedBody::joinCondensed() {
  solver_->joinCondensed(residual_);
  contactForce_ = residual_(contact_.equations);
  return contact_.none() ? contactForce_ : solveSchur(contactForce_);
}

void CondensedBody::moveContact(const Vector& forceChange, const Vector& z) {
  if (!contact_.none()) {
    Vector x = solveSchur(contactForce_ - contact_.C.transpose() * forceChange);
    if (contact_.R.cols() > 0) x += contact_.R * (z - contact_.R.transpose() * x);
    residual_(contact_.equations) = x;
  }
  solver_->expandJoined(residual_);
}

Vector CondensedBody::joinExpanded() {
  solver_->joinExpanded(residual_);
  return body_.spread(residual_);
}

}  // namespace mortier
