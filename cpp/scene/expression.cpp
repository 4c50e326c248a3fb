#include "scene/expression.h"

#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <set>

#include "base/error.h"
#include "scene/document.h"

namespace mortier {

namespace {

/// A compiled expression with variables of its own: muParser keeps their addresses, so that a copy compiles
/// anew, when it is first evaluated: most copies are only passed on.
class Compiled {
 public:
  Compiled(std::string text, bool inSpace) : text_(std::move(text)), inSpace_(inSpace) { compile(); }
  Compiled(const Compiled& other) : text_(other.text_), inSpace_(other.inSpace_) {}
  Compiled(Compiled&& other) noexcept = default;
  Compiled& operator=(const Compiled&) = delete;
  Compiled& operator=(Compiled&&) = delete;
  ~Compiled() = default;

  double operator()(double x, double y, double t) const { return (*this)(SpacePoint(x, y, 0), t); }
  double operator()(const SpacePoint& x, double t) const {
    if (!work_) compile();
    work_->x = x;
    work_->t = t;
    return work_->parser.Eval();
  }

  /// Those that the text holds; reads it again.
  [[nodiscard]] std::set<std::string> variables() const {
    std::set<std::string> names;
    for (const auto& [name, address] : work_->parser.GetUsedVar()) names.insert(name);
    return names;
  }
  /// Evaluates once; how many values the text holds ("1, 2" are two).
  [[nodiscard]] int values() const {
    work_->parser.Eval();
    return work_->parser.GetNumResults();
  }

 private:
  struct Work {
    mu::Parser parser;
    SpacePoint x{0, 0, 0};
    double t = 0;
  };

  void compile() const {
    work_ = std::make_unique<Work>();
    work_->parser.ResetLocale();
    work_->parser.DefineVar("x", &work_->x[0]);
    work_->parser.DefineVar("y", &work_->x[1]);
    if (inSpace_) work_->parser.DefineVar("z", &work_->x[2]);
    work_->parser.DefineVar("t", &work_->t);
    work_->parser.DefineConst("pi", std::numbers::pi);
    work_->parser.SetExpr(text_);
  }

  std::string text_;
  bool inSpace_;
  mutable std::unique_ptr<Work> work_;
};

/// muParser lets an expression assign to its variables; a datum must not.
bool assigns(const std::string& text) {
  for (size_t i = 0; i < text.size(); ++i) {
    const bool comparison = (i > 0 && std::string("=!<>").find(text[i - 1]) != std::string::npos) ||
                            (i + 1 < text.size() && text[i + 1] == '=');
    if (text[i] == '=' && !comparison) return true;
  }
  return false;
}

/// \throws DatumError  \param z  none in the plane
double finite(double value, const std::string& where, double x, double y, double t,
              std::optional<double> z = {}) {
  if (std::isfinite(value)) return value;
  throw DatumError(where + ", expected a finite number, is " + shortest(value) + " at x = " + shortest(x) +
                   ", y = " + shortest(y) + (z ? ", z = " + shortest(*z) : "") + ", t = " + shortest(t));
}

[[noreturn]] void reject(const std::string& where, const std::string& reason, bool inSpace) {
  throw InputError(where + ", expected an expression in x, y, " + (inSpace ? "z, t (" : "t (") + reason +
                   ")");
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
  if (text.find_first_not_of(" \t\n\r") == std::string::npos) reject(where, "it is empty", inSpace);
  if (assigns(text)) reject(where, "assignment is not allowed", inSpace);
  try {
    Compiled compiled(text, inSpace);
    if (compiled.values() != 1) reject(where, "it has several values", inSpace);
    const std::set<std::string> variables = compiled.variables();
    if (variables.empty()) {
      const double value = compiled(0, 0, 0);
      Expression result = constantExpression(value, std::move(where));
      result.text = text;
      finite(value, result.where, 0, 0, 0);
      return result;
    }
    const bool inTime = variables.count("t") > 0;
    SpaceDatum ofSpace;
    if (variables.count("z") > 0)
      ofSpace = [compiled](const SpacePoint& x, double t) { return compiled(x, t); };
    Datum datum =
        Function([value = std::move(compiled)](double x, double y, double t) { return value(x, y, t); });
    datum.inTime = inTime;
    describe(text, datum);
    return {text, std::move(where), false, std::move(datum), {}, inTime, std::move(ofSpace)};
  } catch (const mu::Parser::exception_type& error) {
    std::string reason = error.GetMsg();
    reason = reason.substr(0, reason.find_first_of("\r\n"));
    if (!reason.empty() && reason.back() == '.') reason.pop_back();
    if (!reason.empty())
      reason.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(reason.front())));
    reject(where, reason, inSpace);
  }
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
