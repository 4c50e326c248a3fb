#include "fem/data_misfit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/body.h"
#include "material/deviatoric.h"
#include "material/elasticity.h"
#include "scene/expression.h"

namespace mortier::data_misfit_test {

constexpr double pi = std::numbers::pi;

/// A datum with what its text says about it.
Datum datumOf(const std::string& text, Function value) {
  Datum datum(std::move(value));
  describe(*parseExpression(text, "").formula, false, datum);
  return datum;
}

Datum unit(std::function<double(double)> value) {
  return Datum(Function([value](double x, double, double) { return value(x); }));
}

double meanOn(const Datum& datum, double from, double to) {
  return onEdge(datum, {{from, 0}, {to, 0}}, 0).mean();
}

TEST(Datum, knowsItsDegreeInSpace) {
  const auto degree = [](const std::string& text) {
    return datumOf(text, [](double, double, double) { return 0.0; }).degree;
  };
  EXPECT_EQ(degree("sin(t)"), 0);
  EXPECT_EQ(degree("t<0.5 ? 3 : t^2*(x-2*y)/7"), 1);
  EXPECT_EQ(degree("(x+1)*(y-t)"), 2);
  EXPECT_EQ(degree("x^3-x"), 3);
  for (const char* text : {"x<0.5", "1/x", "exp(x)", "abs(x)", "x<t ? 1 : 2", "2^x", "x^0.5"})
    EXPECT_EQ(degree(text), Datum::anyDegree) << text;
}

TEST(Datum, enclosureHoldsAllValues) {
  struct Case {
    const char* text;
    Function value;
  };
  const Case cases[] = {
      {"sin(3*x)*cos(y)-t", [](double x, double y, double t) { return std::sin(3 * x) * std::cos(y) - t; }},
      {"exp(-(x-0.3)^2/0.01)+x/(2+y)",
       [](double x, double y, double) { return std::exp(-(x - 0.3) * (x - 0.3) / 0.01) + x / (2 + y); }},
      {"(x<0.4 && y>0.1) ? x^3 : -abs(y-0.5)",
       [](double x, double y, double) { return x < 0.4 && y > 0.1 ? x * x * x : -std::abs(y - 0.5); }},
      {"max(x,y)^2-min(x,2*y)+sqrt(x+y)",
       [](double x, double y, double) {
         return std::pow(std::max(x, y), 2) - std::min(x, 2 * y) + std::sqrt(x + y);
       }},
      {"tanh(x-y)*atan(4*x)+cosh(y-0.5)",
       [](double x, double y, double) { return std::tanh(x - y) * std::atan(4 * x) + std::cosh(y - 0.5); }}};
  constexpr double rounding = 1e-14;
  for (const Case& each : cases) {
    const Datum datum = datumOf(each.text, each.value);
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j) {
        const Box box{{i / 8.0, (i + 1) / 8.0}, {j / 8.0, (j + 1) / 8.0}, {0, 0.5}};
        const Interval range = datum.enclosure(box);
        for (int k = 0; k <= 4; ++k)
          for (int l = 0; l <= 4; ++l) {
            const double value = datum((i + k / 4.0) / 8, (j + l / 4.0) / 8, k / 8.0);
            EXPECT_GE(value, range.least - rounding) << each.text;
            EXPECT_LE(value, range.largest + rounding) << each.text;
          }
      }
  }
}

TEST(AdaptiveQuadrature, meansAreThoseOfKinksJumpsAndWaves) {
  constexpr double close = 1e-9;
  EXPECT_NEAR(meanOn(unit([](double x) { return x < 0.1 ? 1 : 0; }), 0, 1), 0.1, close);
  EXPECT_NEAR(meanOn(unit([](double x) { return std::abs(x - 1 / std::sqrt(7)); }), 0, 1),
              (1.0 / 7 + std::pow(1 - 1 / std::sqrt(7), 2)) / 2, close);
  EXPECT_NEAR(meanOn(unit([](double x) { return std::pow(std::sin(40 * pi * x), 2); }), 0, 0.5), 0.5, close);
  EXPECT_NEAR(meanOn(unit([](double x) { return std::sqrt(x); }), 0, 1), 2.0 / 3, close);
}

TEST(AdaptiveQuadrature, anEnclosureFindsAPeakBetweenPoints) {
  const Datum peak = datumOf("exp(-((x-0.123456)/1e-5)^2)", [](double x, double, double) {
    return std::exp(-std::pow((x - 0.123456) / 1e-5, 2));
  });
  EXPECT_NEAR(meanOn(peak, 0, 1) / (1e-5 * std::sqrt(pi)), 1, 1e-5);
}

TEST(AdaptiveQuadrature, whatIsBeyondTheBudgetIsNamed) {
  const ResolvedEdge wild =
      onEdge(unit([](double x) { return std::sin(1e7 * x) + std::sin(std::sqrt(2) * 1e7 * x); }),
             {{0, 0}, {1, 0}}, 0);
  EXPECT_FALSE(wild.complete());
  const ResolvedEdge jump = onEdge(unit([](double x) { return x < 0.1 ? 1 : 0; }), {{0, 0}, {1, 0}}, 0);
  EXPECT_TRUE(jump.complete());
}

TEST(AdaptiveQuadrature, trianglesSeeJumps) {
  const Datum jump(Function([](double x, double, double) { return x < 0.25 ? 1 : 0; }));
  // The part of the triangle with x < 1/4.
  EXPECT_NEAR(onTriangle(jump, {{0, 0}, {1, 0}, {0, 1}}, 0).mean(), 1 - 0.75 * 0.75, 2e-3);
  const Datum wave(Function([](double x, double y, double) { return std::sin(9 * x) * std::exp(y); }));
  // integral over the unit triangle of sin(9x) (e^(1-x) - 1), times 2
  const double byParts = (std::exp(1) * 9 - std::sin(9.0) - 9 * std::cos(9.0)) / 82;
  EXPECT_NEAR(onTriangle(wave, {{0, 0}, {1, 0}, {0, 1}}, 0).mean(), 2 * (byParts - (1 - std::cos(9.0)) / 9),
              1e-6);
}

TEST(Misfit, ofAWaveIsItsSize) {
  const double k = 8 * pi;
  const ResolvedEdge wave = onEdge(unit([k](double x) { return std::sin(k * x); }), {{0, 0}, {0.5, 0}}, 0);
  const Misfit w = interpolationMisfit(wave, {0, 0, 0}, 1);
  EXPECT_NEAR(w.square, 0.5, 1e-8);
  // W = -cos/k on the edge, of length 1/2
  EXPECT_NEAR(w.primitive, 0.5 / (k / 2 * k / 2), 0.05 * w.primitive);
  EXPECT_NEAR(w.slope, k * k / 4 / 2, 0.02 * k * k);
  const ResolvedEdge parabola = onEdge(unit([](double x) { return 1 - x + x * x; }), {{0, 0}, {2, 0}}, 0);
  EXPECT_LT(interpolationMisfit(parabola, {1, 3, 1}, 2).square, 1e-25);
}

TEST(Misfit, ofALineSeesWhatAlternates) {
  // Half a wave an edge: no continuous linear function has a part of it, though each mean is 2/pi.
  for (const int degree : {1, 2}) {
    std::vector<LineEdge> edges;
    const double k = degree * 8 * pi;
    for (int e = 0; e < 8; ++e)
      edges.push_back(
          {onEdge(unit([k](double x) { return std::sin(k * x); }), {{e / 8.0, 0}, {(e + 1) / 8.0, 0}}, 0),
           {e, e + 1, degree > 1 ? 100 + e : -1},
           0.125});
    const auto seen = lineProjection(edges, degree);
    // Away from the ends of the line.
    for (const int e : {3, 4})
      EXPECT_LT(std::abs(seen[e][0]) + std::abs(seen[e][1]), degree == 1 ? 0.03 : 0.1) << degree;
  }
  // What is continuous is seen whole.
  std::vector<LineEdge> edges;
  const auto bent = [](double x) { return std::abs(x - 0.5) - x; };
  for (int e = 0; e < 4; ++e)
    edges.push_back({onEdge(unit(bent), {{e / 4.0, 0}, {(e + 1) / 4.0, 0}}, 0), {e, e + 1, -1}, 0.25});
  const auto seen = lineProjection(edges, 1);
  for (int e = 0; e < 4; ++e)
    for (const int end : {0, 1}) EXPECT_NEAR(seen[e][end], bent((e + end) / 4.0), 1e-8);
}

/// Two triangles on the unit square, label 3 on top.
Body square(Conditions conditions, int degree, bool axisymmetric = false) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.regions = {0, 0};
  mesh.boundaryEdges = {{2, 3}};
  mesh.boundaryLabels = {3};
  return {"square",
          std::move(mesh),
          axisymmetric ? elasticMaterial({1, 0.3}, Plane::strain) : elasticMaterial({1, 0.3}),
          std::move(conditions),
          degree,
          axisymmetric};
}

/// The resultant, and the moment of the vertical forces about the origin.
Point sums(const Body& body) {
  const Vector f = body.load(1);
  Point result(0, 0);
  for (int node = 0; node < body.nodes(); ++node)
    result += f[2 * node + 1] * Point(1, body.elementNodes().places[node].x());
  return result;
}

TEST(Loads, areTheIntegralsOfTheData) {
  const Datum jump(Function([](double x, double, double t) { return x < 0.1 ? -20 * t : 0; }));
  for (const int degree : {1, 2}) {
    const Point onLine = sums(square({{}, {{3, alongY, jump}}, {}}, degree));
    EXPECT_NEAR(onLine.x(), -2, 1e-8);
    EXPECT_NEAR(onLine.y(), -0.1, 1e-8);
    const Point inBody = sums(square({{}, {}, {{1, jump}}}, degree));
    EXPECT_NEAR(inBody.x(), -2, 0.02);
    EXPECT_NEAR(inBody.y(), -0.1, 0.02);
    const double ring = sums(square({{}, {{3, alongY, jump}}, {}}, degree, true)).x();
    EXPECT_NEAR(ring, -20 * pi * 0.01, 1e-7);
  }
}

TEST(Loads, ofLinearDataAreThoseOfTheRule) {
  const Function linear = [](double x, double y, double t) { return t * (1 + 2 * x - y); };
  for (const int degree : {1, 2}) {
    const Body known = square({{}, {{3, alongNormal, datumOf("t*(1+2*x-y)", linear)}}, {}}, degree);
    const Body unknown = square({{}, {{3, alongNormal, Datum(linear)}}, {}}, degree);
    EXPECT_LT((known.load(0.3) - unknown.load(0.3)).norm(), 1e-14);
  }
}

TEST(InitialStress, isTheMeanOfTriangles) {
  const Datum parabola(Function([](double, double y, double) { return y * y; }));
  for (const int degree : {1, 2}) {
    Conditions conditions;
    conditions.initialStresses.push_back({1, std::nullopt, parabola});
    const Body body = square(std::move(conditions), degree);
    const Matrix stress = body.initialStress();
    double sum = 0;  // s22 = (p - q)/sqrt2
    for (int i = 0; i < body.points(); ++i)
      sum += body.weights()[i] * (stress(0, i) - stress(1, i)) / std::numbers::sqrt2;
    EXPECT_NEAR(sum, 1.0 / 3, 1e-9);
  }
}

}  // namespace mortier::data_misfit_test
