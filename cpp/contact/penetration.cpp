#include "contact/penetration.h"

#include <algorithm>
#include <cmath>

namespace mortier {
namespace {

/// A distance that is off its chord by less than this part of the length is linear.
constexpr double straight = 1e-12;

}  // namespace

void PenetrationIntegral::add(const SmoothPart& part, const FacingLine& mortar, const DistanceAt& distance) {
  for (const Segment& segment : commonRefinement(part.s, mortar.s)) {
    const int i = segment.nonmortar;
    const int j = segment.mortar;
    const auto place = [&](double s) {
      const Sight sight = see(part, mortar, segment, s);
      return Place{{part.nodes[i], part.nodes[i + 1]},
                   {mortar.nodes[j], mortar.nodes[j + 1]},
                   sight.phi,
                   sight.psi,
                   sight.normal,
                   distance(i, s, sight)};
    };
    // Between its ends the distance of two curves is not linear: the chord of a curve hides what is below it.
    const double length = segment.end - segment.begin;
    const double element = part.s[i + 1] - part.s[i];
    const Place begin = place(segment.begin);
    const Place middle = place(segment.begin + length / 2);
    const Place end = place(segment.end);
    if (std::abs(middle.distance - (begin.distance + end.distance) / 2) <= straight * length) {
      stretches_.push_back({begin, end, length, element});
    } else {
      stretches_.push_back({begin, middle, length / 2, element});
      stretches_.push_back({middle, end, length / 2, element});
    }
  }
}

double PenetrationIntegral::Place::jump(const Vector& uNonmortar, const Vector& uMortar) const {
  Point u = Point::Zero();
  for (int k = 0; k < 2; ++k)
    u += phi[k] * uNonmortar.segment<2>(2 * nonmortar[k]) - psi[k] * uMortar.segment<2>(2 * mortar[k]);
  return u.dot(normal) - distance;
}

double PenetrationIntegral::of(const Vector& uNonmortar, const Vector& uMortar) const {
  double integral = 0;
  for (const Stretch& stretch : stretches_) {
    const double a = stretch.begin.jump(uNonmortar, uMortar);
    const double b = stretch.end.jump(uNonmortar, uMortar);
    if (a >= 0 && b >= 0)
      integral += stretch.length * (a + b) / 2;
    else if (a > 0 || b > 0)
      integral += stretch.length * std::max(a, b) * std::max(a, b) / (2 * std::abs(a - b));
  }
  return integral;
}

double PenetrationIntegral::deepest(const Vector& uNonmortar, const Vector& uMortar) const {
  double depth = 0;
  for (const Stretch& stretch : stretches_)
    for (const Place* place : {&stretch.begin, &stretch.end})
      depth = std::max(depth, place->jump(uNonmortar, uMortar));
  return depth;
}

std::vector<GapSquare> PenetrationIntegral::squares(const Vector& uNonmortar, const Vector& uMortar,
                                                    const std::function<bool(int)>& pressed) const {
  std::vector<GapSquare> result;
  result.reserve(stretches_.size());
  for (const Stretch& stretch : stretches_) {
    const auto& nodes = stretch.begin.nonmortar;
    double a = stretch.begin.jump(uNonmortar, uMortar);
    double b = stretch.end.jump(uNonmortar, uMortar);
    double length = stretch.length;
    if (!pressed(nodes[0]) && !pressed(nodes[1])) {
      if (a * b < 0) length *= std::max(a, b) / std::abs(a - b);
      a = std::max(a, 0.0);
      b = std::max(b, 0.0);
    }
    result.push_back({nodes, stretch.begin.mortar, stretch.element, length * (a * a + a * b + b * b) / 3});
  }
  return result;
}

}  // namespace mortier
