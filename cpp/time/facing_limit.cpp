#include "time/facing_limit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/formatted.h"

namespace mortier {
namespace {

/// A stretch of a side as displacements have moved it.
struct MovedEdge {
  std::array<int, 2> nodes;
  Point from, to;

  [[nodiscard]] double distance(const Point& x) const {
    const Point along = to - from;
    const double part = std::clamp(along.dot(x - from) / along.squaredNorm(), 0.0, 1.0);
    return (x - from - part * along).norm();
  }
};

std::vector<MovedEdge> movedEdges(const Body& body, int label, const Vector& u) {
  const ElementNodes& nodes = body.elementNodes();
  const auto at = [&](int node) -> Point { return nodes.places[node] + u.segment<2>(2 * node); };
  std::vector<MovedEdge> edges;
  for (const auto& part : nodes.boundary)
    if (body.mesh().boundaryLabels[part.edge] == label)
      edges.push_back({part.nodes, at(part.nodes[0]), at(part.nodes[1])});
  return edges;
}

/// Between the normals of two edges [degrees].
double angleBetween(const MovedEdge& a, const MovedEdge& b) {
  const Point along1 = a.to - a.from;
  const Point along2 = b.to - b.from;
  return std::abs(std::atan2(cross(along1, along2), along1.dot(along2))) * 180 / M_PI;
}

/// The largest angle between the normals of an edge at the node and of the nearest edge of the other side.
double angleAt(int node, const Point& x, const std::vector<MovedEdge>& own,
               const std::vector<MovedEdge>& across) {
  constexpr double sameDistance = 1e-6;  // of an edge: both edges at a corner
  double nearest = infinity;
  for (const MovedEdge& edge : across) nearest = std::min(nearest, edge.distance(x));
  double largest = 0;
  for (const MovedEdge& edge : own) {
    if (edge.nodes[0] != node && edge.nodes[1] != node) continue;
    for (const MovedEdge& other : across)
      if (other.distance(x) <= nearest + sameDistance * (other.to - other.from).norm())
        largest = std::max(largest, angleBetween(edge, other));
  }
  return largest;
}

}  // namespace

std::string nearFacingLimit(const Model& model, const State& state) {
  constexpr double limit = 120;  // [degrees]
  double least = limit + 10;
  std::string text;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    if (!interface.follows() || interface.dimension() == 3) continue;
    const auto& [nonmortar, mortar, coupling] = interface.pair();
    const Body& body = model.bodies[nonmortar.body];
    const Vector& u = state.bodies[nonmortar.body].displacement;
    const std::vector<MovedEdge> own = movedEdges(body, nonmortar.label, u);
    const std::vector<MovedEdge> across =
        movedEdges(model.bodies[mortar.body], mortar.label, state.bodies[mortar.body].displacement);
    for (int row = 0; row < interface.rows(); ++row) {
      if (!(state.contactForce[k][row] > 0)) continue;
      const int node = interface.nonmortarNodes()[row];
      const Point x = body.elementNodes().places[node] + u.segment<2>(2 * node);
      const double angle = angleAt(node, x, own, across);
      if (!(angle < least)) continue;
      least = angle;
      text = formatted("; at (%.4g, %.4g) the normals of the sides of ", x.x(), x.y()) + body.name() +
             " and " + model.bodies[mortar.body].name() +
             formatted(" make %.3g degrees, and sides touch where they make %g or more", angle, limit);
    }
  }
  return text;
}

}  // namespace mortier
