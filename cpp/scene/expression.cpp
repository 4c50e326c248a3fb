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

/// \throws DatumError  \param inSpace  whether points have a z
double finite(double value, const std::string& where, const SpacePoint& x, double t, bool inSpace) {
  if (std::isfinite(value)) return value;
  throw DatumError(where + ", expected a finite number, is " + shortest(value) +
                   " at x = " + shortest(x.x()) + ", y = " + shortest(x.y()) +
                   (inSpace ? ", z = " + shortest(x.z()) : "") + ", t = " + shortest(t));
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
  Datum opposite = [value = value.value](const SpacePoint& x, double t) { return -value(x, t); };
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
    Expression result = constantExpression(finite(value({0, 0, 0}, 0), where, {0, 0, 0}, 0, false), where);
    result.text = text;
    return result;
  }
  Datum datum = value;
  datum.inTime = formula->dependsOn(last);
  describe(*formula, inSpace, datum);
  Expression result{text, std::move(where), false, std::move(datum), {}};
  result.inTime = result.value.inTime;
  result.formula = formula;
  return result;
}

Datum finiteValue(const Expression& expression, bool inSpace) {
  Datum datum = expression.value;
  datum.value = [value = expression.value.value, where = expression.where, inSpace](
                    const SpacePoint& x, double t) { return finite(value(x, t), where, x, t, inSpace); };
  return datum;
}

namespace {

template <class Place>
double finiteAt(const Expression& expression, const Place& p, double t) {
  constexpr bool inSpace = Place::SizeAtCompileTime == 3;
  SpacePoint x = SpacePoint::Zero();
  x.head<Place::SizeAtCompileTime>() = p;
  return finite(expression.value(x, t), expression.where, x, t, inSpace);
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
