#include "contact/penetration.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mortier {
namespace {

/// A distance that is off its chord by less than this part of the length is linear.
constexpr double straight = 1e-12;

/// The mean of the positive part of the linear function from a to b.
double positiveMean(double a, double b) {
  if (a >= 0 && b >= 0) return (a + b) / 2;
  return a > 0 || b > 0 ? std::max(a, b) * std::max(a, b) / (2 * std::abs(a - b)) : 0;
}

/// The same of the parabola from a through m in the middle to b.
double positiveMean(double a, double m, double b) {
  const double bend = 2 * (a - 2 * m + b);
  const double slope = 4 * m - 3 * a - b;
  const auto at = [&](double t) { return a + t * (slope + t * bend); };
  std::array<double, 4> ends{0, 1, 1, 1};
  const double discriminant = slope * slope - 4 * bend * a;
  if (discriminant > 0) {
    const double q = -(slope + std::copysign(std::sqrt(discriminant), slope)) / 2;
    ends[1] = std::clamp(q != 0 ? a / q : 0.0, 0.0, 1.0);
    ends[2] = std::clamp(bend != 0 ? q / bend : 1.0, 0.0, 1.0);
    if (ends[1] > ends[2]) std::swap(ends[1], ends[2]);
  }
  double mean = 0;
  for (int k = 0; k < 3; ++k) {  // Simpson's rule between its roots
    const double middle = at((ends[k] + ends[k + 1]) / 2);
    if (middle > 0) mean += (ends[k + 1] - ends[k]) * (at(ends[k]) + 4 * middle + at(ends[k + 1])) / 6;
  }
  return mean;
}

EdgeNodes numbers(const ElementLine& line, int element) {
  EdgeNodes nodes = line.nodesOf(element);
  for (int& node : nodes) node = line.number(node);
  return nodes;
}

}  // namespace

void PenetrationIntegral::add(const SmoothPart& part, const FacingLine& mortar, const DistanceAt& distance) {
  const bool quadratic = part.degree() > 1 || mortar.degree() > 1;
  for (const Segment& segment : commonRefinement(part.s, mortar.s)) {
    const EdgeNodes nonmortarNodes = numbers(part, segment.nonmortar);
    const EdgeNodes mortarNodes = numbers(mortar, segment.mortar);
    const auto place = [&](double s) {
      const Sight sight = see(part, mortar, segment, s);
      return Place{nonmortarNodes, mortarNodes,  sight.phi,
                   sight.psi,      sight.normal, distance(segment.nonmortar, s, sight)};
    };
    // Between its ends the distance of two curves is not linear: the chord of a curve hides what is below it.
    const double length = segment.end - segment.begin;
    const Place begin = place(segment.begin);
    const Place middle = place(segment.begin + length / 2);
    const Place end = place(segment.end);
    const auto first = static_cast<int>(places_.size());
    if (quadratic) {
      places_.insert(places_.end(), {begin, middle, end});
      stretches_.push_back({first, true, length});
    } else if (std::abs(middle.distance - (begin.distance + end.distance) / 2) <= straight * length) {
      places_.insert(places_.end(), {begin, end});
      stretches_.push_back({first, false, length});
    } else {
      places_.insert(places_.end(), {begin, middle, end});
      stretches_.push_back({first, false, length / 2});
      stretches_.push_back({first + 1, false, length / 2});
    }
  }
}

double PenetrationIntegral::Place::jump(const Vector& uNonmortar, const Vector& uMortar) const {
  Point u = Point::Zero();
  for (Eigen::Index k = 0; k < phi.size(); ++k) u += phi[k] * uNonmortar.segment<2>(2 * nonmortar[k]);
  for (Eigen::Index k = 0; k < psi.size(); ++k) u -= psi[k] * uMortar.segment<2>(2 * mortar[k]);
  return u.dot(normal) - distance;
}

double PenetrationIntegral::of(const Vector& uNonmortar, const Vector& uMortar) const {
  double integral = 0;
  for (const Stretch& stretch : stretches_) {
    const auto jump = [&](int k) { return places_[stretch.first + k].jump(uNonmortar, uMortar); };
    integral += stretch.length *
                (stretch.parabola ? positiveMean(jump(0), jump(1), jump(2)) : positiveMean(jump(0), jump(1)));
  }
  return integral;
}

double PenetrationIntegral::deepest(const Vector& uNonmortar, const Vector& uMortar) const {
  double depth = 0;
  for (const Place& place : places_) depth = std::max(depth, place.jump(uNonmortar, uMortar));
  return depth;
}

}  // namespace mortier
