// Data that vary in space and time: numbers, or expressions in x [m], y [m], in space z [m], and t [s] such
// as "-10*t" or "sin(pi*x)".
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/datum.h"

namespace mortier {

class Formulas;

/// Of each interval of time at which data are evaluated: the golden section, which no period of what people
/// write divides.
inline constexpr double unevenPart = 0.3819660112501051;

struct Expression {
  std::string text;       ///< as written, for messages and for FreeFEM
  std::string where;      ///< what a message about it begins with: `scenes/a.toml:14: body upper: ty = "1/t"`
  bool constant = false;  ///< depends on none of x, y, z, t
  Datum value;            ///< copies are independent: a thread takes its own
  std::vector<double> breaks = {};  ///< times at which it has kinks, ascending [s]; known of tables only
  bool inTime = false;              ///< depends on t
  std::shared_ptr<const Formulas> formula =
      {};  ///< of a text that is no number; empty for numbers and tables
};

Expression constantExpression(double value, std::string where);

/// Linear in time between the points of a table, constant before the first and after the last.
/// \pre times ascend strictly; as many values
Expression tableExpression(const std::vector<double>& times, const std::vector<double>& values,
                           std::string where);

/// -value
Expression negated(Expression expression);

/// Operators + - * / ^, comparisons, && ||, a ? b : c, the constant pi, and the usual functions
/// (docs/scene.md). \throws InputError `where, expected an expression in x, y, t (what is wrong and at which
/// character)`.
/// \param inSpace  whether it may depend on z
Expression parseExpression(const std::string& text, std::string where, bool inSpace = false);

/// Evaluates at every point and time. \throws InputError naming the first point and time where it is not
/// finite.
template <class Place>
void requireFinite(const Expression& expression, const std::vector<Place>& points,
                   const std::vector<double>& times);
/// Its values at time 0. \throws InputError as this
template <class Place>
std::vector<double> valuesAt(const Expression& expression, const std::vector<Place>& points);

// The value of a datum, or what is wrong with it.

/// The value of the expression. Where that is not finite the function \throws DatumError naming the datum,
/// the point and the time. \param inSpace  whether points have a z
Datum finiteValue(const Expression& expression, bool inSpace = false);

// What the text of an expression says about it without trying it at points.

/// Fills in the degree in x, y and z, that in t, and enclosures of the values and the derivatives
/// (base/taylor.h) of the datum that the formula in x, y, t or x, y, z, t is.
void describe(const Formulas& formula, bool inSpace, Datum& datum);
/// Whether it is t times what does not depend on t. \param time  the number of t among the variables
bool proportionalToTime(const Formulas& formula);
/// Times that t is compared with: where it may have kinks, as they are met.
std::vector<double> kinksInTime(const Formulas& formula);

}  // namespace mortier
