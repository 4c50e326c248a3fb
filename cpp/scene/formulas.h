// Expressions of several variables, in the language of scene/expression.h, that are evaluated with their
// derivatives: their text is read once into a list of operations, none twice, which then runs on numbers of
// any kind (material/dual.h).
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "material/dual.h"

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
  /// Whether a result depends on the variable.
  [[nodiscard]] bool dependsOn(int variable) const;

  /// \param values  of the variables  \param results  as many as were added  \param work  kept between calls
  template <int n>
  void evaluate(const Dual<n>* values, Dual<n>* results, std::vector<Dual<n>>& work) const;

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
    double number = 0;           ///< of a constant
  };

 private:
  friend class FormulaReader;
  /// The number of this operation, or of the same one before, or of the constant that it is.
  int append(const Operation& operation);
  template <int n>
  static Dual<n> apply(const Operation& operation, const Dual<n>* done);

  std::vector<std::string> variables_;
  std::map<std::string, Text> named_;
  std::map<std::string, int> operationOf_;  ///< of named ones that were read; -1 while they are
  std::vector<Operation> operations_;
  std::map<std::tuple<Op, int, int, int, double>, int> known_;
  std::vector<int> results_;
};

extern template void Formulas::evaluate(const Dual<0>*, Dual<0>*, std::vector<Dual<0>>&) const;
extern template void Formulas::evaluate(const Dual<4>*, Dual<4>*, std::vector<Dual<4>>&) const;
extern template void Formulas::evaluate(const Dual<8>*, Dual<8>*, std::vector<Dual<8>>&) const;

}  // namespace mortier
