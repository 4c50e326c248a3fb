// Friction along straight lines: uniform sliding, the stick zone of Cattaneo and Mindlin, and energy.
#include <gtest/gtest.h>

#include <cmath>

#include "material/elasticity.h"
#include "theory/scenes.h"
#include "time/quantity.h"

namespace mortier::sliding_test {

using namespace scenes;

constexpr double mu = 0.3;

Model roughModel(Body upper, Body lower, const Rows& coupling, int nonmortarBody, const Friction& friction,
                 const Datum& gap = {}) {
  InterfaceOptions options;
  options.friction = friction;
  options.gap = gap;
  coupling.set(options, 0.01);
  return contactModel(std::move(upper), std::move(lower), coupling, nonmortarBody, options);
}

/// Blocks of different meshes and stiffnesses (nu = 0) under the pressure p and the shear stress s: the plate
/// on the top moves by what the strain makes of both, and by `slip`.
Model uniformBlocks(const Rows& coupling, int nonmortarBody, const Friction& friction, double p, double s,
                    double slip, double unit = 1, int degree = 1) {
  const double soft = 100 * unit;
  const double hard = 300 * unit;
  const double down = -p * (1 / soft + 1 / hard);
  const double along = 2 * s * (1 / soft + 1 / hard) + slip;
  const auto at = [](double value) {
    return Function([value](double, double, double t) { return value * t; });
  };
  const auto sides = [&](double sign) { return Condition{sign > 0 ? right : left, 1, at(sign * s)}; };
  Body upper("upper", square(0, 5), elasticMaterial({soft, 0}),
             {{{top, 0, at(along)}, {top, 1, at(down)}}, {sides(1), sides(-1)}, {}}, degree);
  Body lower("lower", square(-1, 7), elasticMaterial({hard, 0}),
             {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {sides(1), sides(-1)}, {}}, degree);
  return roughModel(std::move(upper), std::move(lower), coupling, nonmortarBody, friction);
}

/// Nodal values of the shear stress: positive where the upper body drags the lower one to the right,
/// whichever is nonmortar.
Vector shear(const Model& model, const State& state) {
  return model.interfaces[0].contactPressure(state.frictionForce[0]);
}

// What slides does so under t = mu p everywhere, or under the shear stress that surfaces bear, on any meshes.
TEST(Sliding, isUniform) {
  constexpr double p = 2;
  for (const Rows& coupling : meanRows)
    for (const int nonmortar : {upperBody, lowerBody})
      for (const Friction& friction : {Friction{mu, 0}, Friction{0, mu * p}})
        for (const double direction : {1.0, -1.0})
          for (const auto& [steps, degree] : {std::pair(1, 1), {3, 1}, {1, 2}, {3, 2}}) {
            const double slip = direction * 0.05;
            const Model model =
                uniformBlocks(coupling, nonmortar, friction, p, direction * mu * p, slip, 1, degree);
            // Tresca's bound is there from the beginning: one step alone is uniform.
            if (friction.limit > 0 && steps > 1) continue;
            const Result result = run(model, 1, steps);
            ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
            EXPECT_LE((shear(model, result.state).array() - direction * mu * p).abs().maxCoeff(), 1e-12 * p);
            EXPECT_LE((model.interfaces[0].contactPressure(result.state.contactForce[0]).array() - p)
                          .abs()
                          .maxCoeff(),
                      1e-11 * p);
            const Vector moved = model.interfaces[0].slip(
                result.state.bodies[model.interfaces[0].pair().nonmortar.body].displacement,
                result.state.bodies[model.interfaces[0].pair().mortar.body].displacement);
            EXPECT_LE((moved.array() - slip).abs().maxCoeff(), 1e-12);
            for (const signed char sign : result.state.slipping[0]) EXPECT_EQ(sign, direction > 0 ? 1 : -1);
            EXPECT_LE(result.report.worst.friction, 1e-12);
            // The pressure grows with the slip; the shear stress that surfaces bear is there from the start.
            const double mean = friction.limit > 0 ? 1 : 0.5;
            EXPECT_NEAR(result.state.frictionWork, mean * mu * p * std::abs(slip), 1e-12);
          }
}

// Below mu p nothing slips, and the stress is that of one body.
TEST(Sliding, stickingBlocksAreOneBody) {
  for (const int trial : {0, 1, 2, 3, 4, 5, 6, 7}) {
    const Rows& coupling = meanRows[trial / 2];
    const Model model = uniformBlocks(coupling, upperBody, {mu, 0}, 2, 0.9 * mu * 2, 0, 1, 1 + trial % 2);
    const Result result = run(model, 1, 2);
    ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
    EXPECT_LE((shear(model, result.state).array() - 0.9 * mu * 2).abs().maxCoeff(), 1e-11);
    for (const signed char sign : result.state.slipping[0]) EXPECT_EQ(sign, 0);
    EXPECT_EQ(result.state.frictionWork, 0);
  }
}

TEST(Sliding, unitsDoNotMatter) {
  const double unit = std::ldexp(1.0, 30);
  const Model one = uniformBlocks(CouplingKind::mortar, upperBody, {mu, 0}, 2, 0.5, 0.02);
  const Model other =
      uniformBlocks(CouplingKind::mortar, upperBody, {mu, 0}, 2 * unit, 0.5 * unit, 0.02, unit);
  const Result a = run(one, 1, 4);
  const Result b = run(other, 1, 4);
  ASSERT_EQ(a.report.status, Status::converged) << a.report.reason;
  EXPECT_EQ(a.report.iterations, b.report.iterations);
  EXPECT_EQ(unit * a.state.frictionForce[0], b.state.frictionForce[0]);
  EXPECT_EQ(a.state.slipping[0], b.state.slipping[0]);
}

/// Pressed, sheared to the right, pulled back beyond where it began, lifted off, all in [0, 4].
double down(double t) {
  return -0.05 * (t <= 1 ? t : t <= 3 ? 1 : 1 - 1.5 * (t - 3));
}
double along(double t) {
  return 0.05 * (t <= 1 ? 0 : t <= 2 ? t - 1 : t <= 3 ? 1 - 2 * (t - 2) : -1);
}

Model shearedBlocks(const Rows& coupling, int nonmortarBody, const Friction& friction) {
  Body upper("upper", square(0, 5), elasticMaterial({100, 0.3}),
             {{{top, 0, [](double, double, double t) { return along(t); }},
               {top, 1, [](double, double, double t) { return down(t); }}},
              {},
              {}});
  Body lower("lower", crissCrossMesh({.lower = {-0.3, -1}, .upper = {1.3, 0}, .cellsX = 9, .cellsY = 5}),
             elasticMaterial({40, 0.2}), {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return roughModel(std::move(upper), std::move(lower), coupling, nonmortarBody, friction);
}

/// Elastic energy of stresses.
double energyOf(const Model& model, const std::vector<Matrix>& stress) {
  double sum = 0;
  for (size_t b = 0; b < stress.size(); ++b) {
    Matrix strain;
    model.bodies[b].material().elasticStrain(stress[b], strain);
    for (int i = 0; i < model.bodies[b].points(); ++i)
      sum += model.bodies[b].weights()[i] / 2 * stress[b].col(i).dot(strain.col(i));
  }
  return sum;
}

// In every step the work of loads and supports is the change of the elastic energy and friction's, also where
// gaps close or open; friction's is not negative.
TEST(Sliding, energyIsKept) {
  for (const Rows& coupling :
       {Rows(CouplingKind::interpolation), meanRows[0], meanRows[1], meanRows[2], meanRows[3]})
    for (const int nonmortar : {upperBody, lowerBody}) {
      const Model model = shearedBlocks(coupling, nonmortar, {mu, 0});
      const std::vector<Quantity> external = externalWorks();
      State before = initialState(model);
      double worst = 0;
      double largest = 0;
      int stuck = 0;
      int slipped = 0;
      State state = before;
      const RunReport report =
          march(model, state, {.end = 4, .steps = 40, .quantities = external}, {},
                [&](const State& now, const StepReport& step) {
                  if (step.step == 0) return;
                  const double work = workSince(before, now);
                  const auto yielding = [&](const State& at) {  // p'S p/2 is elastic
                    return model.interfaces[0].yielded(at.contactForce[0]).dot(at.contactForce[0]) / 2;
                  };
                  const double energy = energyOf(model, {now.bodies[0].stress, now.bodies[1].stress}) +
                                        yielding(now) - yielding(before) -
                                        energyOf(model, {before.bodies[0].stress, before.bodies[1].stress});
                  const double friction = now.frictionWork - before.frictionWork;
                  EXPECT_GE(friction, 0);
                  largest = std::max(largest, energyOf(model, {now.bodies[0].stress, now.bodies[1].stress}));
                  const double left = work - energy - friction;
                  worst = std::max(worst, std::abs(left));
                  for (size_t i = 0; i < now.slipping[0].size(); ++i)
                    if (now.contactForce[0][static_cast<Eigen::Index>(i)] > 0)
                      (now.slipping[0][i] == 0 ? stuck : slipped) += 1;
                  before = now;
                });
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      EXPECT_LE(worst, 1e-11 * largest) << nameOf(coupling);
      EXPECT_LE(report.worst.friction, 1e-12);
      EXPECT_GT(state.frictionWork, 0.01 * largest);
      EXPECT_GT(stuck, 20);
      EXPECT_GT(slipped, 20);
      EXPECT_EQ(state.contactForce[0].maxCoeff(), 0);
      EXPECT_EQ(state.frictionForce[0].lpNorm<Eigen::Infinity>(), 0);
      EXPECT_LE(energyOf(model, {state.bodies[0].stress, state.bodies[1].stress}), 1e-20 * largest);
    }
}

// Similar half planes pressed together by a parabola, then pushed along by Q = 0.3 to 0.9 mu P: what is left
// of the zone that sticks is sqrt(1 - Q/(mu P)) of that in contact (Cattaneo 1938, Mindlin 1949).
TEST(Sliding, stickZoneIsThatOfCattaneoAndMindlin) {
  const auto mesh = [](bool upper) {
    return rectangleMesh({.lower = {-10, upper ? 0.0 : -10.0},
                          .upper = {10, upper ? 10.0 : 0.0},
                          .cellsX = 120,
                          .cellsY = 24,
                          .focus = Point(0, 0),
                          .grading = {40, 20}},
                         Cut::both);
  };
  for (const double slide : {0.008, 0.018}) {
    const auto path = [slide](double, double, double t) { return t <= 1 ? 0 : slide * (t - 1); };
    const auto press = [](double, double, double t) { return -0.05 * std::min(t, 1.0); };
    Body upper("upper", mesh(true), elasticMaterial({100, 0.3}), {{{top, 0, path}, {top, 1, press}}, {}, {}});
    Body lower("lower", mesh(false), elasticMaterial({100, 0.3}),
               {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    const Model model = roughModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody,
                                   {mu, 0}, still([](const Point& x) { return x.x() * x.x() / 60; }));
    const Result result = run(model, 2, 2);
    ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
    const Vector& p = result.state.contactForce[0];
    const Vector& t = result.state.frictionForce[0];
    double contact = 0;
    double stick = 0;
    double element = 0;
    const std::vector<int>& nodes = model.interfaces[0].nonmortarNodes();
    double last = 0;
    for (size_t i = 0; i < nodes.size(); ++i) {
      const double x = model.bodies[0].mesh().vertices[nodes[i]].x();
      if (p[static_cast<Eigen::Index>(i)] > 0) contact = x;
      if (p[static_cast<Eigen::Index>(i)] > 0 && result.state.slipping[0][i] == 0) {
        stick = x;
        element = x - last;
      }
      last = x;
    }
    const double exact = std::sqrt(1 - t.sum() / (mu * p.sum()));
    contact += element / 2;  // both end somewhere in the element that follows
    stick += element / 2;
    std::cout << "Q/(mu P) " << t.sum() / (mu * p.sum()) << ": c/a " << stick / contact << ", exact " << exact
              << ", an element " << element / contact << " of a\n";
    EXPECT_NEAR(stick / contact, exact, element / contact);
    EXPECT_GT(t.sum(), 0.2 * mu * p.sum());
    EXPECT_LT(t.sum(), 0.95 * mu * p.sum());
  }
}

}  // namespace mortier::sliding_test
