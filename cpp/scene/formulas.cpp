#include "scene/formulas.h"

#include <cmath>
#include <numbers>

namespace mortier {
namespace {

using Op = Formulas::Op;

double valueOf(double x) {
  return x;
}
template <class Slopes>
double valueOf(const Eigen::AutoDiffScalar<Slopes>& x) {
  return x.value();
}

/// The chain rule for functions that Eigen's numbers have not: f(x) and f'(x) given.
template <class Number>
Number chained(const Number& x, double value, [[maybe_unused]] double slope) {
  if constexpr (std::is_same_v<Number, double>)
    return value;
  else
    return Number(value, x.derivatives() * slope);
}

template <class Number>
Number powerOf(const Number& x, const Number& y) {
  const double value = std::pow(valueOf(x), valueOf(y));
  if constexpr (std::is_same_v<Number, double>)
    return value;
  else
    return Number(value, x.derivatives() * (y.value() * std::pow(x.value(), y.value() - 1)) +
                             y.derivatives() * (std::log(x.value()) * value));
}

/// One operation at some points; a, b, c: the numbers that it takes.
template <class Number>
void apply(const Formulas::Operation& operation, const Number* a, const Number* b, const Number* c,
           Number* out, int points) {
  using std::abs, std::acos, std::asin, std::atan2, std::cos, std::cosh, std::exp, std::log, std::pow,
      std::sin, std::sinh, std::sqrt, std::tan, std::tanh;
  const auto ofOne = [&](auto function) {
    for (int i = 0; i < points; ++i) out[i] = function(a[i]);
  };
  const auto ofTwo = [&](auto function) {
    for (int i = 0; i < points; ++i) out[i] = function(a[i], b[i]);
  };
  const auto ofValues = [&](auto function) {
    for (int i = 0; i < points; ++i) out[i] = Number(function(valueOf(a[i]), valueOf(b[i])) ? 1.0 : 0.0);
  };
  const auto byChainRule = [&](auto function, auto slope) {
    for (int i = 0; i < points; ++i) out[i] = chained(a[i], function(valueOf(a[i])), slope(valueOf(a[i])));
  };
  switch (operation.op) {
    case Op::number:
      return std::fill_n(out, points, Number(operation.number)), void();
    case Op::variable:
      return std::copy_n(a, points, out), void();
    case Op::negate:
      return ofOne([](const Number& x) -> Number { return -x; });
    case Op::add:
      return ofTwo([](const Number& x, const Number& y) -> Number { return x + y; });
    case Op::subtract:
      return ofTwo([](const Number& x, const Number& y) -> Number { return x - y; });
    case Op::multiply:
      return ofTwo([](const Number& x, const Number& y) -> Number { return x * y; });
    case Op::divide:
      return ofTwo([](const Number& x, const Number& y) -> Number { return x / y; });
    case Op::power:
      if (operation.number == 0) return ofTwo([](const Number& x, const Number& y) { return powerOf(x, y); });
      return ofOne([n = operation.number](const Number& x) -> Number { return pow(x, n); });
    case Op::less:
      return ofValues([](double x, double y) { return x < y; });
    case Op::lessOrEqual:
      return ofValues([](double x, double y) { return x <= y; });
    case Op::equal:
      return ofValues([](double x, double y) { return x == y; });
    case Op::notEqual:
      return ofValues([](double x, double y) { return x != y; });
    case Op::both:
      return ofValues([](double x, double y) { return x != 0 && y != 0; });
    case Op::either:
      return ofValues([](double x, double y) { return x != 0 || y != 0; });
    case Op::choose:
      for (int i = 0; i < points; ++i) out[i] = valueOf(a[i]) != 0 ? b[i] : c[i];
      return;
    case Op::min:
      return ofTwo([](const Number& x, const Number& y) { return valueOf(x) < valueOf(y) ? x : y; });
    case Op::max:
      return ofTwo([](const Number& x, const Number& y) { return valueOf(y) < valueOf(x) ? x : y; });
    case Op::atan2:
      return ofTwo([](const Number& y, const Number& x) -> Number { return atan2(y, x); });
    case Op::sin:
      return ofOne([](const Number& x) -> Number { return sin(x); });
    case Op::cos:
      return ofOne([](const Number& x) -> Number { return cos(x); });
    case Op::tan:
      return ofOne([](const Number& x) -> Number { return tan(x); });
    case Op::asin:
      return ofOne([](const Number& x) -> Number { return asin(x); });
    case Op::acos:
      return ofOne([](const Number& x) -> Number { return acos(x); });
    case Op::atan:
      return byChainRule([](double x) { return std::atan(x); }, [](double x) { return 1 / (1 + x * x); });
    case Op::sinh:
      return ofOne([](const Number& x) -> Number { return sinh(x); });
    case Op::cosh:
      return ofOne([](const Number& x) -> Number { return cosh(x); });
    case Op::tanh:
      return ofOne([](const Number& x) -> Number { return tanh(x); });
    case Op::asinh:
      return byChainRule([](double x) { return std::asinh(x); },
                         [](double x) { return 1 / std::sqrt(1 + x * x); });
    case Op::acosh:
      return byChainRule([](double x) { return std::acosh(x); },
                         [](double x) { return 1 / std::sqrt(x * x - 1); });
    case Op::atanh:
      return byChainRule([](double x) { return std::atanh(x); }, [](double x) { return 1 / (1 - x * x); });
    case Op::exp:
      return ofOne([](const Number& x) -> Number { return exp(x); });
    case Op::log:
      return ofOne([](const Number& x) -> Number { return log(x); });
    case Op::log10:
      return ofOne([](const Number& x) -> Number { return log(x) / std::numbers::ln10; });
    case Op::log2:
      return ofOne([](const Number& x) -> Number { return log(x) / std::numbers::ln2; });
    case Op::sqrt:
      return ofOne([](const Number& x) -> Number { return sqrt(x); });
    case Op::abs:
      return ofOne([](const Number& x) -> Number { return abs(x); });
    case Op::sign:
      return ofOne([](const Number& x) { return Number((valueOf(x) > 0) - (valueOf(x) < 0)); });
    case Op::rint:
      return ofOne([](const Number& x) { return Number(std::floor(valueOf(x) + 0.5)); });
  }
}

}  // namespace

template <class Number>
void Formulas::evaluate(const Number* values, Number* results, int points, std::vector<Number>& work) const {
  work.resize(operations_.size() * pointsAtOnce, Number(0));
  for (size_t i = 0; i < operations_.size(); ++i) {
    const Operation& operation = operations_[i];
    const auto done = [&](int k) { return work.data() + pointsAtOnce * std::max(k, 0); };
    const Number* a = operation.op == Op::variable ? values + pointsAtOnce * operation.a : done(operation.a);
    apply(operation, a, done(operation.b), done(operation.c), done(static_cast<int>(i)), points);
  }
  for (size_t i = 0; i < results_.size(); ++i)
    std::copy_n(&work[pointsAtOnce * static_cast<size_t>(results_[i])], points, results + pointsAtOnce * i);
}

template void Formulas::evaluate(const double*, double*, int, std::vector<double>&) const;
template void Formulas::evaluate(const Differentiated<4>*, Differentiated<4>*, int,
                                 std::vector<Differentiated<4>>&) const;
template void Formulas::evaluate(const Differentiated<6>*, Differentiated<6>*, int,
                                 std::vector<Differentiated<6>>&) const;
template void Formulas::evaluate(const Differentiated<8>*, Differentiated<8>*, int,
                                 std::vector<Differentiated<8>>&) const;
template void Formulas::evaluate(const Differentiated<12>*, Differentiated<12>*, int,
                                 std::vector<Differentiated<12>>&) const;

int Formulas::append(const Operation& operation) {
  Operation own = operation;
  const auto isNumber = [&](int i) { return i < 0 || operations_[i].op == Op::number; };
  if (own.op != Op::number && own.op != Op::variable && isNumber(own.a) && isNumber(own.b) &&
      isNumber(own.c)) {
    const auto numberOf = [&](int i) { return i < 0 ? 0 : operations_[i].number; };
    const double a = numberOf(own.a);
    const double b = numberOf(own.b);
    const double c = numberOf(own.c);
    double result = 0;
    apply(own, &a, &b, &c, &result, 1);
    own = {Op::number, -1, -1, -1, result};
  }
  if (own.op == Op::power && isNumber(own.b)) {
    constexpr double most = 16;
    own.number = operations_[own.b].number;
    if (own.number == std::rint(own.number) && std::abs(own.number) <= most)
      return appendWholePower(own.a, static_cast<int>(own.number));
  }
  const bool ordinary = !std::isnan(own.number);  // NaN is never found again
  const auto key = std::make_tuple(own.op, own.a, own.b, own.c, ordinary ? own.number : 0);
  if (ordinary)
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
  operations_.push_back(own);
  const int number = static_cast<int>(operations_.size()) - 1;
  if (ordinary) known_[key] = number;
  return number;
}

int Formulas::appendWholePower(int x, int n) {
  int result = -1;
  int square = x;
  for (int left = std::abs(n); left > 0; left /= 2) {
    if (left % 2 == 1) result = result < 0 ? square : append({Op::multiply, result, square});
    if (left > 1) square = append({Op::multiply, square, square});
  }
  if (n > 0) return result;
  const int one = append({Op::number, -1, -1, -1, 1});
  return n < 0 ? append({Op::divide, one, result}) : one;
}

bool Formulas::dependsOn(int variable) const {
  std::vector<bool> needed(operations_.size());
  for (const int result : results_) needed[result] = true;
  for (size_t i = operations_.size(); i-- > 0;) {
    const Operation& operation = operations_[i];
    if (!needed[i]) continue;
    if (operation.op == Op::variable) {
      if (operation.a == variable) return true;
      continue;
    }
    for (const int each : {operation.a, operation.b, operation.c})
      if (each >= 0) needed[each] = true;
  }
  return false;
}

}  // namespace mortier
