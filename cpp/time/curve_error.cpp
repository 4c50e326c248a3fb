#include "time/curve_error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "contact/boundary_surface.h"
#include "material/stress.h"
#include "mesh/simplices.h"

namespace mortier {
namespace {

using Lenses = std::map<std::array<int, 3>, Lens>;  ///< by sides

void add(Lenses& lenses, const std::array<int, 3>& side, double volume, double traction) {
  if (std::isfinite(volume) && volume != 0) lenses[side] = {volume, volume * traction};
}

/// Along the normal of a label.
double normalTraction(const Body& body, int label, const SpacePoint& at, double time) {
  double sum = 0;
  for (const Condition& traction : body.conditions().tractions)
    if (traction.label == label && traction.component == alongNormal) sum += traction.value(at, time);
  return sum;
}

/// Of parabolas over the edges.
Lenses lensesOf(const Body& body, double time) {
  const TriangleMesh& mesh = body.mesh();
  Lenses lenses;
  for (size_t e = 0; e < mesh.edgeMiddles.size() && body.degree() == 1; ++e) {
    const Point& a = mesh.vertices[mesh.boundaryEdges[e][0]];
    const Point& b = mesh.vertices[mesh.boundaryEdges[e][1]];
    const Point middle = (a + b) / 2;
    const Point off = mesh.edgeMiddles[e] - middle;
    add(lenses, sideOf(mesh.boundaryEdges[e]),
        2 / 3.0 * (off.x() * (b.y() - a.y()) - off.y() * (b.x() - a.x())) * body.depthAt(middle),
        normalTraction(body, mesh.boundaryLabels[e], asSpacePoint(middle), time));
  }
  return lenses;
}

/// How far the surface is out over the middle of a side from a to b, by the normals at its ends.
double offsetOver(const SpacePoint& a, const SpacePoint& b, const SpacePoint& na, const SpacePoint& nb) {
  constexpr double flat = 1e-12;
  const double turn = (nb - na).dot(b - a);
  return std::abs(turn) > flat * (b - a).norm() ? turn / 8 : 0;
}

/// The surface behind the boundary of a body in space.
class Behind {
 public:
  explicit Behind(const TetrahedronMesh& mesh) : mesh_(mesh), surface_(boundarySurface(mesh)) {
    for (size_t t = 0; t < count(); ++t)
      for (int k = 0; k < 3; ++k) sides_[sideOf(t, k)].emplace_back(t, k);
  }
  [[nodiscard]] size_t count() const { return surface_.triangles.size(); }
  [[nodiscard]] const std::array<int, 3>& triangle(size_t t) const { return surface_.triangles[t]; }
  [[nodiscard]] const SpacePoint& facet(size_t t) const { return surface_.facets[t]; }
  /// -1 where a triangle has none.
  [[nodiscard]] int label(size_t t) const {
    return t < mesh_.boundaryLabels.size() ? mesh_.boundaryLabels[t] : -1;
  }
  /// Over the middle of the side from vertex k.
  [[nodiscard]] double offset(size_t t, int k) const {
    const auto& normals = surface_.normals[t];
    const int to = (k + 1) % 3;
    if (!normals[k].known || !normals[to].known) return 0;
    return offsetOver(place(t, k), place(t, to), normals[k].n, normals[to].n);
  }
  [[nodiscard]] double area(size_t t) const {
    return (place(t, 1) - place(t, 0)).cross(place(t, 2) - place(t, 0)).norm() / 2;
  }
  /// By how much a triangle is larger than it is as meshed where another part of the surface, which is
  /// curved, begins at its side from vertex k.
  [[nodiscard]] double widerAt(size_t t, int k) const {
    constexpr double least = 0.2;  // where sides meet at a smaller angle the edge is not known
    for (const auto& [other, at] : sides_.at(sideOf(t, k))) {
      if (surface_.parts[other] == surface_.parts[t]) continue;
      const SpacePoint along = place(t, (k + 1) % 3) - place(t, k);
      const double out = along.normalized().cross(facet(t)).dot(facet(other));
      if (std::abs(out) > least) return 2 / 3.0 * along.norm() * offset(other, at) / out;
    }
    return 0;
  }
  /// The half of the wedge between the surfaces over a triangle and its neighbour in the same part, at the
  /// side from vertex k: an area, as they are turned against each other.
  [[nodiscard]] double wedgeAt(size_t t, int k) const {
    const SpacePoint along = place(t, (k + 1) % 3) - place(t, k);
    for (const auto& [other, at] : sides_.at(sideOf(t, k)))
      if (other != t && surface_.parts[other] == surface_.parts[t])
        return along.cross(facet(t)).dot(facet(other)) * offset(t, k) / 3;
    return 0;
  }
  /// By how much a triangle has less area than the surface over it: half of the square of the slopes.
  [[nodiscard]] double growth(size_t t) const {
    std::array<SpacePoint, 3> slope;  // of barycentric coordinates
    for (int k = 0; k < 3; ++k)
      slope[(k + 2) % 3] = facet(t).cross(place(t, (k + 1) % 3) - place(t, k)) / (2 * area(t));
    double square = 0;
    for (int middle = 0; middle < 3; ++middle) {
      std::array<double, 3> at{0.5, 0.5, 0.5};
      at[(middle + 2) % 3] = 0;
      SpacePoint gradient(0, 0, 0);  // of the sum of 4 o_k L_k L_k+1
      for (int k = 0; k < 3; ++k) {
        const int to = (k + 1) % 3;
        gradient += 4 * offset(t, k) * (at[k] * slope[to] + at[to] * slope[k]);
      }
      square += gradient.squaredNorm() / 3;
    }
    return square / 2 * area(t);
  }

 private:
  [[nodiscard]] const SpacePoint& place(size_t t, int k) const { return mesh_.vertices[triangle(t)[k]]; }
  [[nodiscard]] std::pair<int, int> sideOf(size_t t, int k) const {
    return std::minmax({triangle(t)[k], triangle(t)[(k + 1) % 3]});
  }

  const TetrahedronMesh& mesh_;
  BoundarySurface surface_;
  std::map<std::pair<int, int>, std::vector<std::pair<size_t, int>>> sides_;  ///< triangles, first vertices
};

/// Of what is quadratic over the triangles, from the normals at their vertices.
Lenses lensesOf(const Body& body, const Behind& surface, double time) {
  const TetrahedronMesh& mesh = body.space()->mesh();
  Lenses lenses;
  for (size_t t = 0; t < surface.count(); ++t) {
    const std::array<int, 3>& v = surface.triangle(t);
    const SpacePoint middle = (mesh.vertices[v[0]] + mesh.vertices[v[1]] + mesh.vertices[v[2]]) / 3;
    add(lenses, sideOf(v),
        (surface.offset(t, 0) + surface.offset(t, 1) + surface.offset(t, 2)) / 3 * surface.area(t),
        normalTraction(body, surface.label(t), middle, time));
  }
  return lenses;
}

/// What tractions on sides that are wider than meshed add to the nodes at their edges (dofs).
Vector loadsOnWiderSides(const Body& body, const Behind& surface, double time) {
  Vector loads = Vector::Zero(body.dofs());
  for (const Condition& traction : body.conditions().tractions)
    for (size_t t = 0; t < surface.count(); ++t)
      for (int k = 0; k < 3 && surface.label(t) == traction.label; ++k) {
        const double area = surface.widerAt(t, k);
        if (area == 0) continue;
        const std::array ends{surface.triangle(t)[k], surface.triangle(t)[(k + 1) % 3]};
        const SpacePoint middle = (body.placeOfNode(ends[0]) + body.placeOfNode(ends[1])) / 2;
        const SpacePoint direction = traction.component < alongNormal
                                         ? SpacePoint(SpacePoint::Unit(traction.component))
                                         : surface.facet(t);
        for (const int node : ends)
          loads.segment<3>(Eigen::Index{3} * node) += area / 2 * traction.value(middle, time) * direction;
      }
  return loads;
}

template <class Mesh>
std::vector<Lens> behind(const Lenses& lenses, const Mesh& mesh) {
  std::vector<Lens> all(elementsOf(mesh).size());
  std::vector<char> on(mesh.vertices.size(), 0);
  for (const auto& [side, lens] : lenses)
    for (const int v : side)
      if (v >= 0) on[v] = 1;
  forEachSide(mesh, on, [&](const std::array<int, 3>& side, int element) {
    if (const auto found = lenses.find(side); found != lenses.end())
      all[element] = {all[element].volume + found->second.volume, all[element].pulled + found->second.pulled};
  });
  return all;
}

/// By elements behind them. \param surface  of a body in space
std::vector<Lens> lensesBehind(const Body& body, const Behind* surface, double time) {
  if (surface != nullptr) return behind(lensesOf(body, *surface, time), body.space()->mesh());
  return behind(lensesOf(body, time), body.mesh());
}

std::optional<Behind> surfaceOf(const Body& body) {
  if (const SpaceElements* space = body.space()) return std::optional<Behind>(std::in_place, space->mesh());
  return std::nullopt;
}

/// Of a strain: what a volume grows by, in the plane an area, of rings with the circumference.
double divergence(const Body& body, const Vector& strain) {
  if (body.dimension() == 3) return toSpaceCartesian(strain.head<6>()).head<3>().sum();
  return toCartesian(strain.head<3>()).head<2>().sum() + (body.axisymmetric() ? strain[3] : 0);
}

/// Integral of w (s : E^-1 t - (traction) div z).
double workBehindSides(const Body& body, const std::vector<Lens>& lenses, const Matrix& s, const Matrix& t) {
  if (body.rigid()) return 0;
  Matrix strain;
  body.material().elasticStrain(t, strain);
  const size_t points = body.points() / lenses.size();
  const Eigen::Index tensor = body.material().tensorComponents();
  double work = 0;
  for (size_t i = 0; i < lenses.size() * points; ++i) {
    const auto& [volume, pulled] = lenses[i / points];
    if (volume == 0 && pulled == 0) continue;
    const auto own = static_cast<Eigen::Index>(i);
    work += (volume * s.col(own).head(tensor).dot(strain.col(own).head(tensor)) -
             (pulled == 0 ? 0 : pulled * divergence(body, strain.col(own)))) /
            static_cast<double>(points);
  }
  return work;
}

}  // namespace

Vector volumeBehindSides(const Body& body) {
  const std::optional<Behind> surface = surfaceOf(body);
  const std::vector<Lens> lenses = lensesBehind(body, surface ? &*surface : nullptr, 0);
  Vector volumes(static_cast<Eigen::Index>(lenses.size()));
  for (size_t e = 0; e < lenses.size(); ++e) volumes[static_cast<Eigen::Index>(e)] = lenses[e].volume;
  return volumes;
}

double growthOfSide(const Body& body, int label, const std::vector<char>& among) {
  const auto are = [&](const auto& vertices) {
    return std::all_of(vertices.begin(), vertices.end(), [&](int v) { return among[v] != 0; });
  };
  double growth = 0;
  if (const std::optional<Behind> surface = surfaceOf(body)) {
    for (size_t t = 0; t < surface->count(); ++t) {
      if (surface->label(t) != label || !are(surface->triangle(t))) continue;
      growth += surface->growth(t);
      for (int k = 0; k < 3; ++k) growth += surface->widerAt(t, k) + surface->wedgeAt(t, k);
    }
    return growth;
  }
  const TriangleMesh& mesh = body.mesh();
  for (size_t e = 0; e < mesh.edgeMiddles.size(); ++e) {
    if (mesh.boundaryLabels[e] != label || !are(mesh.boundaryEdges[e])) continue;
    const Point& a = mesh.vertices[mesh.boundaryEdges[e][0]];
    const Point& b = mesh.vertices[mesh.boundaryEdges[e][1]];
    const double length = (b - a).norm();
    const double square = (mesh.edgeMiddles[e] - (a + b) / 2).squaredNorm() / (length * length);
    // Of an arc over its chord, or over the parabola through its middle.
    if (std::isfinite(square))
      growth += length * (body.degree() == 1 ? 8 / 3.0 * square : 64 / 15.0 * square * square);
  }
  return growth;
}

CurvedSides::CurvedSides(const Model& model, double time) : model_(model) {
  for (const Body& body : model.bodies) {
    const std::optional<Behind> surface = surfaceOf(body);
    lenses_.push_back(lensesBehind(body, surface ? &*surface : nullptr, time));
    loads_.push_back(surface ? loadsOnWiderSides(body, *surface, time) : Vector::Zero(body.dofs()));
  }
}

double CurvedSides::changeOf(const State& state, const std::vector<Response>& z,
                             const std::vector<Vector>& moved) const {
  double change = 0;
  for (size_t b = 0; b < z.size(); ++b)
    change += workBehindSides(model_.bodies[b], lenses_[b], state.bodies[b].stress, z[b].stress) -
              loads_[b].dot(moved[b]);
  return change;
}

double CurvedSides::energyBehind(size_t body, const Matrix& stress) const {
  std::vector<Lens> lenses = lenses_[body];
  for (Lens& lens : lenses) lens.pulled = 0;
  return workBehindSides(model_.bodies[body], lenses, stress, stress) / 2;
}

}  // namespace mortier
