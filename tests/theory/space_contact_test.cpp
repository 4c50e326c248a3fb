// Contact and flow in space beside what is known: a contact with a known end, extruded; bodies that flow
// under one stress; laws of space beside those of plane strain.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "material/deviatoric.h"
#include "material/norton.h"
#include "material/overstress.h"
#include "material/viscoelastic.h"
#include "theory/extruded_contact.h"
#include "time/mesh_error.h"

namespace mortier::space_contact_test {

enum : int { bottom = 1, right, top, left, front, back };

using scenes::addSpaceEnergies;
using scenes::Extruded;
using scenes::growing;
using scenes::steady;

struct KnownEnd {
  double error = 0, force = 0;
  int unknowns = 0;
  double estimate = 0;  ///< of the error
};

KnownEnd solveKnownEnd(int cells, int degree, CouplingKind coupling) {
  const std::array<Extruded, 2> sides{Extruded{{1, 0.3}, false}, Extruded{{1, 0.3}, true}};
  Model model;
  model.bodies.push_back(sides[0].body(sides[0].mesh(cells), degree));
  model.bodies.push_back(sides[1].body(sides[1].mesh(cells * 3 / 2), degree));
  addInterface(model, {{1, top}, {0, bottom}, coupling});
  const auto [state, report] = scenes::run(model, 1, 1);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_LE(report.worst.forceBalance, 1e-11);
  double error = 0;
  double norm = 0;
  for (const int b : {0, 1}) {
    const auto exact = [&](const SpacePoint& x) { return sides[b].stress(x); };
    addSpaceEnergies(model.bodies[b], state.bodies[b].stress, exact, error, norm);
  }
  double estimated = 0;
  for (const ErrorEstimate& estimate : MeshErrorEstimator(model)(state)) estimated += estimate.error.sum();
  return {std::sqrt(error / norm), state.contactForce[0].sum(),
          model.bodies[0].freeDofs() + model.bodies[1].freeDofs(), std::sqrt(estimated / norm)};
}

TEST(SpaceContact, knownEndConverges) {
  constexpr double contactForce = 0.25 * 0.769126488659;  // depth times 2/3 1.1^(3/2)
  struct Row {
    int degree;
    CouplingKind coupling;
    std::array<int, 2> cells;
    double leastOrder, forceTolerance;
  };
  for (const Row& row : {Row{1, CouplingKind::weighted, {6, 18}, 0.88, 2e-3},
                         {1, CouplingKind::mortar, {6, 18}, 0.88, 2e-3},
                         {2, CouplingKind::weighted, {6, 18}, 1.45, 1e-3}}) {
    const KnownEnd coarse = solveKnownEnd(row.cells[0], row.degree, row.coupling);
    const KnownEnd fine = solveKnownEnd(row.cells[1], row.degree, row.coupling);
    const double order = std::log(coarse.error / fine.error) / std::log(3);
    std::cout << "degree " << row.degree << (row.coupling == CouplingKind::mortar ? ", mortar" : ", weighted")
              << ": " << coarse.unknowns << " and " << fine.unknowns << " unknowns, errors " << coarse.error
              << ", " << fine.error << ", order " << order << ", force off by "
              << fine.force / contactForce - 1 << "\n";
    std::cout << "estimate over error " << coarse.estimate / coarse.error << ", "
              << fine.estimate / fine.error << "\n";
    for (const KnownEnd& each : {coarse, fine}) {
      EXPECT_GE(each.estimate, 0.95 * each.error);
      EXPECT_LE(each.estimate, 1.35 * each.error);
    }
    EXPECT_GE(order, row.leastOrder);
    EXPECT_NEAR(fine.force / contactForce, 1, row.forceTolerance);
  }
}

// The note's compression test in space: the stress is one everywhere, -10 t along z, and flows from 0.1 on.
TEST(SpaceContact, compressionIsExact) {
  constexpr Elasticity elasticity{3e11, 0.3};
  constexpr Viscoplasticity law{10, 1};
  for (const auto& [coupling, degree] :
       {std::pair{CouplingKind::weighted, 1}, {CouplingKind::mortar, 1}, {CouplingKind::weighted, 2}}) {
    Model model;
    const std::vector<Condition> rollers{{left, alongX, steady(0)}, {front, alongY, steady(0)}};
    std::vector<Condition> held = rollers;
    held.push_back({bottom, alongZ, steady(0)});
    model.bodies.emplace_back("upper", cuboidMesh({{0, 0, 0}, {1, 1, 1}, {3, 4, 2}}),
                              perzynaMaterial(elasticity, law, Plane::none),
                              Conditions{rollers, {{top, alongZ, growing(-10)}}}, degree);
    model.bodies.emplace_back("lower", cuboidMesh({{0, 0, -1}, {1, 1, 0}, {4, 3, 3}}),
                              perzynaMaterial(elasticity, law, Plane::none), Conditions{held, {}}, degree);
    addInterface(model, {{0, bottom}, {1, top}, coupling});
    constexpr int steps = 10;
    const auto [state, report] = scenes::run(model, 1, steps);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    const SpaceStress exact = fromSpaceCartesian(SpaceStress{0, 0, -10, 0, 0, 0});
    double worst = 0;
    for (const BodyState& body : state.bodies)
      worst = std::max(worst, (body.stress.colwise() - exact).cwiseAbs().maxCoeff() / 10);
    std::cout << "compression, degree " << degree << ": stress error " << worst << "\n";
    // The trace of quadratic displacements is not zero at all points but for the rounding of the mesh.
    EXPECT_LE(worst, degree == 1 ? 1e-12 : report.worst.rounding);
    EXPECT_LE(report.worst.rounding, 1e-3);
    // eps_v' = (1 - sigma_Y/|s|) (2/3) s/(2 lambda) along z, by backward Euler.
    double strain = -10 / elasticity.young;
    for (int i = 1; i <= steps; ++i) {
      const double s = -10.0 * i / steps;
      strain += (1.0 / steps) * std::max(0.0, 1 - 1 / std::abs(s)) * (2.0 / 3) * s / (2 * law.viscosity);
    }
    const auto& vertices = model.bodies[0].space()->mesh().vertices;
    for (size_t v = 0; v < vertices.size(); ++v)
      if (vertices[v].z() == 1) {
        const double found = state.bodies[0].displacement[3 * static_cast<Eigen::Index>(v) + 2];
        EXPECT_NEAR(found, 2 * strain, 1e-12 * std::abs(strain));
      }
  }
}

TEST(SpaceContact, threadsChangeNoBit) {
  Model model;
  const std::vector<Condition> rollers{{left, alongX, steady(0)}, {front, alongY, steady(0)}};
  std::vector<Condition> held = rollers;
  held.push_back({bottom, alongZ, steady(0)});
  const auto pressed = [](const SpacePoint& x, double t) { return -10 * t * (1 + x.x() * x.y()); };
  const auto material = perzynaMaterial({1000, 0.3}, {10, 1}, Plane::none);
  model.bodies.emplace_back("upper", cuboidMesh({{0.1, 0.1, 0}, {0.9, 0.9, 1}, {6, 6, 6}}), material,
                            Conditions{rollers, {{top, alongZ, pressed}}}, 2);
  model.bodies.emplace_back("lower", cuboidMesh({{0, 0, -1}, {1, 1, 0}, {7, 7, 7}}), material,
                            Conditions{held, {}}, 2);
  addInterface(model, {{0, bottom}, {1, top}, CouplingKind::weighted});
  ASSERT_EQ(threadsFor(model, 3), 3);
  const auto with = [&](int threads) {
    SolverOptions options;
    options.threads = threads;
    return scenes::run(model, 0.3, 2, options);
  };
  const auto one = with(1);
  const auto three = with(3);
  ASSERT_EQ(one.report.status, Status::converged) << one.report.reason;
  EXPECT_EQ(one.report.iterations, three.report.iterations);
  for (size_t b = 0; b < 2; ++b) {
    EXPECT_TRUE(one.state.bodies[b].stress == three.state.bodies[b].stress);
    EXPECT_TRUE(one.state.bodies[b].displacement == three.state.bodies[b].displacement);
  }
}

// Without shears across the plane, a law of space is that of plane strain; its tangent is the derivative.
void expectAlike(const Material& plane, const Material& space, double young) {
  constexpr double weight = 0.3;
  const Vector strain = Vector::Map(std::array{2e-3, -1e-3, 3e-3, 5e-4, 2e-3, -1e-3}.data(), 6);
  for (const double size : {0.1, 1.0, 100.0}) {
    const auto answerOf = [&](const Material& material, const Vector& strains, const Vector& stress) {
      const Matrix all = size * strains;
      const Matrix zero = Matrix::Zero(all.rows(), 1);
      Linearisation result = material.room(1);
      material.linearise({weight, zero, all, false, &zero}, stress, result, 0, 1);
      return result;
    };
    const Vector flat = strain.head(4);
    // (p, q, r, s33) by the basis of space.
    const auto inSpace = [](const Vector& v) {
      const Eigen::Vector3d s = toCartesian(v.head<3>());
      return Vector(fromSpaceCartesian(SpaceStress{s[0], s[1], v[3], s[2], 0, 0}));
    };
    const Vector even = inSpace(flat);
    const Vector stress4 = 1e3 * flat;
    const Vector stress6 = 1e3 * even;
    const Linearisation four = answerOf(plane, flat, stress4);
    const Linearisation six = answerOf(space, even, stress6);
    EXPECT_LE((six.predictor.col(0) - inSpace(four.predictor.col(0))).cwiseAbs().maxCoeff(),
              1e-14 * four.predictor.cwiseAbs().maxCoeff());
    // The moduli at a stress are dpredictor/dstrain where the law is linearised at its solution.
    Vector stress = stress6;
    for (int i = 0; i < 60; ++i) stress = answerOf(space, strain, stress).predictor;
    const Linearisation solved = answerOf(space, strain, stress);
    for (int k = 0; k < 6; ++k) {
      const double h = 1e-6 * strain.norm();
      const auto solution = [&](double by) {
        Vector s = stress;
        for (int i = 0; i < 30; ++i) s = answerOf(space, strain + by * Vector::Unit(6, k), s).predictor;
        return s;
      };
      const Vector derivative = (solution(h) - solution(-h)) / (2 * h * size);
      const Vector tangent = stressOf(solved, Vector::Unit(6, k), 0);
      EXPECT_LE((derivative - tangent).norm(), 1e-6 * young) << "strain " << k << ", " << size;
    }
  }
}

TEST(SpaceContact, lawsOfSpaceAreThoseOfPlaneStrain) {
  constexpr Elasticity elasticity{1000, 0.3};
  const auto expect = [&](const std::string& name, const auto& plane, const auto& space) {
    SCOPED_TRACE(name);
    expectAlike(*plane, *space, elasticity.young);
  };
  constexpr Viscoplasticity perzyna{10, 1};
  expect("Perzyna", perzynaMaterial(elasticity, perzyna, Plane::strain),
         perzynaMaterial(elasticity, perzyna, Plane::none));
  constexpr NortonCreep norton{2, 0.1, 4};
  expect("Norton", nortonMaterial(elasticity, norton, Plane::strain),
         nortonMaterial(elasticity, norton, Plane::none));
  for (const double relaxed : {0.0, 0.4})
    expect("relaxed " + std::to_string(relaxed),
           viscoelasticMaterial(elasticity, {0.5, relaxed}, Plane::strain),
           viscoelasticMaterial(elasticity, {0.5, relaxed}, Plane::none));
  for (const double hardening : {0.0, 50.0})
    for (const double reference : {0.0, 2.0}) {
      Overstress law;
      law.yieldStress = 1;
      law.referenceStress = reference;
      law.exponent = 3;
      law.kinematicHardening = hardening;
      expect("overstress " + std::to_string(reference) + ", " + std::to_string(hardening),
             overstressMaterial(elasticity, law, Plane::strain),
             overstressMaterial(elasticity, law, Plane::none));
    }
}

}  // namespace mortier::space_contact_test
