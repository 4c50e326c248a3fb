#include "contact/surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/error.h"

namespace mortier {
namespace {

/// Normals whose sine is below this are one.
constexpr double sameNormal = 1e-9;
/// Mortar triangles that turn away by more than this do not face a direction.
constexpr double grazing = -1e-3;
/// Polygons below this part of a triangle are dropped.
constexpr double smallestPolygon = 1e-14;
/// By how much a ray may miss a triangle, in its barycentric coordinates.
constexpr double rounding = 1e-9;

/// l.x >= 0, l.y >= 0, 1 - l.x - l.y >= 0 (Sutherland, Hodgman 1974). The coordinate that is clipped
/// becomes exactly 0.
void clip(std::vector<Point>& polygon, int side) {
  const auto inside = [side](const Point& l) { return side < 2 ? l[side] : 1 - l.x() - l.y(); };
  std::vector<Point> result;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    const double fa = inside(a);
    const double fb = inside(b);
    if (fa >= 0) result.push_back(a);
    if ((fa < 0) != (fb < 0) && fa != 0 && fb != 0) {
      Point cut = a + fa / (fa - fb) * (b - a);
      if (side < 2)
        cut[side] = 0;
      else
        cut.y() = 1 - cut.x();
      result.push_back(cut);
    }
  }
  polygon = std::move(result);
}

/// Finds the triangles of TriangleTree::findAlong().
struct NearLine {
  const SpacePoint& from;
  const SpacePoint& direction;
  double radius, reach;
  const std::vector<Eigen::AlignedBox3d>& boxes;
  std::vector<int>& found;

  [[nodiscard]] bool intersectVolume(const Eigen::AlignedBox3d& box) const {
    const SpacePoint middle = box.center() - from;
    const double size = box.diagonal().norm() / 2;
    const double along = middle.dot(direction);
    return std::abs(along) <= reach + size && (middle - along * direction).norm() <= radius + size;
  }
  [[nodiscard]] bool intersectObject(int triangle) const {
    if (intersectVolume(boxes[triangle])) found.push_back(triangle);
    return false;  // the search goes on
  }
};

double areaOf(const std::vector<Point>& polygon) {
  double twice = 0;
  for (size_t i = 2; i < polygon.size(); ++i)
    twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return twice / 2;
}

}  // namespace

ContactSurface::ContactSurface(const TetrahedronMesh& mesh, const SpaceNodes& nodes, int label)
    : degree(nodes.degree) {
  Eigen::AlignedBox3d box;
  SpacePoint sum = SpacePoint::Zero();
  const BoundarySurface surface = boundarySurface(mesh, label);
  for (size_t i = 0; i < nodes.faces.size(); ++i) {
    if (mesh.boundaryLabels[i] != label) continue;
    std::array<SpacePoint, 3>& x = places.emplace_back();
    for (int k = 0; k < 3; ++k) {
      x[k] = nodes.places[nodes.faces[i][k]];
      box.extend(x[k]);
    }
    const SpacePoint twice = (x[1] - x[0]).cross(x[2] - x[0]);
    area += twice.norm() / 2;
    sum += twice;
    triangles.push_back(nodes.faces[i]);
    normals.push_back(twice.normalized());
    parts.push_back(surface.parts[i]);
    vertexNormals.push_back(surface.normals[i]);
  }
  if (triangles.empty())
    throw InputError("label = " + std::to_string(label) + ", expected a boundary label of " + mesh.name);
  extent = box.sizes().maxCoeff();
  const SpacePoint mean = sum.normalized();
  const auto isMean = [&](const SpacePoint& n) { return n.cross(mean).norm() < sameNormal; };
  planar = std::all_of(normals.begin(), normals.end(), isMean) &&
           std::all_of(vertexNormals.begin(), vertexNormals.end(), [&](const auto& ofTriangle) {
             return std::all_of(ofTriangle.begin(), ofTriangle.end(),
                                [&](const SurfaceNormal& normal) { return isMean(normal.n); });
           });
  findCurvatures();
  findSides();
}

/// |n_i - n_j|/|x_i - x_j| of the edges at a vertex.
void ContactSurface::findCurvatures() {
  std::map<std::array<int, 2>, std::pair<double, int>> sums;  // by vertices and parts
  for (size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      for (const int other : {(k + 1) % 3, (k + 2) % 3}) {
        const double turn = (vertexNormals[t][k].n - vertexNormals[t][other].n).norm();
        auto& [sum, count] = sums[{triangles[t][k], parts[t]}];
        sum += turn < sameNormal ? 0 : turn / (places[t][k] - places[t][other]).norm();
        ++count;
      }
  for (size_t t = 0; t < triangles.size(); ++t) {
    std::array<double, 3>& own = curvatures.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const auto& [sum, count] = sums.at({triangles[t][k], parts[t]});
      own[k] = sum / count;
    }
  }
}

std::vector<int> ContactSurface::nodes() const {
  std::set<int> all;
  for (const auto& triangle : triangles) all.insert(triangle.begin(), triangle.begin() + perTriangle());
  return {all.begin(), all.end()};
}

SpacePoint ContactSurface::normalAt(int triangle, const Eigen::Vector3d& l) const {
  const auto& [a, b, c] = vertexNormals[triangle];
  return (l[0] * a.n + l[1] * b.n + l[2] * c.n).normalized();
}

double ContactSurface::curvatureAt(int triangle, const Eigen::Vector3d& l) const {
  const auto& [a, b, c] = curvatures[triangle];
  return l[0] * a + l[1] * b + l[2] * c;
}

TriangleTree::TriangleTree(const ContactSurface& surface) : surface_(surface) {
  for (const auto& [a, b, c] : surface.places) boxes_.emplace_back(a).extend(b).extend(c);
  std::vector<int> triangles(boxes_.size());
  std::iota(triangles.begin(), triangles.end(), 0);
  tree_.init(triangles.begin(), triangles.end(), boxes_.begin(), boxes_.end());
}

void TriangleTree::findAlong(const SpacePoint& from, const SpacePoint& direction, double radius, double reach,
                             std::vector<int>& found) const {
  found.clear();
  NearLine near{from, direction, radius, reach, boxes_, found};
  Eigen::BVIntersect(tree_, near);
  std::sort(found.begin(), found.end());
}

RayHit TriangleTree::along(const SpacePoint& from, const SpacePoint& direction, double reach) const {
  std::vector<int> candidates;
  findAlong(from, direction, rounding * surface_.extent, reach, candidates);
  RayHit nearest;
  for (const int t : candidates) {
    if (surface_.normals[t].dot(direction) > grazing) continue;
    const auto& [a, b, c] = surface_.places[t];
    Eigen::Matrix3d equations;
    equations << b - a, c - a, -direction;
    const Eigen::Vector3d x = equations.inverse() * (from - a);
    const Eigen::Vector3d mu(1 - x[0] - x[1], x[0], x[1]);
    if (mu.minCoeff() < -rounding || std::abs(x[2]) > reach) continue;
    if (nearest.triangle < 0 || std::abs(x[2]) < std::abs(nearest.delta)) nearest = {t, mu, x[2]};
  }
  return nearest;
}

namespace {

/// Between the normals of both sides, nearer to that of the flatter one.
SpacePoint directionBetween(const SpacePoint& n1, double curvature1, const SpacePoint& n2,
                            double curvature2) {
  const double part = curvature1 / (curvature1 + curvature2);
  return ((1 - part) * n1 - part * n2).normalized();
}

}  // namespace

SpacePoint TriangleTree::contactDirection(const SpacePoint& place, const SpacePoint& n1, double curvature1,
                                          double reach, bool curved) const {
  constexpr int repetitions =
      4;  // each makes the point that is faced more exact by the turn along the distance
  SpacePoint n = n1;
  for (int i = 0; i < repetitions && curvature1 > 0; ++i) {
    const RayHit hit = along(place, n, reach);
    if (hit.triangle < 0) break;
    const SpacePoint n2 = curved ? surface_.normalAt(hit.triangle, hit.mu) : surface_.normals[hit.triangle];
    if (!(n1.dot(n2) < 0)) return n1;
    n = directionBetween(n1, curvature1, n2, surface_.curvatureAt(hit.triangle, hit.mu));
  }
  return n;
}

double squareOfCosine(const ContactSurface& nonmortar, const ContactSurface& mortar,
                      const FacingTriangles& facing, const SpacePoint& d, const Point& l) {
  if (mortar.planar) return 1;  // d is its normal
  const Eigen::Vector3d b(1 - l.x() - l.y(), l.x(), l.y());
  const Eigen::Vector3d mu = facing.at(l);
  const double curvature = nonmortar.curvatureAt(facing.nonmortar, b);
  const SpacePoint n1 = nonmortar.normalAt(facing.nonmortar, b);
  const SpacePoint n2 = mortar.normalAt(facing.mortar, mu);
  if (!(curvature > 0) || !(n1.dot(n2) < 0)) return 1;
  const double cosine = directionBetween(n1, curvature, n2, mortar.curvatureAt(facing.mortar, mu)).dot(d);
  return cosine * cosine;
}

void forEachFacing(const ContactSurface& nonmortar, const ContactSurface& mortar,
                   const std::vector<SpacePoint>& directions, double reach,
                   const std::function<void(const FacingTriangles&)>& visit) {
  const TriangleTree tree(mortar);
  std::vector<int> candidates;
  for (size_t t = 0; t < nonmortar.triangles.size(); ++t) {
    const auto& x = nonmortar.places[t];
    const SpacePoint& d = directions[t];
    const SpacePoint middle = (x[0] + x[1] + x[2]) / 3;
    double radius = 0;
    for (const SpacePoint& place : x) radius = std::max(radius, (place - middle).norm());
    tree.findAlong(middle, d, radius, reach + radius, candidates);
    Eigen::Matrix3d own;
    own << x[1] - x[0], x[2] - x[0], d;
    const Eigen::Matrix3d toOwn = own.inverse();
    for (const int other : candidates) {
      if (mortar.normals[other].dot(d) > grazing) continue;
      FacingTriangles facing{static_cast<int>(t), other, {}, {}, {}};
      Eigen::Matrix3d corners;  // columns (l1, l2, 1) of the mortar vertices
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d l = toOwn * (mortar.places[other][k] - x[0]);
        corners.col(k) << l.x(), l.y(), 1;
        facing.delta[k] = l.z();
        facing.polygon.emplace_back(l.x(), l.y());
      }
      std::reverse(facing.polygon.begin(), facing.polygon.end());  // the surfaces look at each other
      for (int side = 0; side < 3 && facing.polygon.size() > 2; ++side) clip(facing.polygon, side);
      if (facing.polygon.size() < 3 || areaOf(facing.polygon) < smallestPolygon) continue;
      if (facing.delta.cwiseAbs().minCoeff() > reach) continue;
      facing.mu = corners.inverse();
      visit(facing);
    }
  }
}

VertexTable verticesOf(const ContactSurface& surface) {
  VertexTable vertices;
  for (size_t t = 0; t < surface.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int part = surface.parts[t];
      VertexFacts& vertex = vertices[{surface.triangles[t][k], part}];
      vertex.place = surface.places[t][k];
      vertex.normal = surface.vertexNormals[t][k].n;
      vertex.curvature = surface.curvatures[t][k];
      for (const int other : {(k + 1) % 3, (k + 2) % 3})
        vertex.neighbours.insert({surface.triangles[t][other], part});
    }
  return vertices;
}

void shareFunctions(VertexTable& vertices) {
  std::vector<PartVertex> open;
  for (const auto& [key, vertex] : vertices)
    if (vertex.rows.empty()) open.push_back(key);
  while (!open.empty()) {
    std::vector<std::pair<PartVertex, std::vector<std::pair<int, double>>>> found;
    std::vector<PartVertex> still;
    for (const PartVertex& key : open) {
      std::map<int, double> parts;
      int givers = 0;
      for (const PartVertex& neighbour : vertices[key].neighbours) {
        const auto& rows = vertices[neighbour].rows;
        givers += rows.empty() ? 0 : 1;
        for (const auto& [row, part] : rows) parts[row] += part;
      }
      if (givers == 0) {
        still.push_back(key);
        continue;
      }
      std::vector<std::pair<int, double>> rows;
      for (const auto& [row, part] : parts) rows.emplace_back(row, part / givers);
      found.emplace_back(key, std::move(rows));
    }
    if (found.empty()) return;  // parts of the surface that face nothing
    for (auto& [key, rows] : found) vertices[key].rows = std::move(rows);
    open = std::move(still);
  }
}

SurfaceRefinement::SurfaceRefinement(const ContactSurface& nonmortar, const ContactSurface& mortar,
                                     const TriangleTree& tree, bool continuous)
    : reach(std::min(nonmortar.extent, mortar.extent)),
      directions(nonmortar.normals),
      vertices(verticesOf(nonmortar)),
      tree_(tree) {
  if (mortar.planar && !nonmortar.planar) plane_ = -mortar.normals.front();
  for (size_t t = 0; t < directions.size(); ++t) {
    if (plane_) directions[t] = *plane_;
    const auto& [a, b, c] = nonmortar.places[t];
    const Eigen::Vector3d middle = Eigen::Vector3d::Constant(1.0 / 3);
    const auto triangle = static_cast<int>(t);
    if (continuous) directions[t] = nonmortar.normalAt(triangle, middle);
    if (const double curvature = plane_ ? 0 : nonmortar.curvatureAt(triangle, middle); curvature > 0)
      directions[t] = tree.contactDirection((a + b + c) / 3, directions[t], curvature, reach, continuous);
  }
  forEachFacing(nonmortar, mortar, directions, reach, [&](const FacingTriangles& each) {
    // A triangle that does not look at the plane faces nothing.
    if (directions[each.nonmortar].dot(nonmortar.normals[each.nonmortar]) < 1e-3) return;
    facing.push_back(each);
    constexpr double rounding = 1e-9;
    const std::array<Point, 3> corners{Point(0, 0), Point(1, 0), Point(0, 1)};
    for (int k = 0; k < 3; ++k)
      if (each.at(corners[k]).minCoeff() >= -rounding)
        vertices[{nonmortar.triangles[each.nonmortar][k], nonmortar.parts[each.nonmortar]}].faces = true;
  });
}

SpacePoint SurfaceRefinement::directionAt(const VertexFacts& vertex) const {
  return plane_ ? *plane_
                : tree_.contactDirection(vertex.place, vertex.normal, vertex.curvature, reach, true);
}

}  // namespace mortier
