#include "scene/known_datum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "scene/formulas.h"

namespace mortier {
namespace {

using Op = Formulas::Op;
using Operation = Formulas::Operation;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Interval anything{-infinity, infinity};

Interval of(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? anything : Interval{std::min(a, b), std::max(a, b)};
}
bool holds(const Interval& range, double value) {
  return range.least <= value && value <= range.largest;
}
Interval both(const Interval& a, const Interval& b) {
  return {std::min(a.least, b.least), std::max(a.largest, b.largest)};
}
Interval truth(bool always, bool never) {
  return {always ? 1.0 : 0.0, never ? 0.0 : 1.0};
}

template <class Function>
Interval atCorners(const Interval& a, const Interval& b, Function function) {
  return both(of(function(a.least, b.least), function(a.least, b.largest)),
              of(function(a.largest, b.least), function(a.largest, b.largest)));
}

/// An even function that ascends from 0.
template <class Function>
Interval even(const Interval& a, Function function) {
  Interval range = of(function(a.least), function(a.largest));
  if (holds(a, 0)) range.least = function(0.0);
  return range;
}

/// A function that ascends on [least, largest] and is defined there alone.
template <class Function>
Interval ascending(const Interval& a, Function function, double least = -infinity,
                   double largest = infinity) {
  return of(function(std::clamp(a.least, least, largest)), function(std::clamp(a.largest, least, largest)));
}

/// sin(x + shift)
Interval sine(const Interval& a, double shift) {
  constexpr double pi = std::numbers::pi;
  if (!(a.largest - a.least < 2 * pi)) return {-1, 1};
  Interval range = of(std::sin(a.least + shift), std::sin(a.largest + shift));
  const auto passes = [&](double angle) {
    return std::floor((a.largest + shift - angle) / (2 * pi)) >
           std::floor((a.least + shift - angle) / (2 * pi));
  };
  if (passes(pi / 2)) range.largest = 1;
  if (passes(-pi / 2)) range.least = -1;
  return range;
}

Interval power(const Operation& operation, const Interval& a, const Interval& b) {
  const auto pow = [](double x, double y) { return std::pow(x, y); };
  if (a.least >= 0 && !(a.least == 0 && b.least < 0)) return atCorners(a, b, pow);
  const double n = operation.number;
  if (n <= 0 || n != std::rint(n)) return anything;
  if (std::fmod(n, 2) == 0) return even(a, [&](double x) { return std::pow(x, n); });
  return of(std::pow(a.least, n), std::pow(a.largest, n));
}

Interval apply(const Operation& operation, const Interval& a, const Interval& b, const Interval& c) {
  constexpr double pi = std::numbers::pi;
  const bool zero = a.least == 0 && a.largest == 0;
  const bool notZero = !holds(a, 0);
  const bool otherZero = b.least == 0 && b.largest == 0;
  const bool otherNotZero = !holds(b, 0);
  switch (operation.op) {
    case Op::number:
      return of(operation.number, operation.number);
    case Op::variable:
      return a;
    case Op::negate:
      return {-a.largest, -a.least};
    case Op::add:
      return of(a.least + b.least, a.largest + b.largest);
    case Op::subtract:
      if (operation.a == operation.b) return {0, 0};
      return of(a.least - b.largest, a.largest - b.least);
    case Op::multiply:
      if (zero || otherZero) return {0, 0};
      if (operation.a == operation.b) return even(a, [](double x) { return x * x; });
      return atCorners(a, b, [](double x, double y) { return x * y; });
    case Op::divide:
      return otherNotZero ? atCorners(a, b, [](double x, double y) { return x / y; }) : anything;
    case Op::power:
      return power(operation, a, b);
    case Op::less:
      return truth(a.largest < b.least, a.least >= b.largest);
    case Op::lessOrEqual:
      return truth(a.largest <= b.least, a.least > b.largest);
    case Op::equal:
    case Op::notEqual: {
      const bool same = a.least == a.largest && b.least == b.largest && a.least == b.least;
      const bool other = a.largest < b.least || a.least > b.largest;
      return operation.op == Op::equal ? truth(same, other) : truth(other, same);
    }
    case Op::both:
      return truth(notZero && otherNotZero, zero || otherZero);
    case Op::either:
      return truth(notZero || otherNotZero, zero && otherZero);
    case Op::choose:
      return notZero ? b : zero ? c : both(b, c);
    case Op::min:
      return {std::min(a.least, b.least), std::min(a.largest, b.largest)};
    case Op::max:
      return {std::max(a.least, b.least), std::max(a.largest, b.largest)};
    case Op::atan2:
      return {-pi, pi};
    case Op::sin:
      return sine(a, 0);
    case Op::cos:
      return sine(a, pi / 2);
    case Op::tan:
      if (std::floor(a.least / pi + 0.5) != std::floor(a.largest / pi + 0.5)) return anything;
      return of(std::tan(a.least), std::tan(a.largest));
    case Op::asin:
      return ascending(
          a, [](double x) { return std::asin(x); }, -1, 1);
    case Op::acos:
      return ascending(
          a, [](double x) { return std::acos(x); }, -1, 1);
    case Op::atan:
      return ascending(a, [](double x) { return std::atan(x); });
    case Op::sinh:
      return ascending(a, [](double x) { return std::sinh(x); });
    case Op::cosh:
      return even(a, [](double x) { return std::cosh(x); });
    case Op::tanh:
      return ascending(a, [](double x) { return std::tanh(x); });
    case Op::asinh:
      return ascending(a, [](double x) { return std::asinh(x); });
    case Op::acosh:
      return ascending(
          a, [](double x) { return std::acosh(x); }, 1);
    case Op::atanh:
      return ascending(
          a, [](double x) { return std::atanh(x); }, -1, 1);
    case Op::exp:
      return ascending(a, [](double x) { return std::exp(x); });
    case Op::log:
      return ascending(
          a, [](double x) { return std::log(x); }, 0);
    case Op::log10:
      return ascending(
          a, [](double x) { return std::log10(x); }, 0);
    case Op::log2:
      return ascending(
          a, [](double x) { return std::log2(x); }, 0);
    case Op::sqrt:
      return ascending(
          a, [](double x) { return std::sqrt(x); }, 0);
    case Op::abs:
      return even(a, [](double x) { return std::abs(x); });
    case Op::sign:
      return ascending(a, [](double x) { return double((x > 0) - (x < 0)); });
    case Op::rint:
      return ascending(a, [](double x) { return std::floor(x + 0.5); });
  }
  return anything;
}

/// The degree in x and y of a polynomial whose coefficients depend on t.
int degreeOf(const Operation& operation, int a, int b, int c) {
  constexpr int any = Datum::anyDegree;
  const int most = std::max({a, b, c});
  switch (operation.op) {
    case Op::variable:
      return operation.a < 2 ? 1 : 0;
    case Op::negate:
    case Op::add:
    case Op::subtract:
      return most;
    case Op::multiply:
      return std::min(any, a + b);
    case Op::divide:
      return b == 0 ? a : any;
    case Op::choose:
      return a == 0 ? most : any;
    default:
      return most == 0 ? 0 : any;
  }
}

}  // namespace

void describe(const std::string& text, Datum& datum) {
  Formulas formulas({"x", "y", "t"}, {});
  try {
    formulas.add({text, ""});
  } catch (const InputError&) {
    return;  // words that formulas do not have
  }
  const std::vector<Operation>& operations = formulas.operations();
  std::vector<int> degrees;
  for (const Operation& each : operations) {
    const bool variable = each.op == Op::variable;
    const auto of = [&](int k) { return k < 0 || variable ? 0 : degrees[k]; };
    degrees.push_back(degreeOf(each, of(each.a), of(each.b), of(each.c)));
  }
  datum.degree = degrees[formulas.result(0)];
  datum.enclosure = [operations, result = formulas.result(0),
                     work = std::vector<Interval>(operations.size())](const Box& box) mutable {
    const std::array<Interval, 3> variables{box.x, box.y, box.t};
    for (size_t i = 0; i < operations.size(); ++i) {
      const Operation& each = operations[i];
      const auto of = [&](int k) { return work[std::max(k, 0)]; };
      work[i] = apply(each, each.op == Op::variable ? variables[each.a] : of(each.a), of(each.b), of(each.c));
    }
    return work[result];
  };
}

}  // namespace mortier
