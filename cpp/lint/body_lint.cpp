#include <algorithm>

#include "base/digits.h"
#include "base/formatted.h"
#include "lint/lint.h"
#include "mesh/box_of.h"

namespace mortier {
namespace {

bool isOf(const ContactDescription& c, const std::string& a, const std::string& b) {
  const std::string& one = c.nonmortar().body;
  const std::string& other = c.mortar().body;
  return (one == a && other == b) || (one == b && other == a);
}

bool inContact(const SceneDescription& scene, const std::string& a, const std::string& b) {
  bool any = false;
  forEachPair(scene, [&](const ContactDescription& pair) { any = any || isOf(pair, a, b); });
  return any;
}

/// By the number of boundary edges that a ray to the right crosses.
bool inside(const Point& p, const TriangleMesh& mesh, const Topology& topology) {
  bool result = false;
  for (const BoundaryEdge& edge : topology.boundary) {
    const Point& a = mesh.vertices[edge.from];
    const Point& b = mesh.vertices[edge.to];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) result = !result;
  }
  return result;
}

double meanEdge(const TriangleMesh& mesh, const Topology& topology) {
  double sum = 0;
  for (const BoundaryEdge& edge : topology.boundary)
    sum += (mesh.vertices[edge.to] - mesh.vertices[edge.from]).norm();
  return sum / static_cast<double>(topology.boundary.size());
}

struct Meeting {
  int inside = -1;   ///< a vertex of the first deep in the second
  int touching = 0;  ///< vertices of the first on the boundary of the second
  int where = -1;    ///< one of them
};

/// \param meant  depth of an interference of the two, no more than which is no fault [m].
Meeting meet(const TriangleMesh& a, const Topology& boundaryOfA, const TriangleMesh& b,
             const Topology& boundaryOfB, double meant) {
  constexpr double touching = 1e-6;  // of the extent
  constexpr double deep = 0.25;      // of the edges: curved sides that touch overlap by less
  Meeting result;
  const auto box = boxOf(b.vertices);
  const SegmentTree tree(b, boundaryOfB);
  const double edge = meanEdge(b, boundaryOfB);
  constexpr double polygons = 1.5;  // what is seen at other vertices than those of the contact may be deeper
  const double depth = std::max(deep * edge, polygons * meant);
  const Point margin = Point::Constant(depth);
  const double near = touching * extent(b);
  for (const BoundaryEdge& each : boundaryOfA.boundary) {
    const Point& p = a.vertices[each.from];
    if ((p.array() < (box.min() - margin).array()).any() || (p.array() > (box.max() + margin).array()).any())
      continue;
    double distance = INFINITY;
    tree.near(p - margin, p + margin,
              [&](int e) { distance = std::min(distance, distanceToSegment(p, tree.segments()[e])); });
    if (distance <= near) {
      ++result.touching;
      result.where = each.from;
    } else if (result.inside < 0 && distance > depth && inside(p, b, boundaryOfB)) {
      result.inside = each.from;
    }
  }
  return result;
}

void comparePair(const LintInput& input, size_t i, size_t j, Faults& faults) {
  const BodyDescription& one = input.scene.bodies[i];
  const BodyDescription& two = input.scene.bodies[j];
  const std::string both = "bodies " + one.name + " and " + two.name;
  const TriangleMesh& a = *input.meshes[i];
  const TriangleMesh& b = *input.meshes[j];
  constexpr double units = 300;
  const std::string& length = input.scene.units.length;
  const std::string& stress = input.scene.units.stress;
  const double ratio = extent(a) / extent(b);
  const bool deform = !one.isTool() && !two.isTool();
  if (deform && std::max(ratio, 1 / ratio) > units)
    faults.add("extent-ratio", ratio < 1 ? one.meshWhere : two.meshWhere,
               both + " are " + digits(extent(a), 4) + " " + length + " and " + digits(extent(b), 4) + " " +
                   length + " wide");
  const double young = one.material.elasticity.young / two.material.elasticity.young;
  if (deform && std::max(young, 1 / young) >= units)
    faults.add("stiffness-ratio", input.where({"body", "material", "young"}, young < 1 ? i : j),
               both + " have young = " + shortest(one.material.elasticity.young) + " " + stress + " and " +
                   shortest(two.material.elasticity.young) + " " + stress);
  if (one.point || two.point) return;
  if (input.topologies[i].boundary.empty() || input.topologies[j].boundary.empty()) return;
  double meant = 0;
  for (size_t k = 0; k < input.interference.size(); ++k)
    if (isOf(input.scene.contacts[k], one.name, two.name)) meant = std::max(meant, input.interference[k]);
  const Meeting m1 = meet(a, input.topologies[i], b, input.topologies[j], meant);
  const Meeting m2 = meet(b, input.topologies[j], a, input.topologies[i], meant);
  if (m1.inside >= 0 || m2.inside >= 0) {
    const TriangleMesh& mesh = m1.inside >= 0 ? a : b;
    const int v = m1.inside >= 0 ? m1.inside : m2.inside;
    faults.add("bodies-overlap", mesh.name + ": vertex " + std::to_string(v + 1),
               both + " penetrate each other, e.g. at " + placeText(mesh.vertices[v]));
  } else if (m1.touching + m2.touching > 2 && !inContact(input.scene, one.name, two.name)) {
    const TriangleMesh& mesh = m1.touching > 0 ? a : b;
    const int v = m1.touching > 0 ? m1.where : m2.where;
    faults.add("contact-missing", mesh.name + ": vertex " + std::to_string(v + 1),
               both + " touch, e.g. at " + placeText(mesh.vertices[v]) + ", and no contact says so");
  }
}

}  // namespace

void lintBodies(const LintInput& input, Faults& faults) {
  const auto& bodies = input.scene.bodies;
  for (size_t i = 0; i < bodies.size(); ++i) {
    for (size_t j = i + 1; j < bodies.size(); ++j)
      if (input.meshes[i] != nullptr && input.meshes[j] != nullptr) comparePair(input, i, j, faults);
    bool meetsAny = std::any_of(bodies.begin(), bodies.end(), [&](const BodyDescription& other) {
      return inContact(input.scene, bodies[i].name, other.name);
    });
    forEachPair(input.scene, [&](const ContactDescription& pair) {
      meetsAny = meetsAny || pair.offset == bodies[i].name;
    });
    if (bodies.size() > 1 && !meetsAny)
      faults.add("body-alone", bodies[i].where,
                 "body " + bodies[i].name + " is in no contact: it is solved beside the others");
  }
}

}  // namespace mortier
