#include "fem/supports.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "mesh/boundary_line.h"

namespace mortier {
namespace {

/// Sides that turn by less are smooth.
const double cornerCosine = std::cos(40 * std::numbers::pi / 180);

/// Directions whose sine is below this are the same: straight sides have one, whatever coordinates round.
constexpr double sameDirection = 1e-5;

/// A stretch of the boundary seen from one of its nodes.
struct Side {
  int edge = 0;    ///< number of the stretch
  int other = 0;   ///< the node at its other end
  Point weighted;  ///< outward normal over the squared length of the edge: over the length, a unit vector
  Point normal;    ///< unit
};

using SidesOfNodes = std::map<int, std::vector<Side>>;

bool parallel(const Point& a, const Point& b) {
  return std::abs(cross(a, b)) < sameDirection;
}

bool isTurned(int component) {
  return component == alongNormal || component == alongTangent;
}

Point axis(int component) {
  return Point::Unit(component == alongX ? 0 : 1);
}

/// The edges with a normal or tangential condition, by their nodes.
SidesOfNodes sidesOf(const TriangleMesh& mesh, const ElementNodes& nodes,
                     const std::vector<PrescribedDisplacement>& conditions) {
  SidesOfNodes result;
  for (size_t e = 0; e < nodes.boundary.size(); ++e) {
    const auto& [edge, whole] = nodes.boundary[e];
    const int label = mesh.boundaryLabels[whole];
    const auto here = [&](const PrescribedDisplacement& c) {
      return c.actsOn(label) && isTurned(c.component);
    };
    if (std::none_of(conditions.begin(), conditions.end(), here)) continue;
    const Point along = nodes.places[edge[1]] - nodes.places[edge[0]];
    const double length = along.norm();
    const Point normal(along.y() / length, -along.x() / length);
    for (const int end : {0, 1})
      result[edge[end]].push_back({static_cast<int>(e), edge[1 - end], normal / length, normal});
  }
  return result;
}

/// The other side at the node that continues this one smoothly; nullptr where there is none.
const Side* smoothNeighbour(const std::vector<Side>& sides, const Side& side) {
  for (const Side& each : sides)
    if (each.edge != side.edge && each.normal.dot(side.normal) > cornerCosine) return &each;
  return nullptr;
}

/// The normal of a side at a node.
Point normalAt(const SidesOfNodes& sides, int node, const Side& side) {
  // Of the circle through three nodes: edge normals weighted by the inverse lengths.
  if (const Side* next = smoothNeighbour(sides.at(node), side))
    return (side.weighted + next->weighted).normalized();
  // At an end of the line: the neighbour's normal, mirrored at that of the edge between.
  const std::vector<Side>& there = sides.at(side.other);
  if (const Side* next = smoothNeighbour(there, side)) {
    const Point m = (side.weighted + next->weighted).normalized();
    return (2 * m.dot(side.normal) * side.normal - m).normalized();
  }
  return side.normal;
}

Point upwards(const Point& direction) {
  return direction.y() < 0 ? Point(-direction) : direction;
}

/// A direction and the number by which it is sorted: the sign of a cross product is no order, as that of a
/// direction with itself may be positive where products are rounded once.
struct Upwards {
  explicit Upwards(const Point& either) : direction(upwards(either)) {
    angle = std::atan2(direction.y(), direction.x());
  }

  Point direction;   ///< unit, upwards
  double angle = 0;  ///< from the x axis, 0 to pi
};

/// The axis or the mean of all directions that are the same as this one: nodes of a straight side may lie
/// beside it by the rounding of their coordinates, and would hold the body along the side.
/// \param all  by their angles, ascending
Point oneOf(const std::vector<Upwards>& all, const Point& direction) {
  const auto& [own, angle] = Upwards(direction);
  Point mean(0, 0);
  for (const Point& same : {Point(1, 0), Point(0, 1)})
    if (parallel(same, own)) mean = own.dot(same) > 0 ? same : Point(-same);
  if (mean.isZero(0)) {
    const auto first = std::lower_bound(all.begin(), all.end(), angle - sameDirection,
                                        [](const Upwards& each, double least) { return each.angle < least; });
    for (auto each = first; each != all.end() && each->angle < angle + sameDirection; ++each)
      mean += each->direction;
    mean.normalize();
  }
  return mean.dot(direction) > 0 ? mean : Point(-mean);
}

}  // namespace

void Supports::hold(NodeSupport& support, const Point& direction, int condition) {
  if (const int same = sameMotion(support, direction); same >= 0) {
    if (support.conditions[same] != condition) further_.push_back({support.node, condition, direction});
    return;
  }
  if (support.count == 2) {
    further_.push_back({support.node, condition, direction});
    return;
  }
  support.directions[support.count] = direction;
  support.conditions[support.count] = condition;
  ++support.count;
}

Supports::Supports(const TriangleMesh& mesh, const ElementNodes& nodes,
                   const std::vector<PrescribedDisplacement>& conditions) {
  const SidesOfNodes sides = sidesOf(mesh, nodes, conditions);
  std::map<int, NodeSupport> held;
  const auto directionAt = [&](size_t c, size_t e, int node) -> Point {
    const std::vector<Side>& here = sides.at(node);
    const auto side =
        std::find_if(here.begin(), here.end(), [&](const Side& s) { return s.edge == static_cast<int>(e); });
    const Point n = normalAt(sides, node, *side);
    return conditions[c].component == alongNormal ? n : Point(-n.y(), n.x());
  };
  std::vector<Upwards> directions;
  for (size_t c = 0; c < conditions.size(); ++c)
    for (size_t e = 0; isTurned(conditions[c].component) && e < nodes.boundary.size(); ++e)
      if (conditions[c].actsOn(mesh.boundaryLabels[nodes.boundary[e].edge]))
        for (const int node : nodes.boundary[e].nodes) directions.emplace_back(directionAt(c, e, node));
  std::sort(directions.begin(), directions.end(),
            [](const Upwards& a, const Upwards& b) { return a.angle < b.angle; });
  // Axes first: a normal that is one of them up to rounding is left out.
  for (const bool turned : {false, true})
    for (size_t c = 0; c < conditions.size(); ++c) {
      const int component = conditions[c].component;
      if (isTurned(component) != turned) continue;
      if (conditions[c].point) {
        const int vertex = vertexAt(mesh, *conditions[c].point);
        if (vertex < 0) continue;
        held[vertex].node = vertex;
        hold(held[vertex], axis(component), static_cast<int>(c));
        continue;
      }
      if (conditions[c].onAxis) {
        for (int node = 0; node < nodes.count(); ++node) {
          if (nodes.places[node].x() != 0) continue;
          held[node].node = node;
          hold(held[node], axis(component), static_cast<int>(c));
        }
        continue;
      }
      for (size_t e = 0; e < nodes.boundary.size(); ++e) {
        if (!conditions[c].actsOn(mesh.boundaryLabels[nodes.boundary[e].edge])) continue;
        for (const int node : nodes.boundary[e].nodes) {
          NodeSupport& support = held[node];
          support.node = node;
          if (!turned) {
            hold(support, axis(component), static_cast<int>(c));
            continue;
          }
          hold(support, oneOf(directions, directionAt(c, e, node)), static_cast<int>(c));
        }
      }
    }
  std::map<int, int> numbers;
  for (const auto& [node, support] : held) {
    numbers[node] = static_cast<int>(nodes_.size());
    nodes_.push_back(support);
  }
  for (FurtherMotion& motion : further_) motion.support = numbers.at(motion.support);
}

Point prescribed(const NodeSupport& support, const std::array<double, 2>& values, const Point& u) {
  const Point& d = support.directions[0];
  if (support.count == 1) {
    if (d.y() == 0) return {values[0] / d.x(), u.y()};
    if (d.x() == 0) return {u.x(), values[0] / d.y()};
    return u + (values[0] - d.dot(u)) * d;
  }
  const Point& e = support.directions[1];
  return Point(values[0] * e.y() - values[1] * d.y(), values[1] * d.x() - values[0] * e.x()) / cross(d, e);
}

int sameMotion(const NodeSupport& support, const Point& direction) {
  for (int i = 0; i < support.count; ++i)
    if (parallel(support.directions[i], direction)) return i;
  return -1;
}

double impliedMotion(const NodeSupport& support, const std::array<double, 2>& values,
                     const Point& direction) {
  const int same = sameMotion(support, direction);
  if (same >= 0) return support.directions[same].dot(direction) > 0 ? values[same] : -values[same];
  return direction.dot(prescribed(support, values, Point::Zero()));
}

}  // namespace mortier
