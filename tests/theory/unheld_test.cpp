// What nothing holds is named with its motion; a run ends at the last equilibrium before that.
#include <gtest/gtest.h>

#include "base/error.h"
#include "theory/scenes.h"

namespace mortier::unheld_test {

using namespace scenes;

std::string unheldMessage(const Model& model) {
  try {
    run(model, 1, 1);
  } catch (const UnheldBodyError& error) {
    return error.what();
  }
  return "none";
}

void expectNames(const std::string& message, const std::string& body, const std::string& motion) {
  EXPECT_NE(message.find("body " + body), std::string::npos) << message;
  EXPECT_NE(message.find(motion), std::string::npos) << message;
}

Body heldBelow(TriangleMesh mesh) {
  return {"lower",
          std::move(mesh),
          elasticMaterial(noteElasticity),
          {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}}};
}

TEST(Unheld, translationAlongTheContactIsNamed) {
  Body upper("upper", square(0, 3), elasticMaterial(noteElasticity), {{}, {{top, 1, constant(-1)}}, {}});
  expectNames(unheldMessage(
                  contactModel(std::move(upper), heldBelow(square(-1, 4)), CouplingKind::mortar, upperBody)),
              "upper", "translation along (1, 0)");
}

// One contact node under the right corner, its force in the middle of the overlap from 0.9 to 1; rollers on
// the bottom leave the rotation about that.
TEST(Unheld, rotationAboutTheOnlyContactNodeIsNamed) {
  Body upper("upper", square(0, 3), elasticMaterial(noteElasticity),
             {{{bottom, 0, constant(0)}}, {{top, 1, constant(-1)}}, {}});
  TriangleMesh below = crissCrossMesh({{0.9, -1}, {1.9, 0}, 4, 4});
  expectNames(unheldMessage(contactModel(std::move(upper), heldBelow(std::move(below)), CouplingKind::mortar,
                                         upperBody)),
              "upper", "rotation about (0.95, ");
}

TEST(Unheld, bodyWithoutContactIsNamed) {
  Model model;
  model.bodies.push_back(heldBelow(square(-1, 2)));
  model.bodies.emplace_back("loose", square(0, 2), elasticMaterial(noteElasticity),
                            Conditions{{{left, 0, constant(0)}}, {}, {}});
  expectNames(unheldMessage(model), "loose", "translation along (0, 1)");
}

// The load turns round at t = 0.3, within a step or at its end, and pulls a block off that only contact
// holds.
TEST(Unheld, pullOffEndsAtTheLastEquilibrium) {
  constexpr double balance = 1e-10;
  constexpr double turn = 0.3;
  const Function load = [](double, double, double t) { return -10 * (1 - t / turn); };
  for (const bool elastic : {true, false})
    for (const CouplingKind coupling : couplings)
      for (const int steps : {7, 10, 13, 20, 23, 30}) {
        const auto material = elastic ? elasticMaterial(noteElasticity)
                                      : perzynaMaterial(noteElasticity, noteLaw(Projection::frobenius));
        Body upper("upper", square(0, 4), material, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
        Body lower("lower", square(-1, 7), material,
                   {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
        const Model model = contactModel(std::move(upper), std::move(lower), coupling, upperBody);
        SCOPED_TRACE(std::string(elastic ? "elastic, " : "viscoplastic, ") + nameOf(coupling) +
                     ", N = " + std::to_string(steps));
        const auto [state, report] = run(model, 1, steps);
        EXPECT_EQ(report.status, Status::unheld);
        expectNames(report.reason, "upper", "translation along (0, 1)");
        EXPECT_EQ(report.steps, static_cast<int>(0.3 * steps + 1e-9));
        EXPECT_EQ(state.time, 1.0 * report.steps / steps);
        std::vector<Vector> rest;
        for (size_t b = 0; b < 2; ++b)
          rest.push_back(model.bodies[b].load(state.time) -
                         model.bodies[b].internalForce(state.bodies[b].stress));
        model.interfaces[0].subtractForces(state.contactForce[0], rest[0], rest[1]);
        for (size_t b = 0; b < 2; ++b)
          for (int dof = 0; dof < model.bodies[b].dofs(); ++dof)
            if (model.bodies[b].equations()[dof] < 0) rest[b][dof] = 0;
        EXPECT_LE(rest[0].cwiseAbs().maxCoeff(), balance);
        EXPECT_LE(rest[1].cwiseAbs().maxCoeff(), balance);
      }
}

/// A block with rollers on its left above one that is held, `distance` apart.
Model apart(double distance, const std::shared_ptr<const Material>& material, const Function& load,
            CouplingKind coupling = CouplingKind::mortar) {
  Body upper("upper", square(distance, 3), material, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
  return contactModel(std::move(upper), heldBelow(square(-1, 5)), coupling, upperBody);
}

// A body that contact holds only once it has closed travels there, however small its load is beside its
// stiffness; the stress is then uniform. What a stress can be measured by is the rounding of E times the
// distance over the size.
TEST(Unheld, bodiesTravelUntilContactCloses) {
  constexpr double distance = 0.1;
  for (const CouplingKind coupling :
       {CouplingKind::mortar, CouplingKind::interpolation, CouplingKind::weighted})
    for (const bool elastic : {true, false})
      for (const double pressure : {1e-6, 1e-3, 1.0, 1e3}) {
        const auto material = elastic ? elasticMaterial(noteElasticity)
                                      : perzynaMaterial(noteElasticity, noteLaw(Projection::frobenius));
        const Model model = apart(
            distance, material, [pressure](double, double, double t) { return -pressure * t; }, coupling);
        const auto [state, report] = run(model, 1, 10);
        ASSERT_EQ(report.status, Status::converged) << report.reason;
        EXPECT_NEAR(state.contactForce[0].sum(), pressure, 1e-9 * pressure + 1e-15 * noteElasticity.young);
        EXPECT_NEAR(state.bodies[upperBody].displacement[1], -distance,
                    1e-9 * distance + 3 * pressure / noteElasticity.young + (elastic ? 0 : 10 * pressure));
      }
}

TEST(Unheld, pullingABodyOffAnOpenGapNamesIt) {
  for (const double pull : {1e-12, 1.0}) {
    const auto [state, report] = run(apart(0.1, elasticMaterial(noteElasticity), constant(pull)), 1, 1);
    EXPECT_EQ(report.status, Status::unheld);
    expectNames(report.reason, "upper", "translation along (0, 1)");
  }
}

// Above a gap that stays open nothing drives the wedge sideways, and nothing holds it: it could be anywhere.
TEST(Unheld, motionsThatNoClosedContactHoldsAreNamed) {
  TriangleMesh mesh = square(0.1, 4);
  for (Point& x : mesh.vertices) x.y() -= 0.2 * (0.5 - std::abs(x.x() - 0.5));  // a V below
  const auto model = [&](double down) {
    Body upper("wedge", mesh, elasticMaterial(noteElasticity),
               {{{top, 1, [down](double, double, double t) { return -down * t; }}}, {}, {}});
    TriangleMesh below = square(-1.1, 4);
    for (Point& x : below.vertices) x.y() -= 0.2 * (0.5 - std::abs(x.x() - 0.5));
    return contactModel(std::move(upper), heldBelow(std::move(below)), CouplingKind::mortar, upperBody);
  };
  const Model open = model(0.05);
  const auto [state, report] = run(open, 1, 1);
  EXPECT_EQ(report.status, Status::unheld);
  EXPECT_EQ(report.rejected, 0);
  expectNames(report.reason, "wedge", "translation along (1, 0)");
  EXPECT_EQ(run(model(0.3), 1, 1).report.status, Status::converged);  // both flanks hold it
}

}  // namespace mortier::unheld_test
