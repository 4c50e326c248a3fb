#include "time/parts_of_run.h"

#include <utility>

namespace mortier {
namespace {

/// To the parts of this rank.
struct Restriction {
  const Model& model;
  [[nodiscard]] Vector nodes(size_t body, const Vector& nodal) const {
    return nodesOfPart(model.parts[body], nodal);
  }
  [[nodiscard]] Matrix points(size_t body, const Matrix& columns) const {
    return pointsOfPart(model.parts[body], columns);
  }
};

/// To the whole bodies, on the first rank.
struct Gathering {
  const Model& model;
  [[nodiscard]] Vector nodes(size_t body, const Vector& nodal) const {
    return gatheredNodes(model.parts[body], *model.ranks, nodal);
  }
  [[nodiscard]] Matrix points(size_t body, const Matrix& columns) const {
    return gatheredPoints(model.parts[body], *model.ranks, columns);
  }
};

template <class Way>
State taken(const Way& way, const State& from) {
  State state;
  state.time = from.time;
  for (size_t b = 0; b < from.bodies.size(); ++b) {
    const BodyState& body = from.bodies[b];
    state.bodies.push_back({way.nodes(b, body.displacement),
                            way.points(b, body.stress),
                            way.points(b, body.viscoplasticStrain),
                            body.work,
                            {}});
    if (body.thermalStrain.rows() > 0) state.bodies[b].thermalStrain = way.points(b, body.thermalStrain);
  }
  state.contactForce = from.contactForce;
  state.gap = from.gap;
  state.frictionForce = from.frictionForce;
  state.slipping = from.slipping;
  state.frictionWork = from.frictionWork;
  state.frictionWorkOf = from.frictionWorkOf;
  state.gapWork = from.gapWork;
  return state;
}

template <class Way>
MarchMemory taken(const Way& way, const MarchMemory& from) {
  MarchMemory memory;
  memory.begin = from.begin;
  memory.run = from.run;
  memory.timeStep = from.timeStep;
  memory.solver = from.solver;
  for (const std::vector<BodyIncrement>& stage : from.increments) {
    std::vector<BodyIncrement>& increments = memory.increments.emplace_back();
    for (size_t b = 0; b < stage.size(); ++b)
      increments.push_back(
          {{way.nodes(b, stage[b].displacement.high), way.nodes(b, stage[b].displacement.low)},
           way.points(b, stage[b].stress)});
  }
  const ControllerMemory& own = from.controller;
  memory.controller = {own.trial,    taken(way, own.start),
                       own.timeStep, own.scale,
                       own.largest,  own.local,
                       {},           own.error,
                       own.worst,    own.slip,
                       own.missed,   own.pairEnd};
  for (size_t b = 0; b < own.strain.size(); ++b)
    memory.controller.strain.push_back(way.points(b, own.strain[b]));
  return memory;
}

}  // namespace

State ofParts(const Model& model, const State& whole) {
  return taken(Restriction{model}, whole);
}

MarchMemory ofParts(const Model& model, const MarchMemory& whole) {
  return taken(Restriction{model}, whole);
}

State gathered(const Model& model, const State& own) {
  return taken(Gathering{model}, own);
}

MarchMemory gathered(const Model& model, const MarchMemory& own) {
  return taken(Gathering{model}, own);
}

}  // namespace mortier
