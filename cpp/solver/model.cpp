#include "solver/model.h"

#include <algorithm>
#include <cmath>

namespace mortier {
namespace {

/// Whether the supports of a body leave no more than rounding of a direction at a node.
bool holds(const Body& body, int node, const Point& direction) {
  constexpr double rounding = 1e-9;
  for (const auto& [equation, value] : body.parts(node, direction))
    if (equation >= 0 && std::abs(value) > rounding) return false;
  return true;
}

}  // namespace

bool anyRough(const Model& model) {
  return std::any_of(model.interfaces.begin(), model.interfaces.end(),
                     [](const ContactInterface& interface) { return interface.rough(); });
}

bool anyDistanceMoves(const Model& model) {
  return std::any_of(model.interfaces.begin(), model.interfaces.end(),
                     [](const ContactInterface& interface) { return interface.distanceMoves(); });
}

bool solvesSparse(const Model& model, const SolverOptions& options) {
  double conditions = 0;
  double equations = 0;
  for (const ContactInterface& interface : model.interfaces) conditions += interface.rows();
  for (const Body& body : model.bodies) equations += body.freeDofs();
  return solvesSparse(conditions, equations, anyRough(model), options);
}

bool solvesSparse(double conditions, double equations, bool rough, const SolverOptions& options) {
  return !rough && options.method == Method::newton &&
         conditions * conditions * conditions > options.denseWork * equations;
}

void addInterface(Model& model, const ContactPair& pair, InterfaceOptions options) {
  const Body& nonmortar = model.bodies[pair.nonmortar.body];
  const Body& mortar = model.bodies[pair.mortar.body];
  options.nonmortarHeld = [&](int node, const Point& n) { return holds(nonmortar, node, n); };
  options.mortarHeld = [&](int node, const Point& n) { return holds(mortar, node, n); };
  model.interfaces.emplace_back(pair, ContactMesh{nonmortar.mesh(), nonmortar.elementNodes()},
                                ContactMesh{mortar.mesh(), mortar.elementNodes()}, options);
}

}  // namespace mortier
