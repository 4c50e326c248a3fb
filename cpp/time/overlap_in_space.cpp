#include <algorithm>
#include <cmath>

#include "contact/smooth_part.h"
#include "time/overlap_places.h"

namespace mortier {
namespace {

double angle(const SpacePoint& a, const SpacePoint& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The turn of a surface at a triangle, where its sides are no edges of the body.
double smoothTurn(const MovedSurface& surface, int triangle, bool reentrant) {
  double most = 0;
  for (int k = 0; k < 3; ++k)
    if (const double turn = surface.turn(triangle, k); std::abs(turn) < sharpTurn)
      most = std::max(most, reentrant ? -turn : std::abs(turn));
  return most;
}

double changeOfTurn(const MovedSurface& drawn, const MovedSurface& moved, int triangle) {
  double most = 0;
  for (int k = 0; k < 3; ++k)
    most = std::max(most, std::abs(moved.turn(triangle, k) - drawn.turn(triangle, k)));
  return most;
}

/// What a point of a triangle is moved by.
SpacePoint motionAt(const MovedSurface& drawn, const MovedSurface& moved, int triangle, const SpacePoint& x) {
  const SpacePoint &a = moved.corner(triangle, 0), &b = moved.corner(triangle, 1),
                   &c = moved.corner(triangle, 2);
  const SpacePoint n = (b - a).cross(c - a);
  const double whole = n.squaredNorm();
  const double atB = (x - a).cross(c - a).dot(n) / whole;
  const double atC = (b - a).cross(x - a).dot(n) / whole;
  const auto motion = [&](int k) -> SpacePoint {
    return moved.corner(triangle, k) - drawn.corner(triangle, k);
  };
  return (1 - atB - atC) * motion(0) + atB * motion(1) + atC * motion(2);
}

}  // namespace

std::vector<OverlapCheck::Region> OverlapCheck::inSpace(size_t one, size_t other, const Places& places,
                                                        const std::vector<Between>& contacts) const {
  const std::vector<SpacePointInside> found =
      pointsInside(places.surfaces[one], places.surfaces[other], places.rounding);
  if (found.empty()) return {};
  const bool follows =
      std::ranges::any_of(contacts, [](const Between& contact) { return contact.interface->follows(); });
  Region region;
  for (const SpacePointInside& point : found) {
    const size_t own = point.of == 0 ? one : other;
    const size_t across = point.of == 0 ? other : one;
    const MovedSurface& drawn = spaceDrawn_[own];
    const MovedSurface& drawnAcross = spaceDrawn_[across];
    const MovedSurface& moved = places.surfaces[own];
    const MovedSurface& movedAcross = places.surfaces[across];
    if (point.of == 0 && !point.node) region.area += moved.area(point.triangle);
    const int label = spaceOutlines_[own].labels[point.triangle];
    const int labelAcross = spaceOutlines_[across].labels[point.across];
    const double size = drawn.size(point.triangle);
    const double sizeAcross = drawnAcross.size(point.across);
    Sample sample{{static_cast<int>(own), static_cast<int>(across)},
                  {label, labelAcross},
                  point.at,
                  point.depth,
                  std::max(size, sizeAcross)};
    const SpacePoint motion = motionAt(drawn, moved, point.triangle, point.at);
    const SpacePoint motionAcross = motionAt(drawnAcross, movedAcross, point.across, point.foot);
    sample.drawn = {SpacePoint(point.at - motion), SpacePoint(point.foot - motionAcross)};
    const double inclination = angle(moved.normal(point.triangle), -movedAcross.normal(point.across));
    const double inclined = inclination < sharpTurn ? inclination : 0;
    auto [asked, nonmortar, named] = atPoint(
        contacts, own, {label, labelAcross}, {size, sizeAcross},
        {spaceOutlines_[own].triangles[point.triangle], spaceOutlines_[across].triangles[point.across]});
    if (!named) asked = std::max(asked, -drawnAcross.nearest(sample.drawn[0]).distance);
    const double chords = (point.node ? 0 : size * smoothTurn(drawn, point.triangle, true) / 4) +
                          sizeAcross * smoothTurn(drawnAcross, point.across, true) / 4;
    const SpacePoint relative = motion - motionAcross;
    const SpacePoint& n = drawn.normal(point.triangle);
    const double slip = (relative - n.dot(relative) * n).norm();
    const double turn = std::max(angle(n, -movedAcross.normal(point.across)),
                                 angle(drawnAcross.normal(point.across), -moved.normal(point.triangle)));
    // Surfaces that do not face each other have no rows whose directions could be off.
    const double slide = follows || turn > sharpTurn ? 0 : slip > sample.size ? infinity : slip * turn;
    sample.always =
        places.residual + places.rounding + asked + overlap::chords * chords + overlap::sliding * slide;
    const double curvature = smoothTurn(drawn, point.triangle, false) / size +
                             smoothTurn(drawnAcross, point.across, false) / sizeAcross;
    sample.pressed = overlap::meshes * (size * changeOfTurn(drawn, moved, point.triangle) +
                                        sizeAcross * changeOfTurn(drawnAcross, movedAcross, point.across) +
                                        curvature * nonmortar * nonmortar / 4) +
                     inclined * nonmortar / 3;
    sample.nonmortar = nonmortar;
    region.samples.push_back(sample);
  }
  return {region};
}

std::vector<OverlapCheck::Region> OverlapCheck::behindMeshes(const std::vector<Between>& contacts,
                                                             const Places& places,
                                                             const std::vector<Vector>& u,
                                                             double time) const {
  constexpr double known = 1e-6;  // of an element: of the least distance in it
  std::vector<Region> regions;
  for (const Between& contact : contacts) {
    const ContactInterface& interface = *contact.interface;
    if (interface.dimension() != 3) continue;
    const bool given = interface.distanceIsGiven();
    const ContactInterface::SurfacePoints& points =
        given ? interface.surfacePoints() : interface.nearestPoints();
    const ContactPair& pair = interface.pair();
    const std::array<int, 2> bodies{pair.nonmortar.body, pair.mortar.body};
    const Matrix jump = points.jump(u[bodies[0]], u[bodies[1]]);
    const Matrix moved = points.traces[0] * u[bodies[0]].reshaped(3, u[bodies[0]].size() / 3).transpose();
    const Vector apart = given ? interface.pointDistances(time) : points.distances;
    std::array<Matrix, 2> drawn;
    for (const size_t side : {0, 1}) {
      const std::vector<SpacePoint>& x = body(bodies[side]).space()->nodes().places;
      drawn[side] =
          points.traces[side] * Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
                                    x.front().data(), x.size(), 3);
    }
    Region region;
    for (Eigen::Index i = 0; i < jump.cols(); ++i) {
      const double depth = points.normals[i].dot(jump.col(i)) - apart[i];
      const double size = points.sizes[0][i];
      const double always = places.residual + places.rounding + known * size;
      if (!(depth > always)) continue;
      Sample sample{bodies,  {pair.nonmortar.label, pair.mortar.label}, {}, depth, size, size, always,
                    infinity};
      for (const size_t side : {0, 1}) sample.drawn[side] = drawn[side].row(i);
      sample.at = sample.drawn[0] + moved.row(i).transpose();
      region.samples.push_back(sample);
    }
    if (!region.samples.empty()) regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace mortier
