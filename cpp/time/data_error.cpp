// What data that the discrete problem does not resolve add to the error: the part w of a datum that neither
// the trial functions nor the recovered stress can follow. Of waves of wave number k on the edge of a half
// plane
//
//   tractions        2/E |w|_-1/2^2,      |w|_-1/2^2 = |W| |w|,    W' = w off the L2 projection onto traces,
//   displacements    E/2 |w|_1/2^2,       |w|_1/2^2  ~ |w| |w'|,   w off the interpolant,
//   distances        E*/2 |w|_1/2^2,      1/E* = 1/E1 + 1/E2,      where the bodies press,
//
// and of a triangle of size d  2/E (d/pi)^2 |w|^2  for body forces, |w|^2/E for initial stresses and
// E |expansion|^2 |w|^2 for temperatures.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem/data_misfit.h"
#include "time/mesh_error.h"

namespace mortier {
namespace {

/// The nodes of an edge: its ends, and of a quadratic one its middle.
std::vector<Point> placesOf(const Body& body, size_t edge) {
  const ElementNodes& nodes = body.elementNodes();
  const auto& [a, b] = body.mesh().boundaryEdges[edge];
  std::vector<Point> places{nodes.places[a], nodes.places[b]};
  if (nodes.degree > 1) places.push_back(nodes.places[nodes.middles[edge]]);
  return places;
}

std::vector<Point> placesOfTriangle(const Body& body, size_t triangle) {
  std::vector<Point> places;
  for (int a = 0; a < body.elementNodes().perElement(); ++a)
    places.push_back(body.elementNodes().places[body.elementNodes().of(triangle)[a]]);
  return places;
}

Misfit offInterpolant(const Body& body, const Datum& datum, const std::vector<Point>& places, double t) {
  std::array<double, 3> values{};
  for (size_t a = 0; a < places.size(); ++a) values[a] = datum(places[a].x(), places[a].y(), t);
  return interpolationMisfit(onEdge(datum, places, t), values, body.degree());
}

bool unresolved(const Body& body, const Datum& datum) {
  return datum && datum.degree > body.degree();
}

bool isOnEdges(const Condition& held) {
  return !held.point && !held.onAxis;
}

/// |w| |w'| on an edge.
double halfNorm(const Misfit& w) {
  return std::sqrt(w.square * w.slope);
}

}  // namespace

bool MeshErrorEstimator::hasVaryingData(const Body& body) {
  const Conditions& data = body.conditions();
  const auto any = [&](const auto& all) {
    return std::any_of(all.begin(), all.end(),
                       [&](const auto& each) { return unresolved(body, each.value); });
  };
  return any(data.displacements) || any(data.tractions) || any(data.forces) || any(data.initialStresses) ||
         (body.heated() && unresolved(body, data.temperature));
}

void MeshErrorEstimator::addAtEdge(size_t b, size_t edge, double energy, bool needsTotalStrain,
                                   const State& state, Vector& error) const {
  const Body& body = model_.bodies[b];
  const int index = static_cast<int>(b);
  const int triangle =
      elementBehind(index, body.mesh().boundaryLabels[edge], body.mesh().boundaryEdges[edge]);
  const Compliance compliance = complianceOf(state, index, triangle);
  const std::vector<Point> places = placesOf(body, edge);
  error[triangle] +=
      body.depthAt((places[0] + places[1]) / 2) * energy *
      (needsTotalStrain ? compliance.elastic / (compliance.all * compliance.all) : compliance.elastic);
}

void MeshErrorEstimator::addTractions(size_t b, const std::vector<std::pair<size_t, ResolvedEdge>>& tractions,
                                      const State& state, Vector& error) const {
  const Body& body = model_.bodies[b];
  std::vector<LineEdge> edges;
  for (const auto& [e, traction] : tractions) {
    const auto& [from, to] = body.mesh().boundaryEdges[e];
    const std::vector<Point> places = placesOf(body, e);
    edges.push_back({traction,
                     {from, to, body.degree() > 1 ? body.elementNodes().middles[e] : -1},
                     (places[1] - places[0]).norm()});
  }
  const std::vector<std::array<double, 3>> seen = lineProjection(edges, body.degree());
  for (size_t i = 0; i < edges.size(); ++i) {
    const Misfit w = interpolationMisfit(edges[i].datum, seen[i], body.degree());
    addAtEdge(b, tractions[i].first, 2 * edges[i].length * edges[i].length * w.minusHalf, false, state,
              error);
  }
}

void MeshErrorEstimator::addEdgeData(size_t b, const State& state, Vector& error) const {
  const Body& body = model_.bodies[b];
  const TriangleMesh& mesh = body.mesh();
  const auto forEachEdge = [&](int label, const auto& work) {
    for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
      if (mesh.boundaryLabels[e] == label) work(e, placesOf(body, e));
  };
  for (const Condition& traction : body.conditions().tractions) {
    if (!unresolved(body, traction.value)) continue;
    std::vector<std::pair<size_t, ResolvedEdge>> edges;
    forEachEdge(traction.label, [&](size_t e, const std::vector<Point>& places) {
      edges.emplace_back(e, onEdge(traction.value, places, state.time));
    });
    addTractions(b, edges, state, error);
  }
  for (const Condition& held : body.conditions().displacements) {
    if (!isOnEdges(held) || !unresolved(body, held.value)) continue;
    forEachEdge(held.label, [&](size_t e, const std::vector<Point>& places) {
      addAtEdge(b, e, halfNorm(offInterpolant(body, held.value, places, state.time)) / 2, true, state, error);
    });
  }
}

void MeshErrorEstimator::addTriangleData(size_t b, double t, bool steady, Vector& error) const {
  constexpr double shear = 2.6;  // over the compliance along an axis
  const Body& body = model_.bodies[b];
  const Conditions& data = body.conditions();
  const int points = body.pointsOfTriangle();
  const auto forEachTriangle = [&](const Datum& datum, bool isSteady, const auto& factor) {
    if (!unresolved(body, datum) || isSteady != steady) return;
    for (Eigen::Index k = 0; k < error.size(); ++k) {
      const std::vector<Point> places = placesOfTriangle(body, k);
      double area = 0;
      for (int i = 0; i < points; ++i) area += body.weights()[points * k + i];
      error[k] += area * factor(k, places) * misfit(onTriangle(datum, places, t), body.degree()).square;
    }
  };
  const auto compliance = [&](Eigen::Index k) { return compliances_[b][points * k]; };
  for (const BodyForce& force : data.forces)
    forEachTriangle(force.value, !force.value.inTime, [&](Eigen::Index k, const std::vector<Point>& x) {
      const double square =
          std::max({(x[1] - x[0]).squaredNorm(), (x[2] - x[1]).squaredNorm(), (x[0] - x[2]).squaredNorm()});
      return 2 * compliance(k) * square / (std::numbers::pi * std::numbers::pi);
    });
  for (const InitialStress& stress : data.initialStresses)
    forEachTriangle(stress.value, true, [&](Eigen::Index k, const auto& /*places*/) {
      if (stress.region && body.mesh().regions[k] != *stress.region) return 0.0;
      return (stress.component == 2 ? shear : 1) * compliance(k);
    });
  if (body.heated())
    forEachTriangle(data.temperature, !data.temperature.inTime, [&](Eigen::Index k, const auto& /*places*/) {
      return data.expansion.col(points * k).squaredNorm() / compliance(k);
    });
}

std::vector<MeshErrorEstimator::GivenGap> MeshErrorEstimator::givenGaps(size_t k, double t) const {
  const ContactInterface& contact = model_.interfaces[k];
  const auto& [nonmortar, mortar, coupling] = contact.pair();
  const Body& body = model_.bodies[nonmortar.body];
  std::vector<GivenGap> gaps;
  if (!unresolved(body, contact.given())) return gaps;
  for (size_t e = 0; e < body.mesh().boundaryEdges.size(); ++e) {
    if (body.mesh().boundaryLabels[e] != nonmortar.label) continue;
    const std::vector<Point> places = placesOf(body, e);
    const Misfit w = offInterpolant(body, contact.given(), places, t);
    gaps.push_back(
        {body.mesh().boundaryEdges[e], body.depthAt((places[0] + places[1]) / 2) * halfNorm(w), w.most});
  }
  return gaps;
}

void MeshErrorEstimator::addGivenGaps(size_t k, const State& state,
                                      std::vector<ErrorEstimate>& estimates) const {
  const ContactInterface& contact = model_.interfaces[k];
  const auto& [nonmortar, mortar, coupling] = contact.pair();
  const std::vector<GivenGap> moving =
      contact.given().inTime ? givenGaps(k, state.time) : std::vector<GivenGap>();
  const std::vector<GivenGap>& gaps = contact.given().inTime ? moving : givenGaps_[k];
  if (gaps.empty()) return;
  // How far open the nodes are; those without a row are as their neighbours.
  const Vector gap = contact.gap(state.bodies[nonmortar.body].displacement,
                                 state.bodies[mortar.body].displacement, state.time);
  std::vector<double> open(model_.bodies[nonmortar.body].nodes(), INFINITY);
  for (int row = 0; row < contact.rows(); ++row) {
    double& here = open[contact.nonmortarNodes()[row]];
    here = std::min(here, state.contactForce[k][row] > 0 ? 0 : -gap[row]);
  }
  Compliance facing;  // the softest of the other side: it is what yields
  for (const auto& [side, triangle] : behind_.at({mortar.body, mortar.label})) {
    const Compliance here = complianceOf(state, mortar.body, triangle);
    if (facing.all == 0 || here.all < facing.all) facing = here;
  }
  for (const auto& [edge, square, most] : gaps) {
    if (!(std::min(open[edge[0]], open[edge[1]]) < most)) continue;
    const int triangle = elementBehind(nonmortar.body, nonmortar.label, edge);
    const Compliance compliance = complianceOf(state, nonmortar.body, triangle) + facing;
    estimates[nonmortar.body].error[triangle] +=
        compliance.elastic / (compliance.all * compliance.all) / 2 * square;
  }
}

void MeshErrorEstimator::readData() {
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    steadyData_.emplace_back();
    if (!hasVaryingData(body)) continue;
    steadyData_[b] = Vector::Zero(static_cast<Eigen::Index>(body.mesh().triangles.size()));
    addTriangleData(b, 0, true, steadyData_[b]);
    for (const Condition& each : body.conditions().tractions)
      if (unresolved(body, each.value)) addSides(static_cast<int>(b), each.label);
    for (const Condition& each : body.conditions().displacements)
      if (isOnEdges(each) && unresolved(body, each.value)) addSides(static_cast<int>(b), each.label);
  }
  for (size_t k = 0; k < model_.interfaces.size(); ++k)
    givenGaps_.push_back(model_.interfaces[k].given().inTime ? std::vector<GivenGap>() : givenGaps(k, 0));
}

void MeshErrorEstimator::addData(const State& state, std::vector<ErrorEstimate>& estimates) const {
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    if (steadyData_[b].size() == 0) continue;
    estimates[b].error += steadyData_[b];
    addEdgeData(b, state, estimates[b].error);
    addTriangleData(b, state.time, false, estimates[b].error);
  }
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    addGivenGaps(k, state, estimates);
    addPressures(k, state, estimates);
  }
}

}  // namespace mortier
