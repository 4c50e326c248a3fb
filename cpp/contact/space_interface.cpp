// A contact interface between two surfaces: rows as in coupling.h, integrals over the common refinement of
// their triangles.
//
// A nonmortar triangle sees the mortar surface along n ~ R1 n1 - R2 n2, n1, n2 the outward normals and R1, R2
// the radii of curvature of both surfaces, as in the plane (facing_line.h): a plane triangle along its own
// normal, a curved one that faces a plane along the normal of the plane, on which alone the distance depends.
// Each point of a rule adds a pair of opposite forces along the line through x1 and x2: rows balance in force
// and moment.
//
// Row functions are the hat functions of the nonmortar vertices, whatever the degree: quadratic functions
// have no mean on a triangle (int chi_vertex = 0), so that forces at vertices say nothing of the pressure. A
// vertex has a row for each smooth part of the surface that meets there if it sees the mortar surface itself.
// The functions of the others go to neighbours with rows in equal parts, neighbour by neighbour, so that row
// functions still add up to 1.
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "base/error.h"
#include "contact/interface.h"
#include "contact/surface.h"

namespace mortier {
namespace {

/// Radon's rule of seven points on the triangle, exact for polynomials of degree 5.
struct RadonPoint {
  double a, b, weight;  ///< barycentric coordinates of two corners, part of the area
};
constexpr double near1 = 0.470142064105115, near2 = 0.059715871789770;
constexpr double far1 = 0.101286507323456, far2 = 0.797426985353087;
constexpr double nearWeight = 0.132394152788506, farWeight = 0.125939180544827;
constexpr std::array<RadonPoint, 7> radonRule{{{1.0 / 3, 1.0 / 3, 0.225},
                                               {near1, near1, nearWeight},
                                               {near1, near2, nearWeight},
                                               {near2, near1, nearWeight},
                                               {far1, far1, farWeight},
                                               {far1, far2, farWeight},
                                               {far2, far1, farWeight}}};

std::array<double, 6> traceShapes(int degree, const Eigen::Vector3d& b) {
  if (degree == 1) return {b[0], b[1], b[2], 0, 0, 0};
  return {b[0] * (2 * b[0] - 1), b[1] * (2 * b[1] - 1), b[2] * (2 * b[2] - 1),
          4 * b[0] * b[1],       4 * b[1] * b[2],       4 * b[2] * b[0]};
}

/// A vertex of the nonmortar surface, as one of its smooth parts sees it.
using PartVertex = std::pair<int, int>;  // vertex, part

struct VertexFacts {
  SpacePoint place, normal;
  double curvature = 0;
  std::set<PartVertex> neighbours;
  bool sees = false;
  std::vector<std::pair<int, double>> rows;  ///< to which its hat function goes, with which part
};

using VertexTable = std::map<PartVertex, VertexFacts>;

/// Neighbours are those along edges.
VertexTable verticesOf(const ContactSurface& surface) {
  VertexTable vertices;
  for (size_t t = 0; t < surface.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int part = surface.parts[t];
      VertexFacts& vertex = vertices[{surface.triangles[t][k], part}];
      vertex.place = surface.places[t][k];
      vertex.normal = surface.vertexNormals[t][k];
      vertex.curvature = surface.curvatures[t][k];
      for (const int other : {(k + 1) % 3, (k + 2) % 3})
        vertex.neighbours.insert({surface.triangles[t][other], part});
    }
  return vertices;
}

/// Gives the hat functions without a row to neighbours that have one.
void shareFunctions(VertexTable& vertices) {
  std::vector<PartVertex> open;
  for (const auto& [key, vertex] : vertices)
    if (vertex.rows.empty()) open.push_back(key);
  while (!open.empty()) {
    std::vector<std::pair<PartVertex, std::vector<std::pair<int, double>>>> found;
    std::vector<PartVertex> still;
    for (const PartVertex& key : open) {
      std::map<int, double> parts;
      int givers = 0;
      for (const PartVertex& neighbour : vertices[key].neighbours) {
        const auto& rows = vertices[neighbour].rows;
        givers += rows.empty() ? 0 : 1;
        for (const auto& [row, part] : rows) parts[row] += part;
      }
      if (givers == 0) {
        still.push_back(key);
        continue;
      }
      std::vector<std::pair<int, double>> rows;
      for (const auto& [row, part] : parts) rows.emplace_back(row, part / givers);
      found.emplace_back(key, std::move(rows));
    }
    if (found.empty()) return;  // parts of the surface that see nothing
    for (auto& [key, rows] : found) vertices[key].rows = std::move(rows);
    open = std::move(still);
  }
}

}  // namespace

ContactInterface ContactInterface::inSpace(const ContactPair& pair, const SpaceContactMesh& nonmortarMesh,
                                           const SpaceContactMesh& mortarMesh,
                                           const SpaceInterfaceOptions& options) {
  const ContactSurface nonmortar(nonmortarMesh.mesh, nonmortarMesh.nodes, pair.nonmortar.label,
                                 options.nonmortarHeld);
  const ContactSurface mortar(mortarMesh.mesh, mortarMesh.nodes, pair.mortar.label, options.mortarHeld);
  const std::string names = nonmortarMesh.mesh.name + " and " + mortarMesh.mesh.name;
  if (pair.coupling == CouplingKind::coarsened ||
      (pair.coupling != CouplingKind::weighted && nonmortar.degree > 1))
    throw InputError(names + ": in space variant = \"weighted\" is known, and for linear displacements " +
                     "\"mortar\" and \"interpolation\"");
  ContactInterface result;
  result.dimension_ = 3;
  result.pair_ = pair;

  const bool planeRules = mortar.planar && !nonmortar.planar;
  const double reach = std::min(nonmortar.extent, mortar.extent);
  const TriangleTree tree(mortar);
  std::vector<SpacePoint> directions = nonmortar.normals;
  if (planeRules) std::fill(directions.begin(), directions.end(), SpacePoint(-mortar.normals.front()));
  for (size_t t = 0; t < directions.size() && !planeRules; ++t) {
    const auto& [a, b, c] = nonmortar.places[t];
    const Eigen::Vector3d middle = Eigen::Vector3d::Constant(1.0 / 3);
    const auto triangle = static_cast<int>(t);
    if (const double curvature = nonmortar.curvatureAt(triangle, middle); curvature > 0)
      directions[t] = tree.contactDirection((a + b + c) / 3, nonmortar.normals[t], curvature, reach, false);
  }
  std::vector<FacingTriangles> facing;
  VertexTable vertices = verticesOf(nonmortar);
  const auto keyOf = [&](int triangle, int k) {
    return PartVertex{nonmortar.triangles[triangle][k], nonmortar.parts[triangle]};
  };
  forEachFacing(nonmortar, mortar, directions, reach, [&](const FacingTriangles& each) {
    // A triangle that does not look at the plane sees nothing.
    if (directions[each.nonmortar].dot(nonmortar.normals[each.nonmortar]) < 1e-3) return;
    facing.push_back(each);
    constexpr double rounding = 1e-9;
    const std::array<Point, 3> corners{Point(0, 0), Point(1, 0), Point(0, 1)};
    for (int k = 0; k < 3; ++k)
      if (each.at(corners[k]).minCoeff() >= -rounding) vertices[keyOf(each.nonmortar, k)].sees = true;
  });

  // Rows.
  const auto contactNormal = [&](const VertexFacts& vertex) {
    return planeRules ? SpacePoint(-mortar.normals.front())
                      : tree.contactDirection(vertex.place, vertex.normal, vertex.curvature, reach, true);
  };
  const bool mayMerge = nonmortar.degree == 1 && options.nonmortarHeld;
  const auto held = [&](const PartVertex& key, const VertexFacts& vertex) {
    return mayMerge && options.nonmortarHeld(key.first, contactNormal(vertex));
  };
  const bool allHeld = std::all_of(vertices.begin(), vertices.end(), [&](const auto& each) {
    return !each.second.sees || held(each.first, each.second);
  });
  std::vector<RaySight> sights;
  std::vector<double> distances;
  std::vector<SpacePoint> places;
  for (auto& [key, vertex] : vertices) {
    if (!vertex.sees) continue;
    const SpacePoint n = contactNormal(vertex);
    const RaySight sight = tree.along(vertex.place, n, reach);
    if (pair.coupling == CouplingKind::interpolation && sight.triangle < 0) continue;
    if (!allHeld && held(key, vertex)) {
      bool across = true;  // whether the other side is held there too
      for (int k = 0; k < 3 && pair.coupling == CouplingKind::interpolation; ++k)
        across = across && options.mortarHeld &&
                 (std::abs(sight.mu[k]) < 1e-9 || options.mortarHeld(mortar.triangles[sight.triangle][k], n));
      if (across) {
        ++result.heldEnds_;
        continue;
      }
    }
    vertex.rows.emplace_back(static_cast<int>(result.nonmortarNodes_.size()), 1);
    result.nonmortarNodes_.push_back(key.first);
    result.spaceNormals_.push_back(n);
    sights.push_back(sight);
    distances.push_back(sight.triangle < 0 ? infinity
                                           : sight.delta + n.dot(mortar.offset(sight.triangle, sight.mu)));
    places.push_back(vertex.place);
  }
  shareFunctions(vertices);
  const auto rows = static_cast<Eigen::Index>(result.nonmortarNodes_.size());
  if (rows == 0)
    throw InputError(names + " overlap at no nonmortar vertex, expected bodies that face each other");

  // Integrals.
  const Eigen::Index columns1 = 3 * static_cast<Eigen::Index>(nonmortarMesh.nodes.count());
  const Eigen::Index columns2 = 3 * static_cast<Eigen::Index>(mortarMesh.nodes.count());
  const bool projects = pair.coupling == CouplingKind::mortar;
  Triplets mass, D, M, trace1, trace2, functions;
  Vector distance = Vector::Zero(rows);
  Vector least = Vector::Constant(rows, infinity);
  result.lengths_ = Vector::Zero(rows);
  std::vector<double> areas, gaps, sizes;
  const auto add = [](Triplets& entries, Eigen::Index row, int node, double value, const SpacePoint& n) {
    for (int c = 0; c < 3; ++c)
      if (const double entry = value * n[c]; entry != 0)
        entries.emplace_back(static_cast<int>(row), 3 * node + c, entry);
  };
  for (const FacingTriangles& each : facing) {
    const auto& x = nonmortar.places[each.nonmortar];
    const SpacePoint& n = directions[each.nonmortar];
    const double twiceArea = (x[1] - x[0]).cross(x[2] - x[0]).norm();
    std::array<const VertexFacts*, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = &vertices[keyOf(each.nonmortar, k)];
    if (std::all_of(corners.begin(), corners.end(), [](const auto* c) { return c->rows.empty(); })) continue;
    const auto& nodes1 = nonmortar.triangles[each.nonmortar];
    const auto& nodes2 = mortar.triangles[each.mortar];
    // Calls at(values of the traces and of the row functions) at a point of the refinement.
    const auto atPoint = [&](const Point& l, auto&& at) {
      const Eigen::Vector3d b(1 - l.x() - l.y(), l.x(), l.y());
      const Eigen::Vector3d mu = each.at(l);
      std::map<int, double> chi;
      for (int k = 0; k < 3; ++k)
        for (const auto& [row, part] : corners[k]->rows) chi[row] += part * b[k];
      // Of the curved surfaces, that of the triangles but for what these are off.
      const double apart =
          mu.dot(each.delta) + n.dot(mortar.offset(each.mortar, mu) - nonmortar.offset(each.nonmortar, b));
      at(traceShapes(nonmortar.degree, b), traceShapes(mortar.degree, mu), chi, apart);
    };
    for (size_t i = 2; i < each.polygon.size(); ++i) {
      const Point& p0 = each.polygon[0];
      const Point e1 = each.polygon[i - 1] - p0;
      const Point e2 = each.polygon[i] - p0;
      const double area = cross(e1, e2) / 2 * twiceArea;
      if (!(area > 0)) continue;
      for (const auto& [a, b, weight] : radonRule)
        atPoint(p0 + a * e1 + b * e2, [&, weight = weight](const auto& phi, const auto& psi, const auto& chi,
                                                           double delta) {
          for (const auto& [row, value] : chi) {
            const double w = weight * area * value;
            result.lengths_[row] += w;
            distance[row] += w * delta;
            least[row] = std::min(least[row], delta);
            for (const auto& [other, otherValue] : chi) {
              mass.emplace_back(row, other, w * otherValue);
              // Of the difference from the motions of the rows' own vertices.
              if (projects)
                add(D, row, result.nonmortarNodes_[other], -w * otherValue, result.spaceNormals_[other]);
            }
            for (int k = 0; k < nonmortar.perTriangle(); ++k) add(D, row, nodes1[k], w * phi[k], n);
            for (int k = 0; k < mortar.perTriangle(); ++k) add(M, row, nodes2[k], -w * psi[k], n);
          }
        });
      const auto point = static_cast<int>(areas.size());
      atPoint(p0 + (e1 + e2) / 3, [&](const auto& phi, const auto& psi, const auto& chi, double delta) {
        for (int k = 0; k < nonmortar.perTriangle(); ++k) trace1.emplace_back(point, nodes1[k], phi[k]);
        for (int k = 0; k < mortar.perTriangle(); ++k) trace2.emplace_back(point, nodes2[k], psi[k]);
        for (const auto& [row, value] : chi) functions.emplace_back(point, row, value);
        gaps.push_back(delta);
      });
      areas.push_back(area);
      sizes.push_back(std::sqrt(twiceArea));
      result.points_.normals.push_back(n);
    }
  }
  const auto faced = static_cast<Eigen::Index>(areas.size());
  result.points_.traces = {assembled(faced, nonmortarMesh.nodes.count(), trace1),
                           assembled(faced, mortarMesh.nodes.count(), trace2)};
  result.points_.rows = assembled(faced, rows, functions);
  result.points_.areas = Eigen::Map<const Vector>(areas.data(), faced);
  result.points_.distances = Eigen::Map<const Vector>(gaps.data(), faced);
  result.points_.sizes = Eigen::Map<const Vector>(sizes.data(), faced);
  result.overlap_ = result.points_.areas.sum() / std::min(nonmortar.area, mortar.area);

  result.mass_ = assembled(rows, rows, mass);
  if (pair.coupling == CouplingKind::weighted) {
    const Eigen::SparseMatrix<double> lumped(result.lengths_.asDiagonal());
    const auto inverse = result.lengths_.asDiagonal().inverse();
    result.mass_ = lumped;
    result.C1_ = inverse * assembled(rows, columns1, D);
    result.C2_ = inverse * assembled(rows, columns2, M);
    result.distance_ = inverse * distance;
  } else {
    Triplets own, seen;
    for (Eigen::Index row = 0; row < rows; ++row) {
      const SpacePoint& n = result.spaceNormals_[row];
      add(own, row, result.nonmortarNodes_[row], 1, n);
      for (int k = 0; k < 3 && !projects; ++k)
        add(seen, row, mortar.triangles[sights[row].triangle][k], -sights[row].mu[k], n);
    }
    result.C1_ = assembled(rows, columns1, own);
    result.C2_ = assembled(rows, columns2, seen);
    result.distance_ = Eigen::Map<const Vector>(distances.data(), rows);
    if (projects) {
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(result.mass_);
      const auto projected = [&](Eigen::Index columns, const Triplets& entries) {
        // By its columns that have entries.
        const Eigen::SparseMatrix<double> B = assembled(rows, columns, entries);
        Triplets all;
        for (Eigen::Index j = 0; j < columns; ++j) {
          if (B.col(j).nonZeros() == 0) continue;
          const Vector column = factor.solve(Vector(B.col(j)));
          constexpr double nothing = 1e-17;
          for (Eigen::Index i = 0; i < rows; ++i)
            if (std::abs(column[i]) > nothing) all.emplace_back(i, j, column[i]);
        }
        return assembled(rows, columns, all);
      };
      result.C1_ += projected(columns1, D);
      result.C2_ = projected(columns2, M);
      // The projection of a convex distance may be below the least one that a row function sees.
      const Vector mean = factor.solve(distance);
      result.distance_ = mean.cwiseMax(least.cwiseMin(result.distance_));
    }
  }
  std::set<int> mortarNodes;
  for (const auto& triangle : mortar.triangles)
    mortarNodes.insert(triangle.begin(), triangle.begin() + mortar.perTriangle());
  result.mortarNodes_.assign(mortarNodes.begin(), mortarNodes.end());
  const double smaller = std::min(nonmortar.extent, mortar.extent);
  result.settleDistance(options.initial, smaller, names);
  return result;
}

double ContactInterface::interpenetration(const Vector& uNonmortar, const Vector& uMortar, double t) const {
  if (dimension_ == 2) return penetration_.of(uNonmortar, uMortar, nodalGap(t));
  const Matrix jump = points_.jump(uNonmortar, uMortar);
  double sum = 0;
  for (Eigen::Index i = 0; i < jump.cols(); ++i)
    sum += points_.areas[i] * std::max(0.0, points_.normals[i].dot(jump.col(i)) - points_.distances[i]);
  return sum;
}

Matrix ContactInterface::SurfacePoints::jump(const Vector& uNonmortar, const Vector& uMortar) const {
  const auto byNodes = [](const Vector& u) { return u.reshaped(3, u.size() / 3).transpose(); };
  return (traces[0] * byNodes(uNonmortar) - traces[1] * byNodes(uMortar)).transpose();
}

}  // namespace mortier
