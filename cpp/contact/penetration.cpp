#include "contact/penetration.h"

#include <algorithm>
#include <cmath>

namespace mortier {

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
    stretches_.push_back({place(segment.begin), place(segment.end), segment.end - segment.begin});
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

}  // namespace mortier
