// Models that the theory tests share, built from the layers: no scene file, no program.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "material/perzyna.h"
#include "material/stress.h"
#include "mesh/generate.h"
#include "time/march.h"

namespace mortier::scenes {

constexpr int bottom = 1;
constexpr int right = 2;
constexpr int top = 3;
constexpr int left = 4;

constexpr int upperBody = 0;
constexpr int lowerBody = 1;

constexpr CouplingKind couplings[] = {CouplingKind::interpolation, CouplingKind::mortar};
inline const char* nameOf(CouplingKind coupling) {
  return coupling == CouplingKind::mortar ? "mortar" : "interpolation";
}

/// Rows of contact, as in the literature or stabilised.
struct Rows {
  CouplingKind kind = CouplingKind::mortar;
  bool stabilised = false;

  Rows(CouplingKind of, bool stabilise = false) : kind(of), stabilised(stabilise) {}
  operator CouplingKind() const { return kind; }
  /// \param compliance  of the mortar body [1/Pa]
  void set(InterfaceOptions& options, double compliance) const {
    options.stabilised = stabilised;
    options.mortarCompliance = compliance;
  }
};
inline const Rows meanRows[] = {CouplingKind::mortar,
                                CouplingKind::weighted,
                                {CouplingKind::mortar, true},
                                {CouplingKind::weighted, true}};
inline std::string wordOf(const Rows& rows) {
  return std::string(rows.stabilised ? "stabilised " : "") +
         (rows.kind == CouplingKind::weighted ? "weighted" : nameOf(rows.kind));
}

/// The note's material: E = 3e11 Pa, nu = 0.3, lambda = 10 Pa s, sigma_Y = 1 Pa.
constexpr Elasticity noteElasticity{3e11, 0.3};
inline Viscoplasticity noteLaw(Projection projection) {
  return {10, 1, projection};
}

inline Function constant(double value) {
  return [value](double, double, double) { return value; };
}

/// A distance that is given and does not change.
inline Datum still(const std::function<double(const Point&)>& gap) {
  Datum datum = [gap](const SpacePoint& x, double) { return gap(x.head<2>()); };
  datum.inTime = false;
  return datum;
}

inline TriangleMesh square(double lowerY, int cells) {
  return crissCrossMesh({.lower = {0, lowerY}, .upper = {1, lowerY + 1}, .cellsX = cells, .cellsY = cells});
}

/// Two bodies in contact between the bottom of the upper and the top of the lower one.
inline Model contactModel(Body upper, Body lower, CouplingKind coupling, int nonmortarBody,
                          const InterfaceOptions& options = {}) {
  Model model;
  model.bodies.push_back(std::move(upper));
  model.bodies.push_back(std::move(lower));
  const ContactSide upperSide{upperBody, bottom};
  const ContactSide lowerSide{lowerBody, top};
  const bool first = nonmortarBody == upperBody;
  const ContactPair pair{first ? upperSide : lowerSide, first ? lowerSide : upperSide, coupling};
  addInterface(model, pair, options);
  return model;
}

/// The note's compression test: unit squares that meet on y = 0, rollers on the left and below, -10 t on the
/// top.
inline Model compression(int upperCells, int lowerCells, const std::shared_ptr<const Material>& material,
                         CouplingKind coupling, int nonmortarBody) {
  const Function load = [](double, double, double t) { return -10 * t; };
  Body upper("upper", square(0, upperCells), material, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
  Body lower("lower", square(-1, lowerCells), material,
             {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return contactModel(std::move(upper), std::move(lower), coupling, nonmortarBody);
}

struct Result {
  State state;
  RunReport report;
};

inline Result run(const Model& model, double end, int steps, const SolverOptions& options = {}) {
  Result result{initialState(model), {}};
  result.report = march(model, result.state, {.end = end, .steps = steps}, options,
                        [](const State&, const StepReport&) {});
  return result;
}

inline double interpenetration(const Model& model, const State& state) {
  const ContactInterface& interface = model.interfaces[0];
  return interface.interpenetration(state.bodies[interface.pair().nonmortar.body].displacement,
                                    state.bodies[interface.pair().mortar.body].displacement);
}

struct Range {
  double min = INFINITY;
  double max = -INFINITY;
  double sum = 0;
  int count = 0;
  void add(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
    sum += value;
    ++count;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  /// Largest distance from a value.
  [[nodiscard]] double distance(double value) const {
    return std::max(std::abs(min - value), std::abs(max - value));
  }
};

inline Range vonMisesRange(const State& state) {
  Range range;
  for (const BodyState& body : state.bodies)
    for (Eigen::Index i = 0; i < body.stress.cols(); ++i) range.add(vonMises(body.stress.col(i)));
  return range;
}

/// A component of the displacement at the nodes that `where` picks.
template <class Where>
Range displacementRange(const Body& body, const BodyState& state, int component, Where where) {
  Range range;
  for (int v = 0; v < body.nodes(); ++v)
    if (where(body.elementNodes().places[v])) range.add(state.displacement[2 * v + component]);
  return range;
}

// The work of loads and supports on two bodies, as a run counts it (time/count_work.cpp).

inline std::vector<Quantity> externalWorks() {
  std::vector<Quantity> works(2);
  for (int b = 0; b < 2; ++b) {
    works[b].kind = Quantity::Kind::externalWork;
    works[b].body = b;
  }
  return works;
}
inline double workSince(const State& before, const State& now) {
  double work = 0;
  for (size_t b = 0; b < now.bodies.size(); ++b)
    work += now.bodies[b].work.external - before.bodies[b].work.external;
  return work;
}

/// Exponent of h fitted to the errors by least squares.
inline double fittedOrder(const std::vector<double>& h, const std::vector<double>& errors) {
  double x = 0;
  double y = 0;
  double xx = 0;
  double xy = 0;
  const auto n = static_cast<double>(h.size());
  for (size_t i = 0; i < h.size(); ++i) {
    x += std::log(h[i]) / n;
    y += std::log(errors[i]) / n;
  }
  for (size_t i = 0; i < h.size(); ++i) {
    xx += (std::log(h[i]) - x) * (std::log(h[i]) - x);
    xy += (std::log(h[i]) - x) * (std::log(errors[i]) - y);
  }
  return xy / xx;
}

}  // namespace mortier::scenes
