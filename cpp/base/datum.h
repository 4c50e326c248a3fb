// A datum, a function of space and time, with what is known of it everywhere, not at points alone: so it is
// seen where it cannot vary within an element, and where a narrow peak of it may be.
#pragma once

#include <concepts>
#include <functional>
#include <utility>

#include "base/taylor.h"
#include "base/types.h"

namespace mortier {

/// A part of space and time.
struct Box {
  Interval x, y, t;
  Interval z{0, 0};  ///< in space
};

/// f(x [m], t [s]); of the plane f(x [m], y [m], t [s]), the same at every z.
struct Datum {
  /// With x, y and t along a piece of a line.
  using Along = std::function<Taylor(const Taylor& x, const Taylor& y, const Taylor& t)>;
  static constexpr int anyDegree = 1000;

  Datum() = default;
  // NOLINTBEGIN: functions of which nothing is known are data
  template <std::invocable<const SpacePoint&, double> Value>
  Datum(Value f) : value(std::move(f)) {}
  template <std::invocable<double, double, double> Value>
  Datum(Value f) : value([f = std::move(f)](const SpacePoint& x, double t) { return f(x.x(), x.y(), t); }) {}
  // NOLINTEND

  double operator()(const SpacePoint& x, double t) const { return value(x, t); }
  double operator()(double x, double y, double t) const { return value({x, y, 0}, t); }
  explicit operator bool() const { return static_cast<bool>(value); }

  std::function<double(const SpacePoint& x, double t)> value;
  int degree = anyDegree;        ///< of the polynomial in x, y and z that it is at every time
  bool inTime = true;            ///< whether it may change in time
  int degreeInTime = anyDegree;  ///< of the polynomial in t that it is at every place
  /// Holds all values in a box; empty where nothing is known. Copies are independent.
  std::function<Interval(const Box&)> enclosure = {};
  /// Enclosures along lines; empty where nothing is known. Each call reads the formula anew.
  std::function<Along()> along = {};

  [[nodiscard]] bool constant() const { return degree == 0 && !inTime; }
};

}  // namespace mortier
