// Random lines of contact between two or three layers, thin or thick beside their cells, straight or bent,
// linear or quadratic, in a plane or around an axis: loads in waves that press and lift, distances in waves,
// bodies that contact alone holds, all laws, loads that come and go, steps of all kinds.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "material/deviatoric.h"
#include "theory/scenes.h"
#include "unit/enumerated_contact.h"

namespace mortier::scenes {

struct RandomLine {
  Model model;
  TimePlan time;
  bool restarted = false;  ///< the run is to be stopped after its first step, and to go on from there
  std::string words;
};

/// What a length and a stress of one are called.
struct RandomUnits {
  double length = 1;
  double stress = 1;
};

inline Function waves(double mean, double amplitude, double count, double phase, double length) {
  return [=](double x, double, double t) {
    return t * (mean + amplitude * std::cos(2 * std::numbers::pi * count * x / length + phase));
  };
}

/// \param most  cells along a line
inline RandomLine randomLine(unsigned seed, int most, const RandomUnits& units = {}) {
  Randoms random(seed);
  const auto uniform = [&] { return (random.below(1 << 20) + 0.5) / (1 << 20); };
  const int cells = 4 + random.below(most - 3);
  const double length = cells * units.length;
  const int law = random.below(5);
  const bool ring = random.below(6) == 0;
  const int degree = random.below(5) == 0 ? 2 : 1;
  const auto material = [&](double E) -> std::shared_ptr<const Material> {
    const Elasticity elasticity{E * units.stress, 0.1 * random.below(5)};
    constexpr Projection projections[] = {Projection::frobenius, Projection::elasticity,
                                          Projection::compliance};
    const Viscoplasticity flow{0.1 * units.stress, (0.5 + uniform()) * units.stress,
                               projections[std::max(law - 2, 0)]};
    if (law < 2) return ring ? elasticMaterial(elasticity, Plane::strain) : elasticMaterial(elasticity);
    return ring ? perzynaMaterial(elasticity, flow, Plane::strain) : perzynaMaterial(elasticity, flow);
  };
  constexpr double E = 100;
  const double press = 0.5 * uniform() * units.stress;
  const double wave = random.below(3) == 0 ? 0 : 2 * uniform();
  const Function load = waves(-press, wave * press, random.below(8), 6 * uniform(), length);
  const double bend = random.below(4) == 0 ? 0.02 * length * uniform() : 0;
  const double bends = 1 + random.below(3);
  const auto bent = [&](TriangleMesh mesh) {
    for (Point& v : mesh.vertices) v.y() += bend * std::sin(bends * std::numbers::pi * v.x() / length);
    return mesh;
  };

  const int held = random.below(ring ? 3 : 4);
  const int layers = random.below(4) == 0 ? 3 : 2;
  RandomLine line;
  double y = 0;
  std::string heights;
  for (int b = 0; b < layers; ++b) {
    const int across = 1 + random.below(degree == 2 ? 2 : 3);
    const int along = b == 0 || random.below(4) == 0 ? cells : std::max(3, cells + random.below(9) - 4);
    const double height = across * std::exp(random.normal()) * units.length;
    const double upper = y;
    y -= height;
    heights += " " + std::to_string(height / units.length);
    Conditions conditions;
    if (b == layers - 1) {
      conditions.displacements = {{left, 0, constant(0)}, {bottom, 1, constant(0)}};
    } else if (b > 0) {
      conditions.displacements = {{left, 0, constant(0)}};  // contact alone holds it up
    } else if (held == 1) {
      const Function motion = waves(-0.003 * units.length, 0.003 * wave * units.length, 3, 1, length);
      conditions.displacements = {{top, 0, constant(0)}, {top, 1, motion}};
    } else {
      conditions.tractions = {{top, 1, load}};
      if (held == 0) conditions.displacements = {{left, 0, constant(0)}, {left, 1, constant(0)}};
      if (held == 2) conditions.displacements = {{left, 0, constant(0)}};
      if (held == 3)
        conditions.displacements = {{0, 0, constant(0), SpacePoint(0, upper, 0)}};  // against turning
    }
    line.model.bodies.emplace_back("body " + std::to_string(b),
                                   bent(crissCrossMesh({{0, y}, {length, upper}, along, across})),
                                   material(b == 0 || random.below(2) == 0 ? E : 30 * E * uniform()),
                                   std::move(conditions), degree, ring);
  }
  for (int b = 0; b + 1 < layers; ++b) {
    InterfaceOptions options;
    options.axisymmetric = ring;
    if (random.below(2) == 0) {
      const double depth = 0.01 * uniform() * units.length;
      const double count = random.below(6);
      const double phase = 6 * uniform();
      options.gap = still([=](const Point& x) {
        return depth * (1 + std::cos(2 * std::numbers::pi * count * x.x() / length + phase));
      });
    } else if (bend != 0) {
      options.initial = InitialGap::close;
    }
    const ContactSide upperSide{b, bottom};
    const ContactSide lowerSide{b + 1, top};
    const CouplingKind coupling = couplings[random.below(2)];
    const bool first = random.below(2) == 0;
    addInterface(line.model, {first ? upperSide : lowerSide, first ? lowerSide : upperSide, coupling},
                 options);
    line.words += std::string(nameOf(coupling)) + " ";
  }
  line.time = {.end = 1, .steps = 1 + random.below(law < 2 ? 2 : 3)};
  if (law >= 2 && random.below(8) == 0) line.time.tolerance = 0.02;
  line.restarted = random.below(4) == 0;
  int conditions = 0;
  for (const ContactInterface& interface : line.model.interfaces) conditions += interface.rows();
  line.words += std::to_string(conditions) + " conditions, law " + std::to_string(law) + ", held " +
                std::to_string(held) + ", heights" + heights + ", degree " + std::to_string(degree) +
                (ring ? ", axisymmetric" : "") + (bend > 0 ? ", bent" : "") +
                (line.time.controlled() ? ", steps by error" : "") + (line.restarted ? ", restarted" : "");
  return line;
}

/// Runs a line. \param restart  from the state after the first step.
inline Result runLine(const RandomLine& line, const SolverOptions& options, bool restart = false) {
  Result result{initialState(line.model), {}};
  MarchMemory memory;
  State firstState;
  MarchMemory firstMemory;
  const auto keep = [&](const State& state, const StepReport& report) {
    if (report.step != 1) return;
    firstState = state;
    firstMemory = memory;
  };
  result.report = march(line.model, result.state, memory, line.time, options, keep);
  if (!restart || firstState.bodies.empty()) return result;
  result.state = firstState;
  result.report = march(line.model, result.state, firstMemory, line.time, options,
                        [](const State&, const StepReport&) {});
  return result;
}

/// How far two results are from each other, relative to forces and displacements.
struct Difference {
  double force = 0;
  double displacement = 0;
  bool sameEnd = true;
  bool converged = false;
};

inline Difference differenceOf(const Result& a, const Result& b) {
  Difference result;
  result.sameEnd = a.report.status == b.report.status;
  result.converged = result.sameEnd && a.report.status == Status::converged;
  if (!result.converged) return result;
  const auto worst = [](double& difference, double& size, const Vector& x, const Vector& y) {
    difference = std::max(difference, (x - y).cwiseAbs().maxCoeff());
    size = std::max(size, x.cwiseAbs().maxCoeff());
  };
  double force = 0;
  double displacement = 0;
  for (size_t k = 0; k < a.state.contactForce.size(); ++k)
    worst(result.force, force, a.state.contactForce[k], b.state.contactForce[k]);
  for (size_t i = 0; i < a.state.bodies.size(); ++i)
    worst(result.displacement, displacement, a.state.bodies[i].displacement, b.state.bodies[i].displacement);
  if (force > 0) result.force /= force;
  if (displacement > 0) result.displacement /= displacement;
  return result;
}

inline SolverOptions sparseContact() {
  SolverOptions options;
  options.denseWork = 0;
  return options;
}

/// The tolerance also decides how much rounding is left in contact (solver/newton.cpp).
inline SolverOptions denseContact(double tolerance) {
  SolverOptions options;
  options.denseWork = std::numeric_limits<double>::infinity();
  options.tolerance = tolerance;
  return options;
}

/// One line solved without dense matrices, and with them to a hundredth of the tolerance.
inline Difference denseAndSparse(const RandomLine& line) {
  return differenceOf(runLine(line, denseContact(1e-13)), runLine(line, sparseContact(), line.restarted));
}

}  // namespace mortier::scenes
