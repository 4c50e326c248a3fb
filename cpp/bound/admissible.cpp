#include "bound/admissible.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "bound/pressures.h"

namespace mortier {

Admissible::Admissible(const Model& of, const State& state) : model(of) {
  obstacle = construct(state);
}

std::string Admissible::foreseen(const Model& model, const State& state) {
  std::vector<SideDatum> distances;
  return Admissible(model).place(state, distances);
}

/// The bodies with their data, on meshes that match.
std::string Admissible::place(const State& state, std::vector<SideDatum>& distances) {
  for (const Body& body : model.bodies) {
    if (body.degree() != 1) return "displacements are quadratic";
    for (const Condition& held : body.conditions().displacements)
      if (held.point) return body.name() + " is held at a point";
  }
  meshes = matchedMeshes(model, state.time);
  if (!meshes.obstacle.empty()) return meshes.obstacle;

  bodies.reserve(model.bodies.size());
  for (size_t b = 0; b < model.bodies.size(); ++b)
    bodies.emplace_back(model, state, meshes.bodies[b], static_cast<int>(b));
  for (size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].data().curvedSupport) return model.bodies[b].name() + " is held along a curve";
    if (!bodies[b].data().obstacle.empty()) return bodies[b].data().obstacle;
    if (beyondLinear.empty()) beyondLinear = bodies[b].data().beyond;
  }
  const bool given = std::any_of(model.interfaces.begin(), model.interfaces.end(),
                                 [](const ContactInterface& each) { return bool(each.given()); });
  distances.resize(given ? meshes.pieces.size() : 0);
  for (size_t k = 0; k < distances.size(); ++k) {
    MatchedPiece& piece = meshes.pieces[k];
    const Datum& gap = model.interfaces[piece.interface].given();
    if (!gap) continue;
    const auto& x = bodies[model.interfaces[piece.interface].pair().nonmortar.body].mesh().vertices;
    distances[k] = onSide(gap, x[piece.vertices[0][0]], x[piece.vertices[0][1]], state.time);
    if (!distances[k].known || !std::isfinite(distances[k].slope))
      return "the gap is not known to be continuous";
    piece.distance = distances[k].ends;
    if (!distances[k].linear() && beyondLinear.empty())
      beyondLinear = "the gap is not linear on pieces of the contact line";
  }
  return "";
}

std::string Admissible::construct(const State& state) {
  std::vector<SideDatum> distances;
  if (std::string fault = place(state, distances); !fault.empty()) return fault;

  spread = spreadPressures(model, state, meshes);
  if (!balancePressures(model, meshes, bodies, spread))
    return "bodies that contact alone holds are not in equilibrium with a pressure that is nowhere negative";
  std::vector<std::array<double, 2>> pressures;
  for (const MatchedPiece& piece : meshes.pieces) {
    pressures.push_back(pressureOn(piece, spread));
    strictness.leastPressure = std::min({strictness.leastPressure, pressures.back()[0], pressures.back()[1]});
    press(piece, model, pressures.back(), bodies);
  }

  double largest = 0;
  for (LoadedBody& body : bodies) {
    if (!body.balance()) return "a tangent is singular";
    const auto [worst, size] = body.imbalance();
    strictness.imbalance = std::max(strictness.imbalance, worst);
    largest = std::max(largest, size);
  }
  for (const MatchedPiece& piece : meshes.pieces) {
    const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
    strictness.mismatch =
        std::max(strictness.mismatch, mismatchOf(piece, pressures[&piece - meshes.pieces.data()],
                                                 bodies[nonmortar.body].asPressed(piece.vertices[0]),
                                                 bodies[mortar.body].asPressed(piece.vertices[1])));
  }
  if (largest > 0) {
    strictness.imbalance /= largest;
    strictness.mismatch /= largest;
  }
  if (!strictness.broken().empty()) return strictness.broken();
  lifting = lift(bodies, model, meshes.pieces, pressures);
  if (!lifting.obstacle.empty()) return lifting.obstacle;
  strictness.leastGap = leastGapOf(model, meshes.pieces, lifting.displacements);
  if (!strictness.broken().empty()) return strictness.broken();
  addDefect();
  return moveGaps(distances);
}

/// Where the gap is not linear on a piece the two bodies take up the rest, unless nothing presses there and
/// the piece stays open without.
std::string Admissible::moveGaps(const std::vector<SideDatum>& distances) {
  for (size_t k = 0; k < distances.size(); ++k) {
    if (distances[k].linear()) continue;
    const MatchedPiece& piece = meshes.pieces[k];
    const auto [first, last] = lifting.facingOfPiece[k];
    const auto pressure = pressureOn(piece, spread);
    const double gap = std::min(lifting.facing[first].gap, lifting.facing[last].gap);
    if (std::max(pressure[0], pressure[1]) == 0 && gap > 0 && -distances[k].least <= gap / 2) {
      gapFraction = std::min(gapFraction, 1 + distances[k].least / gap);
      continue;
    }
    const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
    const std::array<int, 2> sides{nonmortar.body, mortar.body};
    const std::array<Point, 2> along{piece.normal, -piece.normal};
    // Shares that go with the compliances have the least energy.
    std::array<double, 2> share{};
    for (int side = 0; side < 2; ++side) {
      const LoadedBody& body = bodies[sides[side]];
      if (!body.isFree(piece.vertices[side])) continue;
      const double norm = body.movedEnergy(piece.vertices[side], along[side], distances[k]);
      share[side] = 1 / (norm * norm);
    }
    if (share[0] + share[1] == 0) return "supports hold both sides where the gap is not linear";
    for (int side = 0; side < 2; ++side)
      if (share[side] > 0)
        bodies[sides[side]].move(piece.vertices[side], along[side],
                                 distances[k].times(share[side] / (share[0] + share[1])));
  }
  return "";
}

/// Forces that rounding leaves in triangles, and at contact lines whose points are not quite the same: each
/// is carried by a body as compliant as the run's loads show.
void Admissible::addDefect() {
  double left = 0;
  double moved = 0;
  double force = 0;
  double triangles = 0;
  for (const auto& body : bodies) {
    left = std::max(left, body.imbalance().worst + body.data().error);
    moved = std::max(moved, body.place().displacement.lpNorm<Eigen::Infinity>());
    force = std::max(force, body.imbalance().largest);
    triangles += static_cast<double>(body.mesh().triangles.size());
  }
  double pressed = 0;
  for (const Vector& each : spread) pressed = std::max(pressed, each.size() > 0 ? each.maxCoeff() : 0);
  const double all =
      std::sqrt(triangles) * left + static_cast<double>(meshes.pieces.size()) * meshes.apart * pressed;
  if (force > 0) defect = all * std::sqrt(moved / force);
}

}  // namespace mortier
