#include "contact/boundary_surface.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/disjoint_sets.h"
#include "contact/smooth_part.h"

namespace mortier {
namespace {

double angleBetween(const SpacePoint& a, const SpacePoint& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The labelled triangles of a mesh, then those of its boundary without a label.
std::vector<std::array<int, 3>> allTriangles(const TetrahedronMesh& mesh) {
  std::vector<std::array<int, 3>> all = mesh.boundaryTriangles;
  const std::vector<std::array<int, 3>> outer = outerTriangles(mesh);
  const std::vector<int> labels = labelsOf(mesh, outer);
  for (size_t i = 0; i < outer.size(); ++i)
    if (labels[i] < 0) all.push_back(outer[i]);
  return all;
}

class Surface {
 public:
  Surface(const TetrahedronMesh& mesh, BoundarySurface& result) : mesh_(mesh), result_(result) {
    result_.triangles = allTriangles(mesh);
    for (const auto& [a, b, c] : result_.triangles)
      result_.facets.push_back((place(b) - place(a)).cross(place(c) - place(a)).normalized());
    findNeighbours();
    findParts();
  }

  void findNormals(const std::optional<int>& label) {
    const size_t n = result_.triangles.size();
    result_.normals.resize(n);
    for (size_t t = 0; t < n; ++t)
      for (SurfaceNormal& normal : result_.normals[t]) normal.n = result_.facets[t];
    std::vector<std::vector<std::pair<int, SurfaceNormal>>> found(mesh_.vertices.size());  // with their parts
    for (size_t t = 0; t < n; ++t) {
      const bool labelled = t < mesh_.boundaryLabels.size();
      if (label && !(labelled && mesh_.boundaryLabels[t] == *label)) continue;
      for (size_t k = 0; k < 3; ++k) {
        if (const SpacePoint* exact = ofGeometry(t, k)) {
          result_.normals[t][k] = {*exact, true, 0};
          continue;
        }
        const int v = result_.triangles[t][k];
        auto each = std::find_if(found[v].begin(), found[v].end(),
                                 [&](const auto& pair) { return pair.first == result_.parts[t]; });
        if (each == found[v].end())
          each = found[v].emplace(each, result_.parts[t], fitted(v, result_.parts[t]));
        const SurfaceNormal& normal = each->second;
        result_.normals[t][k] = normal.known ? normal : SurfaceNormal{result_.facets[t], false, normal.error};
      }
    }
  }

 private:
  [[nodiscard]] const SpacePoint& place(int v) const { return mesh_.vertices[v]; }

  [[nodiscard]] const SpacePoint* ofGeometry(size_t t, size_t k) const {
    if (t >= mesh_.boundaryNormals.size() || !mesh_.boundaryNormals[t][k].allFinite()) return nullptr;
    return &mesh_.boundaryNormals[t][k];
  }

  void findNeighbours() {
    struct Side {
      int low, high, triangle, k;
      bool operator<(const Side& o) const {
        return std::tie(low, high, triangle) < std::tie(o.low, o.high, o.triangle);
      }
    };
    std::vector<Side> sides;
    around_.resize(mesh_.vertices.size());
    for (size_t t = 0; t < result_.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(result_.triangles[t][k], result_.triangles[t][(k + 1) % 3]);
        sides.push_back({low, high, static_cast<int>(t), k});
        around_[result_.triangles[t][k]].push_back(static_cast<int>(t));
      }
    std::sort(sides.begin(), sides.end());
    neighbours_.assign(result_.triangles.size(), {-1, -1, -1});
    const auto same = [&](size_t i, size_t j) {
      return j < sides.size() && sides[i].low == sides[j].low && sides[i].high == sides[j].high;
    };
    for (size_t i = 0, next = 0; i < sides.size(); i = next) {
      for (next = i + 1; same(i, next);) ++next;
      if (next - i != 2) continue;  // where more than two meet the body touches itself
      neighbours_[sides[i].triangle][sides[i].k] = sides[i + 1].triangle;
      neighbours_[sides[i + 1].triangle][sides[i + 1].k] = sides[i].triangle;
    }
  }

  void findParts() {
    DisjointSets sets(result_.triangles.size());
    for (size_t t = 0; t < result_.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        if (const int other = neighbours_[t][k]; other > static_cast<int>(t) && !isCorner(t, k))
          sets.join(static_cast<int>(t), other);
    for (size_t t = 0; t < result_.triangles.size(); ++t)
      result_.parts.push_back(sets.of(static_cast<int>(t)));
  }

  [[nodiscard]] int sideTowards(int triangle, int other) const {
    const auto& sides = neighbours_[triangle];
    return static_cast<int>(std::find(sides.begin(), sides.end(), other) - sides.begin());
  }

  [[nodiscard]] bool isCorner(size_t t, int k) const {
    constexpr double least = M_PI / 180;
    constexpr double ratio = 4;
    const auto triangle = static_cast<int>(t);
    const int other = neighbours_[t][k];
    if (const std::optional<double> exact = turnOfGeometry(triangle, k)) return *exact > least;
    const double turn = angleBetween(result_.facets[t], result_.facets[other]);
    if (turn > sharpTurn) return true;
    if (turn <= least) return false;
    const int back = sideTowards(other, triangle);
    const double mean = (height(triangle, k) + height(other, back)) / 2;
    return turn / mean > ratio * std::max(curvatureBehind(triangle, k), curvatureBehind(other, back));
  }

  /// Between the normals of the geometry on both sides of a side, where these are known.
  [[nodiscard]] std::optional<double> turnOfGeometry(int t, int k) const {
    const int other = neighbours_[t][k];
    double most = 0;
    for (const int end : {k, (k + 1) % 3}) {
      const auto& across = result_.triangles[other];
      const auto at = static_cast<size_t>(std::find(across.begin(), across.end(), result_.triangles[t][end]) -
                                          across.begin());
      const SpacePoint* one = ofGeometry(static_cast<size_t>(t), static_cast<size_t>(end));
      const SpacePoint* two = ofGeometry(static_cast<size_t>(other), at);
      if (one == nullptr || two == nullptr) return std::nullopt;
      most = std::max(most, angleBetween(*one, *two));
    }
    return most;
  }

  /// Of a triangle on its side k.
  [[nodiscard]] double height(int t, int k) const {
    const SpacePoint& a = place(result_.triangles[t][k]);
    const SpacePoint side = place(result_.triangles[t][(k + 1) % 3]) - a;
    return side.cross(place(result_.triangles[t][(k + 2) % 3]) - a).norm() / side.norm();
  }

  /// The turn over the length on the way from the middle of a side k across its triangle t, straight on, as
  /// far as two or three elements of one size reach. At a sharp edge the way is reflected.
  [[nodiscard]] double curvatureBehind(int t, int k) const {
    constexpr double heights = 2.5;
    constexpr int mostSteps = 16;
    const double length = heights * height(t, k);
    const SpacePoint& first = result_.facets[t];
    const std::pair start(t, k);
    SpacePoint from = (place(result_.triangles[t][k]) + place(result_.triangles[t][(k + 1) % 3])) / 2;
    SpacePoint to = result_.facets[t].cross(sideOf(t, k)).normalized();
    double most = 0;
    double gone = 0;
    for (int step = 0; step < mostSteps && gone < length; ++step) {
      int out = -1;
      double leaves = infinity;
      for (const int side : {(k + 1) % 3, (k + 2) % 3}) {  // that is met first
        const SpacePoint outward = sideOf(t, side).cross(result_.facets[t]);
        const double speed = to.dot(outward);
        const double far = outward.dot(place(result_.triangles[t][side]) - from) / speed;
        if (speed > 0 && far < leaves) std::tie(out, leaves) = std::pair(side, std::max(0.0, far));
      }
      gone += leaves;
      if (out < 0 || gone >= length || std::pair(t, out) == start) break;
      const int next = neighbours_[t][out];
      from += leaves * to;
      if (next < 0 || angleBetween(result_.facets[t], result_.facets[next]) > sharpTurn) {
        const SpacePoint outward = sideOf(t, out).cross(result_.facets[t]).normalized();
        to -= 2 * to.dot(outward) * outward;
        k = out;
        continue;
      }
      // The next triangle, unfolded into the plane of this one.
      const SpacePoint side = sideOf(t, out).normalized();
      const SpacePoint across = side.cross(result_.facets[t]);
      to = to.dot(side) * side + to.dot(across) * side.cross(result_.facets[next]);
      k = sideTowards(next, t);
      t = next;
      most = std::max(most, angleBetween(first, result_.facets[t]));
    }
    return most / length;
  }

  [[nodiscard]] SpacePoint sideOf(int t, int k) const {
    return place(result_.triangles[t][(k + 1) % 3]) - place(result_.triangles[t][k]);
  }

  /// Triangles of a part at a vertex.
  void addAround(int v, int part, std::vector<int>& found) const {
    for (const int t : around_[v])
      if (result_.parts[t] == part) found.push_back(t);
  }

  template <class Value>
  static void sortOut(std::vector<Value>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  [[nodiscard]] std::vector<int> verticesOf(const std::vector<int>& triangles) const {
    std::vector<int> vertices;
    for (const int t : triangles)
      vertices.insert(vertices.end(), result_.triangles[t].begin(), result_.triangles[t].end());
    sortOut(vertices);
    return vertices;
  }

  [[nodiscard]] SurfaceNormal fitted(int v, int part) const {
    std::vector<int> triangles;
    addAround(v, part, triangles);
    SpacePoint mean = SpacePoint::Zero();
    for (const int t : triangles) mean += result_.facets[t];
    mean.normalize();
    const std::vector<int> ring = verticesOf(triangles);
    for (const int w : ring) addAround(w, part, triangles);
    sortOut(triangles);
    constexpr double steep = 0.2;
    std::vector<int> kept;
    double turn = 0;
    for (const int t : triangles) {
      if (result_.facets[t].dot(mean) < steep) continue;
      kept.push_back(t);
      turn = std::max(turn, angleBetween(result_.facets[t], mean));
    }
    constexpr double plane = 1e-10;
    if (turn < plane) return {mean, true, 0};
    std::vector<SpacePoint> points;
    for (const int w : verticesOf(kept))
      if (w != v) points.push_back(place(w) - place(v));
    return quadricThrough(points, mean, turn);
  }

  /// Of the quadric through the origin that fits the points, by a first guess.
  /// \param turn  of the triangles [rad]
  static SurfaceNormal quadricThrough(const std::vector<SpacePoint>& points, const SpacePoint& guess,
                                      double turn) {
    constexpr int repetitions = 4;
    constexpr double least = 0.02;      // what the points tell of f, g and h, of their columns
    constexpr double poor = 1e-6;       // the same of the others, of the largest
    constexpr double otherwise = 0.15;  // of the heights: no quadric
    const auto count = static_cast<Eigen::Index>(points.size());
    double radius = 0;
    for (const SpacePoint& x : points) radius = std::max(radius, x.norm());
    SurfaceNormal result{guess, true, 0};
    double bend = 0;  // of z z, beside half of it: the section of the largest curvature is a circle
    for (int i = 0; i < repetitions; ++i) {
      const SpacePoint t1 = result.n.unitOrthogonal();
      const SpacePoint t2 = result.n.cross(t1);
      Matrix own(count, 5), others(count, 3);
      Vector heights(count);
      for (Eigen::Index row = 0; row < count; ++row) {
        const SpacePoint scaled = points[row] / radius;
        const double x = scaled.dot(t1), y = scaled.dot(t2), z = scaled.dot(result.n);
        const double weight = 1 / scaled.squaredNorm();
        own.row(row) << x, y, x * x + z * z / 2, M_SQRT2 * x * y, y * y + z * z / 2;
        own.row(row) *= weight;
        others.row(row) << x * z, y * z, z * z;
        others.row(row) *= weight;
        heights[row] = weight * (z - bend * z * z);
      }
      Eigen::JacobiSVD<Matrix> first(own, Eigen::ComputeThinU | Eigen::ComputeThinV);
      first.setThreshold(poor);
      if (first.rank() < 2) return {guess, false, turn / 2};
      const Eigen::Index rank = first.rank();
      const Matrix basis = first.matrixU().leftCols(rank);
      // What turns t1 and t2 mixes the first two.
      if (const double size = others.leftCols(2).norm(); size > 0) others.leftCols(2) /= size;
      if (const double size = others.col(2).norm(); size > 0) others.col(2) /= size;
      const Matrix left = others - basis * (basis.transpose() * others);
      const Vector heightsLeft = heights - basis * (basis.transpose() * heights);
      const Eigen::JacobiSVD<Matrix> second(left, Eigen::ComputeThinU | Eigen::ComputeThinV);
      Vector higher = Vector::Zero(3);
      Eigen::Index told = 0;
      for (; told < second.singularValues().size() && second.singularValues()[told] > least; ++told)
        higher += second.matrixU().col(told).dot(heightsLeft) / second.singularValues()[told] *
                  second.matrixV().col(told);
      const Vector rest = heights - others * higher;
      const Vector lower = first.solve(rest);
      const Vector misfit = rest - own * lower;
      result.n = (result.n - lower[0] * t1 - lower[1] * t2).normalized();
      const double mean = (lower[2] + lower[4]) / 2;
      const double apart = std::hypot((lower[2] - lower[4]) / 2, lower[3] / M_SQRT2);
      bend = std::clamp(mean, -apart, apart);
      if (i + 1 < repetitions) continue;
      // What the misfit makes of the slopes; where points tell less, the next order of an arc.
      Matrix all(count, rank + told);
      all.leftCols(rank) = basis * first.singularValues().head(rank).asDiagonal();
      all.rightCols(told) = others * second.matrixV().leftCols(told);
      const Matrix inverse = all.completeOrthogonalDecomposition().pseudoInverse();
      const Matrix slopes = first.matrixV().topLeftCorner(2, rank) * inverse.topRows(rank);
      const double freedom = std::max<double>(1, static_cast<double>(count - rank - told));
      result.error = misfit.norm() / std::sqrt(freedom) * slopes.norm();
      if (told < 3) result.error = std::max(result.error, turn * turn * turn / 16);
      if (rank < 5) result.error = std::max(result.error, turn / 2);
      if (misfit.norm() > otherwise * heights.norm()) return {guess, false, turn / 16};
    }
    return result;
  }

  const TetrahedronMesh& mesh_;
  BoundarySurface& result_;
  std::vector<std::array<int, 3>> neighbours_;  ///< across side k, from vertex k to the next; -1: none
  std::vector<std::vector<int>> around_;        ///< by vertices
};

}  // namespace

BoundarySurface boundarySurface(const TetrahedronMesh& mesh, std::optional<int> label) {
  BoundarySurface result;
  Surface(mesh, result).findNormals(label);
  return result;
}

}  // namespace mortier
