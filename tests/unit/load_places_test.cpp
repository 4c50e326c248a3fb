#include <gtest/gtest.h>

#include <cmath>

#include "mesh/generate.h"
#include "mesh/shape.h"
#include "scene/expression.h"
#include "scene/load_courses.h"
#include "unit/scene_folder.h"

namespace mortier::load_places_test {

constexpr double end = 1;
const TimePlan plan{end};
constexpr int top = 3;

LoadPlaces placesOf(const std::string& text, const int* label = &top) {
  const TriangleMesh mesh = crissCrossMesh({{0, 0}, {1, 1}, 6, 6});
  return loadPlaces(parseExpression(text, "test"), mesh, label, plan);
}

LoadPlaces placesInCube(const std::string& text, const int* label = &top) {
  const TetrahedronMesh mesh = cuboidMesh({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}});
  return loadPlaces(parseExpression(text, "test", true), mesh, label, plan);
}

/// The largest value over the places and the times, beside those of a run in 500 equal parts.
double largest(const std::string& text, const LoadPlaces& places) {
  const Expression datum = parseExpression(text, "test", true);
  std::vector<double> times = places.times;
  for (int i = 0; i <= 500; ++i) times.push_back(end * i / 500);
  double most = 0;
  for (const SpacePoint& p : places.points)
    for (const double t : times) most = std::max(most, datum.value(p, t));
  return most;
}
double largest(const std::string& text, const int* label = &top) {
  return largest(text, placesOf(text, label));
}
double largestInCube(const std::string& text, const int* label = &top) {
  return largest(text, placesInCube(text, label));
}

TEST(LoadPlaces, degreesInTimeAreKnown) {
  const auto degree = [](const std::string& text) {
    return parseExpression(text, "test").value.degreeInTime;
  };
  EXPECT_EQ(degree("t*sqrt(x^2+y^2)"), 1);
  EXPECT_EQ(degree("-(3*t - 1)*exp(x)/y"), 1);
  EXPECT_EQ(degree("x*t+y*t*t"), 2);
  for (const char* text : {"sin(t)", "x/t", "t < 0.5 ? x : 1", "abs(t-x)", "max(t, x)"})
    EXPECT_GT(degree(text), 2) << text;
}

// No peak is looked for in a datum that grows along a straight line everywhere.
TEST(LoadPlaces, dataThatAreLinearInTimeAreReadAtTheirEnds) {
  int calls = 0;
  Expression datum = parseExpression("t*sin(20*x)", "test");
  datum.value.value = [&calls, value = datum.value.value](const SpacePoint& x, double t) {
    ++calls;
    return value(x, t);
  };
  const TriangleMesh mesh = crissCrossMesh({{0, 0}, {1, 1}, 6, 6});
  EXPECT_EQ(loadPlaces(datum, mesh, &top, plan).points.size(), 1);
  EXPECT_LE(calls, 2 * 2 * 9 * 6);
}

TEST(LoadPlaces, oneWhereAllCoursesAreAlike) {
  EXPECT_EQ(placesOf("-10*t").points.size(), 1);
  EXPECT_EQ(placesOf("-10*t*(1+x^2)").points.size(), 1);
  EXPECT_EQ(placesOf("x*t+y*t^2", nullptr).points.size(), 2);
}

TEST(LoadPlaces, partsOfAnEdgeAreSeen) {
  EXPECT_GT(largest("20*(x<0.1)*(0.05+exp(-((t-0.3717171)/0.004)^2))"), 19);
  EXPECT_GT(largest("(x<1e-4)*exp(-((t-0.3717171)/0.004)^2)"), 0.9);
  EXPECT_GT(largest("(x>0.52)*(x<0.5201)*t"), 0.9);
  EXPECT_GT(largest("(x-0.5)*(2/3-x)*t*(x>0.5)*(x<0.6667)*144"), 0.9);
}

TEST(LoadPlaces, forcesOnAPartOfACellAreSeen) {
  EXPECT_GT(largest("(x>0.52)*(x<0.53)*(y<0.03)*exp(-((t-0.3717171)/0.004)^2)", nullptr), 0.9);
}

TEST(LoadPlaces, peaksOfAnyLengthAreSeen) {
  EXPECT_GT(largest("exp(-((t-0.3717171)/1e-6)^2)"), 0.9);
  EXPECT_GT(largest("20*(x<0.1)*(0.05+exp(-((t-0.37)/1e-6)^2))"), 19);
  EXPECT_GT(largest("(1+x)*exp(-((t-0.37)/1e-6)^2)"), 1.8);
  EXPECT_GT(largest("exp(-((t-0.3-x/5)/1e-5)^2)"), 0.9);
  EXPECT_GT(largest("(x>0.52)*(x<0.56)*(y<0.03)*exp(-((t-0.3717171)/1e-6)^2)", nullptr), 0.9);
  EXPECT_GT(largest("t+(x<0.1)*(t>0.6123)*(t<0.61231)*7"), 6);
  EXPECT_TRUE(placesOf("sin(20*t)*(1+x)").times.empty());
}

TEST(LoadPlaces, facesAndBodiesInSpaceAreSeen) {
  EXPECT_EQ(placesInCube("-10*t*(1+x^2+z)").points.size(), 1);
  EXPECT_EQ(placesInCube("x*t+z*t^2", nullptr).points.size(), 2);
  EXPECT_GT(largestInCube("(x<1e-3)*(y>0.999)*exp(-((t-0.3717171)/0.004)^2)"), 0.9);
  EXPECT_GT(largestInCube("(x>0.52)*(x<0.53)*(y<0.03)*t"), 0.9);
  EXPECT_GT(largestInCube("(x>0.52)*(x<0.56)*(z<0.03)*exp(-((t-0.3717171)/1e-6)^2)", nullptr), 0.9);
  EXPECT_GT(largestInCube("exp(-((t-0.3-(x+y)/9)/1e-5)^2)"), 0.9);
  for (const SpacePoint& p : placesInCube("(x+y>0.52)*(x+y<0.53)*exp(-((t-0.3717171)/1e-6)^2)").points)
    EXPECT_EQ(p.z(), 1);  // no place beside the face
}

TEST(LoadPlaces, degreesInSpaceCountZ) {
  const auto datum = [](const std::string& text) { return parseExpression(text, "test", true).value; };
  EXPECT_EQ(datum("x*z*t").degree, 2);
  EXPECT_EQ(datum("t*z^3").degreeInTime, 1);
  const Interval range = datum("z-x").enclosure({{0, 1}, {0, 0}, {0, 0}, {2, 3}});
  EXPECT_NEAR(range.least, 1, 1e-12);
  EXPECT_NEAR(range.largest, 3, 1e-12);
}

class LoadCoursesOfParts : public SceneFolder {
 protected:
  LoadCoursesOfParts() : SceneFolder("load_places") {}
};

TEST_F(LoadCoursesOfParts, seePeaksInsideAnEdge) {
  write(R"toml([[body]]
name = "upper"
mesh = { shape = "rectangle", cells = [3, 3], lower = [0, 0], upper = [1, 1] }
material = { young = 1, poisson = 0.3 }
boundary = [{ label = 3, ty = "-0.1*t-exp(-((t-0.7654321)/1e-6)^2)*(abs(x-0.1)<0.05)" }]
[[body]]
name = "lower"
mesh = { shape = "rectangle", cells = [3, 3], lower = [0, -1], upper = [1, 0] }
material = { young = 1, poisson = 0.3 }
boundary = [{ label = 1, ux = 0, uy = 0 }]
)toml" + std::string(contactOfTwoBlocks) +
        "steps = 1\n");
  const SceneDescription scene = readScene(path());
  const LoadCourses courses = loadCourses(scene, modelOf(scene));
  double least = 0;
  for (const Course& course : courses.data)
    least = std::min(least, *std::min_element(course.values.begin(), course.values.end()));
  EXPECT_LT(least, -0.9);
}

}  // namespace mortier::load_places_test
