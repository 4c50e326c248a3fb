#include "scene/expression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "base/error.h"
#include "scene/document.h"
#include "scene/formulas.h"

namespace mortier {

namespace {

/// The value of a formula in x, y, t or x, y, z, t. Copies have numbers of their own: a thread takes its own.
class Value {
 public:
  Value(std::shared_ptr<const Formulas> formula, bool inSpace)
      : formula_(std::move(formula)), variables_(inSpace ? 4 : 3) {}

  double operator()(double x, double y, double t) const { return (*this)(SpacePoint(x, y, 0), t); }
  double operator()(const SpacePoint& x, double t) const {
    values_.resize(variables_ * pointsAtOnce);
    for (int k = 0; k + 1 < variables_; ++k) values_[k * pointsAtOnce] = x[k];
    values_[(variables_ - 1) * pointsAtOnce] = t;
    std::array<double, pointsAtOnce> result;
    formula_->evaluate(values_.data(), result.data(), 1, numbers_);
    return result[0];
  }

 private:
  std::shared_ptr<const Formulas> formula_;
  int variables_;
  mutable std::vector<double> values_, numbers_;
};

/// \throws DatumError  \param z  none in the plane
double finite(double value, const std::string& where, double x, double y, double t,
              std::optional<double> z = {}) {
  if (std::isfinite(value)) return value;
  throw DatumError(where + ", expected a finite number, is " + shortest(value) + " at x = " + shortest(x) +
                   ", y = " + shortest(y) + (z ? ", z = " + shortest(*z) : "") + ", t = " + shortest(t));
}

}  // namespace

Expression constantExpression(double value, std::string where) {
  Datum datum = [value](double, double, double) { return value; };
  datum.degree = 0;
  datum.inTime = false;
  return {shortest(value), std::move(where), true, std::move(datum), {}};
}

Expression tableExpression(const std::vector<double>& times, const std::vector<double>& values,
                           std::string where) {
  // As an expression: nested choices, for those who need the text.
  std::string text = "(t < " + shortest(times.front()) + " ? " + shortest(values.front()) + " : ";
  for (size_t i = 1; i < times.size(); ++i) {
    const std::string slope = shortest((values[i] - values[i - 1]) / (times[i] - times[i - 1]));
    text.append("(t < " + shortest(times[i]) + " ? " + shortest(values[i - 1]) + " + (" + slope + ")*(t - (" +
                shortest(times[i - 1]) + ")) : ");
  }
  text.append(shortest(values.back())).append(times.size(), ')');
  Datum value = [times, values](double, double, double t) {
    const size_t i = std::upper_bound(times.begin(), times.end(), t) - times.begin();
    if (i == 0 || i == times.size()) return i == 0 ? values.front() : values.back();
    const double part = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return (1 - part) * values[i - 1] + part * values[i];
  };
  value.degree = 0;
  return {std::move(text), std::move(where), false, std::move(value), times, true};
}

Expression negated(Expression expression) {
  expression.text = "-(" + expression.text + ")";
  const Datum& value = expression.value;
  Datum opposite = [value = Function(value)](double x, double y, double t) { return -value(x, y, t); };
  opposite.degree = value.degree;
  opposite.inTime = value.inTime;
  opposite.degreeInTime = value.degreeInTime;
  if (value.enclosure)
    opposite.enclosure = [enclosure = value.enclosure](const Box& box) {
      const Interval range = enclosure(box);
      return Interval{-range.largest, -range.least};
    };
  if (value.along)
    opposite.along = [along = value.along] {
      return [f = along()](const Taylor& x, const Taylor& y, const Taylor& t) { return -f(x, y, t); };
    };
  expression.value = std::move(opposite);
  if (expression.inSpace)
    expression.inSpace = [value = expression.inSpace](const SpacePoint& x, double t) { return -value(x, t); };
  return expression;
}

Expression parseExpression(const std::string& text, std::string where, bool inSpace) {
  const std::vector<std::string> variables =
      inSpace ? std::vector<std::string>{"x", "y", "z", "t"} : std::vector<std::string>{"x", "y", "t"};
  const auto formula = std::make_shared<Formulas>(variables, std::map<std::string, Formulas::Text>{});
  formula->add({text, where});
  const Value value(formula, inSpace);
  const int last = static_cast<int>(variables.size()) - 1;
  bool constant = true;
  for (int k = 0; k <= last; ++k) constant = constant && !formula->dependsOn(k);
  if (constant) {
    Expression result = constantExpression(finite(value(0, 0, 0), where, 0, 0, 0), where);
    result.text = text;
    return result;
  }
  SpaceDatum ofSpace;
  if (inSpace && formula->dependsOn(2))
    ofSpace = [value](const SpacePoint& x, double t) { return value(x, t); };
  Datum datum = Function([value](double x, double y, double t) { return value(x, y, t); });
  datum.inTime = formula->dependsOn(last);
  describe(*formula, inSpace, datum);
  Expression result{text, std::move(where), false, std::move(datum), {}};
  result.inTime = result.value.inTime;
  result.inSpace = std::move(ofSpace);
  result.formula = formula;
  return result;
}

double Expression::at(const SpacePoint& x, double t) const {
  return inSpace ? inSpace(x, t) : value(x.x(), x.y(), t);
}

Datum finiteValue(const Expression& expression) {
  Datum datum = expression.value;
  static_cast<Function&>(datum) = [value = Function(expression.value), where = expression.where](
                                      double x, double y, double t) {
    return finite(value(x, y, t), where, x, y, t);
  };
  return datum;
}

SpaceDatum finiteInSpace(const Expression& expression) {
  SpaceDatum value = expression.inSpace;
  if (!value)
    value = [plane = Function(expression.value)](const SpacePoint& x, double t) {
      return plane(x.x(), x.y(), t);
    };
  return [value = std::move(value), where = expression.where](const SpacePoint& x, double t) {
    return finite(value(x, t), where, x.x(), x.y(), t, x.z());
  };
}

SpaceDatum finiteAt(const Expression& expression, bool inSpace) {
  if (inSpace) return finiteInSpace(expression);
  return [value = Function(finiteValue(expression))](const SpacePoint& x, double t) {
    return value(x.x(), x.y(), t);
  };
}

namespace {

template <class Place>
double finiteAt(const Expression& expression, const Place& p, double t) {
  SpacePoint x(p[0], p[1], 0);
  std::optional<double> z;
  if constexpr (Place::SizeAtCompileTime == 3) z = x[2] = p[2];
  return finite(expression.at(x, t), expression.where, p[0], p[1], t, z);
}

}  // namespace

template <class Place>
void requireFinite(const Expression& expression, const std::vector<Place>& points,
                   const std::vector<double>& times) {
  for (const double t : times)
    for (const Place& p : points) finiteAt(expression, p, t);
}

template <class Place>
std::vector<double> valuesAt(const Expression& expression, const std::vector<Place>& points) {
  std::vector<double> values;
  for (const Place& p : points) values.push_back(finiteAt(expression, p, 0));
  return values;
}

template void requireFinite(const Expression&, const std::vector<Point>&, const std::vector<double>&);
template void requireFinite(const Expression&, const std::vector<SpacePoint>&, const std::vector<double>&);
template std::vector<double> valuesAt(const Expression&, const std::vector<Point>&);
template std::vector<double> valuesAt(const Expression&, const std::vector<SpacePoint>&);

}  // namespace mortier
