// Contact without dense matrices over its conditions against contact with them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <optional>

#include "base/error.h"
#include "theory/random_line.h"
#include "theory/random_scene.h"

namespace mortier::long_lines_test {

using namespace scenes;

constexpr double tolerance = 1e-10;

/// None where a bent line turns a quadratic triangle of a coarse mesh inside out.
std::optional<RandomLine> soundLine(unsigned seed, int cells) {
  try {
    return randomLine(seed, cells);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

TEST(LongLines, randomLinesAgreeWithDenseMatrices) {
  const char* asked = std::getenv("MORTIER_RANDOM_LINES");
  const int count = asked != nullptr ? std::atoi(asked) : 100;
  const int cells = asked != nullptr ? 40 : 14;
  double force = 0;
  double displacement = 0;
  int solved = 0;
  int otherEnd = 0;
  unsigned seed = 0;
  for (int drawn = 0; drawn < count; ++seed) {
    const std::optional<RandomLine> sound = soundLine(seed, cells);
    if (!sound) continue;
    ++drawn;
    const RandomLine& line = *sound;
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + line.words);
    const Difference difference = denseAndSparse(line);
    otherEnd += difference.sameEnd ? 0 : 1;
    EXPECT_LE(difference.force, tolerance);
    EXPECT_LE(difference.displacement, tolerance);
    force = std::max(force, difference.force);
    displacement = std::max(displacement, difference.displacement);
    solved += difference.converged ? 1 : 0;
  }
  EXPECT_GE(solved, count * 9 / 10);
  // Bodies around an axis that flow, and so keep their volume, are more than the sparse way can factorise.
  EXPECT_LE(otherEnd, count / 100);
  std::cout << count << " random lines, " << solved << " are solved both ways, " << otherEnd
            << " one way only: forces agree to " << force << ", displacements to " << displacement << "\n";
}

// By powers of two every number is scaled without rounding.
TEST(LongLines, unitsChangeNoIteration) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    const RandomLine line = randomLine(seed, 10);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + line.words);
    const RunReport report = runLine(line, sparseContact()).report;
    const RandomUnits units{.length = 0x1p-10, .stress = 0x1p30};
    const RunReport scaled = runLine(randomLine(seed, 10, units), sparseContact()).report;
    EXPECT_EQ(scaled.status, report.status);
    EXPECT_EQ(scaled.iterations, report.iterations);
    EXPECT_EQ(scaled.steps, report.steps);
  }
}

TEST(LongLines, randomScenesAgreeWithTrialOfAllActiveSets) {
  constexpr int count = 500;
  const SolverOptions options = sparseContact();
  double worst = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const RandomScene scene(seed);
    const Model model = scene.model();
    const auto exact = scene.solve(model.interfaces[0]);
    ASSERT_TRUE(exact.has_value());
    const auto [state, report] = run(model, 1, 1, options);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    const double force = (state.contactForce[0] - exact->p).cwiseAbs().maxCoeff() /
                         std::max(exact->scale, std::numeric_limits<double>::min());
    EXPECT_LE(force, 1e-9);
    worst = std::max(worst, force);
  }
  std::cout << count << " random scenes: forces agree to " << worst << "\n";
}

/// Both ways end alike; where they find a solution it is the same. \param unique  whether forces are.
Result expectSame(const Model& model, bool unique = true, double most = tolerance) {
  const Result dense = run(model, 1, 1, denseContact(tolerance));
  Result sparse = run(model, 1, 1, sparseContact());
  const Difference difference = differenceOf(dense, sparse);
  EXPECT_TRUE(difference.sameEnd) << dense.report.reason << sparse.report.reason;
  EXPECT_LE(difference.displacement, most);
  EXPECT_TRUE(!unique || difference.force <= tolerance) << difference.force;
  EXPECT_EQ(dense.report.special.idle, sparse.report.special.idle);
  return sparse;
}

Conditions onRollers() {
  return {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}};
}

Conditions pressed(double load) {
  return {{{left, 0, constant(0)}}, {{top, 1, constant(load)}}, {}};
}

/// A block of so many cells in one row on another one.
Model blocks(int upperCells, int lowerCells, Conditions upper, Conditions lower, double upperModulus = 100) {
  const auto mesh = [](double y, int cells) { return rectangleMesh({{0, y}, {4, y + 1}, cells, 1}); };
  Body above("upper", mesh(0, upperCells), elasticMaterial({upperModulus, 0.3}), std::move(upper));
  Body below("lower", mesh(-1, lowerCells), elasticMaterial({100, 0.3}), std::move(lower));
  return contactModel(std::move(above), std::move(below), CouplingKind::mortar, upperBody);
}

int closed(const Result& result) {
  int count = 0;
  for (const Vector& p : result.state.contactForce) count += static_cast<int>((p.array() > 0).count());
  return count;
}

TEST(LongLines, oneCellAllClosedAllOpen) {
  EXPECT_EQ(closed(expectSame(blocks(1, 1, pressed(-1), onRollers()))), 2);
  EXPECT_EQ(closed(expectSame(blocks(40, 30, pressed(-1), onRollers()))), 41);
  const Result lifted = expectSame(blocks(40, 30, pressed(1), onRollers()));
  EXPECT_NE(lifted.report.status, Status::converged);
  EXPECT_NE(lifted.report.reason.find("contact cannot hold"), std::string::npos) << lifted.report.reason;
  const Conditions raised{{{left, 0, constant(0)}, {top, 1, constant(0.1)}}, {}, {}};
  EXPECT_EQ(closed(expectSame(blocks(40, 30, raised, onRollers()))), 0);
}

TEST(LongLines, heldOnBothSidesAtOneEnd) {
  Conditions upper = pressed(-1);
  Conditions lower = onRollers();
  for (Conditions* conditions : {&upper, &lower}) conditions->displacements.push_back({left, 1, constant(0)});
  expectSame(blocks(12, 9, std::move(upper), std::move(lower)));
}

TEST(LongLines, interfaceGivenTwice) {
  Model model = blocks(12, 9, pressed(-1), onRollers());
  const Result once = expectSame(model);
  addInterface(model, {{upperBody, bottom}, {lowerBody, top}, CouplingKind::mortar});
  const Result twice = expectSame(model, false);
  const Vector sum = twice.state.contactForce[0] + twice.state.contactForce[1];
  const Vector& alone = once.state.contactForce[0];
  EXPECT_LE((sum - alone).cwiseAbs().maxCoeff(), tolerance * alone.maxCoeff());
}

TEST(LongLines, stiffLineFinerThanTheOther) {
  // Forces on the stiff line are those of a rigid one, which are not unique, but for a part in 1e8.
  expectSame(blocks(48, 4, pressed(-1), onRollers(), 1e10), false, 1e-8);
}

TEST(LongLines, closedLine) {
  const auto ring = [](const char* name, double inner, double outer, int cells, Conditions conditions) {
    return Body(name, annulusMesh({{0, 0}, inner, outer, 4, cells, 1}), elasticMaterial({100, 0.3}),
                std::move(conditions));
  };
  const Function pressure = [](double x, double, double) { return -1 - 0.9 * x; };
  Conditions outside{{{2, alongTangent, constant(0)}}, {{2, alongNormal, pressure}}, {}};
  Conditions inside{{{1, 0, constant(0)}, {1, 1, constant(0)}}, {}, {}};
  Model model;
  model.bodies.push_back(ring("outer", 1, 1.05, 64, std::move(outside)));
  model.bodies.push_back(ring("inner", 0.9, 1, 48, std::move(inside)));
  InterfaceOptions options;
  options.initial = InitialGap::close;
  addInterface(model, {{0, 1}, {1, 2}, CouplingKind::mortar}, options);
  EXPECT_GT(closed(expectSame(model)), 32);
}

TEST(LongLines, twoLinesBetweenTwoBodies) {
  // A beam over the gap between two blocks of one body.
  constexpr int topOfTheOther = 13;
  constexpr int between = 21;
  constexpr int overTheOther = 22;
  TriangleMesh lower = rectangleMesh({{0, -1}, {4, 0}, 4, 1});
  const TriangleMesh other = rectangleMesh({{8, -1}, {12, 0}, 5, 1});
  const auto shift = static_cast<int>(lower.vertices.size());
  lower.vertices.insert(lower.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) lower.triangles.push_back({a + shift, b + shift, c + shift});
  for (const auto& [a, b] : other.boundaryEdges) lower.boundaryEdges.push_back({a + shift, b + shift});
  lower.regions.insert(lower.regions.end(), other.regions.begin(), other.regions.end());
  for (const int label : other.boundaryLabels)
    lower.boundaryLabels.push_back(label == top ? topOfTheOther : label);
  TriangleMesh beam = rectangleMesh({{0, 0}, {12, 1}, 12, 1});
  for (size_t e = 0; e < beam.boundaryEdges.size(); ++e) {
    const auto& [a, b] = beam.boundaryEdges[e];
    const double x = (beam.vertices[a].x() + beam.vertices[b].x()) / 2;
    int& label = beam.boundaryLabels[e];
    if (label == bottom && x > 4) label = x < 8 ? between : overTheOther;
  }
  Model model;
  model.bodies.emplace_back("beam", beam, elasticMaterial({100, 0.3}),
                            Conditions{{{left, 0, constant(0)}}, {{top, 1, constant(-0.1)}}, {}});
  Conditions conditions{{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}};
  model.bodies.emplace_back("lower", lower, elasticMaterial({100, 0.3}), std::move(conditions));
  addInterface(model, {{0, bottom}, {1, top}, CouplingKind::mortar});
  addInterface(model, {{0, overTheOther}, {1, topOfTheOther}, CouplingKind::interpolation});
  const Result result = expectSame(model);
  EXPECT_NEAR(result.state.contactForce[0].sum() + result.state.contactForce[1].sum(), 1.2, 1e-9);
}

}  // namespace mortier::long_lines_test
