#include "scene/expression.h"

#include <algorithm>
#include <numbers>

#include "base/error.h"
#include "scene/formulas.h"

namespace mortier {
namespace {

using Op = Formulas::Op;
using Operation = Formulas::Operation;

Interval range(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? Interval::anything() : Interval{std::min(a, b), std::max(a, b)};
}
Interval widened(const Interval& a) {
  return a + Interval{-4 * std::numeric_limits<double>::epsilon() * a.magnitude(),
                      4 * std::numeric_limits<double>::epsilon() * a.magnitude()};
}
/// Whether it does not change along the line.
bool steady(const Taylor& u) {
  return std::all_of(u.c.begin() + 1, u.c.end(), [](const Interval& each) { return each.isZero(); });
}
Taylor truth(bool always, bool never, const Taylor& a, const Taylor& b) {
  const Interval value{always ? 1.0 : 0.0, never ? 0.0 : 1.0};
  return always || never || (steady(a) && steady(b)) ? Taylor::constant(value) : Taylor::within(value);
}
/// One of two.
Taylor either(const Taylor& condition, const Taylor& u, const Taylor& v) {
  if (!steady(condition)) return Taylor::within(hull(u.c[0], v.c[0]));
  Taylor result;
  for (int k = 0; k <= Taylor::order; ++k) result.c[k] = hull(u.c[k], v.c[k]);
  return result;
}
Taylor one() {
  return Taylor::constant({1, 1});
}

Taylor absolute(const Taylor& u) {
  if (u.c[0].least >= 0) return u;
  if (u.c[0].largest <= 0) return -u;
  if (steady(u)) return Taylor::constant({0, u.c[0].magnitude()});
  Taylor result = Taylor::within({0, u.c[0].magnitude()});
  result.c[1] = hull(u.c[1], -u.c[1]);
  return result;
}
Taylor least(const Taylor& u, const Taylor& v) {
  if (u.c[0].largest <= v.c[0].least) return u;
  if (v.c[0].largest <= u.c[0].least) return v;
  const Interval values{std::min(u.c[0].least, v.c[0].least), std::min(u.c[0].largest, v.c[0].largest)};
  if (steady(u) && steady(v)) return Taylor::constant(values);
  Taylor result = Taylor::within(values);
  result.c[1] = hull(u.c[1], v.c[1]);
  return result;
}
/// A function that has steps: constant where its values do not change.
Taylor stepwise(const Taylor& u, double first, double last) {
  return first == last || steady(u) ? Taylor::constant(range(first, last))
                                    : Taylor::within(range(first, last));
}
Taylor hyperbolic(const Taylor& u, double sign) {
  return (exp(u) + Taylor::constant({sign, sign}) * exp(-u)) * Taylor::constant({0.5, 0.5});
}

template <class Function>
Taylor inverse(const Taylor& u, const Taylor& q, double lowest, double highest, Function function) {
  const Interval values = widened(range(function(std::clamp(u.c[0].least, lowest, highest)),
                                        function(std::clamp(u.c[0].largest, lowest, highest))));
  return integrated(u, q, values);
}

Taylor power(const Operation& operation, const Taylor& u, const Taylor& v) {
  if (operation.number != 0) return pow(u, operation.number);
  if (u.c[0].least > 0) return exp(v * log(u));
  if (!(u.c[0].least == 0 && v.c[0].least > 0)) return Taylor::within(Interval::anything());
  const auto most = [&](double x) {
    return std::max(std::pow(x, v.c[0].least), std::pow(x, v.c[0].largest));
  };
  return Taylor::within(widened({0, most(u.c[0].largest)}));
}

Taylor apply(const Operation& operation, const Taylor& a, const Taylor& b, const Taylor& c) {
  const Interval& u = a.c[0];
  const Interval& v = b.c[0];
  const bool yes = !u.holds(0);
  const bool otherYes = !v.holds(0);
  switch (operation.op) {
    case Op::number:
      return Taylor::constant({operation.number, operation.number});
    case Op::variable:
      return a;
    case Op::negate:
      return -a;
    case Op::add:
      return a + b;
    case Op::subtract:
      return operation.a == operation.b ? Taylor() : a - b;
    case Op::multiply: {
      Taylor result = a * b;
      if (operation.a == operation.b) result.c[0] = pow(a, 2).c[0];
      return result;
    }
    case Op::divide:
      return a / b;
    case Op::power:
      return power(operation, a, b);
    case Op::less:
      return truth(u.largest < v.least, u.least >= v.largest, a, b);
    case Op::lessOrEqual:
      return truth(u.largest <= v.least, u.least > v.largest, a, b);
    case Op::equal:
    case Op::notEqual: {
      const bool same = u.least == u.largest && v.least == v.largest && u.least == v.least;
      const bool other = u.largest < v.least || u.least > v.largest;
      return operation.op == Op::equal ? truth(same, other, a, b) : truth(other, same, a, b);
    }
    case Op::both:
      return truth(yes && otherYes, u.isZero() || v.isZero(), a, b);
    case Op::either:
      return truth(yes || otherYes, u.isZero() && v.isZero(), a, b);
    case Op::choose:
      return yes ? b : u.isZero() ? c : either(a, b, c);
    case Op::min:
      return least(a, b);
    case Op::max:
      return -least(-a, -b);
    case Op::atan2:
      if (v.least > 0)
        return inverse(a / b, one() + a / b * (a / b), -infinity, infinity,
                       [](double x) { return std::atan(x); });
      return Taylor::within({-std::numbers::pi, std::numbers::pi});
    case Op::sin:
      return sinAndCos(a)[0];
    case Op::cos:
      return sinAndCos(a)[1];
    case Op::tan: {
      const auto [s, k] = sinAndCos(a);
      Taylor result = s / k;
      if (!k.c[0].holds(0)) result.c[0] = widened(range(std::tan(u.least), std::tan(u.largest)));
      return result;
    }
    case Op::asin:
      return inverse(a, pow(one() - a * a, 0.5), -1, 1, [](double x) { return std::asin(x); });
    case Op::acos:
      return inverse(a, -pow(one() - a * a, 0.5), -1, 1, [](double x) { return std::acos(x); });
    case Op::atan:
      return inverse(a, one() + a * a, -infinity, infinity, [](double x) { return std::atan(x); });
    case Op::sinh:
      return hyperbolic(a, -1);
    case Op::cosh: {
      Taylor result = hyperbolic(a, 1);
      const Interval ends = range(std::cosh(u.least), std::cosh(u.largest));
      result.c[0] = widened({u.holds(0) ? 1 : ends.least, ends.largest});
      return result;
    }
    case Op::tanh: {
      Taylor result = one() - Taylor::constant({2, 2}) / (one() + exp(a + a));
      result.c[0] = widened(range(std::tanh(u.least), std::tanh(u.largest)));
      return result;
    }
    case Op::asinh:
      return inverse(a, pow(one() + a * a, 0.5), -infinity, infinity, [](double x) { return std::asinh(x); });
    case Op::acosh:
      return inverse(a, pow(a * a - one(), 0.5), 1, infinity, [](double x) { return std::acosh(x); });
    case Op::atanh:
      return inverse(a, one() - a * a, -1, 1, [](double x) { return std::atanh(x); });
    case Op::exp:
      return exp(a);
    case Op::log:
      return log(a);
    case Op::log10:
      return log(a) / Taylor::constant(widened({std::numbers::ln10, std::numbers::ln10}));
    case Op::log2:
      return log(a) / Taylor::constant(widened({std::numbers::ln2, std::numbers::ln2}));
    case Op::sqrt:
      return pow(a, 0.5);
    case Op::abs:
      return absolute(a);
    case Op::sign: {
      const auto sign = [](double x) { return static_cast<double>((x > 0) - (x < 0)); };
      return stepwise(a, sign(u.least), sign(u.largest));
    }
    case Op::rint:
      return stepwise(a, std::floor(u.least + 0.5), std::floor(u.largest + 0.5));
  }
  return Taylor::within(Interval::anything());
}

/// The degree of a polynomial in the variables of these degrees.
int degreeOf(const Operation& operation, const std::array<int, 4>& variables, int a, int b, int c) {
  constexpr int any = Datum::anyDegree;
  const int most = std::max({a, b, c});
  switch (operation.op) {
    case Op::variable:
      return variables[operation.a];
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

void describe(const Formulas& formula, bool inSpace, Datum& datum) {
  const std::vector<Operation>& operations = formula.operations();
  const auto degreeIn = [&](const std::array<int, 4>& variables) {
    std::vector<int> degrees;
    for (const Operation& each : operations) {
      const bool variable = each.op == Op::variable;
      const auto of = [&](int k) { return k < 0 || variable ? 0 : degrees[k]; };
      degrees.push_back(degreeOf(each, variables, of(each.a), of(each.b), of(each.c)));
    }
    return degrees[formula.result(0)];
  };
  using Which = std::array<int, 4>;
  datum.degree = degreeIn(inSpace ? Which{1, 1, 1, 0} : Which{1, 1, 0, 0});
  datum.degreeInTime = degreeIn(inSpace ? Which{0, 0, 0, 1} : Which{0, 0, 1, 0});
  const auto enclosed =
      [operations, inSpace, result = formula.result(0), work = std::vector<Taylor>(operations.size())](
          const Taylor& x, const Taylor& y, const Taylor& t, const Taylor& z) mutable -> const Taylor& {
    const std::array<const Taylor*, 4> variables{&x, &y, inSpace ? &z : &t, &t};
    for (size_t i = 0; i < operations.size(); ++i) {
      const Operation& each = operations[i];
      const auto of = [&](int k) -> const Taylor& { return work[std::max(k, 0)]; };
      work[i] =
          apply(each, each.op == Op::variable ? *variables[each.a] : of(each.a), of(each.b), of(each.c));
    }
    return work[result];
  };
  datum.enclosure = [values = enclosed](const Box& box) mutable {
    return values(Taylor::constant(box.x), Taylor::constant(box.y), Taylor::constant(box.t),
                  Taylor::constant(box.z))
        .c[0];
  };
  datum.along = [enclosed] {
    return [values = enclosed](const Taylor& x, const Taylor& y, const Taylor& t) mutable {
      return values(x, y, t, Taylor());
    };
  };
}

bool proportionalToTime(const Formulas& formula) {
  enum Kind { constant, proportional, other };
  const int time = formula.variables() - 1;
  std::vector<Kind> kinds;
  for (const Operation& each : formula.operations()) {
    const auto of = [&](int k) { return k < 0 || each.op == Op::variable ? constant : kinds[k]; };
    const Kind a = of(each.a);
    const Kind b = of(each.b);
    const Kind c = of(each.c);
    Kind kind = a == constant && b == constant && c == constant ? constant : other;
    switch (each.op) {
      case Op::variable:
        kind = each.a == time ? proportional : constant;
        break;
      case Op::negate:
        kind = a;
        break;
      case Op::add:
      case Op::subtract:
        if (a == b) kind = a;
        break;
      case Op::multiply:
        if (a == constant || b == constant) kind = std::max(a, b);
        break;
      case Op::divide:
        if (b == constant) kind = a;
        break;
      case Op::choose:
        if (a == constant && b == c) kind = b;
        break;
      default:
        break;
    }
    kinds.push_back(kind);
  }
  return kinds[formula.result(0)] == proportional;
}

std::vector<double> kinksInTime(const Formulas& formula) {
  std::vector<double> result;
  const auto isTime = [&](const Operation& each) {
    return each.op == Op::variable && each.a == formula.variables() - 1;
  };
  for (const Operation& each : formula.operations()) {
    const bool compares =
        each.op == Op::less || each.op == Op::lessOrEqual || each.op == Op::min || each.op == Op::max;
    if (!compares) continue;
    const Operation& a = formula.operations()[each.a];
    const Operation& b = formula.operations()[each.b];
    if (isTime(a) && b.op == Op::number) result.push_back(b.number);
    if (isTime(b) && a.op == Op::number) result.push_back(a.number);
  }
  return result;
}

}  // namespace mortier
