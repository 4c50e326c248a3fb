// The compression test, loaded far beyond yield and unloaded onto the yield surface or next to it. The exact
// answer of the step that unloads is a uniform elastic change, or a small flow more.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "theory/scenes.h"

namespace mortier::unloading_test {

using namespace scenes;

constexpr Projection projections[] = {Projection::elasticity, Projection::frobenius, Projection::compliance};

/// Everything that a case may change.
struct Unloading {
  int upperCells = 6;
  int lowerCells = 16;
  Projection projection = Projection::elasticity;
  CouplingKind coupling = CouplingKind::mortar;
  double softer = 1;  ///< young and viscosity over those of the note
  double angle = 0;   ///< by which the scene is turned
  Function load;      ///< pressure on the top [Pa]

  [[nodiscard]] Model model() const {
    const Elasticity elasticity{noteElasticity.young / softer, noteElasticity.poisson};
    Viscoplasticity law = noteLaw(projection);
    law.viscosity /= softer;
    const auto material = perzynaMaterial(elasticity, law);
    const auto turned = [this](double lowerY, int cells) {
      TriangleMesh mesh = square(lowerY, cells);
      for (Point& x : mesh.vertices) x = Eigen::Rotation2Dd(angle) * x;
      return mesh;
    };
    const Function pulled = [this](double x, double y, double t) { return -load(x, y, t); };
    Body upper("upper", turned(0, upperCells), material,
               {{{left, alongNormal, constant(0)}}, {{top, alongNormal, pulled}}, {}});
    Body lower("lower", turned(-1, lowerCells), material,
               {{{left, alongNormal, constant(0)}, {bottom, alongNormal, constant(0)}}, {}, {}});
    return contactModel(std::move(upper), std::move(lower), coupling, upperBody);
  }
};

struct Course {
  Result result;
  int worst = 0;  ///< linear solves in the hardest step
};

Course run(const Unloading& scene, int steps, Scheme scheme = Scheme::backwardEuler) {
  const Model model = scene.model();
  Course course{{initialState(model), {}}, 0};
  course.result.report = march(model, course.result.state, {.end = 1, .steps = steps, .scheme = scheme}, {},
                               [](const State&, const StepReport&) {});
  course.worst = course.result.report.maxIterationsInAStep;
  return course;
}

/// Beside yield, on either side.
const std::vector<double> loads = {0.5,       0.999,     1 - 1e-6, 1 - 1e-9, 1 - 1e-12, 1 - 1e-15, 1,
                                   1 + 1e-15, 1 + 1e-12, 1 + 1e-9, 1 + 1e-6, 1.001,     2};

TEST(Unloading, ontoYieldAndBesideItIsElastic) {
  constexpr double tolerance = 1e-10;  // of a step
  int hardest = 0;
  for (const Projection projection : projections)
    for (const double softer : {1.0, 1e9})
      for (const double load : loads) {
        Unloading scene;
        scene.projection = projection;
        scene.softer = softer;
        scene.load = [load](double, double, double t) { return t <= 0.5 ? 8 : load; };
        const auto [result, worst] = run(scene, 2);
        ASSERT_EQ(result.report.status, Status::converged) << load << ": " << result.report.reason;
        hardest = std::max(hardest, worst);
        for (const BodyState& body : result.state.bodies)
          for (Eigen::Index i = 0; i < body.stress.cols(); ++i) {
            const Eigen::Vector3d error =
                toCartesian(body.stress.col(i).head<3>()) - Eigen::Vector3d(0, -load, 0);
            EXPECT_LE(error.cwiseAbs().maxCoeff(), tolerance) << load;
          }
      }
  EXPECT_LE(hardest, 5);
  std::cout << "linear solves in the hardest step " << hardest << "\n";
}

TEST(Unloading, everyStepEnds) {
  constexpr int most = 40;
  for (const int steps : {20, 60, 200})
    for (const Projection projection : projections) {
      Unloading scene;
      scene.projection = projection;
      scene.load = [](double, double, double t) { return t <= 0.5 ? 20 * t : 20 * (1 - t); };
      const auto [result, worst] = run(scene, steps);
      EXPECT_EQ(result.report.status, Status::converged) << steps << ": " << result.report.reason;
      EXPECT_LE(worst, most) << steps;
    }
}

// Rates of stages that are taken from stresses would strain the next stage by their rounding times theta e.
TEST(Unloading, withTwoStages) {
  constexpr int most = 12;
  for (const Projection projection : projections)
    for (const double load : {1 - 1e-12, 1.0, 1 + 1e-9}) {
      Unloading scene;
      scene.projection = projection;
      scene.load = [load](double, double, double t) { return t <= 0.5 ? 8 : load; };
      const auto [result, worst] = run(scene, 2, Scheme::sdirk2);
      EXPECT_EQ(result.report.status, Status::converged) << load << ": " << result.report.reason;
      EXPECT_LE(worst, most) << load;
    }
}

TEST(Unloading, onOtherMeshes) {
  for (const auto& [upper, lower] : {std::pair{3, 5}, std::pair{6, 6}, std::pair{6, 12}})
    for (const CouplingKind coupling : couplings)
      for (const double angle : {0.0, 0.3}) {
        Unloading scene;
        scene.upperCells = upper;
        scene.lowerCells = lower;
        scene.coupling = coupling;
        scene.angle = angle;
        scene.load = [](double, double, double t) { return t <= 0.5 ? 8 : 1; };
        const auto [result, worst] = run(scene, 2);
        const std::string name = std::to_string(upper) + ":" + std::to_string(lower) + " " +
                                 nameOf(coupling) + " turned by " + std::to_string(angle);
        EXPECT_EQ(result.report.status, Status::converged) << name << ": " << result.report.reason;
        // The stress of interpolation is not uniform: what flows and what does not is found by the usual
        // ways.
        EXPECT_LE(worst, coupling == CouplingKind::mortar ? 5 : 40) << name;
        std::cout << name << ": " << worst << "\n";
      }
}

}  // namespace mortier::unloading_test
