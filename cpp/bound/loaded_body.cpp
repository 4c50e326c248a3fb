#include "bound/loaded_body.h"

#include <algorithm>
#include <memory>

#include "base/dense_templates.h"
#include "base/interrupt.h"
#include "bound/relaxation.h"
#include "bound/unresolved_data.h"
#include "fem/rigid_modes.h"
#include "linear/condensing_solver.h"
#include "material/stress.h"

namespace mortier {
namespace {

/// (p, q, r) of (s11, s22, s12), and the same for strains.
Eigen::Matrix3d toBasis() {
  Eigen::Matrix3d B;
  for (int c = 0; c < 3; ++c) B.col(c) = fromCartesian(Eigen::Vector3d::Unit(c));
  return B;
}

/// What forces that are out of balance are measured against [N/m].
double sizeOf(const Body& body, const Vector& load, const Vector& left) {
  return std::max(body.gather(left).lpNorm<Eigen::Infinity>(), body.gather(load).lpNorm<Eigen::Infinity>());
}

}  // namespace

Linearisation elasticLaw(const Body& body) {
  const Material& material = body.material();
  Linearisation law = material.room(body.points());
  const Matrix none = Matrix::Zero(material.components(), body.points());
  material.linearise({0, none, none}, none, law, 0, body.points());
  return law;
}

LoadedBody::LoadedBody(const Model& model, const State& state, const CutMesh& cut, int index)
    : place_{model.bodies[index],
             cut,
             {model.bodies[index].name(), cut.mesh,
              std::shared_ptr<const Material>(std::shared_ptr<void>(), &model.bodies[index].material()),
              model.bodies[index].conditions()},
             Sides(cut.mesh),
             cut.displacement(state.bodies[index].displacement),
             {},
             {}},
      modes_(rigidModes(place_.body)) {
  const Linearisation law = elasticLaw(model.bodies[index]);
  const Eigen::Matrix3d B = toBasis();
  place_.moduli.reserve(place_.cut.parents.size());
  place_.compliances.reserve(place_.cut.parents.size());
  stress_.reserve(place_.cut.parents.size());
  for (size_t t = 0; t < place_.cut.parents.size(); ++t) {
    const int parent = place_.cut.parents[t];
    place_.moduli.emplace_back(Eigen::Map<const Eigen::Matrix3d>(moduliAt(law.moduli, parent).data()));
    if (t > 0 && place_.moduli[t] == place_.moduli[t - 1])
      place_.compliances.push_back(place_.compliances.back());
    else
      place_.compliances.emplace_back(B.transpose() * place_.moduli.back().inverse() * B);
    stress_.emplace_back(toCartesian(state.bodies[index].stress.col(parent).head<3>()));
  }
  data_ = readData(place_, state.time);
}

void LoadedBody::move(const std::array<int, 2>& vertices, const Point& along, const SideDatum& datum) {
  moveSide(place_, sideBetween(vertices), along, datum, data_);
}
double LoadedBody::movedEnergy(const std::array<int, 2>& vertices, const Point& along,
                               const SideDatum& datum) const {
  return mortier::movedEnergy(place_, sideBetween(vertices), along, datum);
}

void LoadedBody::press(const std::array<int, 2>& vertices, const Point& outward,
                       const std::array<double, 2>& moments) {
  const int e = sideBetween(vertices);
  const int first = place_.sides.all()[e].vertices[0] == vertices[0] ? 0 : 1;
  for (int end = 0; end < 2; ++end) {
    data_.known[e].moments[end == 0 ? first : 1 - first] -= moments[end] * outward;
    data_.load.segment<2>(2 * vertices[end]) -= moments[end] * outward;
  }
}
int LoadedBody::sideBetween(const std::array<int, 2>& vertices) const {
  for (const int e : place_.sides.sidesAt(vertices[0]))
    if (place_.sides.all()[e].vertices[0] == vertices[1] || place_.sides.all()[e].vertices[1] == vertices[1])
      return e;
  return -1;
}

bool LoadedBody::balance() {
  std::vector<Stress> stress = stress_;
  if (!equilibrate(stress)) return false;
  moments_ = balancedMoments(mesh(), place_.sides, stress, data_.forces, data_.known);
  Relaxation relaxation(mesh(), place_.sides, place_.compliances, stress_, data_.forces, data_.known,
                        moments_);
  relaxation.relax();
  energies_ = relaxation.energies();
  return true;
}
double LoadedBody::norm() const {
  double sum = 0;
  for (size_t t = 0; t < stress_.size(); ++t)
    sum += doubleArea(mesh(), static_cast<int>(t)) / 2 * stress_[t].dot(place_.compliances[t] * stress_[t]);
  return sum;
}
std::array<Point, 2> LoadedBody::asPressed(const std::array<int, 2>& vertices) const {
  const int e = sideBetween(vertices);
  std::array<Point, 2> moments = moments_[e];
  const KnownTraction& known = data_.known[e];
  for (int end = 0; end < 2; ++end) {
    const Point off = moments[end] - known.moments[end];
    moments[end] = known.moments[end];
    for (int i = 0; i < known.count; ++i) moments[end] += known.known[i].dot(off) * known.known[i];
  }
  if (place_.sides.all()[e].vertices[0] != vertices[0]) std::swap(moments[0], moments[1]);
  return moments;
}
Imbalance LoadedBody::imbalance() const {
  return imbalanceOf(mesh(), place_.sides, moments_, data_.forces, data_.known);
}

LoadedBody LoadedBody::unloaded(const Vector& near) const {
  LoadedBody result = *this;
  result.place_.displacement = near;
  result.stress_ = stressOf(near);
  result.data_.load.setZero();
  result.data_.error = 0;
  for (BodyLoad& force : result.data_.forces) force.setZero();
  for (KnownTraction& known : result.data_.known) known.moments = {Point(0, 0), Point(0, 0)};
  return result;
}

void LoadedBody::pull(int label, const Point& traction) {
  for (int e = 0; e < place_.sides.count(); ++e) {
    const Side& side = place_.sides.all()[e];
    if (side.boundary < 0 || mesh().boundaryLabels[side.boundary] != label) continue;
    const auto& [a, b] = side.vertices;
    const Point moment = (mesh().vertices[b] - mesh().vertices[a]).norm() / 2 * traction;
    for (int end = 0; end < 2; ++end) {
      data_.known[e].moments[end] += moment;
      data_.load.segment<2>(2 * side.vertices[end]) += moment;
    }
  }
}

void LoadedBody::push(int triangle, const Point& force) {
  data_.forces[triangle].head<2>() += force;
  for (const int v : mesh().triangles[triangle])
    data_.load.segment<2>(2 * v) += place_.body.weights()[triangle] / 3 * force;
}

CompositeTriangle LoadedBody::elementOf(int triangle) const {
  const auto& v = mesh().triangles[triangle];
  return {{mesh().vertices[v[0]], mesh().vertices[v[1]], mesh().vertices[v[2]]},
          place_.compliances[triangle]};
}

Vector LoadedBody::leftOver(Vector forces, const std::vector<Stress>& stress) const {
  for (int t = 0; t < static_cast<int>(stress.size()); ++t) takeForces(mesh(), t, stress[t], forces);
  return forces;
}

std::vector<Stress> LoadedBody::stressOf(const Vector& displacement) const {
  const Eigen::Matrix3d back = toBasis().inverse();
  std::vector<Stress> stress(place_.moduli.size());
  for (int t = 0; t < static_cast<int>(stress.size()); ++t)
    stress[t] = back * (place_.moduli[t] * strainIn(mesh(), t, displacement));
  return stress;
}

std::vector<double> LoadedBody::tangent() const {
  Matrix moduli(place_.body.material().symmetricTangent() ? 6 : 9,
                static_cast<Eigen::Index>(place_.moduli.size()));
  for (size_t t = 0; t < place_.moduli.size(); ++t) {
    const Eigen::Matrix3d& D = place_.moduli[t];
    if (moduli.rows() == 6)
      moduli.col(t) << D(0, 0), D(1, 0), D(2, 0), D(1, 1), D(2, 1), D(2, 2);
    else
      moduli.col(t) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(D.data());
  }
  std::vector<double> values(place_.body.pattern().entries());
  place_.body.tangent(moduli, values);
  return values;
}

/// Adds what brings finite element stresses into equilibrium with the load; what rounding leaves is taken up
/// again.
bool LoadedBody::equilibrate(std::vector<Stress>& stress) const {
  constexpr int most = 4;
  constexpr double enough = 1e-10;  // of the largest force
  const Vector left = leftOver(data_.load, stress);
  const double size = sizeOf(place_.body, data_.load, left);
  std::vector<double> values = tangent();
  pin(values);
  auto solver = multifrontalSolver(place_.body.pattern(), {});
  if (!solver->factorise(values)) {
    solver = suiteSparseSolver(place_.body.pattern(), {});
    if (!solver->factorise(values)) return false;
  }
  Vector x = place_.body.gather(left);
  for (int i = 0; i < most; ++i) {
    solver->condense(x);
    solver->expand(x);
    const std::vector<Stress> more = stressOf(place_.body.spread(x));
    for (size_t t = 0; t < stress.size(); ++t) stress[t] += more[t];
    x = place_.body.gather(leftOver(data_.load, stress));
    if (!(x.lpNorm<Eigen::Infinity>() > enough * size)) break;
  }
  return true;
}

/// Springs at as many equations as there are rigid motions: forces in equilibrium leave them at rest.
void LoadedBody::pin(std::vector<double>& values) const {
  if (modes_.cols() == 0) return;
  Matrix motions(place_.body.freeDofs(), modes_.cols());
  for (Eigen::Index m = 0; m < modes_.cols(); ++m) motions.col(m) = place_.body.gather(modes_.col(m));
  const Eigen::ColPivHouseholderQR<Matrix> qr(motions.transpose());
  const SparsePattern& pattern = place_.body.pattern();
  for (Eigen::Index m = 0; m < modes_.cols(); ++m) {
    const int equation = qr.colsPermutation().indices()[m];
    for (int k = pattern.columnStart[equation]; k < pattern.columnStart[equation + 1]; ++k)
      if (pattern.rows[k] == equation) values[k] *= 2;
  }
}

}  // namespace mortier
