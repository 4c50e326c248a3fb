// Random lines of contact between two layers, thin or thick beside their cells: loads in waves that press and
// lift, distances in waves, a body that contact alone holds, all laws, loads that come and go.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "theory/scenes.h"
#include "unit/enumerated_contact.h"

namespace mortier::scenes {

struct RandomLine {
  Model model;
  int steps = 1;
  bool elastic = true;
  std::string words;
};

inline Function waves(double mean, double amplitude, double count, double phase, double length) {
  return [=](double x, double, double t) {
    return t * (mean + amplitude * std::cos(2 * std::numbers::pi * count * x / length + phase));
  };
}

/// \param most  cells along a line
inline RandomLine randomLine(unsigned seed, int most) {
  Randoms random(seed);
  const auto uniform = [&] { return (random.below(1 << 20) + 0.5) / (1 << 20); };
  const int upperCells = 4 + random.below(most - 3);
  const int lowerCells = random.below(4) == 0 ? upperCells : std::max(3, upperCells + random.below(9) - 4);
  const double length = upperCells;
  const auto rows = [&] { return 1 + random.below(3); };
  const auto height = [&] { return std::exp(0.5 * random.normal()); };
  const int law = random.below(5);
  const auto material = [&](double E) {
    const Elasticity elasticity{E, 0.1 * random.below(5)};
    if (law < 2) return elasticMaterial(elasticity);
    constexpr Projection projections[] = {Projection::frobenius, Projection::elasticity,
                                          Projection::compliance};
    return perzynaMaterial(elasticity, {0.1, 0.5 + uniform(), projections[law - 2]});
  };
  const int rowsAbove = rows();
  const int rowsBelow = rows();
  const double above = rowsAbove * height();
  const double below = rowsBelow * height();
  const double E = 100;
  const auto upperMaterial = material(E);
  const auto lowerMaterial = material(random.below(2) == 0 ? E : 30 * E * uniform());

  const double press = 0.5 * uniform();
  const double wave = random.below(3) == 0 ? 0 : 2 * uniform();
  const Function load = waves(-press, wave * press, random.below(8), 6 * uniform(), length);
  const int held = random.below(4);
  Conditions onTop{{}, {{top, 1, load}}, {}};
  if (held == 0)
    onTop.displacements = {{left, 0, constant(0)}, {left, 1, constant(0)}};
  else if (held == 1)
    onTop = {{{top, 0, constant(0)}, {top, 1, waves(-0.003, 0.003 * wave, 3, 1, length)}}, {}, {}};
  else if (held == 2)
    onTop.displacements = {{left, 0, constant(0)}};  // contact alone holds it up
  else
    onTop.displacements = {{0, 0, constant(0), Point(0, above)}};  // and against turning
  Body upper("upper", crissCrossMesh({{0, 0}, {length, above}, upperCells, rowsAbove}), upperMaterial,
             std::move(onTop));
  Body lower("lower", crissCrossMesh({{0, -below}, {length, 0}, lowerCells, rowsBelow}), lowerMaterial,
             {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  InterfaceOptions options;
  if (random.below(2) == 0) {
    const double depth = 0.01 * uniform();
    const double count = random.below(6);
    const double phase = 6 * uniform();
    options.gap = [=](const Point& x) {
      return depth * (1 + std::cos(2 * std::numbers::pi * count * x.x() / length + phase));
    };
  }
  const CouplingKind coupling = couplings[random.below(2)];
  const int nonmortar = random.below(2);
  RandomLine line{contactModel(std::move(upper), std::move(lower), coupling, nonmortar, options),
                  law < 2 ? 1 + random.below(2) : 1 + random.below(3), law < 2, ""};
  line.words = std::string(nameOf(coupling)) + ", " + std::to_string(line.model.interfaces[0].rows()) +
               " conditions, law " + std::to_string(law) + ", held " + std::to_string(held);
  return line;
}

/// How far two results are from each other, relative to forces and displacements.
struct Difference {
  double force = 0;
  double displacement = 0;
  bool sameEnd = true;
};

/// One line solved with dense matrices and without.
inline Difference denseAndSparse(const RandomLine& line) {
  SolverOptions options;
  options.denseEntries = 1e300;
  const Result dense = run(line.model, 1, line.steps, options);
  options.denseEntries = 0;
  const Result sparse = run(line.model, 1, line.steps, options);
  Difference result;
  result.sameEnd = dense.report.status == sparse.report.status;
  if (!result.sameEnd || dense.report.status != Status::converged) return result;
  const double force = dense.state.contactForce[0].cwiseAbs().maxCoeff();
  if (force > 0)
    result.force = (dense.state.contactForce[0] - sparse.state.contactForce[0]).cwiseAbs().maxCoeff() / force;
  double size = 0;
  for (size_t b = 0; b < 2; ++b) {
    const Vector& u = dense.state.bodies[b].displacement;
    size = std::max(size, u.cwiseAbs().maxCoeff());
    result.displacement =
        std::max(result.displacement, (u - sparse.state.bodies[b].displacement).cwiseAbs().maxCoeff());
  }
  if (size > 0) result.displacement /= size;
  return result;
}

}  // namespace mortier::scenes
