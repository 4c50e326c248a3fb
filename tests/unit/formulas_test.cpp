#include "scene/formulas.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "scene/expression.h"

namespace mortier {
namespace {

/// Of x, y and t.
template <int n>
Dual<n> valueOf(const std::string& text, double x, double y, double t) {
  Formulas formulas({"x", "y", "t"}, {});
  formulas.add({text, text});
  std::array<Dual<n>, 3> values{x, y, t};
  for (int k = 0; k < std::min(n, 3); ++k) values[k].slope[k] = 1;
  Dual<n> result;
  std::vector<Dual<n>> work;
  formulas.evaluate(values.data(), &result, work);
  return result;
}

const char* const texts[] = {"-x^2",
                             "2^-1",
                             "2^3^2",
                             "x - y - t",
                             "x/y/t",
                             "-2*3",
                             "2*-x",
                             "2^-y^2",
                             "x < y < t",
                             "x == x && 0 || 1",
                             "1 || 0 && 0",
                             "x > 1 ? 2 : y < 0 ? 3 : t",
                             "x < y + 5",
                             "x <= y",
                             "x >= y",
                             "x != y",
                             "0.5e1*x + .25",
                             "sin(x) + cos(y)*tan(t)",
                             "asin(x/9) + acos(y/9) - atan(t)",
                             "atan2(x, y)",
                             "sinh(x) - cosh(y) + tanh(t)",
                             "asinh(x) + acosh(2 + y) + atanh(t/9)",
                             "exp(-x)*log(y) + ln(t) - log10(x) + log2(y)",
                             "sqrt(x^2 + y^2)",
                             "abs(x - y) + sign(y - x)",
                             "min(x, y, t) + 2*max(x, y, t)",
                             "rint(3*x) + x",
                             "x^y",
                             "x^2.5 + y^7 - t^-3",
                             "(x + y)*(x - y)/(x*x + 1)",
                             "pi*x + _pi*_e",
                             "((x))"};

// The language is that of all other expressions.
TEST(Formulas, agreeWithMuParser) {
  for (const std::string text : texts)
    for (const auto& [x, y, t] : {std::array{0.7, 1.3, 2.1}, {1.9, 0.4, 0.8}, {1.0, 1.0, 1.0}}) {
      const double expected = parseExpression(text, "").value(x, y, t);
      EXPECT_NEAR(valueOf<0>(text, x, y, t).value, expected, 1e-12 * (1 + std::abs(expected))) << text;
    }
}

TEST(Formulas, slopesAreThoseOfDifferences) {
  for (const std::string text : texts)
    for (const auto& point : {std::array{0.71, 1.3, 2.1}, {1.9, 0.43, 0.8}}) {
      const Dual<4> result = valueOf<4>(text, point[0], point[1], point[2]);
      for (int k = 0; k < 3; ++k) {
        constexpr double h = 1e-5;
        std::array<double, 3> above = point;
        std::array<double, 3> below = point;
        above[k] += h;
        below[k] -= h;
        const auto at = [&](const auto& p) { return valueOf<0>(text, p[0], p[1], p[2]).value; };
        const double slope = (at(above) - at(below)) / (2 * h);
        EXPECT_NEAR(result.slope[k], slope, 1e-7 * (1 + std::abs(slope))) << text << ", " << k;
      }
    }
}

TEST(Formulas, haveNoSlopeWhereTheirArgumentHasNone) {
  const Dual<4> mises = valueOf<4>("sqrt(x^2 + y^2)", 0, 0, 0);
  EXPECT_EQ(mises.value, 0);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(mises.slope[k], 0);
  const Dual<4> flow = valueOf<4>("max(0, 1 - 2/sqrt(x^2 + y^2))*x", 0, 0, 0);
  EXPECT_EQ(flow.value, 0);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(flow.slope[k], 0);
}

TEST(Formulas, namedOnesMayHoldEachOther) {
  Formulas formulas({"x"},
                    {{"b", {"2*a", "b"}}, {"a", {"x + c", "a"}}, {"c", {"3", "c"}}, {"d", {"y", "d"}}});
  formulas.add({"a*b", ""});
  formulas.add({"c", ""});
  EXPECT_TRUE(formulas.dependsOn(0));
  std::array<Dual<0>, 2> results;
  std::vector<Dual<0>> work;
  const Dual<0> x = 2.0;
  formulas.evaluate(&x, results.data(), work);
  EXPECT_EQ(results[0].value, 50);
  EXPECT_EQ(results[1].value, 3);
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

}  // namespace
}  // namespace mortier
