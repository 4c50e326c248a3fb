#include "solver/iterate.h"

#include <algorithm>
#include <array>
#include <utility>

#include "solver/state.h"

namespace mortier {

ActiveSets startingSets(const State& state0) {
  ActiveSets sets;
  for (const Vector& p : state0.contactForce) {
    const bool none = p.size() == 0 || p.maxCoeff() <= 0;
    std::vector<char> active(p.size());
    for (Eigen::Index i = 0; i < p.size(); ++i) active[i] = none || p[i] > 0 ? 1 : 0;
    sets.push_back(std::move(active));
  }
  return sets;
}

Iterate startingIterate(const State& state0) {
  Iterate iterate;
  for (const BodyState& body : state0.bodies)
    iterate.bodies.push_back({TwoPartVector::zero(body.displacement.size()), body.stress, {}});
  iterate.contactForce = state0.contactForce;
  iterate.active = startingSets(state0);
  iterate.frictionForce = state0.frictionForce;
  iterate.slipping = state0.slipping;
  for (size_t k = 0; k < state0.slipping.size(); ++k) {
    const Vector& t = state0.frictionForce[k];
    const std::vector<signed char>& slips = state0.slipping[k];
    iterate.slipDirections.emplace_back(t.size() > static_cast<Eigen::Index>(slips.size()) ? slips.size()
                                                                                           : 0);
    for (size_t i = 0; i < iterate.slipDirections.back().size(); ++i)
      if (slips[i] != 0)
        iterate.slipDirections.back()[i].along = t.segment<2>(2 * static_cast<Eigen::Index>(i)).normalized();
  }
  iterate.tieForce = state0.tieForce;
  return iterate;
}

/// In a step of length zero supports jump from where the state is.
void prescribe(const Model& model, const Step& step, Iterate& iterate) {
  const bool jump = step.data.time == step.state0.time;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    TwoPartVector& increment = iterate.bodies[b].increment;
    model.bodies[b].prescribeIncrement(step.state0.time, step.data.time, increment);
    if (!jump) continue;
    const Vector& u0 = step.state0.bodies[b].displacement;
    Vector u = u0;
    model.bodies[b].prescribe(step.data.time, u);
    increment.high += u - u0;
  }
  iterate.distanceChange.clear();
  if (!anyDistanceMoves(model)) return;
  for (const ContactInterface& interface : model.interfaces)
    iterate.distanceChange.emplace_back(interface.distance(step.data.time) -
                                        interface.distance(step.state0.time));
}

void addThermalStrain(const Model& model, const State& state0, StepData& data) {
  if (std::none_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) { return body.heated(); }))
    return;
  const bool shifted = !data.explicitStrain.empty();
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    data.thermal.push_back(body.heated()
                               ? Matrix(body.thermalStrain(data.time) - state0.bodies[b].thermalStrain)
                               : Matrix(Matrix::Zero(body.material().components(), body.points())));
    if (shifted)
      data.explicitStrain[b] += data.thermal[b];
    else
      data.explicitStrain.push_back(data.thermal[b]);
  }
}

void updateStrain(const Model& model, const Step& step, size_t body, Iterate& iterate) {
  BodyIterate& unknowns = iterate.bodies[body];
  unknowns.strain.resizeLike(unknowns.stress);
  model.bodies[body].strain(unknowns.increment, step.explicitStrain(body), unknowns.strain, 0,
                            model.bodies[body].points());
}

double largestMotion(const Iterate& iterate) {
  double motion = 0;
  for (const BodyIterate& body : iterate.bodies)
    motion = std::max(motion, body.increment.high.lpNorm<Eigen::Infinity>());
  return motion;
}

std::vector<Vector> displacementsOf(const State& state) {
  std::vector<Vector> u;
  for (const BodyState& body : state.bodies) u.push_back(body.displacement);
  return u;
}

std::vector<Vector> displacements(const State& state0, const Iterate& iterate) {
  std::vector<Vector> u;
  for (size_t b = 0; b < state0.bodies.size(); ++b)
    u.push_back(state0.bodies[b].displacement + iterate.bodies[b].increment.value());
  return u;
}

std::vector<Vector> gaps(const Model& model, const std::vector<Vector>& gap0, const Iterate& iterate) {
  std::vector<Vector> result;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const TwoPartVector& u1 = iterate.bodies[interface.pair().nonmortar.body].increment;
    const TwoPartVector& u2 = iterate.bodies[interface.pair().mortar.body].increment;
    // The parts apart: the first no longer changes where the iteration ends.
    result.emplace_back((gap0[k] + interface.jump(u1.high, u2.high)) + interface.jump(u1.low, u2.low));
    if (!iterate.distanceChange.empty()) result.back() -= iterate.distanceChange[k];
    if (interface.yields()) result.back() -= interface.yielded(iterate.contactForce[k]);
  }
  return result;
}

double gapWork(const State& state0, const Iterate& solution) {
  double work = 0;
  for (size_t k = 0; k < solution.distanceChange.size(); ++k)
    work -= (state0.contactForce[k] + solution.contactForce[k]).dot(solution.distanceChange[k]) / 2;
  return work;
}

std::vector<Vector> jumps(const Model& model, const State& state0, const Iterate& iterate) {
  std::vector<Vector> result;
  if (model.ties.empty()) return result;
  std::array<std::vector<Vector>, 2> increments;
  for (const BodyIterate& body : iterate.bodies) {
    increments[0].push_back(body.increment.high);
    increments[1].push_back(body.increment.low);
  }
  for (size_t k = 0; k < model.ties.size(); ++k) {
    const Tie& tie = model.ties[k];
    result.emplace_back(tie.jump(increments[0]) + tie.jump(increments[1]));
    if (tie.elastic()) result.back() -= tie.yielded(iterate.tieForce[k] - state0.tieForce[k]);
  }
  return result;
}

std::vector<Vector> slips(const Model& model, const Iterate& iterate) {
  std::vector<Vector> result;
  for (const ContactInterface& interface : model.interfaces) {
    const TwoPartVector& u1 = iterate.bodies[interface.pair().nonmortar.body].increment;
    const TwoPartVector& u2 = iterate.bodies[interface.pair().mortar.body].increment;
    result.emplace_back();
    if (interface.hasFriction())
      result.back() = interface.slip(u1.high, u2.high) + interface.slip(u1.low, u2.low);
  }
  return result;
}

std::vector<Vector> frictionWork(const std::vector<Vector>& friction0, const Iterate& solution,
                                 const std::vector<Vector>& slip0, const std::vector<Vector>& slip1) {
  std::vector<Vector> work;
  for (size_t k = 0; k < slip1.size(); ++k) {
    work.emplace_back(Vector::Zero(slip1[k].size()));
    const Eigen::Index components =
        slip1[k].size() / std::max<Eigen::Index>(1, solution.contactForce[k].size());
    for (Eigen::Index i = 0; i < slip1[k].size(); ++i)
      if (const Eigen::Index row = i / components;
          solution.slipping[k][row] != 0 || solution.contactForce[k][row] <= 0)
        work[k][i] = (friction0[k][i] * slip0[k][i] + solution.frictionForce[k][i] * slip1[k][i]) / 2;
  }
  return work;
}

std::vector<Vector> solvedGaps(const Model& model, const std::vector<Vector>& gap0, const Iterate& solution) {
  std::vector<Vector> result = gaps(model, gap0, solution);
  for (size_t k = 0; k < result.size(); ++k) {
    for (Eigen::Index i = 0; i < result[k].size(); ++i)
      if (solution.active[k][i] != 0) result[k][i] = 0;
    const ContactInterface& interface = model.interfaces[k];
    if (interface.yields()) result[k] += interface.yielded(solution.contactForce[k]);
  }
  return result;
}

bool flows(const Model& model, const State& state) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Material& material = model.bodies[b].material();
    const Matrix strain = strainOfLaw(material, state.bodies[b]);
    for (int i = 0; i < model.bodies[b].points(); ++i)
      if (material.flows(state.bodies[b].stress, i, &strain)) return true;
  }
  return false;
}

}  // namespace mortier
