#include "time/mesh_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "material/stress.h"
#include "mesh/simplices.h"
#include "solver/model.h"

namespace mortier {

namespace {

/// Strain over stress along x, or along the stiffest of the axes and the bisectors between them where these
/// differ by more than rounding [1/Pa].
Vector stiffestCompliance(const Body& body, Threads& threads) {
  constexpr double differs = 1 - 1e-9;
  // s11, s22, s12, s33, s13, s23; the first four are of the plane.
  const SpaceStress along[] = {
      {1, 0, 0, 0, 0, 0},        {0, 1, 0, 0, 0, 0},       {0.5, 0.5, 0.5, 0, 0, 0},
      {0.5, 0.5, -0.5, 0, 0, 0}, {0, 0, 0, 1, 0, 0},       {0.5, 0, 0, 0.5, 0.5, 0},
      {0.5, 0, 0, 0.5, -0.5, 0}, {0, 0.5, 0, 0.5, 0, 0.5}, {0, 0.5, 0, 0.5, 0, -0.5}};
  const bool space = body.space() != nullptr;
  Matrix stress(body.material().components(), body.points());
  Matrix strain(body.material().components(), body.points());
  Vector result(body.points());
  forEachBlock(body.points(), threads, [&](int begin, int end) {
    auto own = stress.middleCols(begin, end - begin);
    own.setZero();
    for (const SpaceStress& s : along) {
      if (space)
        own.topRows<6>().colwise() = fromSpaceCartesian(SpaceStress{s[0], s[1], s[3], s[2], s[4], s[5]});
      else if (&s == along + 4)
        break;
      else
        own.topRows<3>().colwise() = fromCartesian(s.head<3>());
      body.material().elasticStrain(stress, strain, begin, end);
      for (int i = begin; i < end; ++i) {
        const double compliance = stress.col(i).dot(strain.col(i));
        if (&s == along || compliance < differs * result[i]) result[i] = compliance;
      }
    }
  });
  return result;
}

}  // namespace

MeshErrorEstimator::MeshErrorEstimator(const Model& model, Threads& threads) : model_(model) {
  for (const Body& body : model.bodies) {
    bodies_.emplace_back(body);
    compliances_.push_back(stiffestCompliance(body, threads));
  }
  for (const ContactInterface& interface : model.interfaces) {
    const auto& [nonmortar, mortar, coupling] = interface.pair();
    for (const ContactSide& side : {nonmortar, mortar}) addSides(side.body, side.label);
  }
  if (model.bodies.front().dimension() == 2) readData();
}

void MeshErrorEstimator::addSides(int body, int label) {
  const auto [place, isNew] = behind_.try_emplace({body, label});
  if (!isNew) return;
  place->second = model_.bodies[body].withMesh(
      [&](const auto& mesh, const auto&) { return elementsBehind(mesh, label); });
}

int MeshErrorEstimator::elementBehind(int body, int label, const std::array<int, 2>& edge) const {
  return behind_.at({body, label}).at(sideOf(edge));
}

MeshErrorEstimator::Compliance MeshErrorEstimator::complianceOf(const State& state, int body,
                                                                int triangle) const {
  const Body& of = model_.bodies[body];
  if (of.rigid()) return {0, 0};
  const int point = of.pointsOfTriangle() * triangle;
  const double elastic = compliances_[body][point];
  if (of.material().linear()) return {elastic, elastic};
  // What has flowed is as soft as it was strained.
  const double flowed = state.bodies[body].viscoplasticStrain.col(point).norm();
  const double stress = state.bodies[body].stress.col(point).norm();
  return {elastic, stress > 0 ? elastic + flowed / stress : elastic};
}

std::vector<ErrorEstimate> MeshErrorEstimator::operator()(const State& state, Threads& threads) const {
  std::vector<ErrorEstimate> estimates(bodies_.size());
  threads.forEach(static_cast<int>(bodies_.size()),
                  [&](int b) { estimates[b] = bodies_[b](state.bodies[b].stress, threads); });
  const bool space = model_.bodies.front().dimension() == 3;
  for (size_t k = 0; k < model_.interfaces.size(); ++k)
    if (space)
      addSurfaceGaps(k, state, estimates);
    else
      addGaps(k, state, estimates);
  addTies(state, estimates);
  if (!space) addData(state, estimates);
  return estimates;
}

void MeshErrorEstimator::addTies(const State& state, std::vector<ErrorEstimate>& estimates) const {
  const std::vector<Vector> u = displacementsOf(state);
  for (size_t k = 0; k < model_.ties.size(); ++k) {
    const Tie& tie = model_.ties[k];
    const int nonmortar = tie.pair().nonmortar.body;
    const int mortar = tie.pair().mortar.body;
    const TiePoints& points = tie.points();
    const Matrix jump = tie.jumpAtPoints(u, state.tieForce[k]);
    for (Eigen::Index i = 0; i < jump.cols(); ++i) {
      const auto& [own, opposite] = points.elements[i];
      Compliance compliance = complianceOf(state, nonmortar, own) + complianceOf(state, mortar, opposite);
      compliance.all += points.layer / points.sizes[i];
      estimates[nonmortar].error[own] += compliance.elastic / (compliance.all * compliance.all) *
                                         points.weights[i] * jump.col(i).squaredNorm() / points.sizes[i];
    }
  }
}

/// The square of a state that is moved by a small part of the field: what it differs by is twice the product.
std::vector<Vector> MeshErrorEstimator::products(const State& state, const std::vector<ErrorEstimate>& own,
                                                 const std::vector<Response>& other, Threads& threads) const {
  constexpr double little = 1e-8;  // its square, which is left out, is no more than rounding
  double energy = 0;
  double energyOfOther = 0;
  for (size_t b = 0; b < other.size(); ++b) {
    Matrix strain;
    model_.bodies[b].material().elasticStrain(other[b].stress, strain);
    for (int i = 0; i < model_.bodies[b].points(); ++i)
      energyOfOther += model_.bodies[b].weights()[i] * other[b].stress.col(i).dot(strain.col(i));
    energy += own[b].energy;
  }
  std::vector<Vector> result;
  if (!(energy > 0) || !(energyOfOther > 0)) {
    for (const ErrorEstimate& each : own) result.emplace_back(Vector::Zero(each.error.size()));
    return result;
  }
  const double part = little * std::sqrt(energy / energyOfOther);
  State moved = state;
  for (size_t b = 0; b < other.size(); ++b) {
    BodyState& body = moved.bodies[b];
    body.displacement += part * other[b].displacement;
    body.stress += part * other[b].stress;
    // What has flowed is as soft as it was.
    for (Eigen::Index i = 0; i < body.viscoplasticStrain.cols(); ++i)
      if (const double stress = state.bodies[b].stress.col(i).norm(); stress > 0)
        body.viscoplasticStrain.col(i) *= body.stress.col(i).norm() / stress;
  }
  const std::vector<ErrorEstimate> with = (*this)(moved, threads);
  for (size_t b = 0; b < own.size(); ++b) result.emplace_back((with[b].error - own[b].error) / (2 * part));
  return result;
}

void CurrentMeshError::moveTo(const State& state) {
  state_ = &state;
  estimates_.reset();
}

CurrentMeshError::Estimates CurrentMeshError::estimates() {
  if (!estimates_) {
    Threads threads(threadsFor(model_, threads_));
    estimates_ = std::make_shared<const std::vector<ErrorEstimate>>(estimator(threads)(*state_, threads));
  }
  return estimates_;
}

double CurrentMeshError::roundingOf(size_t body, double displacement) {
  Threads threads(threadsFor(model_, threads_));
  return estimator(threads).roundingOf(body, displacement, threads);
}

std::vector<Vector> CurrentMeshError::products(const std::vector<Response>& other) {
  const Estimates own = estimates();
  Threads threads(threadsFor(model_, threads_));
  return estimator(threads).products(*state_, *own, other, threads);
}

Matrix CurrentMeshError::recovered(size_t body) {
  Threads threads(threadsFor(model_, threads_));
  return estimator(threads).ofBody(body).recovered(state_->bodies[body].stress, threads);
}

const MeshErrorEstimator& CurrentMeshError::estimator(Threads& threads) {
  if (!estimator_) estimator_.emplace(model_, threads);
  return *estimator_;
}

void MeshErrorEstimator::addGaps(size_t interface, const State& state,
                                 std::vector<ErrorEstimate>& estimates) const {
  const ContactInterface& contact = model_.interfaces[interface];
  const auto& [nonmortar, mortar, coupling] = contact.pair();
  // Forces that are conditions on projections of quadratic traces have a pressure that does not vanish
  // outside contact.
  const bool bounded =
      hasMeans(coupling) || (coupling == CouplingKind::mortar && model_.bodies[nonmortar.body].degree() == 1);
  if (!bounded) return;
  for (const GapSquare& square :
       contact.gapSquares(state.contactForce[interface], state.bodies[nonmortar.body].displacement,
                          state.bodies[mortar.body].displacement, state.time)) {
    const int triangle = elementBehind(nonmortar.body, nonmortar.label, square.nonmortar);
    const Compliance compliance =
        complianceOf(state, nonmortar.body, triangle) +
        complianceOf(state, mortar.body, elementBehind(mortar.body, mortar.label, square.mortar));
    estimates[nonmortar.body].error[triangle] +=
        compliance.elastic / (compliance.all * compliance.all) * square.integral / square.element;
  }
}

double MeshErrorEstimator::roundingOf(size_t body, double displacement, Threads& threads) const {
  constexpr double roundings = 4;
  const Body& of = model_.bodies[body];
  const double u = roundings * std::numeric_limits<double>::epsilon() * displacement;
  const Matrix ones = Matrix::Ones(of.material().components(), of.points());
  Matrix strain(of.material().components(), of.points());
  const std::vector<Point> places = of.axisymmetric() ? of.places() : std::vector<Point>();
  // What the square of a size of an element stands for: 1, the circumference, in space the size itself.
  const auto beyondSquare = [&](int i) {
    if (of.space() != nullptr) return std::cbrt(of.pointsOfTriangle() * of.weights()[i]);
    return of.axisymmetric() ? of.depthAt(places[i]) : 1.0;
  };
  std::vector<double> sums(blocksOf(of.points()), 0);
  forEachBlock(of.points(), threads, [&](int begin, int end) {
    of.material().elasticStrain(ones, strain, begin, end);
    double& sum = sums[begin / itemsOfBlock];
    for (int i = begin; i < end; ++i)
      sum += beyondSquare(i) * u * u / strain.col(i).cwiseAbs().head<3>().minCoeff();
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace mortier
