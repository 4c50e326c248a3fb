// The patch test in space: blocks whose meshes do not match, pressed on each other, through the solver of the
// plane.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <iostream>
#include <random>

#include "base/error.h"
#include "material/deviatoric.h"
#include "material/stress.h"
#include "mesh/shape.h"
#include "time/march.h"

namespace mortier::space_patch_test {

enum : int { bottom = 1, right, top, left, front, back };
constexpr Elasticity elasticity{1000, 0.3};
constexpr double pressure = 10;

using SpaceMap = std::function<SpacePoint(const SpacePoint&)>;

Datum constant(double value) {
  return [value](const SpacePoint&, double t) { return value * t; };
}

/// A box whose vertices are moved at random by parts of a cell, but for its sides and x = 1/2, then mapped.
TetrahedronMesh block(const Cuboid& cuboid, unsigned seed, const SpaceMap& map) {
  const auto& [lower, upper, cells] = cuboid;
  TetrahedronMesh mesh = cuboidMesh(cuboid);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-0.2, 0.2);
  for (SpacePoint& x : mesh.vertices) {
    const SpacePoint from = x;
    for (int c = 0; c < 3; ++c) {
      const double by = part(random) * (upper[c] - lower[c]) / cells[c];
      const bool side = from[c] - lower[c] < 1e-9 || upper[c] - from[c] < 1e-9;
      if (!side && !(c == 0 && std::abs(from[c] - 0.5) < 1e-9)) x[c] += by;
    }
    x = map(x);
  }
  validate(mesh);
  return mesh;
}

/// Under hydrostatic pressure, u = strain x on the sides `held`: no shear acts on any surface.
Body hydrostatic(const std::string& name, TetrahedronMesh mesh, const std::vector<int>& held,
                 const std::vector<int>& pressed, int degree, bool averaged = false) {
  const double strain = -pressure * (1 - 2 * elasticity.poisson) / elasticity.young;
  Conditions conditions;
  for (const int label : held)
    for (const int c : {0, 1, 2})
      conditions.displacements.push_back(
          {label, c, [=](const SpacePoint& x, double t) { return t * strain * x[c]; }});
  for (const int label : pressed) conditions.tractions.push_back({label, alongNormal, constant(-pressure)});
  return {name,   std::move(mesh), elasticMaterial(elasticity, Plane::none), std::move(conditions),
          degree, averaged};
}

struct Case {
  CouplingKind coupling = CouplingKind::weighted;
  int degree = 1;
  bool upperNonmortar = true;
  SpaceMap map = [](const SpacePoint& x) { return x; };
  bool held = false;  ///< whether the sides are, in place of a pressure
  bool averaged = false;
};

Model twoBlocks(const Case& of) {
  Model model;
  const std::vector<int> sides{left, right, front, back};
  const auto add = [&](const std::string& name, const Cuboid& cuboid, unsigned seed, int end) {
    std::vector<int> held(1, end);
    if (of.held) held.insert(held.end(), sides.begin(), sides.end());
    model.bodies.push_back(hydrostatic(name, block(cuboid, seed, of.map), held,
                                       of.held ? std::vector<int>() : sides, of.degree, of.averaged));
  };
  add("upper", {{0, 0, 0}, {1, 1, 1}, {4, 3, 2}}, 1, top);
  add("lower", {{0, 0, -1}, {1, 1, 0}, {6, 4, 3}}, 2, bottom);
  const ContactSide above{0, bottom};
  const ContactSide below{1, top};
  addInterface(model, {of.upperNonmortar ? above : below, of.upperNonmortar ? below : above, of.coupling});
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
  const SpaceStress exact = fromSpaceCartesian(SpaceStress{-pressure, -pressure, -pressure, 0, 0, 0});
  for (const BodyState& body : state.bodies)
    found.stress = std::max(found.stress, (body.stress.colwise() - exact).cwiseAbs().maxCoeff() / pressure);
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

const std::vector<std::pair<CouplingKind, int>> exactCouplings{
    {CouplingKind::weighted, 1}, {CouplingKind::mortar, 1}, {CouplingKind::weighted, 2}};

const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, SpacePoint(1, 2, 3).normalized()).toRotationMatrix();

TEST(SpacePatch, flatAndTilted) {
  double worst = 0;
  for (const bool tilted : {false, true})
    for (const bool upper : {true, false})
      for (const auto& [coupling, degree] : exactCouplings) {
        Case of{coupling, degree, upper};
        if (tilted) of.map = [](const SpacePoint& x) { return SpacePoint(turn * x); };
        expectPatch(of, worst);
        of.averaged = true;
        if (degree == 1) expectPatch(of, worst);
      }
  std::cout << "flat and tilted planes: stress error at most " << worst << "\n";
}

TEST(SpacePatch, roofAndStep) {
  double worst = 0;
  for (const double slope : {-1.5, 0.1, 0.5, 1.5})
    for (const bool upper : {true, false})
      for (const auto& [coupling, degree] : exactCouplings)
        for (const bool tilted : {false, true}) {
          SCOPED_TRACE(slope);
          Case of{coupling, degree, upper};
          of.map = [=](const SpacePoint& x) {
            const SpacePoint roof(x.x(), x.y(), x.z() + slope * std::abs(x.x() - 0.5));
            return tilted ? SpacePoint(turn * roof) : roof;
          };
          expectPatch(of, worst);
        }
  std::cout << "roofs: stress error at most " << worst << "\n";
}

// The sides of both bodies are held up to the contact surface.
TEST(SpacePatch, closedCorners) {
  double worst = 0;
  for (const bool upper : {true, false})
    for (const auto& [coupling, degree] : exactCouplings)
      for (const double slope : {0.0, 0.5}) {
        Case of{coupling, degree, upper};
        of.held = true;
        of.map = [=](const SpacePoint& x) {
          return SpacePoint(x.x(), x.y(), x.z() + slope * std::abs(x.x() - 0.5));
        };
        expectPatch(of, worst);
      }
  std::cout << "closed corners: stress error at most " << worst << "\n";
}

// The edge of the mortar surface lies inside nonmortar triangles, of a body whose surface is held.
TEST(SpacePatch, mortarEdgeInsideTriangles) {
  double worst = 0;
  const SpaceMap same = [](const SpacePoint& x) { return x; };
  for (const auto& [coupling, degree] : exactCouplings) {
    Model model;
    model.bodies.push_back(hydrostatic("upper", block({{0.2, 0.15, 0}, {0.73, 0.8, 1}, {3, 4, 3}}, 1, same),
                                       {top}, {left, right, front, back}, degree));
    model.bodies.push_back(hydrostatic("lower", block({{0, 0, -1}, {1, 1, 0}, {4, 5, 2}}, 2, same),
                                       {bottom, top, left, right, front, back}, {}, degree));
    addInterface(model, {{1, top}, {0, bottom}, coupling});
    const Found found = solve(model);
    EXPECT_LE(found.stress, stressTolerance);
    EXPECT_LE(found.balance, balanceTolerance);
    worst = std::max(worst, found.stress);
  }
  std::cout << "mortar edge inside nonmortar triangles: stress error at most " << worst << "\n";
}

// What interpolation cannot do, though its forces balance.
TEST(SpacePatch, interpolationFails) {
  const Found found = solve(twoBlocks({CouplingKind::interpolation}));
  EXPECT_GT(found.stress, 0.02);
  EXPECT_LE(found.balance, balanceTolerance);
}

// Contact alone holds the upper block along z; along x and y, and about z, nothing does.
TEST(SpacePatch, freeMotionsAreNamed) {
  const SpaceMap same = [](const SpacePoint& x) { return x; };
  const auto model = [&](std::vector<Condition> held) {
    Model both;
    Conditions conditions{std::move(held), {{top, alongNormal, constant(-pressure)}}};
    both.bodies.emplace_back("upper", block({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, 1, same),
                             elasticMaterial(elasticity, Plane::none), conditions, 1);
    both.bodies.push_back(
        hydrostatic("lower", block({{0, 0, -1}, {1, 1, 0}, {3, 3, 2}}, 2, same), {bottom}, {}, 1));
    addInterface(both, {{0, bottom}, {1, top}, CouplingKind::weighted});
    return both;
  };
  const auto fixed = [](const SpacePoint& at, int component) {
    return Condition{0, component, constant(0), at};
  };
  const auto run = [&](const Model& both) {
    State state = initialState(both);
    return march(both, state, {.end = 1, .steps = 1}, {}, [](const State&, const StepReport&) {});
  };
  const auto expectNamed = [&](std::vector<Condition> conditions, const std::vector<std::string>& words) {
    try {
      run(model(std::move(conditions)));
      FAIL() << "nothing holds " << words.front();
    } catch (const UnheldBodyError& error) {
      for (const std::string& each : words)
        EXPECT_NE(std::string(error.what()).find(each), std::string::npos) << error.what();
    }
  };
  expectNamed({fixed({0, 0, 1}, alongY), fixed({1, 0, 1}, alongY)}, {"translation along x"});
  expectNamed({fixed({0, 0, 1}, alongX), fixed({0, 0, 1}, alongY)},
              {"about the line through (0, 0", "along z"});
  const Model held = model({fixed({0, 0, 1}, alongX), fixed({0, 0, 1}, alongY), fixed({1, 0, 1}, alongY)});
  EXPECT_EQ(run(held).status, Status::converged);
}

}  // namespace mortier::space_patch_test
