#include "scene/formulas.h"

#include <cmath>
#include <numbers>

namespace mortier {
namespace {

using Op = Formulas::Op;

/// A function of one number and its derivative.
template <int n, class Function, class Derivative>
Dual<n> applied(const Dual<n>& x, Function function, Derivative derivative) {
  if constexpr (n == 0) return function(x.value);
  return along(function(x.value), x, derivative(x.value));
}

/// Functions of one number by their C++ names, and their derivatives.
template <int n>
Dual<n> ofOne(Op op, const Dual<n>& x) {
  const auto is = [&](double (*function)(double), double (*derivative)(double)) {
    return applied(x, function, derivative);
  };
  switch (op) {
    case Op::sin:
      return is([](double a) { return std::sin(a); }, [](double a) { return std::cos(a); });
    case Op::cos:
      return is([](double a) { return std::cos(a); }, [](double a) { return -std::sin(a); });
    case Op::tan:
      return is([](double a) { return std::tan(a); }, [](double a) { return 1 + std::tan(a) * std::tan(a); });
    case Op::asin:
      return is([](double a) { return std::asin(a); }, [](double a) { return 1 / std::sqrt(1 - a * a); });
    case Op::acos:
      return is([](double a) { return std::acos(a); }, [](double a) { return -1 / std::sqrt(1 - a * a); });
    case Op::atan:
      return is([](double a) { return std::atan(a); }, [](double a) { return 1 / (1 + a * a); });
    case Op::sinh:
      return is([](double a) { return std::sinh(a); }, [](double a) { return std::cosh(a); });
    case Op::cosh:
      return is([](double a) { return std::cosh(a); }, [](double a) { return std::sinh(a); });
    case Op::tanh:
      return is([](double a) { return std::tanh(a); },
                [](double a) { return 1 / (std::cosh(a) * std::cosh(a)); });
    case Op::asinh:
      return is([](double a) { return std::asinh(a); }, [](double a) { return 1 / std::sqrt(1 + a * a); });
    case Op::acosh:
      return is([](double a) { return std::acosh(a); }, [](double a) { return 1 / std::sqrt(a * a - 1); });
    case Op::atanh:
      return is([](double a) { return std::atanh(a); }, [](double a) { return 1 / (1 - a * a); });
    case Op::log10:
      return log(x) / std::numbers::ln10;
    case Op::log2:
      return log(x) / std::numbers::ln2;
    case Op::log:
      return log(x);
    case Op::exp:
      return exp(x);
    case Op::sqrt:
      return sqrt(x);
    case Op::abs:
      return abs(x);
    case Op::sign:
      return x.value > 0 ? 1.0 : x.value < 0 ? -1.0 : 0.0;
    default:
      return is([](double a) { return std::floor(a + 0.5); }, [](double) { return 0.0; });
  }
}

template <int n>
Dual<n> arcOf(const Dual<n>& y, const Dual<n>& x) {
  const double square = x.value * x.value + y.value * y.value;
  return along(std::atan2(y.value, x.value), y, x.value / square, x, -y.value / square);
}

}  // namespace

template <int n>
Dual<n> Formulas::apply(const Operation& operation, const Dual<n>* done) {
  const Dual<n>& a = done[std::max(operation.a, 0)];
  const Dual<n>& b = done[std::max(operation.b, 0)];
  switch (operation.op) {
    case Op::number:
      return operation.number;
    case Op::negate:
      return -a;
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return a / b;
    case Op::power:
      return operation.number != 0 ? pow(a, operation.number) : pow(a, b);
    case Op::less:
      return a.value < b.value ? 1.0 : 0.0;
    case Op::lessOrEqual:
      return a.value <= b.value ? 1.0 : 0.0;
    case Op::equal:
      return a.value == b.value ? 1.0 : 0.0;
    case Op::notEqual:
      return a.value != b.value ? 1.0 : 0.0;
    case Op::both:
      return (a.value != 0 && b.value != 0) ? 1.0 : 0.0;
    case Op::either:
      return (a.value != 0 || b.value != 0) ? 1.0 : 0.0;
    case Op::choose:
      return a.value != 0 ? b : done[operation.c];
    case Op::min:
      return min(a, b);
    case Op::max:
      return max(a, b);
    case Op::atan2:
      return arcOf(a, b);
    default:
      return ofOne(operation.op, a);
  }
}

template <int n>
void Formulas::evaluate(const Dual<n>* values, Dual<n>* results, std::vector<Dual<n>>& work) const {
  work.resize(operations_.size());
  for (size_t i = 0; i < operations_.size(); ++i) {
    const Operation& operation = operations_[i];
    work[i] = operation.op == Op::variable ? values[operation.a] : apply(operation, work.data());
  }
  for (size_t i = 0; i < results_.size(); ++i) results[i] = work[results_[i]];
}

template void Formulas::evaluate(const Dual<0>*, Dual<0>*, std::vector<Dual<0>>&) const;
template void Formulas::evaluate(const Dual<4>*, Dual<4>*, std::vector<Dual<4>>&) const;
template void Formulas::evaluate(const Dual<8>*, Dual<8>*, std::vector<Dual<8>>&) const;

int Formulas::append(const Operation& operation) {
  Operation own = operation;
  const auto isNumber = [&](int i) { return i < 0 || operations_[i].op == Op::number; };
  if (own.op != Op::number && own.op != Op::variable && isNumber(own.a) && isNumber(own.b) &&
      isNumber(own.c)) {
    std::vector<Dual<0>> done(operations_.size());
    for (const int i : {own.a, own.b, own.c})
      if (i >= 0) done[i] = operations_[i].number;
    own = {Op::number, -1, -1, -1, apply(own, done.data()).value};
  }
  if (own.op == Op::power && isNumber(own.b)) own.number = operations_[own.b].number;
  if (own.op == Op::power && isNumber(own.b) && own.number == 0) own = {Op::number, -1, -1, -1, 1};
  const bool ordinary = !std::isnan(own.number);  // NaN is never found again
  const auto key = std::make_tuple(own.op, own.a, own.b, own.c, ordinary ? own.number : 0);
  if (ordinary)
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
  operations_.push_back(own);
  const int number = static_cast<int>(operations_.size()) - 1;
  if (ordinary) known_[key] = number;
  return number;
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
