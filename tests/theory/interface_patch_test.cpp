// The patch test where Gamma_C is no horizontal line, and the cases where conditions meet.
#include <gtest/gtest.h>

#include <iostream>
#include <random>

#include "theory/stacks.h"

namespace mortier::interface_patch_test {

using namespace scenes;
using namespace stacks;

// About twice what is found.
constexpr double stressTolerance = 2e-13;  // of the pressure
constexpr double imbalanceLimit = 1e-15;
constexpr CouplingKind mortar = CouplingKind::mortar;

void expectPatch(const Model& model, double& worst) {
  const auto [state, report] = run(model, 1, 1);
  ASSERT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_EQ(report.iterations, 1);
  const double error = patchError(model, state);
  EXPECT_LE(error, stressTolerance);
  EXPECT_LE(imbalance(model, state), imbalanceLimit);
  worst = std::max(worst, error);
}

TEST(InterfacePatch, slopedLine) {
  double worst = 0;
  for (int degrees = 0; degrees < 90; ++degrees)
    for (const bool upperNonmortar : {true, false})
      for (const SideConditions sides : {SideConditions::pressed, SideConditions::held})
        expectPatch(stack({4, 7}, turned(degrees * pi / 180), mortar, upperNonmortar, sides), worst);
  std::cout << "sloped by 0 to 89 degrees: stress error at most " << worst << "\n";
}

// Corners at nodes of both meshes.
TEST(InterfacePatch, brokenLine) {
  double worst = 0;
  for (const double slope : {-1.5, -0.5, 0.1, 0.5, 1.5})
    for (const bool upperNonmortar : {true, false})
      for (const SideConditions sides : {SideConditions::pressed, SideConditions::held})
        for (const double angle : {0.0, 1.0}) {
          const Map roof = [=](const Point& x) {
            return Point(x.x(), x.y() + slope * std::abs(x.x() - 0.5));
          };
          expectPatch(stack({4, 6}, turned(angle, roof), mortar, upperNonmortar, sides), worst);
          const Map steps = [=](const Point& x) {
            return Point(x.x(), x.y() + slope * std::clamp(x.x() - 0.25, 0.0, 0.5));
          };
          expectPatch(stack({8, 12}, turned(angle, steps), mortar, upperNonmortar, sides), worst);
        }
  std::cout << "broken lines: stress error at most " << worst << "\n";
}

// Where the finer side is nonmortar its conditions yield, and rows at ends act there.
TEST(InterfacePatch, stabilisedRows) {
  double worst = 0;
  for (const bool upperNonmortar : {true, false})
    for (const SideConditions sides : {SideConditions::pressed, SideConditions::held})
      for (const double slope : {-0.5, 0.0, 1.5}) {
        const Map roof = [=](const Point& x) { return Point(x.x(), x.y() + slope * std::abs(x.x() - 0.5)); };
        for (const Rows& rows : {meanRows[2], meanRows[3]}) {
          InterfaceOptions options;
          rows.set(options, 0.01);
          const Model model = stack({16, 6}, turned(1, roof), rows, upperNonmortar, sides, options);
          EXPECT_EQ(model.interfaces[0].yields(), upperNonmortar);
          expectPatch(model, worst);
        }
      }
  std::cout << "stabilised rows: stress error at most " << worst << "\n";
}

TEST(InterfacePatch, threeBodiesTurnedAtRandom) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(0, 2 * pi);
  double worst = 0;
  for (int trial = 0; trial < 20; ++trial)
    for (const bool upperNonmortar : {true, false})
      for (const SideConditions sides : {SideConditions::pressed, SideConditions::held})
        expectPatch(stack({4, 7, 3}, turned(angle(random)), mortar, upperNonmortar, sides), worst);
  std::cout << "three bodies, turned at random: stress error at most " << worst << "\n";
}

/// A block pressed on an arc: all of contact, parting and curvature, nothing uniform.
Model bow(const Map& motion, const Rows& coupling, bool upperNonmortar) {
  // The upper arc is a little flatter than the lower one.
  const auto place = [&](const Point& x, bool upper) {
    const double phi = 1.2 * (x.x() - 0.5);
    const double r = 2 + x.y() + (upper ? 0.2 * (x.x() - 0.5) * (x.x() - 0.5) : 0);
    return motion({r * std::sin(phi), r * std::cos(phi)});
  };
  const Point down = motion({0.2, -1}) - motion({0, 0});
  Model model;
  const auto body = [&](const std::string& name, int cells, double lower, int label, double by) {
    Conditions conditions;
    for (const int c : {0, 1})
      conditions.displacements.push_back(
          {label, c, [=](double, double, double t) { return t * by * down[c]; }});
    TriangleMesh mesh =
        crissCrossMesh({.lower = {0, lower}, .upper = {1, lower + 1}, .cellsX = cells, .cellsY = cells});
    for (Point& x : mesh.vertices) x = place(x, lower == 0);
    // Mirrored triangles run the other way round.
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
      if (doubleArea(mesh, static_cast<int>(t)) < 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    for (auto& edge : mesh.boundaryEdges) std::sort(edge.begin(), edge.end());
    validate(mesh);
    model.bodies.emplace_back(name, std::move(mesh), elasticMaterial(elasticity), std::move(conditions));
  };
  body("upper", 9, 0, top, 0.05);
  body("lower", 14, -1, bottom, 0);
  const ContactSide above{0, bottom};
  const ContactSide below{1, top};
  InterfaceOptions options;
  coupling.set(options, 0.01);
  addInterface(model, {upperNonmortar ? above : below, upperNonmortar ? below : above, coupling}, options);
  return model;
}

TEST(InterfacePatch, turningAndMirroringChangeNoInvariant) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> angle(0, 2 * pi);
  double worst = 0;
  for (const Rows& coupling : {Rows(CouplingKind::mortar), Rows(CouplingKind::interpolation), meanRows[3]})
    for (const bool upperNonmortar : {true, false}) {
      const Model first = bow(turned(0), coupling, upperNonmortar);
      const auto [state, report] = run(first, 1, 1);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      EXPECT_LE(imbalance(first, state), imbalanceLimit);
      int open = 0;
      for (const double p : state.contactForce[0]) open += p == 0 ? 1 : 0;
      EXPECT_GT(open, 0);
      EXPECT_LT(open, first.interfaces[0].rows());
      for (int trial = 0; trial < 6; ++trial) {
        const bool mirrored = trial % 2 == 1;
        const Map mirror = [=](const Point& x) { return mirrored ? Point(-x.x(), x.y()) : x; };
        const Model second = bow(turned(angle(random), mirror), coupling, upperNonmortar);
        const auto [again, other] = run(second, 1, 1);
        ASSERT_EQ(other.status, Status::converged) << other.reason;
        Vector p = state.contactForce[0];
        if (mirrored) p.reverseInPlace();
        worst = std::max(worst, (again.contactForce[0] - p).cwiseAbs().maxCoeff() / p.maxCoeff());
        const double largest = vonMisesRange(state).max;
        for (size_t b = 0; b < 2; ++b)
          for (int i = 0; i < first.bodies[b].points(); ++i)
            worst = std::max(worst, std::abs(vonMises(again.bodies[b].stress.col(i)) -
                                             vonMises(state.bodies[b].stress.col(i))) /
                                        largest);
      }
    }
  EXPECT_LE(worst, stressTolerance);
  std::cout << "turned and mirrored: von Mises stress and contact forces change by at most " << worst << "\n";
}

/// Everything that a run certifies.
void expectSolved(const Model& model, const std::string& what) {
  SCOPED_TRACE(what);
  State state = initialState(model);
  Certificate worst;
  const RunReport report =
      march(model, state, {.end = 1, .steps = 2}, {}, [&](const State&, const StepReport& step) {
        worst.forceBalance = std::max(worst.forceBalance, step.certificate.forceBalance);
        worst.complementarity = std::max(worst.complementarity, step.certificate.complementarity);
        worst.gapOnActive = std::max(worst.gapOnActive, step.certificate.gapOnActive);
        worst.sign = std::max(worst.sign, step.certificate.sign);
      });
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_LE(worst.forceBalance, 4e-14);
  EXPECT_LE(worst.complementarity, 2e-17);
  // The rounding of displacements of 0.1: 3.5e-17 with OpenBLAS's kernels for Haswell and Zen, below 3e-17
  // with those for SkylakeX, Sandybridge and Nehalem (OPENBLAS_CORETYPE).
  EXPECT_LE(worst.gapOnActive, 4e-17);
  EXPECT_LE(worst.sign, 1e-16);
  EXPECT_LE(imbalance(model, state), imbalanceLimit);
}

// Gamma_C between sides that are held on both bodies, meshes that match and meshes that do not.
TEST(ConditionsMeet, heldToTheEndOfTheContact) {
  double worst = 0;
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation})
    for (const bool upperNonmortar : {true, false})
      for (const int cells : {3, 5, 12}) {
        const Model model = stack({5, cells}, turned(0), coupling, upperNonmortar, SideConditions::held);
        expectSolved(model, std::to_string(cells));
        if (coupling == mortar || cells == 5) expectPatch(model, worst);
      }
}

// Conditions that depend on each other: a rigid nonmortar line finer than the mortar one, and an interface
// that is given twice.
TEST(ConditionsMeet, redundantConditions) {
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation}) {
    const Function down = [](double, double, double t) { return -0.01 * t; };
    Model rigid;
    rigid.bodies.emplace_back("tool", square(0, 12), elasticMaterial(elasticity),
                              Conditions{{{bottom, 0, constant(0)}, {bottom, 1, down}}, {}, {}});
    rigid.bodies.emplace_back("block", square(-1, 4), elasticMaterial(elasticity),
                              Conditions{{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    addInterface(rigid, {{0, bottom}, {1, top}, coupling});
    expectSolved(rigid, "rigid tool");

    for (const int cells : {4, 7}) {
      Model twice = stack({4, cells}, turned(0.3), coupling, true, SideConditions::pressed);
      addInterface(twice, {{1, top}, {0, bottom}, coupling});
      expectSolved(twice, "given twice");
      twice = stack({4, cells}, turned(0.3), coupling, true, SideConditions::pressed);
      addInterface(twice, twice.interfaces[0].pair());
      expectSolved(twice, "given twice the same way");
    }
  }
}

/// Two blocks side by side below one: the interfaces share the node in the middle. With a kink they meet at a
/// corner.
TEST(ConditionsMeet, interfacesThatShareANode) {
  constexpr int middle = 7;
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation})
    for (const double slope : {0.0, 0.4, -0.4})
      for (const bool upperNonmortar : {true, false}) {
        const Map roof = [=](const Point& x) { return Point(x.x(), x.y() + slope * std::abs(x.x() - 0.5)); };
        TriangleMesh upper = mapped(4, 0, roof);
        for (size_t e = 0; e < upper.boundaryEdges.size(); ++e)
          if (upper.boundaryLabels[e] == bottom &&
              upper.vertices[upper.boundaryEdges[e][0]].x() + upper.vertices[upper.boundaryEdges[e][1]].x() >
                  1)
            upper.boundaryLabels[e] = middle;
        Model model;
        model.bodies.push_back(hydrostatic("upper", std::move(upper), {top}, {left, right}));
        for (const int side : {0, 1}) {
          const Map half = [=](const Point& x) { return roof({0.5 * (x.x() + side), x.y()}); };
          model.bodies.push_back(hydrostatic(side == 0 ? "west" : "east", mapped(side == 0 ? 3 : 2, -1, half),
                                             {bottom}, {left, right}));
        }
        for (const int side : {0, 1}) {
          const ContactSide above{0, side == 0 ? bottom : middle};
          const ContactSide below{1 + side, top};
          addInterface(model, {upperNonmortar ? above : below, upperNonmortar ? below : above, coupling});
        }
        expectSolved(model, std::to_string(slope));
        double worst = 0;
        if (coupling == mortar) expectPatch(model, worst);
      }
}

}  // namespace mortier::interface_patch_test
