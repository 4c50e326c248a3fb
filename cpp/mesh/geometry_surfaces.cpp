#include "mesh/geometry_surfaces.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "base/dense_templates.h"

namespace mortier {

std::optional<SharedPoint> sharedPoint(const GeometrySurfaces& geometry, const std::vector<int>& surfaces,
                                       const SpacePoint& x) {
  constexpr int most = 40;
  // Of the sine of half the angle between two normals: surfaces that touch along a curve do not tell where
  // across it a point is.
  constexpr double touching = 0.02;
  if (surfaces.empty()) return std::nullopt;
  SharedPoint best{x, {}, infinity};
  SpacePoint at = x;
  if (surfaces.size() > 1)
    if (const std::optional<SpacePoint> on = geometry.onSharedCurve(surfaces[0], surfaces[1], x)) at = *on;
  const auto count = static_cast<Eigen::Index>(surfaces.size());
  for (int i = 0; i < most; ++i) {
    std::vector<std::pair<int, SpacePoint>> points;
    for (const int surface : surfaces) points.emplace_back(surface, at);
    const std::vector<std::optional<SurfaceFoot>> feet = geometry.feet(points);
    SharedPoint next{at, {}, 0};
    Matrix normals(count, 3);
    Vector distances(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const std::optional<SurfaceFoot>& foot = feet[static_cast<size_t>(k)];
      if (!foot) return std::nullopt;
      const SpacePoint way = foot->at - at;
      next.normals.push_back(foot->normal);
      next.off = std::max(next.off, way.norm());
      // Where there is no normal, towards the foot.
      const SpacePoint along = foot->normal.allFinite() ? foot->normal
                               : way.norm() > 0         ? way.normalized()
                                                        : SpacePoint(SpacePoint::Zero());
      normals.row(k) = along.transpose();
      distances[k] = along.dot(way);
    }
    if (!(next.off < best.off)) break;
    best = next;
    if (best.off == 0) break;
    Eigen::JacobiSVD<Matrix> solver(normals, Eigen::ComputeThinU | Eigen::ComputeThinV);
    solver.setThreshold(touching);
    at += solver.solve(distances);
  }
  if (!std::isfinite(best.off)) return std::nullopt;
  return best;
}

}  // namespace mortier
