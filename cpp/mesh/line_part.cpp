#include "mesh/line_part.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

#include "base/error.h"

namespace mortier {
namespace {

constexpr double roundingOfLines = 1e-12;  // of the line's length
constexpr double nearness = 1e-2;          // the same: points of a curve are not on the polygon

struct Nearest {
  double place = 0;
  double distance = std::numeric_limits<double>::infinity();
};

Nearest nearest(const std::vector<Point>& points, const std::vector<double>& places, const Point& x) {
  Nearest found;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const Point along = points[i + 1] - points[i];
    const double part = std::clamp((x - points[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (x - points[i] - part * along).norm();
    if (distance < found.distance) found = {places[i] + part * (places[i + 1] - places[i]), distance};
  }
  return found;
}

}  // namespace

LinePart::LinePart(const BoundaryLine& line) : points_(line.points), places_{0} {
  for (size_t i = 0; i + 1 < points_.size(); ++i)
    places_.push_back(places_.back() + (points_[i + 1] - points_[i]).norm());
  end_ = places_.back();
}

LinePart::LinePart(const BoundaryLine& line, const Point& from, const Point& to, double margin)
    : LinePart(line) {
  if (line.closed) throw InputError("a part of a closed line, expected all of it or a line with two ends");
  const Nearest first = nearest(points_, places_, from);
  const Nearest last = nearest(points_, places_, to);
  const double length = places_.back();
  if (first.distance > nearness * length) throw InputError("from is not on the line, expected a point of it");
  if (last.distance > nearness * length) throw InputError("to is not on the line, expected a point of it");
  std::tie(begin_, end_) = std::minmax(first.place, last.place);
  if (!(end_ - begin_ > roundingOfLines * length))
    throw InputError("from and to are one point of the line, expected two");
  margin_ = margin > roundingOfLines * length ? margin : 0;
}

double LinePart::along(const Point& x) const {
  return nearest(points_, places_, x).place;
}

double LinePart::weight(double s) const {
  const double off = std::max({begin_ - s, s - end_, 0.0});
  if (margin_ > 0) return std::max(0.0, 1 - off / margin_);
  return off > roundingOfLines * places_.back() ? 0 : 1;
}

std::vector<double> LinePart::stretch(double first, double last) const {
  std::vector<double> places{first};
  for (const double kink : {begin_ - margin_, begin_, end_, end_ + margin_})
    if (kink > first && kink < last && kink > places.back()) places.push_back(kink);
  places.push_back(last);
  return places;
}

std::array<double, 2> LinePart::moments(double first, double last) const {
  if (first == last) return {weight(first) / 2, weight(first) / 2};
  const bool turned = first > last;
  const std::vector<double> places = stretch(std::min(first, last), std::max(first, last));
  std::array<double, 2> sums{};
  for (size_t i = 0; i + 1 < places.size(); ++i)
    for (const double gauss : {-1.0, 1.0}) {  // where the weight is linear
      const double width = places[i + 1] - places[i];
      const double s = places[i] + width * (1 + gauss / std::numbers::sqrt3) / 2;
      const double x = (s - places.front()) / (places.back() - places.front());
      const double part = weight(s) * width / 2 / (places.back() - places.front());
      sums[0] += (1 - x) * part;
      sums[1] += x * part;
    }
  if (turned) std::swap(sums[0], sums[1]);
  return sums;
}

double LinePart::size(bool axisymmetric) const {
  double sum = 0;
  for (size_t i = 0; i + 1 < points_.size(); ++i) {
    const auto [first, last] = moments(places_[i], places_[i + 1]);
    const double turn = 2 * std::numbers::pi;
    sum += (places_[i + 1] - places_[i]) *
           (axisymmetric ? turn * (first * points_[i].x() + last * points_[i + 1].x()) : first + last);
  }
  return sum;
}

double LinePart::deviation(double first, double last, int side) const {
  double most = 0;
  for (const double s : stretch(std::min(first, last), std::max(first, last))) {
    const double x = (s - first) / (last - first);
    most = std::max(most, side * (weight(s) - (1 - x) * weight(first) - x * weight(last)));
  }
  return most;
}

// Constants, or where the weight is continuous what it is at the ends and as much more as it bulges.
std::array<double, 2> LinePart::above(double first, double last) const {
  const auto [low, high] = std::minmax(first, last);
  const double slack = roundingOfLines * places_.back();
  const bool overlaps = std::min(high, end_) - std::max(low, begin_) > slack;
  const double largest = overlaps ? 1 : margin_ > 0 ? std::max(weight(first), weight(last)) : 0;
  if (!(margin_ > 0) || first == last) return {largest, largest};
  const double more = deviation(first, last, 1);
  const std::array<double, 2> linear{weight(first) + more, weight(last) + more};
  return linear[0] + linear[1] < 2 * largest ? linear : std::array{largest, largest};
}

std::array<double, 2> LinePart::below(double first, double last) const {
  const double least = std::min(weight(first), weight(last));
  if (!(margin_ > 0) || first == last) return {least, least};
  const double less = deviation(first, last, -1);
  const std::array<double, 2> linear{weight(first) - less, weight(last) - less};
  return linear[0] + linear[1] > 2 * least ? linear : std::array{least, least};
}

}  // namespace mortier
