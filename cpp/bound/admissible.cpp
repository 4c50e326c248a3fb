#include "bound/admissible.h"

#include <algorithm>
#include <array>

#include "bound/pressures.h"

namespace mortier {
namespace {

bool fits(const EarlierContact& earlier, const MatchedMeshes& meshes, const std::vector<Vector>& spread) {
  const bool gaps = earlier.gaps.empty() || earlier.gaps.size() == meshes.pieces.size();
  return gaps && (earlier.pressures.empty() ||
                  std::equal(earlier.pressures.begin(), earlier.pressures.end(), spread.begin(), spread.end(),
                             [](const Vector& a, const Vector& b) { return a.size() == b.size(); }));
}

/// Rows that had no pressure give their force to the nearest that had. \returns whether there is one
bool pressWhereItDid(const std::vector<Vector>& before, const MatchedMeshes& meshes,
                     std::vector<Vector>& spread) {
  std::vector<Vector> widths;
  for (const Vector& each : spread) widths.emplace_back(Vector::Zero(each.size()));
  for (const MatchedPiece& piece : meshes.pieces)
    for (int k = 0; k < 2 && piece.rows[k] >= 0; ++k)
      widths[piece.interface][piece.rows[k]] += piece.length * (piece.values[k][0] + piece.values[k][1]) / 2;
  for (size_t i = 0; i < spread.size(); ++i)
    for (Eigen::Index row = 0; row < spread[i].size(); ++row) {
      if (before[i][row] > 0 || spread[i][row] == 0) continue;
      Eigen::Index nearest = -1;
      for (Eigen::Index other = 0; other < spread[i].size(); ++other)
        if (before[i][other] > 0 && widths[i][other] > 0 &&
            (nearest < 0 || std::abs(other - row) < std::abs(nearest - row)))
          nearest = other;
      if (nearest < 0) return false;
      spread[i][nearest] += spread[i][row] * widths[i][row] / widths[i][nearest];
      spread[i][row] = 0;
    }
  return true;
}

}  // namespace

Admissible::Admissible(const Model& model, const State& state, double weight, const EarlierContact& earlier) {
  obstacle = construct(model, state, weight, earlier);
}

std::string Admissible::construct(const Model& model, const State& state, double weight,
                                  const EarlierContact& earlier) {
  for (const Body& body : model.bodies) {
    if (body.degree() != 1) return "displacements are quadratic";
    for (const PrescribedDisplacement& held : body.conditions().displacements)
      if (held.point) return body.name() + " is held at a point";
  }
  meshes = matchedMeshes(model);
  if (!meshes.obstacle.empty()) return meshes.obstacle;

  bodies.reserve(model.bodies.size());
  for (size_t b = 0; b < model.bodies.size(); ++b)
    bodies.emplace_back(model, state, meshes.bodies[b], static_cast<int>(b), weight);
  for (size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].hasCurvedSupport()) return model.bodies[b].name() + " is held along a curve";

  spread = spreadPressures(model, state, meshes);
  if (!fits(earlier, meshes, spread)) return "contact of the step before is of other meshes";
  if (!earlier.pressures.empty() && !pressWhereItDid(earlier.pressures, meshes, spread))
    return "contact presses where nothing of the line did";
  if (!balancePressures(model, meshes, bodies, spread))
    return "bodies that contact alone holds are not in equilibrium with a pressure that is nowhere negative";
  std::vector<std::array<double, 2>> pressures;
  for (const MatchedPiece& piece : meshes.pieces) {
    pressures.push_back(pressureOn(piece, spread));
    strictness.leastPressure = std::min({strictness.leastPressure, pressures.back()[0], pressures.back()[1]});
    const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
    const auto moments = momentsOfLinear(pressures.back(), piece.length);
    bodies[nonmortar.body].press(piece.vertices[0], piece.normal, moments);
    bodies[mortar.body].press(piece.vertices[1], -piece.normal, moments);
  }

  double largest = 0;
  std::vector<LiftedBody> lifted;
  for (LoadedBody& body : bodies) {
    if (!body.balance()) return "a tangent is singular";
    const auto [worst, size] = body.imbalance();
    strictness.imbalance = std::max(strictness.imbalance, worst);
    largest = std::max(largest, size);
    oscillation.add(body.oscillation());
    lifted.push_back(body.lifted());
  }
  for (const MatchedPiece& piece : meshes.pieces) {
    const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
    strictness.mismatch =
        std::max(strictness.mismatch, mismatchOf(piece, pressures[&piece - meshes.pieces.data()],
                                                 bodies[nonmortar.body].momentsBetween(piece.vertices[0]),
                                                 bodies[mortar.body].momentsBetween(piece.vertices[1])));
  }
  if (largest > 0) {
    strictness.imbalance /= largest;
    strictness.mismatch /= largest;
  }
  if (!strictness.broken().empty()) return strictness.broken();
  lifting = lift(lifted, model, meshes.pieces, pressures, earlier.gaps);
  if (!lifting.obstacle.empty()) return lifting.obstacle;
  strictness.leastGap = leastGapOf(model, meshes.pieces, lifting.displacements);
  return strictness.broken();
}

}  // namespace mortier
