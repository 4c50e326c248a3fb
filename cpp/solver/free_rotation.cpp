#include "solver/free_rotation.h"

#include <cmath>

#include "base/dense_templates.h"
#include "fem/rigid_modes.h"

namespace mortier {
namespace {

constexpr double same = 1e-6;  // of a radius, or of a motion

/// By dofs, of an angle of one.
Vector rotationAbout(const Point& centre, const Body& body) {
  const std::vector<Point>& places = body.elementNodes().places;
  Vector u(2 * static_cast<Eigen::Index>(places.size()));
  for (size_t v = 0; v < places.size(); ++v) {
    const Point from = places[v] - centre;
    u.segment<2>(2 * static_cast<Eigen::Index>(v)) << -from.y(), from.x();
  }
  return u;
}

/// |x|^2 - 2 c . x = const in the mean of squares.
Point centreOf(const std::vector<Point>& points) {
  Matrix equations(points.size(), 3);
  Vector squares(points.size());
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    const Point x = points[i] - points[0];
    equations.row(i) << 2 * x.x(), 2 * x.y(), 1;
    squares[i] = x.squaredNorm();
  }
  const Vector found = equations.colPivHouseholderQr().solve(squares);
  return points[0] + Point(found[0], found[1]);
}

}  // namespace

std::optional<Point> centreOfRoller(const Model& model, int body) {
  const Body& of = model.bodies[body];
  std::optional<Point> centre;
  for (const ContactInterface& interface : model.interfaces) {
    const ContactPair& pair = interface.pair();
    if (pair.nonmortar.body != body && pair.mortar.body != body) continue;
    if (interface.hasFriction() || of.axisymmetric() || of.dimension() == 3) return std::nullopt;
    std::vector<Point> points;
    for (const int node : pair.nonmortar.body == body ? interface.nonmortarNodes() : interface.mortarNodes())
      points.push_back(of.elementNodes().places[node]);
    if (points.size() < 4) return std::nullopt;
    if (!centre) centre = centreOf(points);
    const double radius = (points[0] - *centre).norm();
    if (!(radius < of.extent() / same)) return std::nullopt;
    for (const Point& x : points)
      if (!(std::abs((x - *centre).norm() - radius) <= same * std::min(radius, of.extent())))
        return std::nullopt;
  }
  return centre;
}

std::optional<Point> freeRotation(const Model& model, int body) {
  const std::optional<Point> centre = centreOfRoller(model, body);
  if (!centre) return std::nullopt;
  const Body& of = model.bodies[body];
  const Matrix modes = rigidModes(of);
  const Vector turn = rotationAbout(*centre, of);
  if (modes.cols() == 0 ||
      (turn - modes * modes.colPivHouseholderQr().solve(turn)).norm() > same * turn.norm())
    return std::nullopt;
  return centre;
}

bool turnsInItself(const Model& model, int body, const Vector& motion) {
  const std::optional<Point> centre = centreOfRoller(model, body);
  if (!centre) return false;
  const Vector turn = rotationAbout(*centre, model.bodies[body]);
  constexpr double nearly = 0.3;  // closed nodes of a polygon lie beside the points where the circle touches
  return (motion - turn * (turn.dot(motion) / turn.squaredNorm())).norm() <= nearly * motion.norm();
}

}  // namespace mortier
