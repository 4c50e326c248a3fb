#include "base/units.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include "base/digits.h"
#include "base/error.h"

namespace mortier {
namespace {

struct Named {
  const char* name;
  Measure measure;
};

/// Those that take no prefix; some are a prefix and a unit by the letter.
constexpr std::array<Named, 9> whole{{{"min", {60, 0, dimensions::time}},
                                      {"h", {3600, 0, dimensions::time}},
                                      {"d", {86400, 0, dimensions::time}},
                                      {"in", {0.0254, 0, dimensions::length}},
                                      {"ft", {0.3048, 0, dimensions::length}},
                                      {"lbf", {4.4482216152605, 0, dimensions::force}},
                                      {"psi", {4.4482216152605 / (0.0254 * 0.0254), 0, dimensions::stress}},
                                      {"ksi", {4.4482216152605 / (0.0254 * 0.0254), 3, dimensions::stress}},
                                      {"bar", {1, 5, dimensions::stress}}}};
constexpr std::array<Named, 5> prefixed{{{"m", {1, 0, dimensions::length}},
                                         {"N", {1, 0, dimensions::force}},
                                         {"Pa", {1, 0, dimensions::stress}},
                                         {"s", {1, 0, dimensions::time}},
                                         {"J", {1, 0, dimensions::energy}}}};
constexpr struct {
  const char* name;
  int decades;
} prefixes[] = {{"", 0},   {"n", -9}, {"u", -6}, {"\u00b5", -6}, {"m", -3}, {"c", -2},
                {"d", -1}, {"k", 3},  {"M", 6},  {"G", 9},       {"T", 12}};

std::optional<Measure> named(const std::string& word) {
  for (const auto& [name, measure] : whole)
    if (word == name) return measure;
  for (const auto& [name, measure] : prefixed)
    for (const auto& [prefix, decades] : prefixes)
      if (word == std::string(prefix) + name) return Measure{1, decades, measure.dimension};
  return std::nullopt;
}

/// a b^power
Measure product(const Measure& a, const Measure& b, int power) {
  return {a.factor * std::pow(b.factor, power),
          a.decades + power * b.decades,
          {a.dimension.length + power * b.dimension.length, a.dimension.force + power * b.dimension.force,
           a.dimension.time + power * b.dimension.time}};
}

double value(const Measure& measure) {
  const double decades = std::pow(10, std::abs(measure.decades));  // exact up to 22
  return measure.decades < 0 ? measure.factor / decades : measure.factor * decades;
}

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool isLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || (static_cast<unsigned char>(c) & 0x80U) != 0;
}

}  // namespace

std::optional<Measure> unitOf(const std::string& text) {
  constexpr int largestPower = 4;
  Measure all;
  int sign = 1;
  bool expected = true;  // a word
  const bool inverse = text.rfind("1/", 0) == 0;
  if (inverse) sign = -1;
  for (size_t i = inverse ? 2 : 0; i < text.size();) {
    const char c = text[i];
    if (c == ' ' || c == '*' || c == '/') {
      if (c != ' ' && expected) return std::nullopt;
      if (c == '/') sign = -1;
      if (c != ' ') expected = true;
      ++i;
      continue;
    }
    size_t end = i;
    while (end < text.size() && isLetter(text[end])) ++end;
    const std::optional<Measure> unit = named(text.substr(i, end - i));
    if (!unit) return std::nullopt;
    int power = 1;
    if (end < text.size() && text[end] == '^') {
      if (end + 1 == text.size() || text[end + 1] < '1' || text[end + 1] > '0' + largestPower)
        return std::nullopt;
      power = text[end + 1] - '0';
      end += 2;
    }
    if (end < text.size() && text[end] != ' ' && text[end] != '*' && text[end] != '/') return std::nullopt;
    all = product(all, *unit, sign * power);
    sign = 1;
    expected = false;
    i = end;
  }
  if (expected) return std::nullopt;
  return all;
}

std::optional<NumberAndUnit> numberAndUnit(const std::string& text) {
  const std::string all = trimmed(text);
  const auto isNumber = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.'; };
  const size_t first = !all.empty() && (all[0] == '-' || all[0] == '+') ? 1 : 0;
  if (first >= all.size() || !isNumber(all[first]) || all.find_first_of("xX") == first + 1)
    return std::nullopt;
  char* end = nullptr;
  const double number = std::strtod(all.c_str(), &end);
  const std::string unit = trimmed(end);
  const bool inverse = unit.rfind("1/", 0) == 0 && unit.size() > 2;
  const bool isUnit =
      !unit.empty() && isLetter(unit[inverse ? 2 : 0]) && std::all_of(unit.begin(), unit.end(), [&](char c) {
        return isLetter(c) || (isNumber(c) && c != '.') || c == ' ' || c == '*' || c == '/' || c == '^';
      });
  if (!isUnit) return std::nullopt;
  return NumberAndUnit{number, unit};
}

Units Units::from(const std::string& text) {
  constexpr double rounding = 1e-9;
  const std::string expected =
      "expected a length, a force and a stress, as in \"mm, N, MPa\", and a time where it is not s";
  Units units;
  units.given = true;
  std::optional<Measure> stress;
  std::array<bool, 4> seen{};
  const std::array order{dimensions::length, dimensions::force, dimensions::stress, dimensions::time};
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    const std::optional<Measure> unit = unitOf(word);
    if (!unit) throw InputError(expected + "; \"" + word + "\" is no unit that is known");
    const auto which =
        static_cast<size_t>(std::find(order.begin(), order.end(), unit->dimension) - order.begin());
    if (which == order.size() || seen[which]) throw InputError(expected + ", each once");
    seen[which] = true;
    if (which == 0) {
      units.length = word;
      units.lengthInSi = *unit;
    } else if (which == 1) {
      units.force = word;
      units.forceInSi = *unit;
    } else if (which == 2) {
      units.stress = word;
      stress = unit;
    } else {
      units.time = word;
      units.timeInSi = *unit;
    }
  }
  if (!seen[0] || !seen[1] || !seen[2]) throw InputError(expected);
  const double ratio = units.in(*stress);
  if (!(std::abs(ratio - 1) <= rounding))
    throw InputError("expected a consistent set: 1 " + units.stress + " is " + digits(ratio, 4) + " " +
                     units.force + "/" + units.area());
  return units;
}

std::string Units::nameOf(const Dimension& dimension) const {
  return dimension == dimensions::length      ? length
         : dimension == dimensions::force     ? force
         : dimension == dimensions::time      ? time
         : dimension == dimensions::rate      ? "1/" + time
         : dimension == dimensions::stress    ? stress
         : dimension == dimensions::viscosity ? stress + " " + time
                                              : bodyForce();
}

double Units::in(const Measure& measure) const {
  const Dimension& d = measure.dimension;
  return value(
      product(product(product(measure, lengthInSi, -d.length), forceInSi, -d.force), timeInSi, -d.time));
}

}  // namespace mortier
