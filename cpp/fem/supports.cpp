#include "fem/supports.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Geometry>

#include "base/dense_templates.h"
#include "mesh/boundary_line.h"

namespace mortier {
namespace {

/// Sides that turn by less are smooth.
const double cornerCosine = std::cos(40 * std::numbers::pi / 180);

/// Directions whose sine is below this are the same: flat sides have one, whatever coordinates round.
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

/// The edges with a normal or tangential condition, by their nodes.
SidesOfNodes sidesOf(const TriangleMesh& mesh, const ElementNodes& nodes,
                     const std::vector<Condition>& conditions) {
  SidesOfNodes result;
  for (size_t e = 0; e < nodes.boundary.size(); ++e) {
    const auto& [edge, whole] = nodes.boundary[e];
    const int label = mesh.boundaryLabels[whole];
    const auto here = [&](const Condition& c) { return c.actsOn(label) && isTurned(c.component); };
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

// ---- space

struct Corner {
  SpacePoint unit;      ///< outward normal of a triangle
  SpacePoint weighted;  ///< by which it counts at this node
};

/// Outward normals at the nodes of the triangles with a normal condition on a label. A vertex weighs them by
/// the sine of the angle over the lengths of both sides, which is exact on spheres (Max 1999).
std::map<int, std::vector<Corner>> cornersOf(const TetrahedronMesh& mesh, const SpaceNodes& nodes,
                                             int label) {
  std::map<int, std::vector<Corner>> corners;
  for (size_t i = 0; i < nodes.faces.size(); ++i) {
    if (mesh.boundaryLabels[i] != label) continue;
    const std::array<int, 6>& face = nodes.faces[i];
    for (int k = 0; k < 3; ++k) {
      const SpacePoint& x = nodes.places[face[k]];
      const SpacePoint a = nodes.places[face[(k + 1) % 3]] - x;
      const SpacePoint b = nodes.places[face[(k + 2) % 3]] - x;
      const SpacePoint normal = a.cross(b);
      const SpacePoint unit = normal.normalized();
      corners[face[k]].push_back({unit, normal / (a.squaredNorm() * b.squaredNorm())});
      if (nodes.degree > 1) corners[face[3 + k]].push_back({unit, unit});
    }
  }
  return corners;
}

/// The normals at a node, one for each smooth part of the boundary that meets there.
std::vector<SpacePoint> normalsAt(const std::vector<Corner>& corners) {
  std::vector<SpacePoint> normals;
  std::vector<char> taken(corners.size(), 0);
  for (size_t i = 0; i < corners.size(); ++i) {
    if (taken[i] != 0) continue;
    SpacePoint sum = SpacePoint::Zero();
    for (size_t j = i; j < corners.size(); ++j) {
      if (taken[j] != 0 || corners[j].unit.dot(corners[i].unit) < cornerCosine) continue;
      taken[j] = 1;
      sum += corners[j].weighted;
    }
    SpacePoint normal = sum.normalized();
    for (int c = 0; c < 3; ++c)
      if (const SpacePoint axis = SpacePoint::Unit(c); normal.cross(axis).norm() < sameDirection)
        normal = normal[c] > 0 ? axis : SpacePoint(-axis);
    normals.push_back(normal);
  }
  return normals;
}

/// Whether a component of a motion is prescribed, of a support that is not turned.
bool holds(const NodeSupport& support, Eigen::Index component) {
  const auto first = support.directions.begin();
  return std::any_of(first, first + support.count,
                     [&](const SpacePoint& direction) { return direction[component] != 0; });
}

}  // namespace

SpacePoint NodeSupport::motion(const std::array<double, 3>& values) const {
  SpacePoint sum = SpacePoint::Zero();
  for (int i = 0; i < count; ++i) {
    const SpacePoint row = frame.row(i);
    sum += (values[i] - directions[i].dot(sum)) / directions[i].dot(row) * row;
  }
  return sum;
}

SpacePoint NodeSupport::held(const SpacePoint& vector) const {
  SpacePoint sum = SpacePoint::Zero();
  for (int i = 0; i < count; ++i) sum += frame.row(i).dot(vector) * frame.row(i).transpose();
  return sum;
}

int NodeSupport::same(const SpacePoint& direction) const {
  for (int i = 0; i < count; ++i)
    if (directions[i].cross(direction).norm() < sameDirection) return i;
  return -1;
}

double NodeSupport::implied(const std::array<double, 3>& values, const SpacePoint& direction) const {
  const int found = same(direction);
  if (found >= 0) return directions[found].dot(direction) > 0 ? values[found] : -values[found];
  return direction.dot(motion(values));
}

/// Prescribes the motion along a direction unless the others of the node imply it.
void Supports::hold(NodeSupport& support, const SpacePoint& direction, int condition) {
  SpacePoint beyond = direction;
  for (int i = 0; i < support.count; ++i) {
    const SpacePoint row = support.frame.row(i);
    beyond -= row.dot(beyond) * row;
  }
  if (support.count == dimension_ || beyond.norm() < sameDirection) {
    const int same = support.same(direction);
    if (same < 0 || support.conditions[same] != condition)
      further_.push_back({support.node, condition, direction});
    return;
  }
  support.directions[support.count] = direction;
  support.frame.row(support.count) = beyond.normalized();
  support.conditions[support.count++] = condition;
}

template <class Nodes, class NodesOf, class DirectionsOf>
void Supports::build(const Nodes& nodes, const std::vector<Condition>& conditions, const NodesOf& nodesOf,
                     const DirectionsOf& directionsOf) {
  std::map<int, NodeSupport> held;
  const auto at = [&](int node) -> NodeSupport& {
    held[node].node = node;
    held[node].place = asSpacePoint(nodes.places[node]);
    return held[node];
  };
  // Axes first: a normal that is one of them up to rounding is left out.
  for (const bool turned : {false, true})
    for (size_t c = 0; c < conditions.size(); ++c) {
      const int component = conditions[c].component;
      if (isTurned(component) != turned) continue;
      if (turned)
        for (const auto& [node, direction] : directionsOf(c)) hold(at(node), direction, static_cast<int>(c));
      else
        for (const int node : nodesOf(conditions[c]))
          hold(at(node), SpacePoint::Unit(component), static_cast<int>(c));
    }
  std::map<int, int> numbers;
  equations_.assign(static_cast<size_t>(dimension_) * nodes.count(), 0);
  for (auto& [node, support] : held) {
    const auto number = static_cast<int>(nodes_.size());
    numbers[node] = number;
    for (int i = 0; i < support.count && support.count < dimension_; ++i)
      support.turned = support.turned || support.directions[i].cwiseAbs().maxCoeff() != 1;
    for (int i = 0; i < support.count; ++i) {
      Eigen::Index axis = i;
      if (!support.turned && support.count < dimension_) support.directions[i].cwiseAbs().maxCoeff(&axis);
      equations_[static_cast<size_t>(dimension_) * node + axis] = -1;
    }
    auto& frame = support.frame;
    if (support.count == 1)
      frame.row(1) = dimension_ == 2 ? SpacePoint(-frame(0, 1), frame(0, 0), 0)
                                     : SpacePoint(SpacePoint(frame.row(0)).unitOrthogonal());
    if (support.count < 3) frame.row(2) = SpacePoint(frame.row(0)).cross(SpacePoint(frame.row(1)));
    if (support.turned && turnedOf_.empty()) turnedOf_.assign(nodes.count(), -1);
    if (support.turned) turnedOf_[node] = number;
    nodes_.push_back(support);
  }
  for (FurtherMotion& motion : further_) motion.support = numbers.at(motion.support);
  for (int& equation : equations_)
    if (equation >= 0) equation = freeDofs_++;
}

Supports::Supports(const TriangleMesh& mesh, const ElementNodes& nodes,
                   const std::vector<Condition>& conditions) {
  const SidesOfNodes sides = sidesOf(mesh, nodes, conditions);
  const auto stretches = [&](const Condition& condition, const auto& visit) {
    for (size_t e = 0; e < nodes.boundary.size(); ++e)
      if (condition.actsOn(mesh.boundaryLabels[nodes.boundary[e].edge]))
        for (const int node : nodes.boundary[e].nodes) visit(e, node);
  };
  const auto directionAt = [&](const Condition& condition, size_t e, int node) -> Point {
    const std::vector<Side>& here = sides.at(node);
    const auto side =
        std::find_if(here.begin(), here.end(), [&](const Side& s) { return s.edge == static_cast<int>(e); });
    const Point n = normalAt(sides, node, *side);
    return condition.component == alongNormal ? n : turned(n);
  };
  std::vector<Upwards> directions;
  for (const Condition& condition : conditions)
    if (isTurned(condition.component))
      stretches(condition,
                [&](size_t e, int node) { directions.emplace_back(directionAt(condition, e, node)); });
  std::sort(directions.begin(), directions.end(),
            [](const Upwards& a, const Upwards& b) { return a.angle < b.angle; });
  build(
      nodes, conditions,
      [&](const Condition& condition) {
        std::vector<int> held;
        if (condition.point)
          if (const int vertex = vertexAt(mesh, Point(condition.point->head<2>())); vertex >= 0)
            held.push_back(vertex);
        for (int node = 0; condition.onAxis && node < nodes.count(); ++node)
          if (nodes.places[node].x() == 0) held.push_back(node);
        stretches(condition, [&](size_t, int node) { held.push_back(node); });
        return held;
      },
      [&](size_t c) {
        std::vector<std::pair<int, SpacePoint>> held;
        stretches(conditions[c], [&](size_t e, int node) {
          held.emplace_back(node, asSpacePoint(oneOf(directions, directionAt(conditions[c], e, node))));
        });
        return held;
      });
}

Supports::Supports(const TetrahedronMesh& mesh, const SpaceNodes& nodes,
                   const std::vector<Condition>& conditions)
    : dimension_(3) {
  build(
      nodes, conditions,
      [&](const Condition& condition) {
        std::vector<int> held;
        if (condition.point)
          if (const int vertex = vertexAt(mesh, *condition.point); vertex >= 0) held.push_back(vertex);
        for (size_t i = 0; i < nodes.faces.size(); ++i)
          if (condition.actsOn(mesh.boundaryLabels[i]))
            held.insert(held.end(), nodes.faces[i].begin(), nodes.faces[i].begin() + nodes.perFace());
        return held;
      },
      [&](size_t c) {
        std::vector<std::pair<int, SpacePoint>> held;
        for (const auto& [node, corners] : cornersOf(mesh, nodes, conditions[c].label))
          for (const SpacePoint& normal : normalsAt(corners)) held.emplace_back(node, normal);
        return held;
      });
}

void Supports::freeMotionsOnly(int count) {
  equations_.assign(equations_.size(), -1);
  freeDofs_ = count;
}

SpacePoint Supports::vectorAt(const Vector& nodal, int node) const {
  SpacePoint vector = SpacePoint::Zero();
  for (int c = 0; c < dimension_; ++c) vector[c] = nodal[static_cast<Eigen::Index>(dimension_) * node + c];
  return vector;
}

Vector Supports::gather(const Vector& nodal) const {
  Vector x(freeDofs_);
  for (size_t dof = 0; dof < equations_.size(); ++dof)
    if (equations_[dof] >= 0) x[equations_[dof]] = nodal[static_cast<Eigen::Index>(dof)];
  for (const NodeSupport& support : nodes_) {
    if (!support.turned) continue;
    const SpacePoint turned = support.frame * vectorAt(nodal, support.node);
    for (int c = support.count; c < dimension_; ++c)
      x[equations_[static_cast<size_t>(dimension_) * support.node + c]] = turned[c];
  }
  return x;
}

Vector Supports::spread(const Vector& x) const {
  Vector nodal = Vector::Zero(static_cast<Eigen::Index>(equations_.size()));
  for (size_t dof = 0; dof < equations_.size(); ++dof)
    if (equations_[dof] >= 0) nodal[static_cast<Eigen::Index>(dof)] = x[equations_[dof]];
  for (const NodeSupport& support : nodes_) {
    if (!support.turned) continue;
    const SpacePoint vector = support.frame.transpose() * vectorAt(nodal, support.node);
    for (int c = 0; c < dimension_; ++c)
      nodal[static_cast<Eigen::Index>(dimension_) * support.node + c] = vector[c];
  }
  return nodal;
}

SpacePoint Supports::motionOf(const NodeSupport& support, const std::vector<Condition>& conditions,
                              std::optional<double> t0, double t1) const {
  std::array<double, 3> values{};
  for (int i = 0; i < support.count; ++i) {
    const Datum& value = conditions[support.conditions[i]].value;
    values[i] = value(support.place, t1) - (t0 ? value(support.place, *t0) : 0);
  }
  return support.motion(values);
}

void Supports::prescribe(const std::vector<Condition>& conditions, double t, Vector& u) const {
  for (const NodeSupport& support : nodes_) {
    const SpacePoint held = motionOf(support, conditions, std::nullopt, t);
    const SpacePoint change = held - support.held(vectorAt(u, support.node));
    for (Eigen::Index c = 0, dof = static_cast<Eigen::Index>(dimension_) * support.node; c < dimension_;
         ++c, ++dof)
      if (support.turned)
        u[dof] += change[c];
      else if (holds(support, c))
        u[dof] = held[c];
  }
}

void Supports::prescribeIncrement(const std::vector<Condition>& conditions, double t0, double t1,
                                  TwoPartVector& increment) const {
  for (const NodeSupport& support : nodes_) {
    const SpacePoint held = motionOf(support, conditions, t0, t1);
    const SpacePoint change = held - support.held(vectorAt(increment.high, support.node));
    const SpacePoint rest = support.held(vectorAt(increment.low, support.node));
    for (Eigen::Index c = 0, dof = static_cast<Eigen::Index>(dimension_) * support.node; c < dimension_;
         ++c, ++dof)
      if (support.turned) {
        increment.high[dof] += change[c];
        increment.low[dof] -= rest[c];
      } else if (holds(support, c)) {
        increment.set(dof, held[c]);
      }
  }
}

}  // namespace mortier
