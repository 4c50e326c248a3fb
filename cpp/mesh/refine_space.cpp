#include "mesh/refine.h"

#include <limits>
#include <numeric>
#include <set>

#include <Eigen/Geometry>

#include "base/interrupt.h"
#include "mesh/cut_simplices.h"
#include "mesh/simplices.h"

namespace mortier {
namespace {

using Edge = std::array<int, 2>;

/// Surfaces that meet at a larger angle than this sine have an edge there.
constexpr double sharpSine = 0.34;

/// The part of a vector that is perpendicular to a unit vector, of length one.
SpacePoint perpendicular(const SpacePoint& vector, const SpacePoint& unit) {
  return (vector - vector.dot(unit) * unit).normalized();
}

class SpaceBisection {
 public:
  SpaceBisection(const TetrahedronMesh& mesh, const CurvedFaces& curves)
      : old_(mesh),
        tetrahedra_(mesh.tetrahedra, mesh.vertices.size()),
        labelled_(mesh.boundaryTriangles, mesh.vertices.size()),
        curved_(curves.triangles, mesh.vertices.size()) {
    result_.mesh = mesh;
    result_.curves = curves;
    onSurface_ = 1e-11 * extent(mesh);
    for (size_t t = 0; t < tetrahedra_.count(); ++t) longest_.push_back(longestOf(static_cast<int>(t)));
    isCut_.assign(tetrahedra_.count(), 0);
  }

  RefinedTetrahedra run(const std::vector<char>& marked) {
    std::vector<int> pending;
    for (size_t t = 0; t < marked.size(); ++t)
      if (marked[t] != 0) pending.push_back(static_cast<int>(t));
    while (!pending.empty()) {
      for (const Edge& edge : ripe(pending)) {
        stopIfInterrupted();
        cut(edge);
      }
      std::erase_if(pending, [&](int t) { return isCut_[t] != 0; });
    }
    collect();
    return std::move(result_);
  }

 private:
  [[nodiscard]] Edge longestOf(int t) const {
    std::tuple<double, int, int> longest{-INFINITY, 0, 0};
    for (const auto& [a, b] : sidesOfTetrahedron)
      longest = std::max(longest, rankOfSide(result_.mesh.vertices, tetrahedra_[t][a], tetrahedra_[t][b]));
    return {std::get<2>(longest), std::get<1>(longest)};
  }

  /// The edges on the way to the longest ones of tetrahedra that can be cut at once, ascending.
  [[nodiscard]] std::vector<Edge> ripe(const std::vector<int>& pending) const {
    std::set<Edge> seen;
    std::vector<Edge> way, found;
    const auto visit = [&](const Edge& edge) {
      if (seen.insert(edge).second) way.push_back(edge);
    };
    for (const int t : pending) visit(longest_[t]);
    for (size_t i = 0; i < way.size(); ++i) {
      stopIfInterrupted();
      const Edge edge = way[i];
      bool longestOfAll = true;
      for (const int t : tetrahedra_.around(edge)) {
        if (longest_[t] == edge) continue;
        longestOfAll = false;
        visit(longest_[t]);
      }
      if (longestOfAll) found.push_back(edge);
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  void cut(const Edge& edge) {
    const std::vector<int> around = tetrahedra_.around(edge);
    const auto m = static_cast<int>(result_.mesh.vertices.size());
    result_.mesh.vertices.push_back((place(edge[0]) + place(edge[1])) / 2);
    const std::vector<int> surface = curved_.around(edge);
    putOntoCurve(m, edge, surface, around);
    for (const int i : surface) {
      curved_.cut(i, edge, m);
      result_.curves.parts.push_back(result_.curves.parts[i]);
    }
    for (const int i : labelled_.around(edge)) {
      labelled_.cut(i, edge, m);
      result_.mesh.boundaryLabels.push_back(result_.mesh.boundaryLabels[i]);
    }
    for (const int t : around) {
      isCut_[t] = 1;
      tetrahedra_.cut(t, edge, m);
      longest_[t] = longestOf(t);
      longest_.push_back(longestOf(static_cast<int>(tetrahedra_.count()) - 1));
      isCut_.push_back(1);
    }
  }

  [[nodiscard]] const SpacePoint& place(int v) const { return result_.mesh.vertices[v]; }

  void putOntoCurve(int m, const Edge& edge, const std::vector<int>& surface,
                    const std::vector<int>& around) {
    std::set<int> parts;
    for (const int i : surface) parts.insert(result_.curves.parts[i]);
    if (parts.empty()) return;
    const SpacePoint d = place(edge[1]) - place(edge[0]);
    const SpacePoint sagitta = sagittaOver(edge, d, {parts.begin(), parts.end()});
    for (const int part : parts) {
      SpacePoint sum = SpacePoint::Zero();
      for (const int v : edge)
        if (normal(v, part).allFinite()) sum += normal(v, part);
      result_.curves.normals[{m, part}] = perpendicular(sum, d.normalized());
    }
    const SpacePoint middle = place(m);
    if (*parts.begin() < 0) {
      putOntoSurfaces(m, edge, surface, middle + sagitta, around);
      return;
    }
    if (sagitta.isZero(0)) return;
    for (const double share : {1.0, 0.5, 0.25, 0.0}) {
      result_.mesh.vertices[m] = middle + share * sagitta;
      if (share == 0 || !spoils(m, edge, around)) break;
      if (share == 1) result_.offCurve.push_back(m);
    }
  }

  /// Onto those of the geometry. \param near  where the vertex is, nearly
  void putOntoSurfaces(int m, const Edge& edge, const std::vector<int>& triangles, const SpacePoint& near,
                       const std::vector<int>& around) {
    const GeometrySurfaces& geometry = *result_.curves.geometry;
    std::vector<int> surfaces;
    std::vector<SpacePoint> facets;
    for (const int i : triangles) {
      const auto& [a, b, c] = curved_[i];
      const int surface = surfaceOfPart(result_.curves.parts[i]);
      if (surface < 0 || std::find(surfaces.begin(), surfaces.end(), surface) != surfaces.end()) continue;
      surfaces.push_back(surface);
      facets.push_back((place(b) - place(a)).cross(place(c) - place(a)));
    }
    if (std::all_of(surfaces.begin(), surfaces.end(), [&](int each) { return geometry.isPlane(each); })) {
      for (const int surface : surfaces)
        result_.curves.normals[{m, partOfSurface(surface)}] = normal(edge[0], partOfSurface(surface));
      return;
    }
    const SpacePoint middle = place(m);
    const double half = (place(edge[1]) - place(edge[0])).norm() / 2;
    const std::optional<SharedPoint> found = sharedPoint(geometry, surfaces, near);
    if (!found || !((found->at - middle).norm() < half)) {
      result_.offCurve.push_back(m);
      return;
    }
    for (size_t k = 0; k < surfaces.size(); ++k)
      result_.curves.normals[{m, partOfSurface(surfaces[k])}] =
          found->normals[k].dot(facets[k]) < 0 ? SpacePoint(-found->normals[k]) : found->normals[k];
    result_.mesh.vertices[m] = found->at;
    const bool spoilt =
        spoils(m, edge, around) && !(makeRoom(edge, around, found->at - middle) && !spoils(m, edge, around));
    if (spoilt) result_.mesh.vertices[m] = middle;
    if (spoilt || found->off > onSurface_) result_.offCurve.push_back(m);
  }

  /// Moves vertices inside the body that tetrahedra around an edge have by a part of what its middle moves.
  /// \returns whether one has moved
  bool makeRoom(const Edge& edge, const std::vector<int>& around, const SpacePoint& shift) {
    constexpr double least = 0.5;  // of the volume of the tetrahedra there
    std::set<int> inside;
    for (const int t : around)
      for (const int v : tetrahedra_[t])
        if (v != edge[0] && v != edge[1] && !curved_.has(v)) inside.insert(v);
    bool any = false;
    for (const int v : inside) {
      const std::vector<int>& own = tetrahedra_.at(v);
      const SpacePoint before = place(v);
      std::vector<double> volumes;
      for (const int t : own) volumes.push_back(volume(result_.mesh, tetrahedra_[t]));
      const auto regionOf = [&](int t) { return old_.regions[tetrahedra_.parent(t)]; };
      if (std::any_of(own.begin(), own.end(), [&](int t) { return regionOf(t) != regionOf(own.front()); }))
        continue;
      for (const double share : {1.0, 0.5, 0.25, 0.0}) {
        result_.mesh.vertices[v] = before + share * shift;
        bool fits = true;
        for (size_t i = 0; i < own.size() && fits; ++i)
          fits = volume(result_.mesh, tetrahedra_[own[i]]) > least * volumes[i];
        if (!fits && share > 0) continue;
        any = any || share > 0;
        break;
      }
      for (const int t : own) longest_[t] = longestOf(t);
    }
    return any;
  }

  [[nodiscard]] bool spoils(int m, const Edge& edge, const std::vector<int>& around) const {
    constexpr double least = 0.25;  // of the volume that a half has on the straight edge
    return std::any_of(around.begin(), around.end(), [&](int t) {
      const double half = volume(result_.mesh, tetrahedra_[t]) / 2;
      return std::any_of(edge.begin(), edge.end(), [&](int v) {
        std::array<int, 4> piece = tetrahedra_[t];
        std::replace(piece.begin(), piece.end(), v, m);
        return !(volume(result_.mesh, piece) > least * half);
      });
    });
  }

  [[nodiscard]] const SpacePoint& normal(int v, int part) const {
    return result_.curves.normals.at({v, part});
  }

  [[nodiscard]] SpacePoint sagittaOver(const Edge& edge, const SpacePoint& d,
                                       const std::vector<int>& parts) const {
    std::array<SpacePoint, 2> tangents;
    std::array<bool, 2> known{};
    for (int end = 0; end < 2; ++end) {
      known[end] = std::all_of(parts.begin(), parts.end(),
                               [&](int part) { return normal(edge[end], part).allFinite(); });
      if (!known[end]) continue;
      SpacePoint own = normal(edge[end], parts[0]);
      if (parts.size() > 1) {
        const SpacePoint along = own.cross(normal(edge[end], parts[1]));
        if (along.norm() > sharpSine) {
          tangents[end] = (along.dot(d) > 0 ? 1 : -1) * along.normalized();
          continue;
        }
        own = (own + normal(edge[end], parts[1])).normalized();
      }
      tangents[end] = perpendicular(d, own);
    }
    const SpacePoint along = d.normalized();
    for (int end = 0; end < 2; ++end) {
      const SpacePoint& other = tangents[1 - end];
      if (!known[end]) tangents[end] = known[1 - end] ? 2 * other.dot(along) * along - other : along;
    }
    return sagittaOf(d, tangents[0], tangents[1]);
  }

  void collect() {
    TetrahedronMesh& mesh = result_.mesh;
    mesh.tetrahedra.clear();
    mesh.regions.clear();
    for (const int t : tetrahedra_.byParents()) {
      mesh.tetrahedra.push_back(tetrahedra_[t]);
      mesh.regions.push_back(old_.regions[tetrahedra_.parent(t)]);
      result_.parents.push_back(tetrahedra_.parent(t));
    }
    mesh.boundaryTriangles = labelled_.all();
    result_.curves.triangles = curved_.all();
    keepNormals();
  }

  /// Those of the geometry at new vertices where it knows their surfaces, at others those before.
  void keepNormals() {
    if (old_.boundaryNormals.empty()) return;
    result_.mesh.boundaryNormals.clear();
    const SpacePoint unknown = SpacePoint::Constant(std::numeric_limits<double>::quiet_NaN());
    std::map<std::array<int, 3>, int> partOf;
    for (size_t i = 0; i < curved_.count(); ++i)
      if (result_.curves.parts[i] < 0) partOf[sideOf(curved_.all()[i])] = result_.curves.parts[i];
    for (size_t i = 0; i < labelled_.count(); ++i) {
      const std::array<int, 3>& triangle = labelled_.all()[i];
      const auto known = partOf.find(sideOf(triangle));
      const auto parent = static_cast<size_t>(labelled_.parent(static_cast<int>(i)));
      const auto& before = old_.boundaryTriangles[parent];
      std::array<SpacePoint, 3>& own = result_.mesh.boundaryNormals.emplace_back();
      for (size_t k = 0; k < 3; ++k) {
        const auto at = std::find(before.begin(), before.end(), triangle[k]) - before.begin();
        own[k] = known != partOf.end() ? normal(triangle[k], known->second)
                 : at < 3              ? old_.boundaryNormals[parent][static_cast<size_t>(at)]
                                       : unknown;
      }
    }
  }

  const TetrahedronMesh& old_;
  CutSimplices<4> tetrahedra_;
  CutSimplices<3> labelled_, curved_;  ///< triangles of the boundary
  std::vector<Edge> longest_;          ///< of tetrahedra, smaller vertex first
  std::vector<char> isCut_;            ///< tetrahedra of the mesh before, and all new ones
  double onSurface_ = 0;               ///< distance of vertices that are on their surfaces [m]
  RefinedTetrahedra result_;
};

}  // namespace

RefinedTetrahedra bisect(const TetrahedronMesh& mesh, const CurvedFaces& curves,
                         const std::vector<char>& marked) {
  return SpaceBisection(mesh, curves).run(marked);
}

SpacePoint sagittaOf(const SpacePoint& d, const SpacePoint& from, const SpacePoint& to) {
  constexpr double straight = 1e-9;
  constexpr double least = 0.5;  // of the cosines: further turned tangents are none of this edge
  const double length = d.norm();
  const double first = from.dot(d) / length;
  const double last = to.dot(d) / length;
  const SpacePoint turn = from - to;
  if (turn.norm() < straight || std::min(first, last) < least) return SpacePoint::Zero();
  return length / (4 + 2 * (first + last)) * turn;
}

}  // namespace mortier
