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

// Members are named one by one: with one more these do not compile.

template <class Way>
BodyState taken(const Way& way, size_t body, const BodyState& from) {
  const auto& [displacement, stress, viscoplastic, work, thermal] = from;
  return {way.nodes(body, displacement), way.points(body, stress), way.points(body, viscoplastic), work,
          thermal.rows() > 0 ? way.points(body, thermal) : Matrix()};
}

template <class Way>
State taken(const Way& way, const State& from) {
  const auto& [time, bodies, force, gap, friction, slipping, work, workOf, gapWork] = from;
  State state{time, {}, force, gap, friction, slipping, work, workOf, gapWork};
  for (size_t b = 0; b < bodies.size(); ++b) state.bodies.push_back(taken(way, b, bodies[b]));
  return state;
}

template <class Way>
BodyIncrement taken(const Way& way, size_t body, const BodyIncrement& from) {
  const auto& [displacement, stress] = from;
  return {{way.nodes(body, displacement.high), way.nodes(body, displacement.low)}, way.points(body, stress)};
}

template <class Way>
ControllerMemory taken(const Way& way, const ControllerMemory& from) {
  const auto& [trial, shortestInaccurate, crossing, start, timeStep, scale, largest, local, strain, error,
               worst, slip, missed, pairEnd] = from;
  ControllerMemory memory{trial,    shortestInaccurate,
                          crossing, taken(way, start),
                          timeStep, scale,
                          largest,  local,
                          {},       error,
                          worst,    slip,
                          missed,   pairEnd};
  for (size_t b = 0; b < strain.size(); ++b) memory.strain.push_back(way.points(b, strain[b]));
  for (size_t b = 0; b < missed.strain.size(); ++b) memory.missed.strain[b] = way.points(b, missed.strain[b]);
  return memory;
}

template <class Way>
MarchMemory taken(const Way& way, const MarchMemory& from) {
  const auto& [begin, run, increments, timeStep, solver, controller] = from;
  MarchMemory memory{begin, run, {}, timeStep, solver, taken(way, controller)};
  for (const std::vector<BodyIncrement>& stage : increments) {
    std::vector<BodyIncrement>& of = memory.increments.emplace_back();
    for (size_t b = 0; b < stage.size(); ++b) of.push_back(taken(way, b, stage[b]));
  }
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
