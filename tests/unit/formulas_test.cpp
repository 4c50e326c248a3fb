#include "scene/formulas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/expression.h"

namespace mortier::formulas_test {

using Slopes = Differentiated<4>;

/// Of x, y and t.
template <class Number>
Number valueAt(const std::string& text, const std::array<Number, 3>& at) {
  Formulas formulas({"x", "y", "t"}, {});
  formulas.add({text, text});
  std::vector<Number> values(3 * pointsAtOnce, Number(0));
  for (int k = 0; k < 3; ++k) values[k * pointsAtOnce] = at[k];
  std::vector<Number> result(pointsAtOnce, Number(0));
  std::vector<Number> work;
  formulas.evaluate(values.data(), result.data(), 1, work);
  return result[0];
}
double valueOf(const std::string& text, double x, double y, double t) {
  return valueAt<double>(text, {x, y, t});
}
Slopes slopesOf(const std::string& text, double x, double y, double t) {
  return valueAt<Slopes>(text, {Slopes(x, 4, 0), Slopes(y, 4, 1), Slopes(t, 4, 2)});
}

struct Example {
  const char* text;
  double (*value)(double x, double y, double t);
};
#define EXAMPLE(text, value)                                                                      \
  {                                                                                               \
    text, [](double x, double y, double t) -> double { return (void)x, (void)y, (void)t, value; } \
  }
const Example examples[] = {
    EXAMPLE("-x^2", -(x* x)),
    EXAMPLE("2^-1", 0.5),
    EXAMPLE("2^3^2", 512),
    EXAMPLE("x - y - t", (x - y) - t),
    EXAMPLE("x/y/t", (x / y) / t),
    EXAMPLE("-2*3", -6),
    EXAMPLE("2*-x", -2 * x),
    EXAMPLE("2^-y^2", std::pow(2, -(y* y))),
    EXAMPLE("x < y < t", (x < y ? 1 : 0) < t),
    EXAMPLE("x == x && 0 || 1", 1),
    EXAMPLE("1 || 0 && 0", 1),
    EXAMPLE("x > 1 ? 2 : y < 0 ? 3 : t", x > 1 ? 2 : t),
    EXAMPLE("x < y + 5", 1),
    EXAMPLE("x <= y", x <= y),
    EXAMPLE("x >= y", x >= y),
    EXAMPLE("x != y", x != y),
    EXAMPLE("0.5e1*x + .25", 5 * x + 0.25),
    EXAMPLE("sin(x) + cos(y)*tan(t)", std::sin(x) + std::cos(y) * std::tan(t)),
    EXAMPLE("asin(x/9) + acos(y/9) - atan(t)", std::asin(x / 9) + std::acos(y / 9) - std::atan(t)),
    EXAMPLE("atan2(x, y)", std::atan2(x, y)),
    EXAMPLE("sinh(x) - cosh(y) + tanh(t)", std::sinh(x) - std::cosh(y) + std::tanh(t)),
    EXAMPLE("asinh(x) + acosh(2 + y) + atanh(t/9)", std::asinh(x) + std::acosh(2 + y) + std::atanh(t / 9)),
    EXAMPLE("exp(-x)*log(y) + ln(t) - log10(x) + log2(y)",
            std::exp(-x) * std::log(y) + std::log(t) - std::log10(x) + std::log2(y)),
    EXAMPLE("sqrt(x^2 + y^2)", std::hypot(x, y)),
    EXAMPLE("abs(x - y) + sign(y - x)", std::abs(x - y) + ((y > x) - (y < x))),
    EXAMPLE("min(x, y, t) + 2*max(x, y, t)", std::min({x, y, t}) + 2 * std::max({x, y, t})),
    EXAMPLE("rint(3*x) + x", std::floor(3 * x + 0.5) + x),
    EXAMPLE("x^y", std::pow(x, y)),
    EXAMPLE("x^2.5 + y^7 - t^-3", std::pow(x, 2.5) + std::pow(y, 7) - std::pow(t, -3)),
    EXAMPLE("(x + y)*(x - y)/(x*x + 1)", (x * x - y * y) / (x * x + 1)),
    EXAMPLE("pi*x + _pi*_e", M_PI* x + M_PI * M_E),
    EXAMPLE("((x))", x)};
#undef EXAMPLE

TEST(Formulas, haveTheValuesOfMathematics) {
  for (const auto& [text, function] : examples)
    for (const auto& [x, y, t] : {std::array{0.7, 1.3, 2.1}, {1.9, 0.4, 0.8}, {1.0, 1.0, 1.0}}) {
      const double expected = function(x, y, t);
      EXPECT_NEAR(parseExpression(text, "").value(x, y, t), expected, 1e-12 * (1 + std::abs(expected)))
          << text;
      EXPECT_NEAR(slopesOf(text, x, y, t).value(), expected, 1e-12 * (1 + std::abs(expected))) << text;
    }
}

// What is read of the operations: products with t, and times at which a datum may have kinks.
TEST(Formulas, knowTheirCourseInTime) {
  const auto formula = [](const std::string& text) { return *parseExpression(text, "").formula; };
  for (const char* text : {"t", "-10*t", "x*t/2", "sin(x)*t - 3*t", "(x < 0 ? 2 : 1)*t", "x < 0 ? t : 2*t"})
    EXPECT_TRUE(proportionalToTime(formula(text))) << text;
  for (const char* text : {"x", "t + 1", "t*t", "1/t", "sin(t)", "t < 1 ? t : 2*t", "min(t, 1)", "t^2"})
    EXPECT_FALSE(proportionalToTime(formula(text))) << text;
  EXPECT_EQ(kinksInTime(formula("t < 0.5 ? t : 1 - t")), std::vector{0.5});
  EXPECT_EQ(kinksInTime(formula("0.25 >= t ? x : y")), std::vector{0.25});
  EXPECT_EQ(kinksInTime(formula("min(t, 0.3) + max(t, 0.7)")), (std::vector{0.3, 0.7}));
  EXPECT_TRUE(kinksInTime(formula("x < 0.5 ? t : t^2")).empty());
}

TEST(Formulas, slopesAreThoseOfDifferences) {
  for (const auto& [text, function] : examples)
    for (const auto& point : {std::array{0.71, 1.3, 2.1}, {1.9, 0.43, 0.8}}) {
      const Slopes result = slopesOf(text, point[0], point[1], point[2]);
      for (int k = 0; k < 3; ++k) {
        constexpr double h = 1e-5;
        std::array<double, 3> above = point;
        std::array<double, 3> below = point;
        above[k] += h;
        below[k] -= h;
        const auto at = [&](const auto& p) { return valueOf(text, p[0], p[1], p[2]); };
        const double slope = (at(above) - at(below)) / (2 * h);
        EXPECT_NEAR(result.derivatives()[k], slope, 1e-7 * (1 + std::abs(slope))) << text << ", " << k;
      }
    }
}

// A block of points: each has its own answer, whatever the block holds beside it.
TEST(Formulas, pointsOfABlockAreIndependent) {
  Formulas formulas({"x", "y"}, {{"r", {"sqrt(x^2 + y^4)", ""}}});
  formulas.add({"r^2.5*x + (x > y ? exp(x) : y^-3)", ""});
  formulas.add({"atan2(x, r)", ""});
  std::vector<Slopes> values(2 * pointsAtOnce, Slopes(0));
  for (int i = 0; i < pointsAtOnce; ++i) {
    values[i] = Slopes(0.1 * (i - 5), 4, 0);
    values[pointsAtOnce + i] = Slopes(1 + 0.03 * i, 4, 1);
  }
  std::vector<Slopes> together(2 * pointsAtOnce, Slopes(0));
  std::vector<Slopes> work;
  formulas.evaluate(values.data(), together.data(), pointsAtOnce, work);
  for (int i = 0; i < pointsAtOnce; ++i) {
    std::vector<Slopes> own(2 * pointsAtOnce, Slopes(0));
    own[0] = values[i];
    own[pointsAtOnce] = values[pointsAtOnce + i];
    std::vector<Slopes> alone(2 * pointsAtOnce, Slopes(0));
    formulas.evaluate(own.data(), alone.data(), 1, work);
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(together[k * pointsAtOnce + i].value(), alone[k * pointsAtOnce].value()) << i;
      EXPECT_EQ(together[k * pointsAtOnce + i].derivatives(), alone[k * pointsAtOnce].derivatives()) << i;
    }
  }
}

TEST(Formulas, namedOnesMayHoldEachOther) {
  Formulas formulas({"x"},
                    {{"b", {"2*a", "b"}}, {"a", {"x + c", "a"}}, {"c", {"3", "c"}}, {"d", {"y", "d"}}});
  formulas.add({"a*b", ""});
  formulas.add({"c", ""});
  EXPECT_TRUE(formulas.dependsOn(0));
  std::array<double, 2 * pointsAtOnce> results{};
  std::vector<double> work;
  const double x = 2.0;
  formulas.evaluate(&x, results.data(), 1, work);
  EXPECT_EQ(results[0], 50);
  EXPECT_EQ(results[pointsAtOnce], 3);
}

TEST(Formulas, rejectsInOneLine) {
  const auto messageOf = [](const std::string& text) -> std::string {
    Formulas formulas({"x"}, {{"a", {"b + 1", "a"}}, {"b", {"a", "b"}}});
    try {
      formulas.add({text, "here"});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(messageOf("x + foo*2"),
            "here, expected an expression in x, a, b (unknown name foo, at character 5)");
  EXPECT_EQ(messageOf("a"), "b, expected an expression in x, a, b (a depends on itself, at character 2)");
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "(";
  std::string tower = "x";
  for (int i = 0; i < 100000; ++i) tower += "^x";
  for (const std::string& text : {std::string(),
                                  std::string(" "),
                                  std::string("x +"),
                                  std::string("(x"),
                                  std::string("x)"),
                                  std::string("x y"),
                                  std::string("x = 1"),
                                  std::string("sin x"),
                                  std::string("sin()"),
                                  std::string("sin(x, x)"),
                                  std::string("atan2(x)"),
                                  std::string("1e999"),
                                  std::string("x ? 1"),
                                  std::string("x ** 2"),
                                  std::string("--x"),
                                  std::string("x, x"),
                                  std::string("\x01"),
                                  std::string("x\0y", 3),
                                  deep,
                                  tower}) {
    const std::string message = messageOf(text);
    EXPECT_EQ(message.find("here, expected an expression in x, a, b ("), 0u) << text.substr(0, 20);
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

}  // namespace mortier::formulas_test
