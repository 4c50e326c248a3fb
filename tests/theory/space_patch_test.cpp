// The patch test in space: blocks whose meshes do not match, pressed on each other, through the solver of the
// plane.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <iostream>
#include <random>

#include "material/plane_strain.h"
#include "mesh/space_shapes.h"
#include "time/march.h"

namespace mortier::space_patch_test {

enum : int { bottom = 1, right, top, left, front, back };
constexpr Elasticity elasticity{1000, 0.3};
constexpr double pressure = 10;

using SpaceMap = std::function<SpacePoint(const SpacePoint&)>;

SpaceDatum constant(double value) {
  return [value](const SpacePoint&, double t) { return value * t; };
}

/// A box whose inner vertices are moved at random by parts of a cell, then mapped.
TetrahedronMesh block(const std::array<int, 3>& cells, double lower, unsigned seed, const SpaceMap& map) {
  TetrahedronMesh mesh =
      cuboidMesh({.lower = {0, 0, lower}, .upper = {1, 1, lower + 1}, .cells = cells});
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-0.2, 0.2);
  for (SpacePoint& x : mesh.vertices) {
    for (int c = 0; c < 3; ++c) {
      const double by = part(random) / cells[c];
      const double from = x[c] - (c == 2 ? lower : 0);
      if (from > 1e-9 && from < 1 - 1e-9) x[c] += by;
    }
    x = map(x);
  }
  validate(mesh);
  return mesh;
}

/// Under hydrostatic pressure, u = strain x on the sides `held`: no shear acts on any surface.
Body hydrostatic(const std::string& name, TetrahedronMesh mesh, const std::vector<int>& held,
                 const std::vector<int>& pressed, int degree) {
  const double strain = -pressure * (1 - 2 * elasticity.poisson) / elasticity.young;
  SpaceConditions conditions;
  for (const int label : held)
    for (const int c : {0, 1, 2})
      conditions.displacements.push_back(
          {label, c, [=](const SpacePoint& x, double t) { return t * strain * x[c]; }});
  for (const int label : pressed) conditions.tractions.push_back({label, spaceNormal, constant(-pressure)});
  return {name, std::move(mesh), spaceElasticMaterial(elasticity), std::move(conditions), degree};
}

struct Case {
  CouplingKind coupling = CouplingKind::weighted;
  int degree = 1;
  bool upperNonmortar = true;
  SpaceMap map = [](const SpacePoint& x) { return x; };
};

Model twoBlocks(const Case& of) {
  Model model;
  model.bodies.push_back(hydrostatic("upper", block({3, 4, 2}, 0, 1, of.map), {top},
                                     {left, right, front, back}, of.degree));
  model.bodies.push_back(hydrostatic("lower", block({5, 3, 3}, -1, 2, of.map), {bottom},
                                     {left, right, front, back}, of.degree));
  const ContactSide above{0, bottom};
  const ContactSide below{1, top};
  addInterface(model,
               {of.upperNonmortar ? above : below, of.upperNonmortar ? below : above, of.coupling});
  return model;
}

struct Found {
  double stress = 0;   ///< error over the pressure
  double balance = 0;  ///< force and moment of contact on both bodies, over the largest nodal force
  int iterations = 0;
};

Found solve(const Model& model) {
  State state = initialState(model);
  const RunReport report =
      march(model, state, {.end = 1, .steps = 1}, {}, [](const State&, const StepReport&) {});
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  Found found;
  found.iterations = report.iterations;
  Eigen::Matrix<double, 6, 1> exact;
  exact << -pressure * std::numbers::sqrt2, 0, 0, -pressure, 0, 0;
  for (const BodyState& body : state.bodies)
    found.stress =
        std::max(found.stress, (body.stress.colwise() - exact).cwiseAbs().maxCoeff() / pressure);
  const ContactInterface& interface = model.interfaces[0];
  std::array<Vector, 2> f;
  for (int b : {0, 1}) f[b] = Vector::Zero(model.bodies[b].dofs());
  interface.subtractForces(state.contactForce[0], f[interface.pair().nonmortar.body],
                           f[interface.pair().mortar.body]);
  SpacePoint force = SpacePoint::Zero();
  SpacePoint moment = SpacePoint::Zero();
  double largest = 0;
  for (int b : {0, 1})
    for (int node = 0; node < model.bodies[b].nodes(); ++node) {
      const SpacePoint each = f[b].segment<3>(3 * node);
      force += each;
      moment += model.bodies[b].space()->nodes().places[node].cross(each);
      largest += each.norm();
    }
  found.balance = std::max(force.norm(), moment.norm()) / largest;
  return found;
}

constexpr double stressTolerance = 1e-12;
constexpr double balanceTolerance = 2e-15;

void expectPatch(const Case& of, double& worst) {
  const Found found = solve(twoBlocks(of));
  EXPECT_LE(found.stress, stressTolerance);
  EXPECT_LE(found.balance, balanceTolerance);
  EXPECT_EQ(found.iterations, 1);
  worst = std::max(worst, found.stress);
}

TEST(SpacePatch, flatAndTilted) {
  double worst = 0;
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.7, SpacePoint(1, 2, 3).normalized())).toRotationMatrix();
  for (const bool tilted : {false, true})
    for (const bool upper : {true, false})
      for (const auto& [coupling, degree] :
           {std::pair{CouplingKind::weighted, 1}, {CouplingKind::mortar, 1}, {CouplingKind::weighted, 2}}) {
        Case of{coupling, degree, upper};
        if (tilted) of.map = [turn](const SpacePoint& x) { return SpacePoint(turn * x); };
        expectPatch(of, worst);
      }
  std::cout << "flat and tilted planes: stress error at most " << worst << "\n";
}

}  // namespace mortier::space_patch_test
