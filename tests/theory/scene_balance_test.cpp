// Forces and energies balance on every scene of scenes/: what loads, supports and contact exert on a body
// sums to nothing, in force and moment, and what is done on a body is stored or dissipated.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "scene/build.h"
#include "scene/resolve.h"
#include "time/nodal_forces.h"

namespace mortier::scene_balance_test {

using Kind = Quantity::Kind;
using Component = Quantity::Component;

/// Over the sum of all nodal forces, their moments over that times the size of the body.
constexpr double forceRounding = 1e-12;
/// Over the work and the energy that go through all bodies.
constexpr double energyRounding = 1e-12;
constexpr double heatedRounding = 1e-11;  // energies are small beside those of the thermal strain
/// Where contact follows the bodies, forces balance to this on the rows at its end.
constexpr double followingRounding = 1e-9;

std::vector<std::string> shippedScenes() {
  std::vector<std::string> scenes;
  for (const auto& entry : std::filesystem::directory_iterator(MORTIER_SCENES))
    if (entry.path().extension() == ".toml") scenes.push_back(entry.path().string());
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

/// Force and moment about the origin; in space the force alone.
using Wrench = Eigen::Vector3d;

Wrench wrenchOf(const Vector& forces, const Body& body) {
  if (body.space() != nullptr) return forces.reshaped(3, forces.size() / 3).rowwise().sum();
  const std::vector<Point>& places = body.elementNodes().places;
  Wrench sum = Wrench::Zero();
  for (size_t v = 0; v < places.size(); ++v) {
    const Point f = forces.segment<2>(2 * static_cast<Eigen::Index>(v));
    sum += Wrench(f.x(), f.y(), places[v].x() * f.y() - places[v].y() * f.x());
  }
  return sum;
}

/// As it is reported.
Wrench quantityOf(const Model& model, const State& state, Kind kind, int body, int label) {
  std::vector<Quantity> quantities;
  const Component third = model.bodies[body].space() != nullptr ? Component::z : Component::momentZ;
  for (const Component component : {Component::x, Component::y, third})
    quantities.push_back({"w", kind, body, label, component});
  const std::vector<double> values = evaluate(quantities, model, state);
  return {values[0], values[1], values[2]};
}

/// The largest sum of the forces on a body, over their size; the contact forces of all bodies are added up.
double outOfBalance(const Model& model, const State& state, int b, Wrench& contacts, double& size) {
  const Body& body = model.bodies[b];
  const Vector load = body.load(state.time);
  Wrench sum = wrenchOf(load, body);
  size += load.cwiseAbs().sum() + contactForces(model, forcesOf(state), b).cwiseAbs().sum();
  std::set<int> held;
  for (const Condition& support : body.conditions().displacements)
    if (!body.rigid()) held.insert(support.label);
  if (body.rigid()) held.insert(0);  // whatever the label
  for (const int label : held) {
    const Wrench reaction = quantityOf(model, state, Kind::reaction, b, label);
    sum += reaction;
    size += reaction.head(body.space() != nullptr ? 3 : 2).cwiseAbs().sum();
  }
  std::set<int> sides;
  for (const ContactInterface& interface : model.interfaces)
    for (const ContactSide& side : {interface.pair().nonmortar, interface.pair().mortar})
      if (side.body == b) sides.insert(side.label);
  for (const Tie& tie : model.ties)
    for (const ContactSide& side : {tie.pair().nonmortar, tie.pair().mortar})
      if (side.body == b) sides.insert(side.label);
  for (const int label : sides) {
    const Wrench contact = quantityOf(model, state, Kind::contactForce, b, label);
    sum += contact;
    contacts += contact;
  }
  // What moves the sides of a tie apart bears its force a third time.
  if (std::ranges::any_of(
          model.ties, [&](const Tie& tie) { return tie.sides().size() > 2 && tie.sides().back().body == b; }))
    sum -= wrenchOf(contactForces(model, forcesOf(state), b), body);
  if (body.space() != nullptr) return sum.cwiseAbs().maxCoeff();
  double reach = 0;
  for (const Point& x : body.elementNodes().places) reach = std::max(reach, x.norm());
  sum[2] /= reach;
  if (body.axisymmetric()) sum[0] = sum[2] = 0;  // the ring itself bears what points outwards
  return sum.cwiseAbs().maxCoeff();
}

double product(const Body& body, const Matrix& a, const Matrix& b) {
  double sum = 0;
  for (int i = 0; i < body.points(); ++i) sum += body.weights()[i] * a.col(i).dot(b.col(i));
  return sum;
}

class SceneBalance : public testing::TestWithParam<std::string> {};

TEST_P(SceneBalance, ofForcesAndEnergies) {
  const std::vector<std::string> stages = stagesToRun(GetParam(), {});
  const std::vector<std::string> first =
      stages.empty() ? std::vector<std::string>() : std::vector{"stage=" + stages.front()};
  ResolvedScene scene = resolveScene(readScene(GetParam(), first));
  const Model model = buildModel(scene);
  TimePlan plan = scene.description.time;
  const auto bodies = static_cast<int>(model.bodies.size());
  for (int b = 0; b < bodies; ++b) plan.quantities.push_back({"work", Kind::work, b});
  State state = initialState(model);
  findInitialEquilibrium(scene.description, model, state);

  double worstForce = 0;
  double largestForce = 0;
  std::vector<double> flow(bodies, 0.0);   // means of the stress times viscoplastic strains
  std::vector<double> euler(bodies, 0.0);  // the stress at the ends times those
  std::vector<double> start(bodies);       // before anything acts
  std::vector<double> stored(bodies);
  const auto energyOf = [&](int b, const State& of) {
    return evaluate({{"energy", Kind::storedEnergy, b}}, model, of)[0];
  };
  for (int b = 0; b < bodies; ++b) start[b] = energyOf(b, state);
  double energies = 0;
  double worstGain = 0;  // from flow, which takes energy: not more than the law is off
  State before = state;
  const RunReport report =
      march(model, state, plan, scene.description.solver, [&](const State& now, const StepReport& step) {
        Wrench contacts = Wrench::Zero();
        double sum = 0;
        double size = 0;
        for (int b = 0; b < bodies; ++b) {
          stored[b] = energyOf(b, now);
          if (step.step == 0) continue;
          sum = std::max(sum, outOfBalance(model, now, b, contacts, size));
          const BodyState& begin = before.bodies[b];
          const BodyState& end = now.bodies[b];
          const Matrix flowed = end.viscoplasticStrain - begin.viscoplasticStrain;
          flow[b] += product(model.bodies[b], begin.stress + end.stress, flowed) / 2;
          euler[b] += product(model.bodies[b], end.stress, flowed);
          worstGain = std::max(worstGain, begin.work.dissipated - end.work.dissipated);
        }
        worstForce = std::max(
            {worstForce, sum, contacts.head(scene.description.inSpace() ? 3 : 2).cwiseAbs().maxCoeff()});
        largestForce = std::max(largestForce, size);
        before = now;
      });
  ASSERT_EQ(report.status, Status::converged) << report.reason;
  const bool follows = anyFollows(model);
  EXPECT_LE(worstForce, (follows ? followingRounding : forceRounding) * largestForce);

  double worstEnergy = 0;
  for (int b = 0; b < bodies; ++b) {
    const WorkDone& work = state.bodies[b].work;
    energies += std::abs(work.external) + std::abs(work.contact) + std::abs(work.thermal) + stored[b];
    const double all = work.external + work.contact + work.thermal;
    worstEnergy = std::max(worstEnergy, std::abs(all - (stored[b] - start[b]) - flow[b]));
    if (plan.scheme == Scheme::backwardEuler)
      worstEnergy = std::max(worstEnergy, std::abs(work.dissipated - euler[b]));
  }
  std::cout << std::filesystem::path(GetParam()).stem().string() << ": forces " << worstForce / largestForce
            << ", energies " << worstEnergy / energies << ", gain " << worstGain / energies << "\n";
  EXPECT_GT(energies, 0);
  EXPECT_LE(worstGain, scene.description.solver.tolerance * energies);
  const bool heated = std::ranges::any_of(model.bodies, &Body::heated);
  const double rounding = follows ? followingRounding : heated ? heatedRounding : energyRounding;
  EXPECT_LE(worstEnergy, rounding * energies);
}

INSTANTIATE_TEST_SUITE_P(Shipped, SceneBalance, testing::ValuesIn(shippedScenes()),
                         [](const testing::TestParamInfo<std::string>& scene) {
                           std::string name = std::filesystem::path(scene.param).stem().string();
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace mortier::scene_balance_test
