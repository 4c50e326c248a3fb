#include "time/singular_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "material/stress.h"
#include "mesh/simplices.h"

namespace mortier {
namespace {

constexpr double nextTo = 1.5;  // edges

/// kappa of a material, from what it makes of stresses; in space that of plane strain.
double kappaOf(const Body& body) {
  const int components = body.material().components();
  Matrix stress = Matrix::Zero(components, body.points());
  Matrix strain = stress;
  if (body.dimension() == 3) {
    stress.topRows<6>().colwise() = fromSpaceCartesian(SpaceStress::Unit(0));
    body.material().elasticStrain(stress, strain);
    const SpaceStress along = toSpaceCartesian(strain.col(0).head<6>());
    return 3 + 4 * along[1] / along[0];
  }
  const auto compliance = [&](int component) {
    stress.setZero();
    stress.row(component).setOnes();
    body.material().elasticStrain(stress, strain);
    return strain(component, 0);
  };
  const double shear = compliance(1);  // (1 + nu)/E
  if (components > 3) return 3 - 4 * (shear / compliance(3) - 1);
  const double all = compliance(0);  // (1 - nu)/E
  const double poisson = (shear - all) / (shear + all);
  return (3 - poisson) / (1 + poisson);
}

/// What the conditions of a label hold of a side. \param into  along the side, away from its corner
SideSupport supportOf(const Body& body, int label, const SpacePoint& into, const SpacePoint& normal) {
  bool across = false;
  bool other = false;
  const auto hold = [&](int component) {
    if (component >= alongNormal) {
      (component == alongNormal ? across : other) = true;
      return;
    }
    const double n = std::abs(normal[component]);
    const double t = std::abs(into[component]);
    if (n * n + t * t > 0.5) (n > t ? across : other) = true;  // the others are along an edge in space
  };
  for (const Condition& held : body.conditions().displacements)
    if (held.actsOn(label)) hold(held.component);
  return across && other ? SideSupport::held : across || other ? SideSupport::sliding : SideSupport::free;
}

/// A vertex of the boundary in the plane, an edge of it in space: how wide the body is there, and what holds
/// its sides.
struct BoundaryCorner {
  SpacePoint at{0, 0, 0};  ///< next to the place
  double angle = 0;
  double edge = 0;  ///< the longest of its sides, across it
  std::vector<SideSupport> sides;
};

/// The point of a vertex or an edge next to a place.
SpacePoint nearestOf(const Body& body, std::span<const int> corner, const SpacePoint& place) {
  const SpacePoint a = body.placeOfNode(corner.front());
  const SpacePoint e = body.placeOfNode(corner.back()) - a;
  if (corner.size() == 1) return a;
  return a + std::clamp(e.dot(place - a) / e.squaredNorm(), 0.0, 1.0) * e;
}

/// From a vertex or an edge to another vertex, across it.
SpacePoint awayFrom(const Body& body, std::span<const int> corner, int vertex) {
  const SpacePoint a = body.placeOfNode(corner.front());
  const SpacePoint e = body.placeOfNode(corner.back()) - a;
  const SpacePoint x = body.placeOfNode(vertex) - a;
  return corner.size() == 1 ? x : SpacePoint(x - e.dot(x) / e.squaredNorm() * e);
}

/// A simplex without some of its vertices, ascending.
template <size_t left, size_t count>
std::array<int, left> without(const std::array<int, count>& simplex, size_t i, size_t j) {
  std::array<int, left> rest{};
  for (size_t k = 0, to = 0; k < count; ++k)
    if (k != i && k != j) rest[to++] = simplex[k];
  std::sort(rest.begin(), rest.end());
  return rest;
}

/// The boundary: edges or triangles and their labels.
template <size_t count>
struct Sides {
  std::vector<std::array<int, count>> facets;
  std::vector<int> labels;  ///< -1 where a triangle has none
};
Sides<2> sidesOf(const TriangleMesh& mesh) {
  return {mesh.boundaryEdges, mesh.boundaryLabels};
}
Sides<3> sidesOf(const TetrahedronMesh& mesh) {
  const std::vector<std::array<int, 3>> outer = outerTriangles(mesh);
  return {outer, labelsOf(mesh, outer)};
}

/// Calls visit(corner, facet, vertex of it that is not on the corner) of all corners of a facet.
template <size_t count, class Visit>
void forEachCorner(const std::array<int, count>& facet, const Visit& visit) {
  for (size_t k = 0; k < count; ++k) visit(without<count - 1>(facet, k, k), facet[k]);
}

/// Whether a corner is next to a place, seen from a side of it.
bool isNextTo(const Body& body, std::span<const int> corner, int vertex, const SpacePoint& place) {
  return (nearestOf(body, corner, place) - place).norm() < nextTo * awayFrom(body, corner, vertex).norm();
}

/// Corners near a place.
template <size_t count>
std::vector<BoundaryCorner> cornersNear(const Body& body, const Sides<count>& sides,
                                        const std::vector<std::array<int, count + 1>>& elements,
                                        const SpacePoint& place) {
  using Vertices = std::array<int, count - 1>;
  std::map<Vertices, BoundaryCorner> corners;
  for (const auto& facet : sides.facets)
    forEachCorner(facet, [&](const Vertices& corner, int vertex) {
      if (isNextTo(body, corner, vertex, place)) corners[corner].at = nearestOf(body, corner, place);
    });
  for (size_t i = 0; i < sides.facets.size(); ++i)
    forEachCorner(sides.facets[i], [&](const Vertices& corner, int vertex) {
      const auto found = corners.find(corner);
      if (found == corners.end()) return;
      const SpacePoint into = awayFrom(body, corner, vertex);
      SpacePoint along(0, 0, 1);
      if (count == 3)
        along = (body.placeOfNode(corner.back()) - body.placeOfNode(corner.front())).normalized();
      const SpacePoint t = into.normalized();
      found->second.edge = std::max(found->second.edge, into.norm());
      found->second.sides.push_back(supportOf(body, sides.labels[i], t, along.cross(t)));
    });
  for (const auto& element : elements)
    for (size_t i = 0; i <= count; ++i)
      for (size_t j = i + 1; j <= count; ++j) {
        const auto rest = without<count - 1>(element, i, j);
        const auto found = corners.find(rest);
        if (found == corners.end()) continue;
        const SpacePoint a = awayFrom(body, rest, element[i]);
        const SpacePoint b = awayFrom(body, rest, element[j]);
        found->second.angle += std::acos(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0));
      }
  std::vector<BoundaryCorner> found;
  for (auto& [vertices, corner] : corners) found.push_back(std::move(corner));
  return found;
}

/// Whether the stress grows towards a corner: its mean square within two edges over that within four.
bool growsTowards(const Body& body, const Matrix& stress, const BoundaryCorner& corner) {
  constexpr double grows = 1.1;
  std::array<double, 2> square{};
  std::array<double, 2> size{};
  for (int i = 0; i < body.points(); ++i)
    for (int k = 0; k < 2; ++k) {
      if (!((body.placeOfPoint(i) - corner.at).norm() < 2 * (k + 1) * corner.edge)) continue;
      square[k] += body.weights()[i] * stress.col(i).squaredNorm();
      size[k] += body.weights()[i];
    }
  return size[0] > 0 && square[0] / size[0] > grows * square[1] / size[1];
}

/// The border of a label of a body: corners that one of its facets has alone, and the vertices opposite.
using Border = std::vector<std::pair<std::vector<int>, int>>;
Border borderOf(const Body& body, int label) {
  return body.withMesh([&](const auto& mesh, const auto&) {
    const auto sides = sidesOf(mesh);
    std::map<std::vector<int>, std::vector<int>> facets;
    for (size_t i = 0; i < sides.facets.size(); ++i)
      if (sides.labels[i] == label)
        forEachCorner(sides.facets[i], [&](const auto& corner, int vertex) {
          facets[{corner.begin(), corner.end()}].push_back(vertex);
        });
    Border border;
    for (const auto& [corner, vertices] : facets)
      if (vertices.size() == 1) border.emplace_back(corner, vertices.front());
    return border;
  });
}

std::vector<BoundaryCorner> cornersNear(const Body& body, const SpacePoint& place) {
  return body.withMesh([&](const auto& mesh, const auto&) {
    return cornersNear(body, sidesOf(mesh), elementsOf(mesh), place);
  });
}

/// Whether the stress of a body grows towards a place of its boundary.
bool growsTowards(const Body& body, const Matrix& stress, const SpacePoint& place) {
  if (body.rigid()) return false;
  BoundaryCorner end;
  end.at = place;
  for (const BoundaryCorner& near : cornersNear(body, place)) end.edge = std::max(end.edge, near.edge);
  return end.edge > 0 && growsTowards(body, stress, end);
}

/// Whether the border of one of two sides passes next to a place, where that of the other one does not, and
/// the stress of one of the bodies grows towards it.
bool endsAt(const ContactPair& pair, const Model& model, const State& state, const SpacePoint& place,
            double reach) {
  const std::array<ContactSide, 2> sides{pair.nonmortar, pair.mortar};
  std::array<Border, 2> borders;
  for (size_t i = 0; i < 2; ++i) borders[i] = borderOf(model.bodies[sides[i].body], sides[i].label);
  for (size_t i = 0; i < 2; ++i)
    for (const auto& [corner, vertex] : borders[i]) {
      const Body& body = model.bodies[sides[i].body];
      const SpacePoint at = nearestOf(body, corner, place);
      if (!isNextTo(body, corner, vertex, place) && !((at - place).norm() < reach)) continue;
      const double edge = awayFrom(body, corner, vertex).norm();
      const Border& other = borders[1 - i];
      if (std::any_of(other.begin(), other.end(), [&](const auto& each) {
            return (nearestOf(model.bodies[sides[1 - i].body], each.first, at) - at).norm() <= edge / 2;
          }))
        continue;
      if (std::any_of(sides.begin(), sides.end(), [&](const ContactSide& side) {
            return growsTowards(model.bodies[side.body], state.bodies[side.body].stress, at);
          }))
        return true;
    }
  return false;
}

}  // namespace

bool isSingular(double angle, SideSupport first, SideSupport second, double kappa) {
  constexpr double degree = M_PI / 180;
  constexpr double turn = 25 * degree;  // corners of a polygon that stands for a curve have less
  constexpr double reentrant = M_PI + turn;
  if (first == SideSupport::sliding && second == first && std::abs(angle - M_PI) <= turn) return false;
  if (first == second && first != SideSupport::sliding) return angle > reentrant;
  if (first == SideSupport::sliding || second == SideSupport::sliding) return 2 * angle > reentrant;
  return angle > std::asin(std::sqrt(std::min(1.0, (kappa + 1) / 4))) + 10 * degree;
}

bool cornerAt(const Body& body, const Matrix& stress, const SpacePoint& place) {
  if (body.rigid()) return false;
  const std::vector<BoundaryCorner> corners = cornersNear(body, place);
  return std::any_of(corners.begin(), corners.end(), [&](const BoundaryCorner& corner) {
    return corner.sides.size() == 2 &&
           isSingular(corner.angle, corner.sides[0], corner.sides[1], kappaOf(body)) &&
           growsTowards(body, stress, corner);
  });
}

bool contactEndsAt(const Model& model, const State& state, const SpacePoint& place, double reach) {
  const auto ends = [&](const ContactPair& pair) { return endsAt(pair, model, state, place, reach); };
  for (size_t k = 0; k < model.interfaces.size(); ++k)
    if (state.contactForce[k].maxCoeff() > 0 && ends(model.interfaces[k].pair())) return true;
  return std::ranges::any_of(model.ties, [&](const Tie& tie) { return ends(tie.pair()); });
}

}  // namespace mortier
