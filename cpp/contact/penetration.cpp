#include "contact/penetration.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/triangle_mesh.h"

namespace mortier {
namespace {

/// A distance that is off its chord by less than this part of the length is linear.
constexpr double straight = 1e-12;

/// The mean of the positive part of the linear function from a to b.
double positiveMean(double a, double b) {
  if (a >= 0 && b >= 0) return (a + b) / 2;
  return a > 0 || b > 0 ? std::max(a, b) * std::max(a, b) / (2 * std::abs(a - b)) : 0;
}

/// The parabola from a through m in the middle to b, over [0, 1].
class Parabola {
 public:
  Parabola(double a, double m, double b) : a_(a), slope_(4 * m - 3 * a - b), bend_(2 * (a - 2 * m + b)) {}

  /// The mean of its positive part: Simpson's rule between its roots.
  [[nodiscard]] double positiveMean() const {
    return overPositive([](double a, double m, double b) { return (a + 4 * m + b) / 6; });
  }
  [[nodiscard]] double squareMean() const { return square(at(0), at(0.5), at(1)); }
  [[nodiscard]] double positiveSquareMean() const { return overPositive(square); }

 private:
  [[nodiscard]] double at(double t) const { return a_ + t * (slope_ + t * bend_); }
  static double square(double a, double m, double b) {
    return (4 * a * a + 16 * m * m + 4 * b * b + 4 * m * (a + b) - 2 * a * b) / 30;
  }
  template <class Mean>
  [[nodiscard]] double overPositive(Mean mean) const {
    std::array<double, 4> ends{0, 1, 1, 1};
    const double discriminant = slope_ * slope_ - 4 * bend_ * a_;
    if (discriminant > 0) {
      const double q = -(slope_ + std::copysign(std::sqrt(discriminant), slope_)) / 2;
      ends[1] = std::clamp(q != 0 ? a_ / q : 0.0, 0.0, 1.0);
      ends[2] = std::clamp(bend_ != 0 ? q / bend_ : 1.0, 0.0, 1.0);
      if (ends[1] > ends[2]) std::swap(ends[1], ends[2]);
    }
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const double middle = at((ends[k] + ends[k + 1]) / 2);
      if (middle > 0) sum += (ends[k + 1] - ends[k]) * mean(at(ends[k]), middle, at(ends[k + 1]));
    }
    return sum;
  }

  double a_, slope_, bend_;
};

/// Where shape functions have these values, as a part of the element.
double partOf(const EdgeValues& shapes) {
  return shapes.size() > 2 ? shapes[1] + shapes[2] / 2 : shapes[1];
}

EdgeNodes numbers(const ElementLine& line, int element) {
  EdgeNodes nodes = line.nodesOf(element);
  for (int& node : nodes) node = line.number(node);
  return nodes;
}

}  // namespace

void PenetrationIntegral::add(const CommonRefinement& refinement, const DistanceAt& distance,
                              bool axisymmetric) {
  const SmoothPart& part = refinement.part();
  const MortarLine& mortar = refinement.mortar();
  const bool quadratic = part.degree() > 1 || mortar.degree() > 1;
  for (const Segment& segment : refinement.segments()) {
    const EdgeNodes nonmortarNodes = numbers(part, segment.nonmortar);
    const EdgeNodes mortarNodes = numbers(mortar, segment.mortar);
    const auto place = [&](double s) {
      const FacingPair facing = refinement.pairAt(segment, s);
      return Place{nonmortarNodes, mortarNodes,   facing.phi,
                   facing.psi,     facing.normal, distance(segment.nonmortar, s, facing)};
    };
    // Between its ends the distance of two curves is not linear: the chord of a curve hides what is below it.
    const double length = segment.end - segment.begin;
    const double element = part.s[segment.nonmortar + 1] - part.s[segment.nonmortar];
    const auto depthAt = [&](double along) {
      const int e = segment.nonmortar;
      return axisymmetric ? circumference(part.at(e, part.partAt(e, segment.begin + along * length))) : 1;
    };
    const Place begin = place(segment.begin);
    const Place middle = place(segment.begin + length / 2);
    const Place end = place(segment.end);
    const auto first = static_cast<int>(places_.size());
    if (quadratic) {
      places_.insert(places_.end(), {begin, middle, end});
      stretches_.push_back({first, true, length, element, depthAt(0.5)});
    } else if (std::abs(middle.distance - (begin.distance + end.distance) / 2) <= straight * length) {
      places_.insert(places_.end(), {begin, end});
      stretches_.push_back({first, false, length, element, depthAt(0.5)});
    } else {
      places_.insert(places_.end(), {begin, middle, end});
      stretches_.push_back({first, false, length / 2, element, depthAt(0.25)});
      stretches_.push_back({first + 1, false, length / 2, element, depthAt(0.75)});
    }
  }
}

double PenetrationIntegral::Place::jump(const Vector& uNonmortar, const Vector& uMortar,
                                        const Vector& gap) const {
  Point u = Point::Zero();
  for (Eigen::Index k = 0; k < phi.size(); ++k) u += phi[k] * uNonmortar.segment<2>(2 * nonmortar[k]);
  for (Eigen::Index k = 0; k < psi.size(); ++k) u -= psi[k] * uMortar.segment<2>(2 * mortar[k]);
  if (gap.size() == 0) return u.dot(normal) - distance;
  double given = 0;
  for (Eigen::Index k = 0; k < phi.size(); ++k) given += phi[k] * gap[nonmortar[k]];
  return u.dot(normal) - given;
}

void PenetrationIntegral::setMoved(const Vector& uNonmortar, const Vector& uMortar) {
  // jump() is less the distance.
  for (Place& place : places_) place.distance += place.jump(uNonmortar, uMortar) + place.distance;
}

double PenetrationIntegral::of(const Vector& uNonmortar, const Vector& uMortar, const Vector& gap) const {
  double integral = 0;
  for (const Stretch& stretch : stretches_) {
    const auto jump = [&](int k) { return places_[stretch.first + k].jump(uNonmortar, uMortar, gap); };
    integral += stretch.length * (stretch.parabola ? Parabola(jump(0), jump(1), jump(2)).positiveMean()
                                                   : positiveMean(jump(0), jump(1)));
  }
  return integral;
}

std::vector<GapSquare> PenetrationIntegral::squares(const Vector& uNonmortar, const Vector& uMortar,
                                                    const std::function<bool(int)>& pressed,
                                                    const Vector& given) const {
  std::vector<GapSquare> result;
  result.reserve(stretches_.size());
  for (const Stretch& stretch : stretches_) {
    const auto jump = [&](int k) { return places_[stretch.first + k].jump(uNonmortar, uMortar, given); };
    const Parabola gap = stretch.parabola ? Parabola(jump(0), jump(1), jump(2))
                                          : Parabola(jump(0), (jump(0) + jump(1)) / 2, jump(1));
    const Place& place = places_[stretch.first];
    const std::array nonmortar{place.nonmortar[0], place.nonmortar[1]};
    const bool any = pressed(nonmortar[0]) || pressed(nonmortar[1]);
    result.push_back({nonmortar,
                      {place.mortar[0], place.mortar[1]},
                      stretch.element,
                      stretch.depth * stretch.length * (any ? gap.squareMean() : gap.positiveSquareMean())});
  }
  return result;
}

std::vector<RefinedPiece> PenetrationIntegral::pieces() const {
  std::vector<RefinedPiece> result;
  for (const Stretch& stretch : stretches_) {
    const Place& a = places_[stretch.first];
    const Place& b = places_[stretch.first + (stretch.parabola ? 2 : 1)];
    result.push_back({{a.nonmortar[0], a.nonmortar[1]},
                      {a.mortar[0], a.mortar[1]},
                      {partOf(a.phi), partOf(b.phi)},
                      {partOf(a.psi), partOf(b.psi)},
                      {a.normal, b.normal},
                      {a.distance, b.distance},
                      stretch.length});
  }
  return result;
}

}  // namespace mortier
