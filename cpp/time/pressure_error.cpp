// What the elements of the mortar side do not resolve of the pressure and the friction on it: to their body
// they are tractions (data_error.cpp). A body of few triangles has smooth stresses under any of them.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/quadrature_rules.h"
#include "time/mesh_error.h"

namespace mortier {
namespace {

/// Nodal tractions along the nonmortar line from forces by rows, by node [Pa]; nodes without a row have those
/// of rows beside them. Means over row functions where these are nowhere negative.
std::map<int, double> nodalTractions(const ContactInterface& contact, int degree, const Vector& forces) {
  Vector values(contact.rows());
  if (rowDegree(contact.pair().coupling, degree) > 1) {
    values = contact.contactPressure(forces);
  } else {
    const Vector& areas = contact.weights();
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = areas[i] > 0 ? forces[i] / areas[i] : 0;
  }
  std::map<int, double> tractions;
  for (int row = 0; row < contact.rows(); ++row) tractions[contact.nonmortarNodes()[row]] = values[row];
  return tractions;
}

/// Of a piecewise linear function on an edge: 0 where no piece is.
class OnEdge {
 public:
  struct Piece {
    std::array<double, 2> at, values;
  };
  void add(const Piece& piece) { pieces_.push_back(piece); }
  [[nodiscard]] ResolvedEdge resolved() {
    std::sort(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) { return a.at < b.at; });
    double end = 0;
    for (const Piece& piece : pieces_) {
      addSamples({{end, piece.at[0]}, {0, 0}});
      addSamples(piece);
      end = std::max(end, piece.at[1]);
    }
    addSamples({{end, 1}, {0, 0}});
    return std::move(edge_);
  }

 private:
  void addSamples(const Piece& piece) {
    const double length = piece.at[1] - piece.at[0];
    if (!(length > 0)) return;
    for (const auto& [s, weight] : gaussFour)
      edge_.samples.push_back(
          {piece.at[0] + s * length, weight * length, (1 - s) * piece.values[0] + s * piece.values[1]});
  }

  std::vector<Piece> pieces_;
  ResolvedEdge edge_;
};

}  // namespace

void MeshErrorEstimator::addPressures(size_t k, const State& state,
                                      std::vector<ErrorEstimate>& estimates) const {
  const ContactInterface& contact = model_.interfaces[k];
  const ContactSide& mortar = contact.pair().mortar;
  if (model_.bodies[mortar.body].rigid()) return;
  const int degree = model_.bodies[contact.pair().nonmortar.body].degree();
  const TriangleMesh& mesh = model_.bodies[mortar.body].mesh();
  std::map<std::array<int, 2>, size_t> edgeOf;  // in the order of its vertices
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    if (mesh.boundaryLabels[e] == mortar.label) edgeOf[mesh.boundaryEdges[e]] = e;
  std::vector<const Vector*> forces{&state.contactForce[k]};
  if (contact.hasFriction()) forces.push_back(&state.frictionForce[k]);
  for (const Vector* force : forces) {
    if (force->isZero(0)) continue;
    const std::map<int, double> tractions = nodalTractions(contact, degree, *force);
    std::map<size_t, OnEdge> onEdges;
    for (const RefinedPiece& piece : contact.pieces()) {
      std::array<double, 2> ends{NAN, NAN};
      for (int i = 0; i < 2; ++i)
        if (const auto found = tractions.find(piece.nonmortar[i]); found != tractions.end())
          ends[i] = found->second;
      for (int i = 0; i < 2; ++i)
        if (std::isnan(ends[i])) ends[i] = std::isnan(ends[1 - i]) ? 0 : ends[1 - i];
      OnEdge::Piece part{piece.mortarAt, {}};
      for (int i = 0; i < 2; ++i)
        part.values[i] = (1 - piece.nonmortarAt[i]) * ends[0] + piece.nonmortarAt[i] * ends[1];
      auto edge = edgeOf.find(piece.mortar);
      if (edge == edgeOf.end()) {
        edge = edgeOf.find({piece.mortar[1], piece.mortar[0]});
        for (double& at : part.at) at = 1 - at;
      }
      if (part.at[0] > part.at[1]) {
        std::swap(part.at[0], part.at[1]);
        std::swap(part.values[0], part.values[1]);
      }
      onEdges[edge->second].add(part);
    }
    std::vector<std::pair<size_t, ResolvedEdge>> resolved;
    for (auto& [edge, on] : onEdges) resolved.emplace_back(edge, on.resolved());
    addTractions(mortar.body, resolved, state, estimates[mortar.body].error);
  }
}

}  // namespace mortier
