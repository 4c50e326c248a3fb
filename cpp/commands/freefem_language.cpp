#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>

#include "base/error.h"
#include "base/printable.h"
#include "commands/freefem.h"

namespace mortier {

namespace {

/// Functions that mean the same in both languages, and how FreeFEM calls them.
const std::map<std::string, std::string>& freefemWords() {
  static const std::map<std::string, std::string> words = [] {
    std::map<std::string, std::string> same;
    for (const char* word :
         {"pi",    "sin",   "cos", "tan", "asin",  "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh",
          "acosh", "atanh", "exp", "log", "log10", "sqrt", "abs",  "min",   "max",  "sign", "rint"})
      same[word] = word;
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
  return freefemFormula(expression.text, expression.where, {{"x", "x"}, {"y", "y"}, {"z", "z"}, {"t", "t"}});
}

std::vector<std::string> namesIn(const std::string& text) {
  std::vector<std::string> names;
  for (size_t i = 0; i < text.size();) {
    const auto isPart = [&](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    const size_t begin = i;
    // A number takes the letter of its exponent along.
    const bool isName = std::isdigit(static_cast<unsigned char>(text[i])) == 0 && text[i] != '.';
    while (i < text.size() && (isPart(text[i]) || (!isName && text[i] == '.'))) ++i;
    if (i == begin)
      ++i;
    else if (isName && freefemWords().count(text.substr(begin, i - begin)) == 0)
      names.push_back(text.substr(begin, i - begin));
  }
  return names;
}

std::string freefemFormula(const std::string& text, const std::string& where,
                           const std::map<std::string, std::string>& names) {
  std::string result;
  Choices choices;
  for (size_t i = 0; i < text.size();) {
    const auto is = [&](size_t k, auto test) {
      return k < text.size() && test(static_cast<unsigned char>(text[k])) != 0;
    };
    const size_t begin = i;
    if (is(i, [](int c) { return std::isalpha(c) != 0 || c == '_' ? 1 : 0; })) {
      while (is(i, [](int c) { return std::isalnum(c) != 0 || c == '_' ? 1 : 0; })) ++i;
      const std::string name = text.substr(begin, i - begin);
      const auto variable = names.find(name);
      const auto word = freefemWords().find(name);
      if (variable == names.end() && word == freefemWords().end())
        throw InputError(where + ": " + name + " is not known to FreeFEM");
      result += variable == names.end() ? word->second : variable->second;
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
        throw InputError(where + ": " + c + " is not known to FreeFEM");
      ++i;
      if (c == ':') result.erase(result.find_last_not_of(' ') + 1);
      result += choices.translated(c);
      if (c == '?' || c == ':') i = std::min(text.find_first_not_of(' ', i), text.size());
    }
  }
  return result + choices.end();
}

std::string freefemMacro(const std::string& name, const std::string& text, const std::string& comment) {
  return text.empty() ? "" : "macro " + name + ' ' + text + "//  " + comment + '\n';
}

std::string freefemString(const std::string& text, const std::string& where) {
  constexpr size_t longest = 250;  // with the quotes of an include
  const auto safe = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
  if (text.size() > longest || !std::all_of(text.begin(), text.end(), safe))
    throw InputError(where + " = \"" + printable(text) + "\", expected at most " + std::to_string(longest) +
                     " printable ASCII characters without \" and \\ (all that a FreeFEM string can hold)");
  return '"' + text + '"';
}

std::string freefemComment(const std::string& text) {
  return "// " + printable(text) + '\n';
}

}  // namespace mortier
