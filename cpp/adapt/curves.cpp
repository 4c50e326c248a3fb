#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "adapt/adapted_meshes.h"
#include "contact/boundary_surface.h"
#include "contact/smooth_part.h"
#include "mesh/simplices.h"

namespace mortier {
namespace {

constexpr int unlabelled = -1;
constexpr int insideLabel = -2;

/// Edges with a label of their own, by their vertices; where two regions meet, that of one side.
std::map<std::array<int, 2>, int> edgesToFollow(const TriangleMesh& mesh) {
  std::map<std::array<int, 2>, int> regionOf;
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      regionOf[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = mesh.regions[t];
  std::map<std::array<int, 2>, int> labels;
  for (const auto& [edge, region] : regionOf) {
    const auto other = regionOf.find({edge[1], edge[0]});
    if (other == regionOf.end())
      labels[edge] = unlabelled;
    else if (region < other->second)
      labels[edge] = insideLabel;
  }
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    labels[mesh.boundaryEdges[e]] = mesh.boundaryLabels[e];
  return labels;
}

/// The edges of one label as lines that neither branch nor end where they could go on.
std::vector<BoundaryLine> linesOf(const TriangleMesh& mesh, const std::vector<std::array<int, 2>>& edges) {
  struct Ends {
    int in = 0;
    std::vector<int> next;
  };
  std::map<int, Ends> at;
  for (const auto& [a, b] : edges) {
    at[a].next.push_back(b);
    ++at[b].in;
  }
  std::map<int, char> passes;
  for (const auto& [v, ends] : at) passes[v] = ends.in == 1 && ends.next.size() == 1 ? 1 : 0;
  std::vector<BoundaryLine> lines;
  const auto follow = [&](int from) {
    BoundaryLine line;
    int v = from;
    do {
      line.nodes.push_back(v);
      const int to = at[v].next.back();
      at[v].next.pop_back();
      v = to;
    } while (passes[v] != 0 && v != from);
    line.nodes.push_back(v);
    line.closed = v == from;
    for (const int node : line.nodes) line.points.push_back(mesh.vertices[node]);
    lines.push_back(std::move(line));
  };
  for (const auto& [v, passed] : passes)
    while (passed == 0 && !at[v].next.empty()) follow(v);
  for (const auto& [v, passed] : passes)  // the others are closed
    if (!at[v].next.empty()) follow(v);
  return lines;
}

/// Of the edges of which the mesh has a third point: the curvature of the arc through the three.
std::map<std::array<int, 2>, double> ofThreePoints(const TriangleMesh& mesh) {
  constexpr double straight = 1e-9;
  std::map<std::array<int, 2>, double> curvatures;
  for (size_t e = 0; e < mesh.edgeMiddles.size(); ++e) {
    if (!mesh.edgeMiddles[e].allFinite()) continue;
    const auto& [a, b] = mesh.boundaryEdges[e];
    const Point& from = mesh.vertices[a];
    const Point& to = mesh.vertices[b];
    const double curvature = arcsOf({from, to}, false, {mesh.edgeMiddles[e]}).front().curvature;
    curvatures[{a, b}] = std::abs(curvature) * (to - from).norm() > straight ? curvature : 0;
  }
  return curvatures;
}

std::string nameOf(int label) {
  return label == unlabelled    ? "its boundary without a label"
         : label == insideLabel ? "the line between its regions"
                                : "label " + std::to_string(label);
}

}  // namespace

KnownCurves curvesBehind(const TriangleMesh& mesh) {
  KnownCurves known;
  std::map<int, std::vector<std::array<int, 2>>> edges;
  for (const auto& [edge, label] : edgesToFollow(mesh)) edges[label].push_back(edge);
  const auto curvatures = ofThreePoints(mesh);
  std::set<std::array<int, 2>> own;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    if (mesh.hasCurve(e)) own.insert(mesh.boundaryEdges[e]);
  for (const auto& [label, ofLabel] : edges) {
    bool polygon = false;
    for (const BoundaryLine& line : linesOf(mesh, ofLabel))
      for (const SmoothPart& part : smoothParts(line))
        for (int e = 0; e < part.elements(); ++e) {
          const std::array<int, 2> edge{part.nodes[e], part.nodes[e + 1]};
          if (own.count(edge) > 0) continue;
          const auto found = curvatures.find(edge);
          const Arc arc = found != curvatures.end() ? Arc{found->second, true} : part.arcs[e];
          if (arc.known && arc.curvature != 0) known.edges[edge] = arc.curvature;
          polygon = polygon || !arc.known;
        }
    if (polygon) known.polygons.push_back(nameOf(label));
  }
  return known;
}

namespace {

/// Numbers of the surfaces of the geometry by triangles of the boundary.
std::map<std::array<int, 3>, int> surfacesByTriangles(const BoundaryGeometry& geometry) {
  std::map<std::array<int, 3>, int> surfaces;
  for (size_t i = 0; i < geometry.triangles.size() && geometry.surfaces != nullptr; ++i)
    surfaces[sideOf(geometry.triangles[i])] = geometry.numbers[i];
  return surfaces;
}

/// At the vertices of triangles whose surfaces the geometry knows, outward.
void takeNormals(const TetrahedronMesh& mesh, CurvedFaces& curved) {
  std::vector<std::pair<int, SpacePoint>> points;
  std::vector<std::array<int, 2>> keys;
  std::vector<SpacePoint> facets;
  std::set<std::array<int, 2>> seen;
  for (size_t t = 0; t < curved.triangles.size(); ++t) {
    if (curved.parts[t] >= 0) continue;
    const auto& [a, b, c] = curved.triangles[t];
    const SpacePoint facet = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    for (const int v : curved.triangles[t]) {
      if (!seen.insert({v, curved.parts[t]}).second) continue;
      keys.push_back({v, curved.parts[t]});
      points.emplace_back(surfaceOfPart(curved.parts[t]), mesh.vertices[v]);
      facets.push_back(facet);
    }
  }
  const std::vector<std::optional<SurfaceFoot>> feet = curved.geometry->feet(points);
  for (size_t i = 0; i < keys.size(); ++i) {
    SpacePoint& normal = curved.normals[keys[i]];
    normal = feet[i] ? feet[i]->normal : SpacePoint::Constant(std::numeric_limits<double>::quiet_NaN());
    if (normal.dot(facets[i]) < 0) normal = -normal;
  }
}

}  // namespace

void putOntoGeometry(TetrahedronMesh& mesh) {
  constexpr double most = 1e-5;  // of the extent: what CAD files allow
  const BoundaryGeometry& geometry = mesh.geometry;
  std::map<int, std::set<int>> surfacesAt;
  for (const auto& [triangle, surface] : surfacesByTriangles(geometry))
    for (const int v : triangle) surfacesAt[v].insert(surface);
  const double farthest = most * extent(mesh);
  for (const auto& [v, surfaces] : surfacesAt) {
    const auto isPlane = [&](int surface) { return geometry.surfaces->isPlane(surface); };
    if (std::all_of(surfaces.begin(), surfaces.end(), isPlane)) continue;
    const std::optional<SharedPoint> found =
        sharedPoint(*geometry.surfaces, {surfaces.begin(), surfaces.end()}, mesh.vertices[v]);
    if (found && (found->at - mesh.vertices[v]).norm() < farthest) mesh.vertices[v] = found->at;
  }
}

CurvedFaces curvesBehind(const TetrahedronMesh& mesh) {
  constexpr double parallel = 1e-9;
  const auto surfaces = surfacesByTriangles(mesh.geometry);
  const BoundarySurface surface = boundarySurface(mesh);
  CurvedFaces curved{surface.triangles, surface.parts, {}, mesh.geometry.surfaces};
  bool plane = true;
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto known = surfaces.find(sideOf(surface.triangles[t]));
    if (known != surfaces.end()) {
      curved.parts[t] = partOfSurface(known->second);
      plane = plane && curved.geometry->isPlane(known->second);
      continue;
    }
    for (size_t k = 0; k < 3; ++k) {
      const SurfaceNormal& normal = surface.normals[t][k];
      plane = plane && (!normal.known || normal.n.cross(surface.facets[t]).norm() < parallel);
      curved.normals[{surface.triangles[t][k], surface.parts[t]}] =
          normal.known ? normal.n : SpacePoint::Constant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  if (plane) return {};
  if (!surfaces.empty()) takeNormals(mesh, curved);
  return curved;
}

}  // namespace mortier
