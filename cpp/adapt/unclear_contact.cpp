#include "adapt/unclear_contact.h"

#include <algorithm>

#include "contact/surface.h"
#include "solver/iterate.h"

namespace mortier {
namespace {

/// By nodes of a body: the largest expected error of a surface at its triangles there [m].
Vector errorsOn(const Body& body, int label) {
  const SpaceElements& space = *body.space();
  const ContactSurface surface(space.mesh(), space.nodes(), label);
  Vector errors = Vector::Zero(space.nodes().count());
  for (size_t t = 0; t < surface.triangles.size(); ++t)
    for (int k = 0; k < surface.perTriangle(); ++k) {
      double& error = errors[surface.triangles[t][k]];
      error = std::max(error, surface.offsetError(static_cast<int>(t)));
    }
  return errors;
}

}  // namespace

std::optional<MissedContact> unclearContact(const Model& model, const State& state) {
  constexpr double known = 1e-6;  // of an element: of the least distance in it
  const std::vector<Vector> u = displacementsOf(state);
  std::optional<MissedContact> deepest;
  double most = 0;
  for (size_t i = 0; i < model.interfaces.size(); ++i) {
    const ContactInterface& interface = model.interfaces[i];
    const ContactInterface::SurfacePoints& points = interface.nearestPoints();
    if (points.distances.size() == 0 || (state.contactForce[i].array() > 0).any()) continue;
    const ContactPair& pair = interface.pair();
    const Body& nonmortar = model.bodies[pair.nonmortar.body];
    const Body& mortar = model.bodies[pair.mortar.body];
    const Matrix jump = points.jump(u[pair.nonmortar.body], u[pair.mortar.body]);
    const auto placesOf = [&](const Body& body, int side) -> Matrix {
      const std::vector<SpacePoint>& x = body.space()->nodes().places;
      Matrix places(static_cast<Eigen::Index>(x.size()), 3);
      for (size_t node = 0; node < x.size(); ++node) places.row(static_cast<Eigen::Index>(node)) = x[node];
      return points.traces[side] * places;
    };
    // Weights of quadratic traces may be negative: a bound.
    const auto errorOf = [&](const Body& body, int label, int side) -> Vector {
      return points.traces[side].cwiseAbs() * errorsOn(body, label);
    };
    const Vector error = errorOf(nonmortar, pair.nonmortar.label, 0) + errorOf(mortar, pair.mortar.label, 1);
    const Matrix one = placesOf(nonmortar, 0);
    const Matrix other = placesOf(mortar, 1);
    for (Eigen::Index k = 0; k < error.size(); ++k) {
      const double depth = points.normals[k].dot(jump.col(k)) - points.distances[k] + error[k];
      if (!(depth > std::max(most, known * points.sizes[0][k]))) continue;
      most = depth;
      deepest = MissedContact{{nonmortar.name(), mortar.name()}, {one.row(k), other.row(k)}};
    }
  }
  return deepest;
}

}  // namespace mortier
