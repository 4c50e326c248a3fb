// Parts of bodies: their sums are those of the whole body, and ranks that have a part each march as one does.
#include "solver/model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <mutex>

#include "material/anisotropy.h"
#include "material/deviatoric.h"
#include "material/parts.h"
#include "material/perzyna.h"
#include "material/viscoelastic.h"
#include "mesh/generate.h"
#include "time/march.h"
#include "time/parts_of_run.h"
#include "time/quantity.h"
#include "unit/dense_reference.h"
#include "unit/thread_ranks.h"

namespace mortier::body_part_test {

constexpr double rounding = 1e-12;

Function constant(double value) {
  return [value](double, double, double) { return value; };
}

struct Case {
  const char* name;
  Plane plane = Plane::stress;
  int degree = 1;
  int support = alongX;
  bool regions = false;
  bool turned = false;
  bool averaged = false;
};

constexpr Case cases[] = {{"plain"},
                          {"quadratic", Plane::stress, 2},
                          {"along the normal", Plane::stress, 1, alongNormal},
                          {"regions", Plane::stress, 1, alongX, true},
                          {"turned axes", Plane::stress, 1, alongX, false, true},
                          {"about the axis", Plane::axisymmetric, 1, alongY},
                          {"about the axis, quadratic", Plane::axisymmetric, 2, alongY},
                          {"averaged volume", Plane::strain, 1, alongNormal, false, false, true},
                          {"averaged volume, quadratic", Plane::axisymmetric, 2, alongY, false, false, true}};

std::shared_ptr<const Material> materialOf(const Case& each, int points) {
  const Elasticity elasticity{100, 0.3};
  const Viscoplasticity flow{10, 0.05, Projection::elasticity};
  if (each.plane != Plane::stress) return perzynaMaterial(elasticity, flow, Plane::strain);
  if (each.turned) {
    const Anisotropy wood = anisotropyOf(Orthotropy{{100, 50, 80}, {0.2, 0.2, 0.1}, {30}}, Plane::stress);
    std::vector<double> angles;
    for (int i = 0; i < points; ++i) angles.push_back(0.1 * i);
    return anisotropicMaterial(wood, perzynaMaterial(stiffestOf(wood), {10, 0.05}), angles);
  }
  if (!each.regions) return perzynaMaterial(elasticity, flow);
  std::vector<int> materialOf;
  for (int i = 0; i < points; ++i) materialOf.push_back(i % 7 == 0 ? 1 : 0);
  return materialOfParts({perzynaMaterial(elasticity, flow), elasticMaterial({50, 0.2})}, materialOf);
}

Body bodyOf(const Case& each) {
  const TriangleMesh mesh = crissCrossMesh({{0, 0}, {1, 1}, 5, 4});
  const int points = static_cast<int>(mesh.triangles.size()) * (each.degree == 1 ? 1 : 3);
  Conditions conditions{{{1, each.support, constant(0)}, {3, each.support, constant(0)}},
                        {{2, alongY, [](double x, double y, double t) { return t * (x - 3 * y); }}},
                        {{1, [](double x, double y, double t) { return t * x * (1 - y); }}}};
  conditions.temperature = [](double x, double, double t) { return t * x; };
  conditions.expansion.setConstant(each.plane == Plane::stress ? 3 : 4, points, 1e-3);
  return {"plate",      mesh,        materialOf(each, points),
          conditions,   each.degree, each.plane == Plane::axisymmetric,
          each.averaged};
}

/// Cells in a pattern that no order of the mesh has.
std::vector<int> scattered(const Body& body, int ranks) {
  std::vector<int> owner;
  for (size_t t = 0; t < body.mesh().triangles.size(); ++t)
    owner.push_back(static_cast<int>(t * t / 5 + t) % ranks);
  for (size_t t = 0; body.patches() != nullptr && t < owner.size(); ++t)  // patches are whole
    owner[t] = owner[*body.patches()->triangles(body.patches()->patchOf()[t]).begin()];
  return owner;
}

void expectNear(const Matrix& value, const Matrix& expected, const std::string& what) {
  ASSERT_EQ(value.rows(), expected.rows()) << what;
  ASSERT_EQ(value.cols(), expected.cols()) << what;
  EXPECT_LE((value - expected).cwiseAbs().maxCoeff(), rounding * expected.cwiseAbs().maxCoeff()) << what;
}

TEST(BodyPart, sumsOfAllPartsAreThoseOfTheBody) {
  constexpr int ranks = 3;
  for (const Case& each : cases) {
    const Body body = bodyOf(each);
    const Matrix stress = Matrix::Random(body.material().components(), body.points());
    const TwoPartVector u{1e-3 * Vector::Random(body.dofs()), Vector::Zero(body.dofs())};
    Matrix strain(stress.rows(), stress.cols());
    body.strain(u, nullptr, strain, 0, body.points());
    Linearisation law = body.material().room(body.points());
    body.material().linearise({0.1, stress, strain}, stress, law, 0, body.points());
    std::vector<double> values;
    body.tangent(law, values);
    const Matrix tangent = denseOf(body.pattern(), values);

    Vector force = Vector::Zero(body.dofs());
    Vector load = force;
    Matrix sum = Matrix::Zero(body.freeDofs(), body.freeDofs());
    std::mutex lock;
    ThreadRanks::run(ranks, [&](Ranks& all) {
      const BodyPart part = partOf(body, scattered(body, ranks), all);
      const Body own(body, part.cut);
      const Matrix ownStress = pointsOfPart(part, stress);
      Matrix ownStrain(ownStress.rows(), ownStress.cols());
      own.strain({nodesOfPart(part, u.high), nodesOfPart(part, u.low)}, nullptr, ownStrain, 0, own.points());
      Linearisation ownLaw = own.material().room(own.points());
      own.material().linearise({0.1, ownStress, ownStrain}, ownStress, ownLaw, 0, own.points());
      std::vector<double> ownValues;
      own.tangent(ownLaw, ownValues);
      const Matrix K = denseOf(own.pattern(), ownValues);
      const Matrix thermal = gatheredPoints(part, all, own.thermalStrain(2));
      const Matrix predictor = gatheredPoints(part, all, ownLaw.predictor);
      Vector forces = own.internalForce(ownStress);
      const std::scoped_lock locked(lock);
      if (all.first()) {
        expectNear(thermal, body.thermalStrain(2), each.name);
        expectNear(predictor, law.predictor, each.name);
      }
      std::vector<int> equation(own.freeDofs(), -1);
      for (int dof = 0; dof < own.dofs(); ++dof) {
        const int whole = 2 * part.cut.nodes[dof / 2] + dof % 2;
        force[whole] += forces[dof];
        load[whole] += own.load(2)[dof];
        ASSERT_EQ(own.equations()[dof] < 0, body.equations()[whole] < 0);
        if (own.equations()[dof] >= 0) equation[own.equations()[dof]] = body.equations()[whole];
      }
      for (Eigen::Index j = 0; j < K.cols(); ++j)
        for (Eigen::Index i = 0; i < K.rows(); ++i) sum(equation[i], equation[j]) += K(i, j);
    });
    expectNear(force, body.internalForce(stress), std::string(each.name) + ": forces");
    expectNear(load, body.load(2), std::string(each.name) + ": loads");
    expectNear(sum, tangent, std::string(each.name) + ": tangent");
  }
}

TEST(BodyPart, whatIsGatheredIsWhatWasCut) {
  const Body body = bodyOf(cases[1]);
  const Vector u = Vector::Random(body.dofs());
  const Matrix stress = Matrix::Random(3, body.points());
  ThreadRanks::run(4, [&](Ranks& all) {
    const BodyPart part = partOf(body, scattered(body, 3), all);  // the last has no triangle
    Vector own = nodesOfPart(part, u);
    for (size_t node = 0; node < part.own.size(); ++node)
      if (part.own[node] == 0) own.segment<2>(2 * static_cast<Eigen::Index>(node)).setZero();
    completeAtNodes(part, all, own);
    EXPECT_EQ(own, nodesOfPart(part, u));
    const Vector whole = gatheredNodes(part, all, own);
    const Matrix points = gatheredPoints(part, all, pointsOfPart(part, stress));
    if (!all.first()) return;
    EXPECT_EQ(whole, u);
    EXPECT_EQ(points, stress);
  });
}

Model pressed(const Case& each, double friction) {
  Model model;
  const auto load = [](double x, double, double t) { return t * (3 - 8 * x); };
  for (const int b : {0, 1}) {
    const TriangleMesh mesh =
        b == 0 ? crissCrossMesh({{0, 0}, {1, 1}, 5, 4}) : crissCrossMesh({{0, -1}, {1, 0}, 6, 5});
    const int points = static_cast<int>(mesh.triangles.size()) * (each.degree == 1 ? 1 : 3);
    Conditions conditions{{{4, alongX, constant(0)}}, {}, {}};
    if (b == 0) conditions.tractions.push_back({3, alongY, load});
    if (b == 1) conditions.displacements.push_back({1, alongY, constant(0)});
    model.bodies.emplace_back(b == 0 ? "upper" : "lower", mesh, materialOf(each, points), conditions,
                              each.degree, each.plane == Plane::axisymmetric);
  }
  InterfaceOptions options;
  options.friction.coefficient = friction;
  options.axisymmetric = each.plane == Plane::axisymmetric;
  addInterface(model, {{0, 1}, {1, 3}, CouplingKind::mortar}, options);
  return model;
}

void expectSameMarch(const Case& each, int ranks, const TimePlan& plan, double friction) {
  constexpr double same = 1e-10;
  const std::string what = std::string(each.name) + " on " + std::to_string(ranks);
  const Model model = pressed(each, friction);
  State alone = initialState(model);
  ASSERT_EQ(march(model, alone, plan, {}, [](const State&, const StepReport&) {}).status, Status::converged);
  const std::vector<double> expected = evaluate(plan.quantities, model, alone);
  ThreadRanks::run(ranks, [&](Ranks& all) {
    const Model own = inParts(model, all);
    TimePlan ownPlan = plan;
    for (Quantity& quantity : ownPlan.quantities) quantity = ofParts(quantity, own);
    State state = initialState(own);
    const RunReport report = march(own, state, ownPlan, {}, [](const State&, const StepReport&) {});
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    const std::vector<double> values = evaluate(ownPlan.quantities, own, state);
    for (size_t i = 0; i < values.size(); ++i)
      EXPECT_NEAR(values[i], expected[i], same * std::abs(expected[i]) + 1e-14) << plan.quantities[i].name;
    const State whole = gathered(own, state);
    if (!all.first()) return;
    for (size_t b = 0; b < 2; ++b) {
      const Matrix difference = whole.bodies[b].stress - alone.bodies[b].stress;
      EXPECT_LE(difference.cwiseAbs().maxCoeff(), same * alone.bodies[b].stress.cwiseAbs().maxCoeff())
          << what;
      const Vector moved = whole.bodies[b].displacement - alone.bodies[b].displacement;
      EXPECT_LE(moved.lpNorm<Eigen::Infinity>(),
                same * alone.bodies[b].displacement.lpNorm<Eigen::Infinity>())
          << what;
    }
  });
}

std::vector<Quantity> quantities() {
  using Kind = Quantity::Kind;
  std::vector<Quantity> all;
  for (const Kind kind :
       {Kind::storedEnergy, Kind::dissipatedEnergy, Kind::work, Kind::externalWork, Kind::largestMises})
    all.push_back({"energy", kind, 0});
  all.push_back({"reaction", Kind::reaction, 0, 4});
  all.push_back({"contact", Kind::contactForce, 1, 3, Quantity::Component::y});
  return all;
}

TEST(BodyPart, ranksMarchAsOneDoes) {
  TimePlan plan{.end = 1, .steps = 3};
  plan.quantities = quantities();
  for (const Case& each : cases)
    if (each.support != alongNormal)
      for (const int ranks : {1, 2, 3}) expectSameMarch(each, ranks, plan, 0);
  expectSameMarch(cases[0], 4, plan, 0.3);
}

TEST(BodyPart, ranksChooseTheSameSteps) {
  TimePlan plan{.end = 1, .scheme = Scheme::sdirk2, .tolerance = 1e-2};
  plan.quantities = quantities();
  for (const int ranks : {2, 3}) expectSameMarch(cases[3], ranks, plan, 0);
}

}  // namespace mortier::body_part_test
