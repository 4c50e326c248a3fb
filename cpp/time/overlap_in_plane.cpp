#include <algorithm>
#include <cmath>

#include "contact/smooth_part.h"
#include "time/overlap_places.h"

namespace mortier {
namespace {

double angle(const Point& a, const Point& b) {
  return std::abs(std::atan2(cross(a, b), a.dot(b)));
}

double turnFrom(const Point& a, const Point& b) {
  return std::atan2(cross(a, b), a.dot(b));
}

/// An outline with its nodes at places.
struct Line {
  const BodyOutline& outline;
  const std::vector<Point>& places;

  [[nodiscard]] Point at(int side, double part) const { return placeOn(outline.sides[side], places, part); }
  [[nodiscard]] Point along(int side, double part) const {
    const OutlineSide& s = outline.sides[side];
    const Point& a = places[s.nodes[0]];
    const Point& b = places[s.nodes[1]];
    if (s.middle < 0) return b - a;
    return (4 * part - 3) * a + (4 * part - 1) * b + (4 - 8 * part) * places[s.middle];
  }
  [[nodiscard]] double length(int side) const {
    const auto& [a, b] = outline.sides[side].nodes;
    return (places[b] - places[a]).norm();
  }
  /// To the left: at the first end of a side, at its other end, within it.
  [[nodiscard]] std::array<double, 3> turns(int side) const {
    const Point begin = along(side, 0);
    const Point end = along(side, 1);
    return {turnFrom(along(outline.previous[side], 1), begin), turnFrom(end, along(outline.next[side], 0)),
            turnFrom(begin, end)};
  }
};

/// The turn of a curve over a side: within it, and at its ends where these are no corners.
/// \param reentrant  to the right alone
double smoothTurn(const Line& line, int side, bool reentrant) {
  const auto [first, last, within] = line.turns(side);
  double most = std::max(0.0, reentrant ? -within : std::abs(within));
  for (const double turn : {first, last})
    if (std::abs(turn) < sharpTurn) most = std::max(most, reentrant ? -turn : std::abs(turn));
  return most;
}

/// By what a line has been bent at a side.
double changeOfTurn(const Line& drawn, const Line& moved, int side) {
  const std::array<double, 3> a = drawn.turns(side);
  const std::array<double, 3> b = moved.turns(side);
  return std::max(std::abs(b[0] - a[0]), std::abs(b[1] - a[1])) + std::abs(b[2] - a[2]);
}

/// By how much the chord of a reentrant curve is off it, part of the way along a straight side.
double reentrantSagitta(const Line& drawn, int side, double part) {
  if (drawn.outline.sides[side].middle >= 0) return 0;
  return drawn.length(side) * smoothTurn(drawn, side, true) / 2 * part * (1 - part);
}

}  // namespace

void OverlapCheck::Places::add(const Body& body, const Vector& u) {
  const Vector moved = body.moved(u);
  if (const SpaceElements* space = body.space()) {
    std::vector<SpacePoint>& places = inSpace.emplace_back(space->nodes().places);
    for (size_t node = 0; node < places.size(); ++node)
      places[node] += moved.segment<3>(3 * static_cast<Eigen::Index>(node));
    return;
  }
  std::vector<Point>& places = inPlane.emplace_back(body.elementNodes().places);
  for (size_t node = 0; node < places.size(); ++node)
    places[node] += moved.segment<2>(2 * static_cast<Eigen::Index>(node));
}

double OverlapCheck::Places::largest(size_t b) const {
  double largest = 0;
  const auto raise = [&](const auto& places) {
    for (const auto& x : places) largest = std::max(largest, x.template lpNorm<Eigen::Infinity>());
  };
  if (inSpace.empty())
    raise(inPlane[b]);
  else
    raise(inSpace[b]);
  return largest;
}

std::vector<OverlapCheck::Region> OverlapCheck::inPlane(size_t one, size_t other, const Places& places,
                                                        const std::vector<Between>& contacts) const {
  const bool follows = std::any_of(contacts.begin(), contacts.end(),
                                   [](const Between& contact) { return contact.interface->follows(); });
  std::vector<Region> regions;
  for (const CommonRegion& found :
       commonRegions(places.outlines[one], places.outlines[other], places.rounding)) {
    Region& region = regions.emplace_back();
    region.area = found.area;
    for (const PointInside& point : found.points) {
      const size_t own = point.of == 0 ? one : other;
      const size_t across = point.of == 0 ? other : one;
      const int label = outlines_[own].sides[point.side].label;
      const int labelAcross = outlines_[across].sides[point.across].label;
      if (drawnOnly(own, label) || drawnOnly(across, labelAcross)) continue;
      const Line drawn{outlines_[own], body(own).elementNodes().places};
      const Line drawnAcross{outlines_[across], body(across).elementNodes().places};
      const Line moved{outlines_[own], places.inPlane[own]};
      const Line movedAcross{outlines_[across], places.inPlane[across]};
      const double length = drawn.length(point.side);
      const double lengthAcross = drawnAcross.length(point.across);
      Sample sample{{static_cast<int>(own), static_cast<int>(across)},
                    {label, labelAcross},
                    {point.at.x(), point.at.y(), 0},
                    point.depth,
                    std::max(length, lengthAcross)};

      const Point place = drawn.at(point.side, point.part);
      const Point placeAcross = drawnAcross.at(point.across, point.partAcross);
      sample.drawn = {SpacePoint(place.x(), place.y(), 0), SpacePoint(placeAcross.x(), placeAcross.y(), 0)};
      const double inclination =
          angle(moved.along(point.side, point.part), -movedAcross.along(point.across, point.partAcross));
      const double inclined = inclination < sharpTurn ? inclination : 0;
      const auto nodesOf = [&](size_t b, int of) {
        const OutlineSide& side = outlines_[b].sides[of];
        return std::array<int, 3>{side.nodes[0], side.nodes[1], side.middle};
      };
      auto [asked, nonmortar, named] = atPoint(contacts, own, {label, labelAcross}, {length, lengthAcross},
                                               {nodesOf(own, point.side), nodesOf(across, point.across)});
      if (!named) asked = std::max(asked, -drawn_[across].nearest(place).distance);
      const double chords = reentrantSagitta(drawn, point.side, point.part) +
                            reentrantSagitta(drawnAcross, point.across, point.partAcross);
      const double pieces =
          places.outlines[own].offCurve(point.side) + places.outlines[across].offCurve(point.across);
      double slide = 0;
      if (!follows) {
        const Point motion = moved.at(point.side, point.part) - place -
                             movedAcross.at(point.across, point.partAcross) + placeAcross;
        const Point way = drawn.along(point.side, point.part);
        const Point wayAcross = drawnAcross.along(point.across, point.partAcross);
        const double slip = std::abs(motion.dot(way.normalized()));
        const double turn = std::max(angle(way, -movedAcross.along(point.across, point.partAcross)),
                                     angle(wayAcross, -moved.along(point.side, point.part)));
        slide = slip > sample.size ? infinity : slip * std::min(1.0, turn);
      }
      sample.always = places.residual + places.rounding + asked + pieces + overlap::chords * chords +
                      overlap::sliding * slide;
      const double curvature = smoothTurn(drawn, point.side, false) / length +
                               smoothTurn(drawnAcross, point.across, false) / lengthAcross;
      sample.pressed =
          overlap::meshes * (length * changeOfTurn(drawn, moved, point.side) +
                             lengthAcross * changeOfTurn(drawnAcross, movedAcross, point.across) +
                             curvature * nonmortar * nonmortar / 8) +
          inclined * nonmortar / 3;
      sample.nonmortar = nonmortar;
      region.samples.push_back(sample);
    }
  }
  return regions;
}

}  // namespace mortier
