// Friction along lines that are curved, broken or shared by bodies, and across a distance.
#include <gtest/gtest.h>

#include <iostream>
#include <numeric>

#include "theory/stacks.h"
#include "time/measure.h"
#include "time/quantity.h"

namespace mortier::rough_lines_test {

using namespace scenes;
using namespace stacks;

constexpr double mu = 0.3;

InterfaceOptions rough(double coefficient = mu) {
  InterfaceOptions options;
  options.friction = {coefficient, 0};
  return options;
}

Map roof(double slope) {
  return [=](const Point& x) { return Point(x.x(), x.y() + slope * std::abs(x.x() - 0.5)); };
}
Map arc(double height) {
  return [=](const Point& x) { return Point(x.x(), x.y() + 4 * height * x.x() * (1 - x.x())); };
}
Map wave(double height) {
  return [=](const Point& x) { return Point(x.x(), x.y() + height * std::sin(2 * pi * x.x())); };
}

/// Force, and moment less the couple that friction leaves, of contact on both bodies, over the nodal forces.
double imbalanceBesideCouple(const Model& model, const State& state) {
  double worst = 0;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    Eigen::Vector3d sum = contactWrench(model, state, k);
    sum[2] -= frictionCouple(model, state, k).z();
    worst = std::max(worst, sum.cwiseAbs().maxCoeff() / state.contactForce[k].cwiseAbs().sum());
  }
  return worst;
}

// No shear acts anywhere: bodies that could stick to each other are as those that could not.
TEST(RoughLines, hydrostaticPressureNeedsNoFriction) {
  double worst = 0;
  double shear = 0;
  for (const double slope : {-1.5, -0.5, 0.0, 0.1, 0.5})
    for (const bool upperNonmortar : {true, false})
      for (const SideConditions sides : {SideConditions::pressed, SideConditions::held})
        for (const double angle : {0.0, 1.0}) {
          const Model model =
              stack({4, 6}, turned(angle, roof(slope)), CouplingKind::mortar, upperNonmortar, sides, rough());
          const auto [state, report] = run(model, 1, 1);
          ASSERT_EQ(report.status, Status::converged) << report.reason;
          worst = std::max(worst, patchError(model, state));
          shear = std::max(shear, state.frictionForce[0].cwiseAbs().maxCoeff() /
                                      state.contactForce[0].cwiseAbs().maxCoeff());
          EXPECT_EQ(state.frictionWork, 0);
          EXPECT_LE(report.worst.friction, 1e-12);
          EXPECT_LE(imbalanceBesideCouple(model, state), 1e-14);
        }
  std::cout << "stress error at most " << worst << ", nodal shear over pressure " << shear << "\n";
  EXPECT_LE(worst, 2e-13);
}

/// The upper body is pushed down and along, then back.
Model sheared(const Map& map, CouplingKind coupling, bool upperNonmortar, double coefficient = mu) {
  const Map at = turned(0, map);
  Model model;
  const auto body = [&](const std::string& name, int cells, double lower, int held, double moves) {
    Conditions conditions;
    const auto along = [=](double t) { return t <= 1 ? 0.0 : t <= 2 ? t - 1 : 3 - t; };
    conditions.displacements.push_back(
        {held, 0, [=](double, double, double t) { return 0.04 * moves * along(t); }});
    conditions.displacements.push_back(
        {held, 1, [=](double, double, double t) { return -0.03 * moves * std::min(t, 1.0); }});
    model.bodies.push_back(
        {name, mapped(cells, lower, at), elasticMaterial({100, 0.3}), std::move(conditions)});
  };
  body("upper", 6, 0, top, 1);
  body("lower", 8, -1, bottom, 0);
  const ContactSide above{0, bottom};
  const ContactSide below{1, top};
  addInterface(model, {upperNonmortar ? above : below, upperNonmortar ? below : above, coupling},
               rough(coefficient));
  return model;
}

// On any line and any meshes friction gives as much to one body as it takes from the other; what it leaves of
// the moment is the couple that is reported.
TEST(RoughLines, forcesBalance) {
  double worst = 0;
  double couples = 0;
  for (const CouplingKind coupling :
       {CouplingKind::mortar, CouplingKind::interpolation, CouplingKind::weighted})
    for (const bool upperNonmortar : {true, false})
      for (const Map& map : {arc(0.2), arc(-0.15), wave(0.05), roof(0.4), roof(-0.3)}) {
        const Model model = sheared(map, coupling, upperNonmortar);
        State state = initialState(model);
        int stuck = 0;
        int slipped = 0;
        double work = 0;
        const RunReport report =
            march(model, state, {.end = 3, .steps = 9}, {}, [&](const State& now, const StepReport& step) {
              if (step.step == 0) return;
              worst = std::max(worst, imbalanceBesideCouple(model, now));
              couples = std::max(couples, std::abs(frictionCouple(model, now, 0).z()) /
                                              now.contactForce[0].cwiseAbs().sum());
              EXPECT_GE(now.frictionWork, work);
              work = now.frictionWork;
              for (size_t i = 0; i < now.slipping[0].size(); ++i)
                if (now.contactForce[0][static_cast<Eigen::Index>(i)] > 0)
                  (now.slipping[0][i] == 0 ? stuck : slipped) += 1;
            });
        ASSERT_EQ(report.status, Status::converged) << report.reason;
        EXPECT_LE(report.worst.friction, 1e-12);
        EXPECT_GT(stuck, 5);
        EXPECT_GT(slipped, 5);
        EXPECT_GT(work, 0);
      }
  std::cout << "imbalance " << worst << ", couples of up to " << couples << " of the forces times 1 m\n";
  EXPECT_LE(worst, 2e-15);
  EXPECT_GT(couples, 1e-6);
}

// Bodies that are drawn apart and taken to touch: t acts across that distance.
TEST(RoughLines, coupleIsForceTimesDistance) {
  constexpr double apart = 0.03;
  for (const bool upperNonmortar : {true, false}) {
    const Function push = [](double, double, double t) { return 0.05 * t; };
    const Function down = [](double, double, double t) { return -0.02 * t; };
    InterfaceOptions options = rough();
    options.initial = InitialGap::close;
    const Model model = contactModel(
        {"upper", square(apart, 4), elasticMaterial({100, 0.3}), {{{top, 0, push}, {top, 1, down}}, {}, {}}},
        {"lower",
         square(-1, 7),
         elasticMaterial({100, 0.3}),
         {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}}},
        CouplingKind::mortar, upperNonmortar ? upperBody : lowerBody, options);
    const auto [state, report] = run(model, 1, 2);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    const double force = state.frictionForce[0].sum();
    EXPECT_GT(force, 0.1);
    EXPECT_NEAR(frictionCouple(model, state, 0).z(), apart * force, 1e-13 * force);
    EXPECT_LE(imbalanceBesideCouple(model, state), 1e-14);
  }
}

/// A pin in a ring that is too narrow for it by `interference`; the pin is turned at its bore, to and fro.
Model pin(int cells, bool pinNonmortar, double interference) {
  const auto turn = [](double t) { return 0.02 * (t <= 1 ? 0 : t <= 2 ? t - 1 : 3 - 2 * (t - 1)); };
  Model model;
  Conditions inside;
  inside.displacements.push_back({1, 0, [=](double, double y, double t) { return -y * turn(t); }});
  inside.displacements.push_back({1, 1, [=](double x, double, double t) { return x * turn(t); }});
  Conditions outside;
  outside.displacements.push_back({2, 0, constant(0)});
  outside.displacements.push_back({2, 1, constant(0)});
  const auto ring = [](double inner, double outer, int around) {
    return annulusMesh(
        {.inner = inner, .outer = outer, .quarters = 4, .cellsAround = around, .cellsAcross = around / 8},
        Cut::both);
  };
  model.bodies.emplace_back("pin", ring(0.5, 1, cells), elasticMaterial({100, 0.3}), std::move(inside));
  model.bodies.emplace_back("ring", ring(1, 2, cells * 5 / 4), elasticMaterial({100, 0.3}),
                            std::move(outside));
  InterfaceOptions options = rough();
  options.gap = still([=](const Point&) { return -interference; });
  const ContactSide ofPin{0, 2};
  const ContactSide ofRing{1, 1};
  addInterface(model, {pinNonmortar ? ofPin : ofRing, pinNonmortar ? ofRing : ofPin, CouplingKind::mortar},
               options);
  return model;
}

// Pressed into the ring by p, the pin turns where the couple reaches 2 pi mu p R^2, and turns back at minus
// that. With u_r = A r + B/r in both (Lame) and no motion of bore and outer circle, p = interference over the
// compliances of both.
TEST(RoughLines, pinTurnsInItsRing) {
  constexpr double interference = 0.002;
  const auto compliance = [](double fixed) {  // |u_r(1)| / p
    const double nu = 0.3;
    const double A = 1;
    const double B = -fixed * fixed;
    return std::abs((A + B) / (100 / (1 - nu * nu) * ((1 + nu) * A - (1 - nu) * B)));
  };
  const double p = interference / (compliance(0.5) + compliance(2));
  for (const bool pinNonmortar : {true, false}) {
    std::vector<double> off;
    for (const int cells : {32, 64}) {
      const Model model = pin(cells, pinNonmortar, interference);
      std::vector<Quantity> torque(1);
      torque[0].kind = Quantity::Kind::reaction;
      torque[0].body = 0;
      torque[0].label = 1;
      torque[0].component = Quantity::Component::momentZ;
      double worst = 0;
      State state = initialState(model);
      const RunReport report =
          march(model, state, {.end = 3, .steps = 6}, {}, [&](const State& now, const StepReport& step) {
            if (step.step == 0) return;
            EXPECT_LE(imbalanceBesideCouple(model, now), 1e-14);
            if (now.time != 2 && now.time != 3) return;
            const double sign = now.time == 2 ? 1 : -1;
            const double exact = sign * 2 * pi * mu * p;
            worst = std::max(worst, std::abs(evaluate(torque, model, now)[0] / exact - 1));
            for (const signed char slips : now.slipping[0]) EXPECT_NE(slips, 0);
          });
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      EXPECT_EQ(state.frictionWork, state.frictionWorkOf[0]);
      EXPECT_GT(state.frictionWork, 0);
      off.push_back(worst);
    }
    std::cout << "the pin's couple is off by " << off[0] << ", " << off[1] << "\n";
    EXPECT_LE(off[1], 2e-4);
    EXPECT_LE(off[1], off[0] / 3.5);
  }
}

/// A block in the corner between a floor and a wall, pushed into it by its other two sides.
Model cornered(bool blockNonmortar, CouplingKind coupling, bool rigid) {
  constexpr int wallSide = right;
  const Function inwards = [](double, double, double t) { return -0.03 * std::min(t, 1.0); };
  const Function outwards = [](double, double, double t) {
    return 0.03 * std::min(t, 1.0) - 0.05 * (t > 1 ? t - 1 : 0);
  };
  Model model;
  model.bodies.emplace_back("block", square(0, 5), elasticMaterial({100, 0.3}),
                            Conditions{{{top, 1, inwards}, {left, 0, outwards}}, {}, {}});
  const auto held = [&](const std::vector<int>& labels) {
    Conditions conditions;
    for (const int label : labels)
      for (const int c : {0, 1}) conditions.displacements.push_back({label, c, constant(0)});
    return conditions;
  };
  const std::vector<int> all{bottom, right, top, left};
  model.bodies.emplace_back("floor",
                            rectangleMesh({.lower = {0, -1}, .upper = {1, 0}, .cellsX = 7, .cellsY = 4}),
                            elasticMaterial({200, 0.3}), held(rigid ? all : std::vector<int>{bottom}));
  model.bodies.emplace_back("wall",
                            rectangleMesh({.lower = {1, 0}, .upper = {2, 1}, .cellsX = 4, .cellsY = 6}),
                            elasticMaterial({200, 0.3}), held(rigid ? all : std::vector<int>{right}));
  const auto add = [&](const ContactSide& ofBlock, const ContactSide& other) {
    addInterface(model, {blockNonmortar ? ofBlock : other, blockNonmortar ? other : ofBlock, coupling},
                 rough());
  };
  add({0, bottom}, {1, top});
  add({0, wallSide}, {2, left});
  return model;
}

// The node of the corner has two conditions across and two along, four for its two motions where floor and
// wall are rigid; then the block is drawn off the wall.
TEST(RoughLines, cornersHaveTwoTangents) {
  for (const CouplingKind coupling :
       {CouplingKind::mortar, CouplingKind::interpolation, CouplingKind::weighted})
    for (const bool blockNonmortar : {true, false})
      for (const bool rigid : {true, false}) {
        SCOPED_TRACE(std::to_string(static_cast<int>(coupling)) + (blockNonmortar ? " block" : " others") +
                     (rigid ? " rigid" : ""));
        const Model model = cornered(blockNonmortar, coupling, rigid);
        State state = initialState(model);
        const RunReport report =
            march(model, state, {.end = 2, .steps = 8}, {}, [&](const State& now, const StepReport& step) {
              if (step.step == 0) return;
              EXPECT_LE(imbalanceBesideCouple(model, now), 1e-13);
              if (now.time == 1) {
                EXPECT_GT(now.contactForce[0].sum(), 0.5);
                EXPECT_GT(now.contactForce[1].sum(), 0.5);
              }
            });
        ASSERT_EQ(report.status, Status::converged) << report.reason;
        EXPECT_LE(report.worst.friction, 1e-12);
        EXPECT_LE(report.worst.forceBalance, 1e-12);
        EXPECT_EQ(report.special.dependent > 0, rigid);
        EXPECT_GT(state.contactForce[0].sum(), 0);
        EXPECT_EQ(state.contactForce[1].maxCoeff(), 0);
        EXPECT_GT(state.frictionWorkOf[0], 0);
        EXPECT_NEAR(state.frictionWork, state.frictionWorkOf[0] + state.frictionWorkOf[1],
                    1e-14 * state.frictionWork);
      }
}

// A wedge in a notch that nothing else holds: pressed by its weight it stays where mu is at least the slope's
// cotangent or not, as the notch has two sides; along the notch, no side holds it without friction.
TEST(RoughLines, blockHeldByABrokenLineAlone) {
  for (const bool upperNonmortar : {true, false}) {
    const Map notch = roof(0.5);
    Conditions weight;
    weight.tractions.push_back({top, 1, [](double, double, double t) { return -10 * t; }});
    weight.tractions.push_back({top, 0, [](double, double, double t) { return 2 * t; }});
    Conditions held;
    for (const int c : {0, 1}) held.displacements.push_back({bottom, c, constant(0)});
    Model model;
    model.bodies.emplace_back("upper", mapped(4, 0, notch), elasticMaterial({1000, 0.3}), std::move(weight));
    model.bodies.emplace_back("lower", mapped(6, -1, notch), elasticMaterial({1000, 0.3}), std::move(held));
    const ContactSide above{0, bottom};
    const ContactSide below{1, top};
    addInterface(model,
                 {upperNonmortar ? above : below, upperNonmortar ? below : above, CouplingKind::mortar},
                 rough());
    const auto [state, report] = run(model, 1, 2);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_LE(report.worst.friction, 1e-12);
    EXPECT_LE(report.worst.forceBalance, 1e-10);
    EXPECT_LE(imbalanceBesideCouple(model, state), 1e-13);
    const Point force = resultant(model, state, 0).head<2>() * (upperNonmortar ? 1 : -1);
    const double length = std::hypot(1, 0.5);  // of the loaded line
    EXPECT_NEAR(force.x(), -2 * length, 1e-9);
    EXPECT_NEAR(force.y(), 10 * length, 1e-9);
  }
}

}  // namespace mortier::rough_lines_test
