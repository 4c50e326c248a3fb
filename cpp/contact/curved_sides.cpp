// The curved surface over the triangles of a contact surface, by its normals at their vertices.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "contact/smooth_part.h"
#include "contact/surface.h"

namespace mortier {

ContactSurface::Side ContactSurface::sideOver(int triangle, int k) const {
  constexpr double steep = 0.3;
  const SurfaceNormal& first = vertexNormals[triangle][k];
  const SurfaceNormal& last = vertexNormals[triangle][(k + 1) % 3];
  const SpacePoint d = places[triangle][(k + 1) % 3] - places[triangle][k];
  SpacePoint up = SpacePoint::Zero();  // perpendicular to the side
  for (const SurfaceNormal* end : {&first, &last})
    if (end->known) up += end->n - end->n.dot(d) / d.squaredNorm() * d;
  if (up.isZero(0)) return {};
  up.normalize();
  if ((first.known && first.n.dot(up) < steep) || (last.known && last.n.dot(up) < steep)) return {};
  const auto slope = [&](const SpacePoint& n) { return -n.dot(d) / n.dot(up); };
  // Where one end has no normal the side is symmetric, as where a line ends in the plane.
  const double begins = first.known ? slope(first.n) : -slope(last.n);
  const double ends = last.known ? slope(last.n) : -begins;
  // The even part is that of a circle to fourth order.
  const double even = (begins - ends) / 2;
  const double angle = std::atan(even / d.norm());
  const double second = even / (1 + angle * angle / 4);
  return {second * up, (begins + ends) / 2 * up, (even - second) * up};
}

void ContactSurface::findSides() {
  sides_.clear();
  for (size_t t = 0; t < triangles.size(); ++t) {
    std::array<Side, 3>& own = sides_.emplace_back();
    for (int k = 0; k < 3; ++k) own[k] = sideOver(static_cast<int>(t), k);
  }
}

double ContactSurface::distanceAlong(const SpacePoint& n, const SpacePoint& apart, int triangle,
                                     const Eigen::Vector3d& l) const {
  constexpr double grazing = 0.2;
  const SpacePoint to = apart + offset(triangle, l);
  const SpacePoint tangent = normalAt(triangle, l);
  const double along = tangent.dot(n);
  return std::abs(along) > grazing ? tangent.dot(to) / along : n.dot(to);
}

/// Errors of normals at both ends of a side of length h make one of h/8 times their sum in its middle; the
/// cubic over an arc that turns by an angle is off it by the square of that over 16 of its sagitta. What
/// heights of third degree are inside a triangle, up to 1/27, is not known from its sides.
double ContactSurface::offsetError(int triangle) const {
  constexpr double parallel = 1e-9;
  double most = 0;
  for (int k = 0; k < 3; ++k) {
    const SurfaceNormal& first = vertexNormals[triangle][k];
    const SurfaceNormal& last = vertexNormals[triangle][(k + 1) % 3];
    const double length = (places[triangle][(k + 1) % 3] - places[triangle][k]).norm();
    const double turn = (first.n - last.n).norm();
    const double sagitta = turn < parallel ? 0 : length * turn / 8;
    const double odd = sides_[triangle][k].odd.norm() / 27;
    most = std::max(most, length * (first.error + last.error) / 8 + sagitta * turn * turn / 16 + odd);
  }
  return most;
}

double errorBetween(const ContactSurface& nonmortar, const ContactSurface& mortar,
                    const FacingTriangles& facing) {
  constexpr double onePlace = 1e-9;
  const double near = onePlace * std::min(nonmortar.extent, mortar.extent);
  const auto& own = nonmortar.places[facing.nonmortar];
  const bool one = std::all_of(own.begin(), own.end(), [&](const SpacePoint& x) {
    const auto& across = mortar.places[facing.mortar];
    return std::any_of(across.begin(), across.end(),
                       [&](const SpacePoint& y) { return (x - y).norm() <= near; });
  });
  return one ? 0 : nonmortar.offsetError(facing.nonmortar) + mortar.offsetError(facing.mortar);
}

double visibleError(const std::vector<DistanceError>& errors) {
  constexpr double visible = 0.1;
  double least = infinity;
  for (const DistanceError& each : errors) least = std::min(least, each.nearest);
  double most = 0;
  for (const DistanceError& each : errors)
    if (each.error >= visible * (each.nearest - least)) most = std::max(most, each.error);
  return most;
}

void shareNormals(ContactSurface& one, ContactSurface& other) {
  constexpr double onePlace = 1e-9;
  const double near = onePlace * std::min(one.extent, other.extent);
  const double opposite = -std::cos(sharpTurn);
  if (one.planar && other.planar) return;
  // Sorted along a direction that no mesh is likely to have.
  const SpacePoint direction = SpacePoint(1, 1 / std::numbers::phi, 2 - std::numbers::phi).normalized();
  struct Corner {
    double x;
    size_t triangle;
    int k;
  };
  std::vector<Corner> corners;
  for (size_t t = 0; t < other.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) corners.push_back({direction.dot(other.places[t][k]), t, k});
  const auto before = [](const Corner& corner, double x) { return corner.x < x; };
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.x, a.triangle, a.k) < std::tie(b.x, b.triangle, b.k);
  });
  std::vector<std::array<SurfaceNormal, 3>> across = other.vertexNormals;
  bool any = false;
  for (size_t t = 0; t < one.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const SpacePoint& place = one.places[t][k];
      const SurfaceNormal own = one.vertexNormals[t][k];
      SurfaceNormal shared = own;
      // At a ridge several normals meet: that of the side which is most nearly opposite.
      const SurfaceNormal* best = nullptr;
      std::vector<const Corner*> matching;
      for (auto at = std::lower_bound(corners.begin(), corners.end(), direction.dot(place) - near, before);
           at != corners.end() && at->x <= direction.dot(place) + near; ++at) {
        const SurfaceNormal& theirs = other.vertexNormals[at->triangle][at->k];
        if ((other.places[at->triangle][at->k] - place).norm() > near || theirs.n.dot(own.n) > opposite ||
            (!own.known && !theirs.known))
          continue;
        matching.push_back(&*at);
        if (best == nullptr || theirs.n.dot(own.n) < best->n.dot(own.n)) best = &theirs;
      }
      if (best != nullptr) {
        const SpacePoint turned = -best->n;
        if (own.known == best->known && own.error == best->error)
          shared.n = (own.n + turned).normalized();
        else if (best->known && (!own.known || best->error < own.error))
          shared = {turned, true, best->error};
        for (const Corner* at : matching)
          if ((other.vertexNormals[at->triangle][at->k].n - best->n).norm() <= onePlace)
            across[at->triangle][at->k] = {-shared.n, shared.known, shared.error};
        any = true;
      }
      one.vertexNormals[t][k] = shared;
    }
  if (!any) return;
  other.vertexNormals = std::move(across);
  one.findSides();
  other.findSides();
}

}  // namespace mortier
