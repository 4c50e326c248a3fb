#include "commands/freefem_expression.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>

#include "base/error.h"

namespace mortier {

namespace {

/// Functions that mean the same in both languages, and how FreeFEM calls them.
const std::map<std::string, std::string>& freefemWords() {
  static const std::map<std::string, std::string> words = [] {
    std::map<std::string, std::string> same;
    for (const char* word : {"x",    "y",     "t",    "pi",   "sin",  "cos",   "tan",   "asin",  "acos",
                             "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp",
                             "log",  "log10", "sqrt", "abs",  "min",  "max",   "sign",  "rint"}) {
      same[word] = word;
    }
    same["ln"] = "log";
    same["_pi"] = "pi";
    same["_e"] = "exp(1.)";
    return same;
  }();
  return words;
}

/// Puts both values of every a ? b : c in parentheses, level by level of those that are there.
class Choices {
 public:
  /// What stands for a character.
  std::string translated(char c) {
    switch (c) {
      case '(':
        open_ += '(';
        return "(";
      case '?':
        open_ += '?';
        return "? (";
      case ':': {
        std::string closed = endOf(':') + ") : (";
        if (!open_.empty()) open_.back() = ':';
        return closed;
      }
      case ',':
        return endOf(':') + ",";
      case ')': {
        std::string closed = endOf(':') + ")";
        if (!open_.empty()) open_.pop_back();
        return closed;
      }
      default:
        return std::string(1, c);
    }
  }
  std::string end() { return endOf(':'); }

 private:
  /// Ends the last values that are open.
  std::string endOf(char kind) {
    std::string closed;
    for (; !open_.empty() && open_.back() == kind; open_.pop_back()) closed += ')';
    return closed;
  }

  std::string open_;  ///< parentheses, ? within a first value, : within a last one
};

}  // namespace

std::string freefemExpression(const Expression& expression) {
  const std::string& text = expression.text;
  std::string result;
  Choices choices;
  for (size_t i = 0; i < text.size();) {
    const auto is = [&](size_t k, auto test) {
      return k < text.size() && test(static_cast<unsigned char>(text[k])) != 0;
    };
    const size_t begin = i;
    if (is(i, [](int c) { return std::isalpha(c) != 0 || c == '_' ? 1 : 0; })) {
      while (is(i, [](int c) { return std::isalnum(c) != 0 || c == '_' ? 1 : 0; })) ++i;
      const auto word = freefemWords().find(text.substr(begin, i - begin));
      if (word == freefemWords().end()) {
        throw InputError(expression.where + ": " + text.substr(begin, i - begin) +
                         " is not known to FreeFEM");
      }
      result += word->second;
    } else if (is(i, [](int c) { return std::isdigit(c) != 0 || c == '.' ? 1 : 0; })) {
      bool real = false;
      for (; is(i, [](int c) { return std::isalnum(c) != 0 || c == '.' ? 1 : 0; }) ||
             (i < text.size() && (text[i] == '-' || text[i] == '+') && i > begin &&
              std::tolower(text[i - 1]) == 'e');
           ++i) {
        real = real || text[i] == '.' || std::tolower(text[i]) == 'e';
      }
      result += text.substr(begin, i - begin) + (real ? "" : ".");
    } else {
      const char c = std::isspace(static_cast<unsigned char>(text[i])) != 0 ? ' ' : text[i];
      if (std::string_view(" +-*/^(),?:<>=!&|").find(c) == std::string_view::npos)
        throw InputError(expression.where + ": " + c + " is not known to FreeFEM");
      ++i;
      if (c == ':') result.erase(result.find_last_not_of(' ') + 1);
      result += choices.translated(c);
      if (c == '?' || c == ':') i = std::min(text.find_first_not_of(' ', i), text.size());
    }
  }
  return result + choices.end();
}

}  // namespace mortier
