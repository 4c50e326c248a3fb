#include "solver/body_system.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/worst.h"
#include "fem/rigid_modes.h"

namespace mortier {
namespace {

/// A motion that moves the contact nodes by less than this part of the others is not held by contact.
constexpr double motionTolerance = 1e-14;

/// A support along the contact normal leaves no more than this part of a row.
constexpr double negligible = 1e-14;

/// Entries of C of one body as (row, node, vector).
template <class Visit>
void forEachEntryOfC(const ContactInterface& interface, int body, Visit visit) {
  const auto visitAll = [&](const ConstraintRows& C) {
    for (int node = 0; 2 * node < C.outerSize(); ++node) {
      ConstraintRows::InnerIterator x(C, 2 * node);
      ConstraintRows::InnerIterator y(C, 2 * node + 1);
      while (x || y) {
        const auto row = static_cast<int>(!y || (x && x.row() < y.row()) ? x.row() : y.row());
        Point vector = Point::Zero();
        if (x && x.row() == row) vector.x() = x.value(), ++x;
        if (y && y.row() == row) vector.y() = y.value(), ++y;
        visit(row, node, vector);
      }
    }
  };
  if (interface.pair().nonmortar.body == body) visitAll(interface.C1());
  if (interface.pair().mortar.body == body) visitAll(interface.C2());
}

}  // namespace

int determinantSign(const Eigen::PartialPivLU<Matrix>& lu) {
  const bool negative =
      ((lu.matrixLU().diagonal().array() < 0).count() % 2 == 1) != (lu.permutationP().determinant() < 0);
  return negative ? -1 : 1;
}

BodySystem::BodySystem(const Model& model, int body, const std::vector<int>& firstRow,
                       const SolverOptions& options)
    : body_(model.bodies[body]), engine_(options.linear), reduce_(options.reduce) {
  findContactDofs(model, body, firstRow);
  findRigidMotions();
  solver_ = engine_ == LinearEngine::multifrontal ? multifrontalSolver(body_.pattern(), kept_)
                                                  : suiteSparseSolver(body_.pattern(), kept_);
  law_ = body_.material().room(body_.points());
}

void BodySystem::findContactDofs(const Model& model, int body, const std::vector<int>& firstRow) {
  std::vector<int> column(body_.freeDofs(), -1);
  const auto forEachEntry = [&](auto visit) {
    for (size_t k = 0; k < model.interfaces.size(); ++k)
      forEachEntryOfC(model.interfaces[k], body, [&](int row, int node, const Point& vector) {
        for (const auto& [equation, value] : body_.parts(node, vector))
          if (equation >= 0 && std::abs(value) > negligible * vector.norm())
            visit(firstRow[k] + row, equation, value);
      });
  };
  forEachEntry([&](int, int equation, double) {
    if (column[equation] >= 0) return;
    column[equation] = static_cast<int>(kept_.size());
    kept_.push_back(equation);
  });
  std::vector<Eigen::Triplet<double>> entries;
  forEachEntry(
      [&](int row, int equation, double value) { entries.emplace_back(row, column[equation], value); });
  C_.resize(firstRow.back(), static_cast<Eigen::Index>(kept_.size()));
  C_.setFromTriplets(entries.begin(), entries.end());
}

void BodySystem::findRigidMotions() {
  motions_ = rigidModes(body_);
  R_.resize(static_cast<Eigen::Index>(kept_.size()), motions_.cols());
  for (Eigen::Index i = 0; i < motions_.cols(); ++i) R_.col(i) = body_.gather(motions_.col(i))(kept_);
  if (motions_.cols() == 0) return;
  // Orthonormal on the contact dofs.
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(R_.transpose() * R_);
  const double largest = std::max(1.0, eigen.eigenvalues().maxCoeff());
  if (eigen.eigenvalues()[0] <= motionTolerance * largest)
    throw UnheldBodyError("body " + body_.name() + ": nothing holds its " +
                          describeRigidMotion(body_, motions_ * eigen.eigenvectors().col(0)) +
                          "; a support (ux, uy) or a contact would");
  const Matrix T = eigen.eigenvectors() * eigen.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal();
  motions_ *= T;
  R_ *= T;
}

template <class Work>
void BodySystem::forEachBlock(const Work& work) {
  threads_->forEach(blocks(), [&](int i) { work(block * i, std::min(block * (i + 1), body_.points())); });
}

template <class Law>
double BodySystem::evaluate(const MaterialStep& step, const Matrix* shift, BodyIterate& iterate,
                            const Law& law) {
  iterate.strain.resizeLike(iterate.stress);
  std::vector<LawReport> reports(blocks());
  forEachBlock([&](int begin, int end) {
    stopIfInterrupted();
    body_.strain(iterate.increment, shift, iterate.strain, begin, end);
    reports[begin / block] = law(begin, end);
  });
  Worst residual;
  law_.elastic = 0;
  for (const LawReport& report : reports) {
    residual.add(report.change);
    law_.elastic += report.elastic;
  }
  return residual.value() == 0 ? 0 : residual.value() / residualScale(step.stress0, iterate);
}

double BodySystem::linearise(const MaterialStep& step, const Matrix* shift, BodyIterate& iterate) {
  return evaluate(step, shift, iterate, [&](int begin, int end) {
    return body_.material().linearise(step, iterate.stress, law_, begin, end);
  });
}

double BodySystem::residualScale(const Matrix& stress0, const BodyIterate& iterate) const {
  // The rounding of the law is a part of the stresses that are there, which may be far beyond yield.
  const double before = stress0.cwiseAbs().maxCoeff();
  if (!body_.material().linear())
    return std::max({body_.material().stressScale(), before, iterate.stress.cwiseAbs().maxCoeff()});
  // What rounding of the displacement makes of a rigid motion: tolerances of 1e-10 times this part are 1e-14 of
  // E |du|/L.
  constexpr double rigidPart = 1e-4;
  const double rigid =
      law_.moduli.cwiseAbs().maxCoeff() * iterate.increment.high.cwiseAbs().maxCoeff() / extent(body_.mesh());
  return std::max({before, law_.predictor.cwiseAbs().maxCoeff(), rigidPart * rigid});
}

double BodySystem::rounding(const Matrix& stress0, const BodyIterate& iterate,
                            const Vector& displacement) const {
  const double strain = std::numeric_limits<double>::epsilon() * body_.largestGradient() *
                        displacement.lpNorm<Eigen::Infinity>();
  const double scale = residualScale(stress0, iterate);
  // A body that was moved before the step and is free of stress has none that could be wrong.
  return strain == 0 || scale == 0 ? 0 : strain * law_.moduli.lpNorm<Eigen::Infinity>() / scale;
}

double BodySystem::regularise(const MaterialStep& step, const Matrix* shift, double relaxation,
                              BodyIterate& iterate) {
  return evaluate(step, shift, iterate, [&](int begin, int end) {
    return body_.material().regularise(step, iterate.stress, penalty_, relaxation, law_, begin, end);
  });
}

void BodySystem::choosePenalty(const Matrix& stress) {
  body_.material().choosePenalty(stress, penalty_);
}

std::string BodySystem::factorise() {
  refactorised_ = false;
  factorisedElastic_ = law_.elastic;
  const bool elastic = law_.elastic == body_.points();
  if (reduce_ && factorised_ && elastic && elasticFactors_) return {};
  refactorised_ = !(std::exchange(counted_, false) && elastic);
  elasticFactors_ = elastic;
  schurFactor_.clear();
  body_.tangent(law_.moduli, values_, *threads_);
  factorised_ = solver_->factorise(values_);
  if (!factorised_ && engine_ == LinearEngine::multifrontal && !body_.pattern().symmetric) {
    // UMFPACK pivots in the whole matrix.
    useLibraries();
    factorised_ = solver_->factorise(values_);
  }
  if (!factorised_) return "body " + body_.name() + ": its tangent is singular with its contact nodes held";
  if (!inContact()) return {};
  // Rigid motions get a stiffness of their own; as z carries them it never acts. It is taken from the tangent: where few
  // nodes are in contact the Schur complement itself may be nothing but rounding.
  Matrix S = solver_->takeSchurComplement();
  if (R_.cols() > 0) {
    double stiffness = 0;
    for (const double value : values_) stiffness = std::max(stiffness, std::abs(value));
    S.noalias() += stiffness * R_ * R_.transpose();
  }
  const bool symmetric = body_.pattern().symmetric;
  factorised_ = schurFactor_.factorise(std::move(S), symmetric) || !symmetric;
  if (!factorised_) return "body " + body_.name() + ": its tangent is not positive definite";
  return {};
}

void BodySystem::addCompliance(Matrix& W) const {
  constexpr int atOnce = 128;
  const Eigen::SparseMatrix<double> columns = C_.transpose();  // contact dofs x contact rows
  for (Eigen::Index begin = 0; begin < columns.cols(); begin += atOnce) {
    stopIfInterrupted();
    const Eigen::Index count = std::min<Eigen::Index>(atOnce, columns.cols() - begin);
    Matrix x = columns.middleCols(begin, count);
    if (x.isZero(0)) continue;
    schurFactor_.solve(x);
    W.middleCols(begin, count) += C_ * x;
  }
}

int BodySystem::determinantSign() const {
  const int interior = solver_->determinantSign();
  return inContact() ? interior * schurFactor_.determinantSign() : interior;
}

void BodySystem::use(Threads& threads) {
  threads_ = &threads;
  solver_->use(threads);
}

void BodySystem::useLibraries() {
  if (engine_ == LinearEngine::suitesparse) return;
  engine_ = LinearEngine::suitesparse;
  solver_ = suiteSparseSolver(body_.pattern(), kept_);
  factorised_ = false;
}

Vector BodySystem::solveSchur(const Vector& f) const {
  Matrix x = f;
  schurFactor_.solve(x);
  return x;
}

Vector BodySystem::condense(const Vector& force) {
  residual_ = body_.gather(force);
  solver_->condense(residual_);
  contactForce_ = residual_(kept_);
  return inContact() ? Vector(solveSchur(contactForce_)) : contactForce_;
}

Vector BodySystem::rigidForce(const Vector& load) const {
  constexpr double roundingOfSums = 1e-14;
  Vector force = motions_.transpose() * load;
  const Vector size = motions_.cwiseAbs().transpose() * load.cwiseAbs();
  for (Eigen::Index i = 0; i < force.size(); ++i)
    if (std::abs(force[i]) <= roundingOfSums * size[i]) force[i] = 0;
  return force;
}

Vector BodySystem::displacementOf(const Vector& forceChange, const Vector& z) {
  if (inContact()) {
    Vector x = solveSchur(contactForce_ - C_.transpose() * forceChange);
    if (R_.cols() > 0) x += R_ * (z - R_.transpose() * x);
    residual_(kept_) = x;
  }
  solver_->expand(residual_);
  return body_.spread(residual_);
}

Matrix BodySystem::stressOf(const Matrix& strain) const {
  Matrix stress(strain.rows(), strain.cols());
  for (int i = 0; i < strain.cols(); ++i) stress.col(i) = mortier::stressOf(law_, strain.col(i), i);
  return stress;
}

void BodySystem::damp(const Matrix& moduli, double delta, const Matrix& strain) {
  if (body_.material().linear()) return;
  law_.moduli += moduli / delta;
  law_.elastic = 0;
  law_.predictor += dampingStress(moduli, delta, strain);
}

Matrix BodySystem::dampingStress(const Matrix& moduli, double delta, const Matrix& strain) const {
  Matrix stress = Matrix::Zero(body_.material().components(), strain.cols());
  if (body_.material().linear()) return stress;
  for (int i = 0; i < strain.cols(); ++i) {
    const std::array<double, 9> D = moduliAt(moduli, i);
    stress.col(i).head<3>() = Eigen::Map<const Eigen::Matrix3d>(D.data()) * strain.col(i).head<3>() / delta;
  }
  return stress;
}

void BodySystem::expand(const Vector& forceChange, const Vector& z, BodyIterate& iterate) {
  const Vector d = displacementOf(forceChange, z);
  iterate.increment += d;
  iterate.stress.resizeLike(law_.predictor);
  forEachBlock([&](int begin, int end) {
    iterate.stress.middleCols(begin, end - begin) = law_.predictor.middleCols(begin, end - begin);
    body_.addStressOf(d, law_, iterate.stress, begin, end);
  });
}

}  // namespace mortier
