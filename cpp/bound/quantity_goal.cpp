#include "bound/quantity_bound.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bound/pressures.h"
#include "mesh/boundary_line.h"
#include "time/quantity_motion.h"

namespace mortier {
namespace {

/// Of directions, and of jumps that are one.
constexpr double roundingOfGoals = 1e-9;

Point directionAt(const Quantity& quantity, const Point& x) {
  return motionAt(quantity, {x.x(), x.y(), 0}).head<2>();
}

/// Boundary values of z: -e in the directions that the supports of the label hold. \returns why they are
/// none of a continuous displacement that is linear on sides; empty where they are
std::string reactionValues(const Quantity& quantity, const Body& body, Vector& z) {
  const TriangleMesh& mesh = body.mesh();
  z = -reactionMotion(quantity, body);
  double size = 0;
  for (size_t k = 0; k < mesh.boundaryEdges.size(); ++k)
    if (mesh.boundaryLabels[k] == quantity.label)
      for (const int v : mesh.boundaryEdges[k])
        size = std::max(size, directionAt(quantity, mesh.vertices[v]).norm());
  for (size_t k = 0; k < mesh.boundaryEdges.size(); ++k) {
    const bool own = mesh.boundaryLabels[k] == quantity.label;
    const auto& [a, b] = mesh.boundaryEdges[k];
    const Point along = (mesh.vertices[b] - mesh.vertices[a]).normalized();
    for (const Condition& held : body.conditions().displacements) {
      if (held.label != mesh.boundaryLabels[k]) continue;
      const Point d = held.component == Component::alongX        ? Point(1, 0)
                      : held.component == Component::alongY      ? Point(0, 1)
                      : held.component == Component::alongNormal ? Point(along.y(), -along.x())
                                                                 : along;
      for (const int v : {a, b}) {
        const double expected = own ? -d.dot(directionAt(quantity, mesh.vertices[v])) : 0;
        if (std::abs(d.dot(z.segment<2>(2 * v)) - expected) > roundingOfGoals * size)
          return "another support holds the body in the same direction where its own ends";
      }
    }
  }
  return "";
}

/// r = e . (inward normal) on the sides of contact with the label. \returns what is wrong with it
std::string weigh(const Admissible& pair, const Quantity& quantity, Vector& r) {
  std::vector<char> seen(pair.lifting.facing.size(), 0);
  for (size_t k = 0; k < pair.meshes.pieces.size(); ++k) {
    const MatchedPiece& piece = pair.meshes.pieces[k];
    const auto& [nonmortar, mortar, coupling] = pair.model.interfaces[piece.interface].pair();
    for (int end = 0; end < 2; ++end) {
      double value = 0;
      for (int side = 0; side < 2; ++side) {
        const ContactSide& at = side == 0 ? nonmortar : mortar;
        if (at.body != quantity.body || at.label != quantity.label) continue;
        const Point& x = pair.bodies[at.body].mesh().vertices[piece.vertices[side][end]];
        value += (side == 0 ? -1 : 1) * piece.normal.dot(directionAt(quantity, x));
      }
      const int i = pair.lifting.facingOfPiece[k][end];
      if (std::exchange(seen[i], 1) != 0 &&
          std::abs(r[i] - value) > roundingOfGoals * std::max(std::abs(r[i]), std::abs(value)))
        return "contact goes on beyond its label";
      r[i] = value;
    }
  }
  return "";
}

/// r of a part of the line: at a vertex the least, or the largest, of what each piece there allows.
void weighPart(const Admissible& pair, const Quantity& quantity, BoundSide side, Vector& r) {
  std::vector<char> seen(pair.lifting.facing.size(), 0);
  const std::vector<Point>& places = pair.bodies[quantity.body].mesh().vertices;
  const double size = quantity.part->size();
  for (size_t k = 0; k < pair.meshes.pieces.size(); ++k) {
    const MatchedPiece& piece = pair.meshes.pieces[k];
    const auto& [nonmortar, mortar, coupling] = pair.model.interfaces[piece.interface].pair();
    std::array<double, 2> values{};
    for (int of = 0; of < 2; ++of) {
      const ContactSide& at = of == 0 ? nonmortar : mortar;
      if (at.body != quantity.body || at.label != quantity.label) continue;
      const double first = quantity.part->along(places[piece.vertices[of][0]]);
      const double last = quantity.part->along(places[piece.vertices[of][1]]);
      values =
          side == BoundSide::below ? quantity.part->below(first, last) : quantity.part->above(first, last);
    }
    for (int end = 0; end < 2; ++end) {
      const int i = pair.lifting.facingOfPiece[k][end];
      const double value = values[end] / size;
      if (std::exchange(seen[i], 1) == 0)
        r[i] = value;
      else
        r[i] = side == BoundSide::below ? std::min(r[i], value) : std::max(r[i], value);
    }
  }
}

/// The first triangle in which a point is; -1 for none.
int triangleAt(const TriangleMesh& mesh, const Point& x) {
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    bool inside = true;
    for (int i = 0; i < 3; ++i)
      inside =
          inside && cross(mesh.vertices[v[(i + 1) % 3]] - mesh.vertices[v[i]], x - mesh.vertices[v[i]]) >=
                        -roundingOfGoals * doubleArea(mesh, static_cast<int>(t));
    if (inside) return static_cast<int>(t);
  }
  return -1;
}

}  // namespace

Goal goalOf(const Admissible& pair, const Quantity& quantity, BoundSide side) {
  Goal goal;
  for (const LoadedBody& body : pair.bodies) {
    goal.held.emplace_back(Vector::Zero(body.body().dofs()));
    goal.loads.emplace_back(Vector::Zero(body.body().dofs()));
  }
  goal.r = Vector::Zero(static_cast<Eigen::Index>(pair.lifting.facing.size()));
  const LoadedBody& body = pair.bodies[quantity.body];
  if (quantity.kind == Quantity::Kind::reaction) {
    goal.obstacle = reactionValues(quantity, body.body(), goal.held[quantity.body]);
  } else if (quantity.kind == Quantity::Kind::contactForce) {
    goal.obstacle = weigh(pair, quantity, goal.r);
  } else if (quantity.kind == Quantity::Kind::meanPressure) {
    weighPart(pair, quantity, side, goal.r);
  } else if (quantity.point) {
    goal.triangle = triangleAt(body.mesh(), quantity.point->head<2>());
    if (goal.triangle < 0) {
      goal.obstacle = "the point is in no triangle";
      return goal;
    }
    goal.force = directionAt(quantity, Point::Zero()) / body.body().weights()[goal.triangle];
    LoadedBody pushed = body.unloaded(goal.held[quantity.body]);
    pushed.push(goal.triangle, goal.force);
    goal.loads[quantity.body] = pushed.load();
  } else {
    double length = 0;
    for (const auto& [a, b] : sidesWith(body.mesh(), quantity.label))
      length += (body.mesh().vertices[b] - body.mesh().vertices[a]).norm();
    goal.traction = directionAt(quantity, Point::Zero()) / length;
    LoadedBody pulled = body.unloaded(goal.held[quantity.body]);
    pulled.pull(quantity.label, goal.traction);
    goal.loads[quantity.body] = pulled.load();
  }
  return goal;
}

std::optional<std::vector<Vector>> adjointPressure(const Admissible& pair, const Vector& glue,
                                                   const std::vector<LoadedBody>& bodies, double c) {
  std::vector<Vector> forces;
  for (const Vector& each : pair.spread) forces.emplace_back(Vector::Zero(each.size()));
  std::vector<char> done(pair.lifting.facing.size(), 0);
  for (size_t k = 0; k < pair.meshes.pieces.size(); ++k) {
    const MatchedPiece& piece = pair.meshes.pieces[k];
    for (int end = 0; end < 2; ++end) {
      const int i = pair.lifting.facingOfPiece[k][end];
      if (std::exchange(done[i], 1) != 0) continue;
      for (int row = 0; row < 2 && piece.rows[row] >= 0; ++row)
        forces[piece.interface][piece.rows[row]] += piece.values[row][end] * glue[i];
    }
  }
  std::vector<Vector> q = spreadForces(pair.model, forces, pair.meshes);
  for (size_t k = 0; k < q.size(); ++k)
    for (Eigen::Index row = 0; row < q[k].size(); ++row) {
      const double p = pair.spread[k][row];
      q[k][row] = p > 0 ? std::clamp(q[k][row], -c * p, c * p) : 0;
    }
  if (!balanceBy(pair.spread, pair.model, pair.meshes, bodies, q)) return std::nullopt;
  return q;
}

}  // namespace mortier
