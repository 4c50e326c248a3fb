// Expressions of several variables, evaluated with their derivatives: their text is read once into a list of
// operations, none twice, each of which then runs on a block of points, in numbers of any kind
// (material/rate_law.h).
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "material/rate_law.h"

namespace mortier {

class Formulas {
 public:
  struct Text {
    std::string text;
    std::string where;  ///< what a message about it begins with
  };

  /// \param named  abbreviations of the user's own: they may hold variables, and each other
  Formulas(std::vector<std::string> variables, std::map<std::string, Text> named);
  /// Whether the language has a function or a constant of that name.
  static bool isWord(const std::string& name);

  /// Reads an expression; it is the next result of evaluate(). \throws InputError `where, expected an
  /// expression in ... (what is wrong, at which character)`.
  void add(const Text& expression);
  [[nodiscard]] int variables() const { return static_cast<int>(variables_.size()); }
  /// Whether a result depends on the variable.
  [[nodiscard]] bool dependsOn(int variable) const;

  /// \param values  of the variables, values[k pointsAtOnce + i] at point i  \param results  as many as were
  /// added, likewise  \param work  kept between calls
  template <class Number>
  void evaluate(const Number* values, Number* results, int points, std::vector<Number>& work) const;

  enum class Op {
    number,
    variable,
    negate,
    add,
    subtract,
    multiply,
    divide,
    power,
    less,
    lessOrEqual,
    equal,
    notEqual,
    both,
    either,
    choose,
    min,
    max,
    atan2,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    asinh,
    acosh,
    atanh,
    exp,
    log,
    log10,
    log2,
    sqrt,
    abs,
    sign,
    rint
  };
  struct Operation {
    Op op;
    int a = -1, b = -1, c = -1;  ///< operations before it that it takes; a: the number of a variable
    double number = 0;           ///< of a constant; of a power whose exponent is one
  };

  /// In the order in which they are to be done; the number of the one that is result i.
  [[nodiscard]] const std::vector<Operation>& operations() const { return operations_; }
  [[nodiscard]] int result(size_t i) const { return results_[i]; }

 private:
  friend class FormulaReader;
  /// The number of this operation, or of the same one before, or of the constant that it is.
  int append(const Operation& operation);
  /// x^n as products.
  int appendWholePower(int x, int n);

  std::vector<std::string> variables_;
  std::map<std::string, Text> named_;
  std::map<std::string, int> operationOf_;  ///< of named ones that were read; -1 while they are
  std::vector<Operation> operations_;
  std::map<std::tuple<Op, int, int, int, double>, int> known_;
  std::vector<int> results_;
};

}  // namespace mortier
