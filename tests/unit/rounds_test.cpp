#include "adapt/rounds.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/interrupt.h"
#include "mesh/generate.h"

namespace mortier::rounds_test {

ResolvedScene sceneOf(double accuracy) {
  ResolvedScene scene;
  scene.description.bodies.emplace_back();
  scene.description.accuracy.energy = accuracy;
  scene.meshes = {crissCrossMesh({.lower = {0, 0}, .upper = {1, 1}, .cellsX = 2, .cellsY = 2})};
  return scene;
}

RoundResult resultOf(const Rounds& rounds, double error) {
  const auto triangles = static_cast<Eigen::Index>(rounds.scene().meshes[0].triangles.size());
  return {{Vector::Constant(triangles, error * error / static_cast<double>(triangles))}, 1, 0, 1};
}
TEST(Rounds, oneRefinementIsMadeBeforeAnEstimateIsTrusted) {
  Rounds rounds(sceneOf(0.1));
  const size_t before = rounds.scene().meshes[0].triangles.size();
  EXPECT_EQ(rounds.judge(resultOf(rounds, 0.001), 1), Rounds::Verdict::goOn);
  EXPECT_GT(rounds.scene().meshes[0].triangles.size(), before);
  EXPECT_EQ(rounds.judge(resultOf(rounds, 0.001), 1), Rounds::Verdict::reached);
}

// The recovered stress of coarse meshes misses more of the error.
TEST(Rounds, largeErrorsHaveALargerMargin) {
  for (const auto& [asked, part] : {std::pair(0.005, 0.85), std::pair(0.05, 0.76), std::pair(0.3, 0.65)}) {
    const auto second = [asked = asked](double estimate) {
      Rounds rounds(sceneOf(asked));
      EXPECT_EQ(rounds.judge(resultOf(rounds, 4 * asked), 1), Rounds::Verdict::goOn);
      return rounds.judge(resultOf(rounds, estimate), 1);
    };
    EXPECT_EQ(second((part + 0.05) * asked), Rounds::Verdict::goOn) << asked;
    EXPECT_EQ(second(part * asked), Rounds::Verdict::reached) << asked;
  }
}

TEST(Rounds, aBoundHasToBeSmallEnoughToo) {
  Rounds rounds(sceneOf(0.1));
  int asked = 0;
  const auto judge = [&](double error, std::optional<double> bound) {
    RoundResult result = resultOf(rounds, error);
    result.bound = [&asked, bound] {
      ++asked;
      return bound;
    };
    return rounds.judge(result, 1);
  };
  EXPECT_EQ(judge(0.05, 0.15), Rounds::Verdict::goOn);  // the first meshes
  EXPECT_EQ(judge(0.095, 0.15), Rounds::Verdict::goOn);
  EXPECT_EQ(asked, 0);
  const size_t before = rounds.scene().meshes[0].triangles.size();
  EXPECT_EQ(judge(0.05, 0.15), Rounds::Verdict::goOn);
  EXPECT_EQ(asked, 1);
  EXPECT_GT(rounds.scene().meshes[0].triangles.size(), before);
  EXPECT_EQ(judge(0.04, 0.12), Rounds::Verdict::goOn);  // three times the estimate again: not asked for
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(judge(0.02, 0.1), Rounds::Verdict::reached);
  EXPECT_EQ(asked, 2);
}

// Bounds of coarse meshes are many times the error, and fall faster.
TEST(Rounds, aBoundThatWasFarTooLargeIsAskedForAgain) {
  Rounds rounds(sceneOf(0.1));
  const auto judge = [&](double error, double bound) {
    RoundResult result = resultOf(rounds, error);
    result.bound = [bound] { return bound; };
    return rounds.judge(result, 1);
  };
  EXPECT_EQ(judge(0.2, 5), Rounds::Verdict::goOn);
  EXPECT_EQ(judge(0.05, 5), Rounds::Verdict::goOn);
  EXPECT_EQ(judge(0.02, 0.08), Rounds::Verdict::reached);
}

TEST(Rounds, whereThereIsNoBoundTheEstimateEndsThem) {
  Rounds rounds(sceneOf(0.1));
  EXPECT_EQ(rounds.judge(resultOf(rounds, 0.5), 1), Rounds::Verdict::goOn);
  RoundResult result = resultOf(rounds, 0.05);
  result.bound = [] { return std::nullopt; };
  EXPECT_EQ(rounds.judge(result, 1), Rounds::Verdict::reached);
}

TEST(Rounds, errorsThatAreNothingButRoundingEndAfterOneRefinement) {
  Rounds rounds(sceneOf(0.1));
  EXPECT_EQ(rounds.judge(resultOf(rounds, 0), 1), Rounds::Verdict::goOn);
  EXPECT_EQ(rounds.judge(resultOf(rounds, 0), 1), Rounds::Verdict::reached);
}

ResolvedScene aimedScene(double tolerance) {
  ResolvedScene scene = sceneOf(0);
  scene.description.accuracy.quantity = "q";
  scene.description.accuracy.tolerance = tolerance;
  return scene;
}

/// With all of the error in the first triangle.
RoundResult aimedAt(const Rounds& rounds, double value, double error, bool proved) {
  RoundResult result = resultOf(rounds, 0.5);
  result.aim = AimedError{"", value, error, proved, {Vector::Zero(result.errors[0].size())}};
  result.aim->parts[0][0] = 7;
  return result;
}

TEST(Rounds, aProvedErrorOfAQuantityIsBelievedAtOnce) {
  Rounds rounds(aimedScene(0.1));
  EXPECT_EQ(rounds.judge(aimedAt(rounds, -2, 0.19, true), 1), Rounds::Verdict::reached);
  EXPECT_NEAR(rounds.meshError(), 0.095, 1e-12);
  Rounds other(aimedScene(0.1));
  EXPECT_EQ(other.judge(aimedAt(other, 2, 0.05, false), 1), Rounds::Verdict::goOn);
  EXPECT_EQ(other.judge(aimedAt(other, 2, 0.05, false), 1), Rounds::Verdict::reached);
}

TEST(Rounds, meshesAreRefinedWhereTheErrorOfAQuantityIs) {
  Rounds rounds(aimedScene(0.1));
  const TriangleMesh before = rounds.scene().meshes[0];
  ASSERT_EQ(rounds.judge(aimedAt(rounds, 1, 0.4, true), 1), Rounds::Verdict::goOn);
  const TriangleMesh after = rounds.scene().meshes[0];
  EXPECT_GT(after.triangles.size(), before.triangles.size());
  const auto& v = before.triangles[0];
  const Point centre = (before.vertices[v[0]] + before.vertices[v[1]] + before.vertices[v[2]]) / 3;
  const double size = std::sqrt(doubleArea(before, 0));
  for (size_t i = before.vertices.size(); i < after.vertices.size(); ++i)
    EXPECT_LE((after.vertices[i] - centre).norm(), 2 * size);
}

TEST(Rounds, whereNothingIsKnownOfAQuantityTheyEndAndSayWhy) {
  Rounds rounds(aimedScene(0.1));
  RoundResult result = aimedAt(rounds, 1, 0.4, false);
  result.aim->obstacle = "a line is curved";
  EXPECT_EQ(rounds.judge(result, 1), Rounds::Verdict::notReached);
  EXPECT_EQ(rounds.reason(), "a line is curved");
  Rounds zero(aimedScene(0.1));
  EXPECT_EQ(zero.judge(aimedAt(zero, 0, 0.4, true), 1), Rounds::Verdict::notReached);
  EXPECT_NE(zero.reason().find("the quantity is 0"), std::string::npos);
}

TEST(Rounds, reachesAreEqual) {
  // 0.46 over 0.75 of 0.0775 is 8: log 8/log 3 = 1.9, two rounds that divide by 2.83 each; at degree 1 that
  // is eight times the triangles.
  Rounds rounds(sceneOf(0.1));
  const double before = static_cast<double>(rounds.scene().meshes[0].triangles.size());
  EXPECT_EQ(rounds.judge(resultOf(rounds, 0.46), 1), Rounds::Verdict::goOn);
  EXPECT_NEAR(static_cast<double>(rounds.scene().meshes[0].triangles.size()) / before, 8, 0.01);
}

TEST(Rounds, limitsEndThemAndTheMeshesAreThoseThatWereSolved) {
  for (const bool seconds : {true, false}) {
    ResolvedScene scene = sceneOf(0.01);
    (seconds ? scene.description.accuracy.maxSeconds : scene.description.accuracy.maxUnknowns) = 30;
    Rounds rounds(std::move(scene));
    const size_t before = rounds.scene().meshes[0].triangles.size();
    EXPECT_EQ(rounds.judge(resultOf(rounds, 0.5), 29.9), Rounds::Verdict::notReached);
    EXPECT_NE(rounds.reason().find(seconds ? "max_seconds" : "max_unknowns"), std::string::npos);
    EXPECT_EQ(rounds.scene().meshes[0].triangles.size(), before);
  }
}

TEST(Rounds, refinementEndsAtAnInterruptionAndWhenTheTimeIsUp) {
  Rounds rounds(sceneOf(0.01));
  const size_t before = rounds.scene().meshes[0].triangles.size();
  interruption::requested = true;
  EXPECT_THROW(rounds.judge(resultOf(rounds, 1), 1), Interrupted);
  interruption::requested = false;
  Rounds late(sceneOf(0.01));
  const TimeLimit over(0);
  EXPECT_EQ(late.judge(resultOf(late, 1), 1), Rounds::Verdict::notReached);
  EXPECT_EQ(late.reason(), "a further round would take more than max_seconds");
  EXPECT_EQ(late.scene().meshes[0].triangles.size(), before);
}

TEST(Rounds, aLimitIsUsedAsFarAsItGoes) {
  ResolvedScene scene = sceneOf(1e-4);
  scene.description.accuracy.maxUnknowns = 200;
  Rounds rounds(std::move(scene));
  EXPECT_EQ(rounds.judge(resultOf(rounds, 0.5), 1), Rounds::Verdict::goOn);
  EXPECT_LE(2 * rounds.scene().meshes[0].vertices.size(), 200U);
}

TEST(Rounds, errorsThatDoNotFallEndThem) {
  Rounds rounds(sceneOf(0.01));
  int done = 0;
  while (rounds.judge(resultOf(rounds, 0.5), 1) == Rounds::Verdict::goOn) ASSERT_LT(++done, 7);
  EXPECT_NE(rounds.reason().find("does not fall"), std::string::npos);
}

// Where bodies flow, steps get a part of what is asked, and early rounds are short in time too.
TEST(Rounds, toleranceOfStepsFollowsTheMeshes) {
  ResolvedScene scene = sceneOf(0.01);
  scene.description.bodies[0].material.flow = Viscoplasticity{};
  Rounds rounds(std::move(scene));
  EXPECT_EQ(rounds.scene().description.time.tolerance, 0.1);
  RoundResult result = resultOf(rounds, 0.2);
  result.time = 0.05;
  EXPECT_EQ(rounds.judge(result, 1), Rounds::Verdict::goOn);
  EXPECT_NEAR(rounds.scene().description.time.tolerance, 0.08, 1e-12);
  result = resultOf(rounds, 0.006);
  result.time = 0.05;
  EXPECT_EQ(rounds.judge(result, 1), Rounds::Verdict::goOn);
  EXPECT_NEAR(rounds.scene().description.time.tolerance, 0.002, 1e-12);
  result = resultOf(rounds, 0.006);
  result.time = 0.0015;
  EXPECT_EQ(rounds.judge(result, 1), Rounds::Verdict::reached);
}

// Bodies that touch between their nodes have no stress on the first meshes.
TEST(Rounds, errorsBeyondTheSolutionMayStayForSixRounds) {
  Rounds rounds(sceneOf(0.1));
  const auto judge = [&] {
    RoundResult result = resultOf(rounds, 0);
    result.errors[0][0] = 1e6;  // in one triangle, so that meshes stay small
    return rounds.judge(result, 1);
  };
  for (int round = 0; round < 6; ++round) ASSERT_EQ(judge(), Rounds::Verdict::goOn) << round;
  EXPECT_EQ(judge(), Rounds::Verdict::notReached);
}

TEST(Rounds, anInfiniteErrorEndsThem) {
  Rounds rounds(sceneOf(0.1));
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(rounds.judge(resultOf(rounds, infinity), 1), Rounds::Verdict::notReached);
  EXPECT_NE(rounds.reason().find("finite energy"), std::string::npos);
}

}  // namespace mortier::rounds_test
