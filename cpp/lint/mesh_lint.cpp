#include <algorithm>
#include <cmath>
#include <map>

#include "base/digits.h"
#include "base/disjoint_sets.h"
#include "base/formatted.h"
#include "lint/lint.h"
#include "mesh/box_of.h"
#include "mesh/element_sides.h"

namespace mortier {
namespace {

/// Points closer than this part of the extent are the same.
constexpr double coincident = 1e-9;

std::string triangle(const TriangleMesh& mesh, int t) {
  return mesh.name + ": triangle " + std::to_string(t + 1);
}

std::string vertex(const TriangleMesh& mesh, int v) {
  return mesh.name + ": vertex " + std::to_string(v + 1);
}

/// Parts that share no vertex, and parts that share single vertices only, about which they turn.
void findParts(const TriangleMesh& mesh, Faults& faults) {
  const EdgeComponents rigid = edgeComponents(mesh);
  if (rigid.count == 1) return;
  std::vector<int> home(mesh.vertices.size(), -1);
  std::vector<int> size(rigid.count, 0);
  std::vector<int> first(rigid.count, -1);
  DisjointSets joined(rigid.count);
  std::vector<int> hinges;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const int part = rigid.of[t];
    if (size[part]++ == 0) first[part] = t;
    for (const int v : mesh.triangles[t]) {
      if (home[v] >= 0 && home[v] != part) {
        joined.join(home[v], part);
        hinges.push_back(v);
      }
      if (home[v] < 0) home[v] = part;
    }
  }
  std::map<int, int> triangles;
  for (int part = 0; part < rigid.count; ++part) triangles[joined.of(part)] += size[part];
  if (triangles.size() > 1) {
    const auto smallest = std::min_element(triangles.begin(), triangles.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
    const int t = first[smallest->first];
    faults.add("mesh-parts", triangle(mesh, t),
               counted(triangles.size(), "part") + " that share no vertex, the smallest has " +
                   counted(smallest->second, "triangle") + ", one of them at " +
                   placeText(mesh.vertices[mesh.triangles[t][0]]));
  }
  if (hinges.empty()) return;
  const int v = hinges.front();
  std::sort(hinges.begin(), hinges.end());
  const auto end = std::unique(hinges.begin(), hinges.end());
  faults.add("hinge", vertex(mesh, v),
             counted(end - hinges.begin(), "vertex") +
                 " at which parts hang together by nothing else, this one at " + placeText(mesh.vertices[v]));
}

/// Boundary vertices that lie where another one does, and boundary edges that do.
void findDoubles(const TriangleMesh& mesh, const Topology& topology, const SegmentTree& tree,
                 Faults& faults) {
  const double tolerance = coincident * extent(mesh);
  const Point margin = Point::Constant(tolerance);
  std::vector<int> vertices;
  for (const BoundaryEdge& edge : topology.boundary) vertices.push_back(edge.from);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::map<int, int> twin;  // the lowest vertex at the same place
  const auto same = [&](int v) { return twin.count(v) != 0 ? twin.at(v) : v; };
  for (const int v : vertices) {
    const Point& p = mesh.vertices[v];
    int first = v;
    tree.near(p - margin, p + margin, [&](int e) {
      for (const int other : {topology.boundary[e].from, topology.boundary[e].to})
        if (other < first && same(other) == other && (p - mesh.vertices[other]).norm() <= tolerance)
          first = other;
    });
    if (first < v) twin[v] = twin[first] = first;
  }
  if (twin.empty()) return;
  std::map<std::pair<int, int>, int> seen;
  std::vector<const BoundaryEdge*> cracks;
  for (const BoundaryEdge& edge : topology.boundary) {
    seen[{same(edge.from), same(edge.to)}] += 1;
    if (seen.count({same(edge.to), same(edge.from)}) != 0) cracks.push_back(&edge);
  }
  if (!cracks.empty()) {
    faults.add("crack", vertex(mesh, cracks.front()->from),
               counted(cracks.size(), "edge") + " with double nodes, as a crack has, one at " +
                   placeText(mesh.vertices[cracks.front()->from]));
    return;
  }
  const auto first =
      std::find_if(twin.begin(), twin.end(), [](const auto& v) { return v.first != v.second; });
  faults.add("duplicate-node", vertex(mesh, first->first),
             counted(twin.size(), "vertex") + " lie in one place with another, this one with vertex " +
                 std::to_string(first->second + 1) + " at " + placeText(mesh.vertices[first->first]));
}

void findHangingNodes(const TriangleMesh& mesh, const Topology& topology, const SegmentTree& tree,
                      Faults& faults) {
  const double tolerance = coincident * extent(mesh);
  const Point margin = Point::Constant(tolerance);
  std::vector<int> hanging;
  for (const BoundaryEdge& each : topology.boundary) {
    const Point& p = mesh.vertices[each.from];
    bool found = false;
    tree.near(p - margin, p + margin, [&](int e) {
      const auto& [a, b] = tree.segments()[e];
      found = found || (distanceToSegment(p, {a, b}) <= tolerance && (p - a).norm() > tolerance &&
                        (p - b).norm() > tolerance);
    });
    if (found) hanging.push_back(each.from);
  }
  if (hanging.empty()) return;
  faults.add("hanging-node", vertex(mesh, hanging.front()),
             counted(hanging.size(), "vertex") + " on an edge without being one of its ends, this one at " +
                 placeText(mesh.vertices[hanging.front()]));
}

void findCrossings(const TriangleMesh& mesh, const Topology& topology, const SegmentTree& tree,
                   Faults& faults) {
  const auto crosses = [](const std::array<Point, 2>& s, const std::array<Point, 2>& r) {
    constexpr double clear = 1e-9;
    const Point u = s[1] - s[0];
    const Point v = r[1] - r[0];
    const double scale = clear * u.norm() * v.norm();
    const double a = cross(u, r[0] - s[0]);
    const double b = cross(u, r[1] - s[0]);
    const double c = cross(v, s[0] - r[0]);
    const double d = cross(v, s[1] - r[0]);
    return ((a > scale && b < -scale) || (a < -scale && b > scale)) &&
           ((c > scale && d < -scale) || (c < -scale && d > scale));
  };
  for (size_t i = 0; i < topology.boundary.size(); ++i) {
    const auto& segment = tree.segments()[i];
    bool found = false;
    tree.near(segment[0].cwiseMin(segment[1]), segment[0].cwiseMax(segment[1]),
              [&](int e) { found = found || crosses(segment, tree.segments()[e]); });
    if (!found) continue;
    faults.add("mesh-overlaps-itself", triangle(mesh, topology.boundary[i].triangle),
               "its boundary crosses itself near " + placeText(segment[0]));
    return;
  }
}

/// What the reader of a file made of its cells.
template <class Mesh>
void findChanges(const Mesh& mesh, Faults& faults) {
  if (!mesh.changed.empty()) faults.add("mesh-changed", mesh.name, mesh.changed);
}

template <class Mesh>
void findSlivers(const Mesh& mesh, Faults& faults) {
  constexpr double flat = 20;  // of the aspect ratio
  const std::string word = elementWord<Mesh>;
  const std::string best = ofTetrahedra<Mesh> ? "regular" : "equilateral";
  size_t slivers = 0;
  double worst = flat;
  int where = 0;
  for (int t = 0; t < static_cast<int>(elementsOf(mesh).size()); ++t) {
    const double ratio = aspectRatio(mesh, t);
    slivers += ratio > flat ? 1 : 0;
    if (ratio > worst) {
      worst = ratio;
      where = t;
    }
  }
  if (slivers > 0)
    faults.add("sliver", mesh.name + ": " + word + " " + std::to_string(where + 1),
               counted(slivers, word) + " with an aspect ratio above " + shortest(flat) + " (" + best +
                   ": 1), this one has " + shortest(std::round(worst)));
}

}  // namespace

void lintMeshes(const LintInput& input, Faults& faults) {
  for (size_t b = 0; b < input.meshes.size(); ++b) {
    if (input.meshes[b] == nullptr || input.scene.bodies[b].isTool()) continue;
    const TriangleMesh& mesh = *input.meshes[b];
    const Topology& topology = input.topologies[b];
    findChanges(mesh, faults);
    findParts(mesh, faults);
    const SegmentTree tree(mesh, topology);
    findDoubles(mesh, topology, tree, faults);
    findHangingNodes(mesh, topology, tree, faults);
    findCrossings(mesh, topology, tree, faults);
    findSlivers(mesh, faults);
  }
}

void lintMeshes(const std::vector<TetrahedronMesh>& meshes, Faults& faults) {
  for (const TetrahedronMesh& mesh : meshes) {
    findChanges(mesh, faults);
    findSlivers(mesh, faults);
  }
}

}  // namespace mortier
