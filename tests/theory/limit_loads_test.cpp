// Limit loads of perfect plasticity as the limits of slow viscoplastic flow: displacements grow slowly, and
// the force stands still in the end. Continuous displacements bound limit loads from above; what the meshes
// leave falls with h.
#include <gtest/gtest.h>

#include <iostream>

#include "material/deviatoric.h"
#include "theory/scenes.h"

namespace mortier::limit_loads_test {

using namespace scenes;

constexpr Elasticity stiff{1000, 0.3};
constexpr Viscoplasticity slow{1e-4, 1};  // overstress of about 1e-3 at the rates below

/// The force along y on a label [N/m], at the end and before the last step.
struct Forces {
  double last = 0;
  double before = 0;
};

Forces forceOn(const Model& model, int label, int steps) {
  const Body& body = model.bodies[0];
  std::vector<char> on(body.nodes(), 0);
  for (size_t e = 0; e < body.mesh().boundaryEdges.size(); ++e)
    if (body.mesh().boundaryLabels[e] == label)
      for (const int v : body.mesh().boundaryEdges[e]) on[v] = 1;
  Forces forces;
  State state = initialState(model);
  const RunReport report =
      march(model, state, {.end = 1, .steps = steps}, {}, [&](const State& now, const StepReport&) {
        const Vector f = body.internalForce(now.bodies[0].stress);
        forces.before = forces.last;
        forces.last = 0;
        for (int v = 0; v < body.nodes(); ++v)
          if (on[v] != 0) forces.last += f[2 * v + 1];
      });
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  return forces;
}

void expectLimit(const char* what, double exact, const std::vector<double>& h,
                 const std::vector<double>& found, double leastOrder, double closest) {
  std::vector<double> errors;
  std::cout << what << ", over the limit load:";
  for (const double value : found) {
    errors.push_back(value / exact - 1);
    std::cout << " " << value / exact;
    EXPECT_GT(errors.back(), 0);
  }
  std::cout << "; order " << fittedOrder(h, errors) << "\n";
  EXPECT_GE(fittedOrder(h, errors), leastOrder);
  EXPECT_LE(errors.back(), closest);
}

// A square plate of half width 1 with a hole of radius a, pulled: (1 - a) sigma_Y. One quarter of it.
Forces plateWithHole(double a, int cells) {
  TriangleMesh mesh = annulusMesh(
      {.inner = 1, .outer = 2, .quarters = 1, .cellsAround = 2 * cells, .cellsAcross = cells}, Cut::both);
  for (Point& x : mesh.vertices) {
    const double part = std::log2(x.norm());
    const Point along = x.normalized();
    x = along * (a + part * (1 / along.cwiseAbs().maxCoeff() - a));
    for (double& c : x)
      if (std::abs(c - 1) < 1e-12) c = 1;
  }
  // Outer sides: 2 right, 5 top.
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    const auto [i, j] = mesh.boundaryEdges[e];
    if (mesh.vertices[i].y() == 1 && mesh.vertices[j].y() == 1) mesh.boundaryLabels[e] = 5;
  }
  validate(mesh);
  Model model;
  model.bodies.emplace_back("plate", std::move(mesh), perzynaMaterial(stiff, slow),
                            Conditions{{{3, alongY, constant(0)},
                                        {4, alongX, constant(0)},
                                        {5, alongY, [](double, double, double t) { return 0.02 * t; }}},
                                       {},
                                       {}});
  return forceOn(model, 5, 8);
}

TEST(LimitLoads, plateWithAHoleInPlaneStress) {
  constexpr double a = 0.5;
  std::vector<double> h;
  std::vector<double> found;
  for (const int cells : {8, 16, 32}) {
    const Forces forces = plateWithHole(a, cells);
    EXPECT_NEAR(forces.before / forces.last, 1, 1e-3);
    h.push_back(1.0 / cells);
    found.push_back(forces.last);
  }
  expectLimit("plate with a hole", 1 - a, h, found, 0.9, 5e-3);
}

}  // namespace mortier::limit_loads_test
