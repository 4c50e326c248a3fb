// The grammar of expressions (docs/scene.md).
#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "scene/formulas.h"

namespace mortier {

namespace {

using Op = Formulas::Op;

struct Callable {
  Op op;
  int least;  ///< how many numbers it takes
  int most;
};

const std::map<std::string, Callable>& functions() {
  constexpr int any = 1000;
  static const std::map<std::string, Callable> all{
      {"sin", {Op::sin, 1, 1}},     {"cos", {Op::cos, 1, 1}},     {"tan", {Op::tan, 1, 1}},
      {"asin", {Op::asin, 1, 1}},   {"acos", {Op::acos, 1, 1}},   {"atan", {Op::atan, 1, 1}},
      {"sinh", {Op::sinh, 1, 1}},   {"cosh", {Op::cosh, 1, 1}},   {"tanh", {Op::tanh, 1, 1}},
      {"asinh", {Op::asinh, 1, 1}}, {"acosh", {Op::acosh, 1, 1}}, {"atanh", {Op::atanh, 1, 1}},
      {"exp", {Op::exp, 1, 1}},     {"log", {Op::log, 1, 1}},     {"ln", {Op::log, 1, 1}},
      {"log10", {Op::log10, 1, 1}}, {"log2", {Op::log2, 1, 1}},   {"sqrt", {Op::sqrt, 1, 1}},
      {"abs", {Op::abs, 1, 1}},     {"sign", {Op::sign, 1, 1}},   {"rint", {Op::rint, 1, 1}},
      {"atan2", {Op::atan2, 2, 2}}, {"min", {Op::min, 1, any}},   {"max", {Op::max, 1, any}}};
  return all;
}

const std::map<std::string, double>& constants() {
  static const std::map<std::string, double> all{
      {"pi", std::numbers::pi}, {"_pi", std::numbers::pi}, {"_e", std::numbers::e}};
  return all;
}

}  // namespace

class FormulaReader {
 public:
  FormulaReader(Formulas& formulas, const Formulas::Text& source, int depth = 0)
      : formulas_(formulas), source_(source), depth_(depth) {}

  int read() {
    const int result = choice();
    if (at_ < text().size()) reject(std::string("unexpected ") + text()[at_]);
    return result;
  }

 private:
  [[nodiscard]] const std::string& text() const { return source_.text; }

  [[noreturn]] void reject(const std::string& reason) const {
    std::string names;
    for (const std::string& each : formulas_.variables_) names += (names.empty() ? "" : ", ") + each;
    for (const auto& [name, value] : formulas_.named_) names += ", " + name;
    throw InputError(source_.where + ", expected an expression in " + names + " (" + reason +
                     ", at character " + std::to_string(at_ + 1) + ")");
  }

  void skipSpace() {
    while (at_ < text().size() && std::isspace(static_cast<unsigned char>(text()[at_])) != 0) ++at_;
  }
  /// Whether the text goes on with `word`, which is then behind.
  bool takes(const std::string& word) {
    skipSpace();
    if (text().compare(at_, word.size(), word) != 0) return false;
    at_ += word.size();
    return true;
  }
  int append(Op op, int a, int b = -1, int c = -1) { return formulas_.append({op, a, b, c}); }

  void descend() {
    constexpr int deepest = 200;
    if (++depth_ > deepest) reject("nested too deep");
  }
  int choice() {
    descend();
    int result = binary(0);
    if (takes("?")) {
      const int yes = choice();
      if (!takes(":")) reject("expected a : to the ?");
      result = append(Op::choose, result, yes, choice());
    }
    --depth_;
    return result;
  }
  /// An operator between two values.
  struct Binary {
    const char* sign;
    Op op;
    bool exchanged = false;  ///< a > b is b < a
  };
  /// Operators of a level and of those that bind more; a sign comes before those that it begins with.
  int binary(size_t level) {
    static const std::vector<std::vector<Binary>> levels{{{"||", Op::either}},
                                                         {{"&&", Op::both}},
                                                         {{"<=", Op::lessOrEqual},
                                                          {">=", Op::lessOrEqual, true},
                                                          {"==", Op::equal},
                                                          {"!=", Op::notEqual},
                                                          {"<", Op::less},
                                                          {">", Op::less, true}},
                                                         {{"+", Op::add}, {"-", Op::subtract}},
                                                         {{"*", Op::multiply}, {"/", Op::divide}}};
    if (level == levels.size()) return signedPower();
    int result = binary(level + 1);
    while (true) {
      const auto found = std::find_if(levels[level].begin(), levels[level].end(),
                                      [&](const Binary& each) { return takes(each.sign); });
      if (found == levels[level].end()) return result;
      const int other = binary(level + 1);
      result = found->exchanged ? append(found->op, other, result) : append(found->op, result, other);
    }
  }
  int signedPower() {
    if (takes("-")) return append(Op::negate, power());
    takes("+");
    return power();
  }
  int power() {
    const int base = single();
    return takes("^") ? append(Op::power, base, exponent()) : base;
  }
  int exponent() {
    descend();
    const int result = signedPower();
    --depth_;
    return result;
  }

  int single() {
    skipSpace();
    if (at_ == text().size()) reject("it ends where a value is expected");
    if (takes("(")) {
      const int result = choice();
      if (!takes(")")) reject("expected a )");
      return result;
    }
    const char c = text()[at_];
    if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') return number();
    if (std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_') return word();
    reject(std::string("unexpected ") + c);
  }
  int number() {
    double value = 0;
    const auto [end, error] = std::from_chars(text().data() + at_, text().data() + text().size(), value);
    if (error != std::errc()) reject("not a number");
    at_ = end - text().data();
    return formulas_.append({Op::number, -1, -1, -1, value});
  }
  int word() {
    const size_t begin = at_;
    while (at_ < text().size() &&
           (std::isalnum(static_cast<unsigned char>(text()[at_])) != 0 || text()[at_] == '_'))
      ++at_;
    const std::string name = text().substr(begin, at_ - begin);
    if (const auto function = functions().find(name); function != functions().end()) {
      if (!takes("(")) reject("expected a ( after " + name);
      return call(name, function->second);
    }
    for (size_t k = 0; k < formulas_.variables_.size(); ++k)
      if (formulas_.variables_[k] == name) return append(Op::variable, static_cast<int>(k));
    if (formulas_.named_.count(name) > 0) return named(name);
    if (const auto constant = constants().find(name); constant != constants().end())
      return formulas_.append({Op::number, -1, -1, -1, constant->second});
    at_ = begin;
    reject("unknown name " + name);
  }
  int call(const std::string& name, const Callable& function) {
    std::vector<int> of{choice()};
    while (takes(",")) of.push_back(choice());
    if (!takes(")")) reject("expected a ) to " + name);
    const int count = static_cast<int>(of.size());
    if (count < function.least || count > function.most)
      reject(name + " takes " + std::to_string(function.least) +
             (function.most > function.least ? " or more" : ""));
    if (function.most == 1) return append(function.op, of[0]);
    int result = of[0];
    for (size_t k = 1; k < of.size(); ++k) result = append(function.op, result, of[k]);
    return result;
  }
  /// One of the user's own; read when it is first met.
  int named(const std::string& name) {
    const auto known = formulas_.operationOf_.find(name);
    if (known != formulas_.operationOf_.end()) {
      if (known->second < 0) reject(name + " depends on itself");
      return known->second;
    }
    formulas_.operationOf_[name] = -1;
    const int result = FormulaReader(formulas_, formulas_.named_.at(name), depth_).read();
    return formulas_.operationOf_[name] = result;
  }

  Formulas& formulas_;
  const Formulas::Text& source_;
  size_t at_ = 0;
  int depth_;
};

Formulas::Formulas(std::vector<std::string> variables, std::map<std::string, Text> named)
    : variables_(std::move(variables)), named_(std::move(named)) {}

bool Formulas::isWord(const std::string& name) {
  return functions().count(name) + constants().count(name) > 0;
}

void Formulas::add(const Text& expression) {
  results_.push_back(FormulaReader(*this, expression).read());
}

}  // namespace mortier
