// Quadrature rules integrate the polynomials of their degree exactly.
#include "base/quadrature_rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace mortier {
namespace {

constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

template <class Rule>
double onEdge(const Rule& rule, int power) {
  double sum = 0;
  for (const auto& [at, weight] : rule) sum += weight * std::pow(at, power);
  return sum;
}

/// Of a^i b^j c^k over the area.
template <class Rule>
double onTriangle(const Rule& rule, int i, int j, int k) {
  double sum = 0;
  for (const auto& [at, weight] : rule)
    sum += weight * std::pow(at[0], i) * std::pow(at[1], j) * std::pow(at[2], k);
  return sum;
}
/// 2 i! j! k!/(i + j + k + 2)!
double exactly(int i, int j, int k) {
  return 2 * std::tgamma(i + 1) * std::tgamma(j + 1) * std::tgamma(k + 1) / std::tgamma(i + j + k + 3);
}

template <class Rule>
void expectDegreeOnEdge(const Rule& rule, int degree) {
  for (int power = 0; power <= degree; ++power) EXPECT_NEAR(onEdge(rule, power), 1.0 / (power + 1), rounding);
  EXPECT_GT(std::abs(onEdge(rule, degree + 1) - 1.0 / (degree + 2)), 1e-8);
}

template <class Rule>
void expectDegreeOnTriangle(const Rule& rule, int degree) {
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j)
      for (int k = 0; i + j + k <= degree; ++k)
        EXPECT_NEAR(onTriangle(rule, i, j, k), exactly(i, j, k), rounding) << i << " " << j << " " << k;
  EXPECT_GT(std::abs(onTriangle(rule, degree + 1, 0, 0) - exactly(degree + 1, 0, 0)), 1e-5);
}

TEST(QuadratureRules, areExactToTheirDegreeAndNotBeyond) {
  expectDegreeOnEdge(gaussThree, 5);
  expectDegreeOnEdge(gaussFour, 7);
  expectDegreeOnEdge(lobattoSeven, 11);
  expectDegreeOnTriangle(dunavantSix, 4);
  expectDegreeOnTriangle(radonSeven, 5);
}

}  // namespace
}  // namespace mortier
