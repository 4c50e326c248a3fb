#include <algorithm>
#include <cmath>
#include <map>

#include "base/digits.h"
#include "base/error.h"
#include "lint/lint.h"
#include "mesh/boundary_line.h"
#include "mesh/triangle_mesh.h"
#include "scene/resolve.h"

namespace mortier {
namespace {

/// What the scene does with a label of a body.
struct Use {
  bool condition = false;
  bool contact = false;
};

std::map<int, Use> usesOf(const SceneDescription& scene, size_t body) {
  std::map<int, Use> uses;
  for (const ConditionDescription& c : scene.bodies[body].conditions)
    if (!c.point) uses[c.label].condition = true;
  forEachPair(scene, [&](const ContactDescription& contact) {
    for (const SideDescription& side : contact.sides)
      if (side.body == scene.bodies[body].name) uses[side.label].contact = true;
  });
  return uses;
}

/// Outward, of the length of the edge.
Point normal(const TriangleMesh& mesh, const BoundaryEdge& edge) {
  const Point along = mesh.vertices[edge.to] - mesh.vertices[edge.from];
  return {along.y(), -along.x()};
}

std::string sideOf(const TriangleMesh& mesh, const Topology& topology, int label) {
  Point n{0, 0};
  double length = 0;
  for (const BoundaryEdge& edge : topology.boundary)
    if (edge.label == label) {
      n += normal(mesh, edge);
      length += normal(mesh, edge).norm();
    }
  if (n.norm() < length / 2) return "around";
  const bool upright = std::abs(n.y()) >= std::abs(n.x());
  return upright ? (n.y() > 0 ? "top" : "bottom") : (n.x() > 0 ? "right" : "left");
}

/// A label as the scene writes it.
std::string written(int label, const std::string& name) {
  return name.empty() ? std::to_string(label) : "\"" + name + "\"";
}

/// ` "top"` where the mesh has a name for the number.
std::string nameOf(const std::map<std::string, int>& names, int number) {
  for (const auto& [name, known] : names)
    if (known == number) return " \"" + name + "\"";
  return "";
}

void findMissing(const LintInput& input, size_t b, const Topology& topology, Faults& faults) {
  const TriangleMesh& mesh = *input.meshes[b];
  const std::vector<int> labels = boundaryLabels(mesh);
  const std::string known = listed(labels.size(), [&](size_t i) {
    return std::to_string(labels[i]) + nameOf(mesh.labelNames, labels[i]) + " (" +
           sideOf(mesh, topology, labels[i]) + ")";
  });
  const auto require = [&](int label, const std::string& name, const std::string& place) {
    if (std::binary_search(labels.begin(), labels.end(), label)) return;
    faults.add("missing-label", place,
               "body " + input.scene.bodies[b].name + ": no edge of " + mesh.name + " has label " +
                   written(label, name) + "; there are: " + (known.empty() ? "none" : known));
  };
  for (const ConditionDescription& c : input.scene.bodies[b].conditions)
    if (!c.point) require(c.label, c.labelName, c.where);
  forEachPair(input.scene, [&](const ContactDescription& contact) {
    for (const SideDescription& side : contact.sides)
      if (side.body == input.scene.bodies[b].name) require(side.label, side.labelName, side.where);
  });
}

void findMissingPoints(const LintInput& input, size_t b, Faults& faults) {
  const auto require = [&](const Point& point, const std::string& place) {
    try {
      vertexPoint(*input.meshes[b], point, "body " + input.scene.bodies[b].name);
    } catch (const InputError& error) {
      faults.add("missing-point", place, error.what());
    }
  };
  for (const ConditionDescription& c : input.scene.bodies[b].conditions)
    if (c.point) require(*c.point, c.where);
  for (const QuantityDescription& quantity : input.scene.quantities)
    if (quantity.point && quantity.kind == Quantity::Kind::reaction &&
        quantity.body == input.scene.bodies[b].name)
      require(*quantity.point, quantity.where);
}

/// Stretches of the boundary that nothing is said of, where their neighbourhood suggests that something was
/// meant.
void findUnused(const LintInput& input, size_t b, const Topology& topology, Faults& faults) {
  constexpr double sameDirection = 1 - 1e-6;
  const TriangleMesh& mesh = *input.meshes[b];
  const std::map<int, Use> uses = usesOf(input.scene, b);
  const std::string body = "body " + input.scene.bodies[b].name + ": ";
  std::map<int, int> edgeFrom;
  std::map<int, int> edgeTo;
  for (int e = 0; e < static_cast<int>(topology.boundary.size()); ++e) {
    edgeFrom[topology.boundary[e].from] = e;
    edgeTo[topology.boundary[e].to] = e;
  }
  const auto used = [&](int label) { return label != noLabel && uses.count(label) != 0; };
  const auto name = [&](int label) {
    return label == noLabel ? std::string("no label") : labelText(mesh, label);
  };
  const auto straight = [&](const BoundaryEdge& one, const BoundaryEdge& two) {
    return normal(mesh, one).normalized().dot(normal(mesh, two).normalized()) > sameDirection;
  };
  const auto neighbour = [&](const std::map<int, int>& edges, int v) -> const BoundaryEdge* {
    const auto found = edges.find(v);
    return found == edges.end() ? nullptr : &topology.boundary[found->second];
  };
  std::map<int, bool> named;
  for (const BoundaryEdge& edge : topology.boundary) {
    const BoundaryEdge* before = neighbour(edgeTo, edge.from);
    if (used(edge.label) || before == nullptr || before->label == edge.label || named[edge.label]) continue;
    // The first edge of a stretch without use: where it ends.
    const BoundaryEdge* last = &edge;
    size_t length = 1;
    const BoundaryEdge* after = neighbour(edgeFrom, edge.to);
    for (; after != nullptr && after->label == edge.label; after = neighbour(edgeFrom, after->to)) {
      last = after;
      ++length;
    }
    const bool begins = used(before->label) && straight(*before, edge);
    const bool ends = after != nullptr && used(after->label) && straight(*last, *after);
    if (!begins && !ends) continue;
    named[edge.label] = true;
    const std::string place = mesh.name + ": edge from vertex " + std::to_string(edge.from + 1);
    if (begins && ends && before->label == after->label)
      faults.add("label-interrupted", place,
                 body + name(before->label) + " is interrupted by " + counted(length, "edge") + " with " +
                     name(edge.label) + ", of which the scene says nothing");
    else
      faults.add("unused-label", place,
                 body + name(edge.label) + " goes on straight from " +
                     name(begins ? before->label : after->label) + ", and the scene says nothing of it");
  }
}

/// Linear triangles whose every corner is held have no strain but the prescribed one.
void findLocked(const LintInput& input, size_t b, Faults& faults) {
  if (input.scene.degree > 1) return;
  const TriangleMesh& mesh = *input.meshes[b];
  const std::vector<char> held = heldDofs(mesh, input.scene.bodies[b].conditions);
  size_t locked = 0;
  int where = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    bool all = true;
    for (const int v : mesh.triangles[t]) all = all && held[2 * v] != 0 && held[2 * v + 1] != 0;
    if (all && locked++ == 0) where = t;
  }
  if (locked > 0)
    faults.add("locked-triangle", mesh.name + ": triangle " + std::to_string(where + 1),
               "body " + input.scene.bodies[b].name + ": " + counted(locked, "triangle") +
                   " without freedom to strain: every corner is held");
}

void findRegions(const LintInput& input, size_t b, Faults& faults) {
  const TriangleMesh& mesh = *input.meshes[b];
  const BodyDescription& body = input.scene.bodies[b];
  std::vector<int> regions = mesh.regions;
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  const std::string list = listed(regions.size(), [&](size_t i) {
    return std::to_string(regions[i]) + nameOf(mesh.regionNames, regions[i]);
  });
  for (const RegionDescription& region : body.regions)
    if (!std::binary_search(regions.begin(), regions.end(), region.label))
      faults.add("missing-region", region.where,
                 "body " + body.name + ": no triangle of " + mesh.name + " is in region " +
                     written(region.label, region.labelName) + "; there are: " + list);
  if (regions.size() >= 2 && body.regions.empty())
    faults.add("regions-unused", body.meshWhere,
               "body " + body.name + ": " + mesh.name + " has regions " + list + ", the body one material");
}

}  // namespace

void lintLabels(const LintInput& input, Faults& faults) {
  for (size_t b = 0; b < input.meshes.size(); ++b) {
    if (input.meshes[b] == nullptr) continue;
    const Topology& topology = input.topologies[b];
    findMissing(input, b, topology, faults);
    if (input.scene.bodies[b].isTool()) continue;
    findMissingPoints(input, b, faults);
    findUnused(input, b, topology, faults);
    findLocked(input, b, faults);
    findRegions(input, b, faults);
  }
}

}  // namespace mortier
