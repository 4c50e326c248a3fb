#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include "base/error.h"
#include "base/quadrature_rules.h"
#include "contact/interface_entries.h"
#include "contact/row_functions.h"
#include "contact/surface.h"
#include "contact/tie_jumps.h"
#include "mesh/simplices.h"

namespace mortier {
namespace {

/// Points that are apart by less than this part of the size of an element are one.
constexpr double together = 1e-12;

/// The shape functions of an element at a point of a side of it, extended to x.
/// \param nodes  of the element: vertices, then the middles of its sides
/// \param places  of these, as columns (dimensions x nodes) [m]
/// \param at  barycentric coordinates of the point (dimensions + 1)
template <int dim>
NodeValues extended(std::span<const int> nodes, const Eigen::Matrix<double, dim, Eigen::Dynamic>& places,
                    const Eigen::Matrix<double, dim + 1, 1>& at, const Eigen::Matrix<double, dim, 1>& x) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Vector shapes = Vector::Zero(n);
  Matrix slopes = Matrix::Zero(n, dim + 1);  // by barycentric coordinates
  if (n == dim + 1) {
    shapes = at;
    slopes.setIdentity();
  } else {
    for (int k = 0; k <= dim; ++k) {
      shapes[k] = at[k] * (2 * at[k] - 1);
      slopes(k, k) = 4 * at[k] - 1;
    }
    for (Eigen::Index k = dim + 1; k < n; ++k) {
      constexpr std::array<std::array<int, 2>, 6> sides = sidesOfTetrahedron;  // first those of a triangle
      const auto [a, b] = sides[static_cast<size_t>(k - dim - 1)];
      shapes[k] = 4 * at[a] * at[b];
      slopes(k, a) = 4 * at[b];
      slopes(k, b) = 4 * at[a];
    }
  }
  const Matrix along = slopes.rightCols(dim).colwise() - slopes.col(0);
  const Eigen::Matrix<double, dim, dim> size = places * along;
  const Eigen::Matrix<double, dim, 1> apart = x - places * shapes;
  if (apart.norm() > together * size.norm()) shapes += along * size.inverse() * apart;
  NodeValues trace;
  for (Eigen::Index k = 0; k < n; ++k)
    if (shapes[k] != 0) trace.emplace_back(nodes[static_cast<size_t>(k)], shapes[k]);
  return trace;
}

template <int dim, class Nodes>
Eigen::Matrix<double, dim, Eigen::Dynamic> placesOf(const Nodes& all, std::span<const int> nodes) {
  Eigen::Matrix<double, dim, Eigen::Dynamic> places(dim, nodes.size());
  for (size_t k = 0; k < nodes.size(); ++k) places.col(static_cast<Eigen::Index>(k)) = all.places[nodes[k]];
  return places;
}

/// Of a mesh of one element.
template <int dim, class Nodes>
NodeValues ofOnlyElement(const Nodes& nodes, const SpacePoint& x) {
  const std::span own(nodes.of(0), static_cast<size_t>(nodes.perElement()));
  const auto middle = Eigen::Matrix<double, dim + 1, 1>::Constant(1.0 / (dim + 1));
  return extended<dim>(own, placesOf<dim>(nodes, own), middle, x.head<dim>());
}

/// The nodes of a side, and what of it is theirs [m], in space and of rings [m^2].
std::map<int, double> partsOfNodes(const ContactMesh& of, int label, bool axisymmetric) {
  std::map<int, double> parts;
  for (size_t e = 0; e < of.mesh.boundaryEdges.size(); ++e) {
    if (of.mesh.boundaryLabels[e] != label) continue;
    const auto [a, b] = of.mesh.boundaryEdges[e];
    const auto depth = [&](int node) { return axisymmetric ? circumference(of.nodes.places[node]) : 1; };
    const Point& xa = of.nodes.places[a];
    const Point& xb = of.nodes.places[b];
    if (of.nodes.degree == 1) {
      const double sixth = (xb - xa).norm() / 6;
      parts[a] += sixth * (2 * depth(a) + depth(b));
      parts[b] += sixth * (depth(a) + 2 * depth(b));
      continue;
    }
    const int middle = of.nodes.middles[e];
    const Point& xm = of.nodes.places[middle];
    parts[a] += depth(a) * (4 * xm - 3 * xa - xb).norm() / 6;
    parts[middle] += depth(middle) * (xb - xa).norm() * 2 / 3;
    parts[b] += depth(b) * (xa - 4 * xm + 3 * xb).norm() / 6;
  }
  return parts;
}

std::map<int, double> partsOfNodes(const SpaceContactMesh& of, int label, bool /*axisymmetric*/) {
  std::map<int, double> parts;
  for (size_t i = 0; i < of.nodes.faces.size(); ++i) {
    if (of.mesh.boundaryLabels[i] != label) continue;
    const std::array<int, 6>& face = of.nodes.faces[i];
    const auto& x = of.nodes.places;
    const double area = (x[face[1]] - x[face[0]]).cross(x[face[2]] - x[face[0]]).norm() / 2;
    for (int k = 0; k < of.nodes.perFace(); ++k)
      parts[face[k]] += of.nodes.degree == 2 && k < 3 ? 0 : area / 3;
  }
  return parts;
}

}  // namespace

RigidTrace::RigidTrace(int ofBody, const ContactMesh& mesh)
    : body(ofBody),
      nodes(mesh.nodes.count()),
      at([&nodes = mesh.nodes](const SpacePoint& x) { return ofOnlyElement<2>(nodes, x); }) {}

RigidTrace::RigidTrace(int ofBody, const SpaceContactMesh& mesh)
    : body(ofBody),
      nodes(mesh.nodes.count()),
      at([&nodes = mesh.nodes](const SpacePoint& x) { return ofOnlyElement<3>(nodes, x); }) {}

template <class Contact>
Tie::Jumps Tie::between(const Contact& nonmortar, int mortarNodes, const TieOptions& options) {
  sides_ = {{pair_.nonmortar.body, {}, {}}, {pair_.mortar.body, {}, {}}};
  nodesOfSides_ = {nonmortar.nodes.count(), mortarNodes};
  Jumps jumps;
  jumps.placeOf = [&nodes = nonmortar.nodes](int node) { return asSpacePoint(nodes.places[node]); };
  if (options.offset) {
    jumps.offset = &*options.offset;
    jumps.sign = options.offsetOfMortar ? -1 : 1;
    sides_.push_back({options.offset->body, {}, {}});
    nodesOfSides_.push_back(options.offset->nodes);
  }
  return jumps;
}

Tie::Tie(const ContactPair& pair, const ContactMesh& nonmortarMesh, const ContactMesh& mortarMesh,
         const TieOptions& options)
    : pair_(pair) {
  if (options.kind != TieKind::surface) {
    followPoint(nonmortarMesh, {pair.mortar.body, mortarMesh}, options);
    return;
  }
  const BoundaryLine nonmortar = boundaryLine(nonmortarMesh.mesh, nonmortarMesh.nodes, pair.nonmortar.label);
  const BoundaryLine mortar = boundaryLine(mortarMesh.mesh, mortarMesh.nodes, pair.mortar.label);
  const std::vector<SmoothPart> parts = partsFacing(nonmortar, mortar);
  const MortarLine across(mortar);
  const ElementsBehind behind = elementsBehind(mortarMesh.mesh, pair.mortar.label);
  const ElementsBehind ownBehind = elementsBehind(nonmortarMesh.mesh, pair.nonmortar.label);
  const bool atNodes = pair.coupling == CouplingKind::interpolation;
  Jumps jumps = between(nonmortarMesh, mortarMesh.nodes.count(), options);
  double length = 0;
  for (size_t number = 0; number < parts.size(); ++number) {
    const SmoothPart& part = parts[number];
    length += part.length();
    const CommonRefinement refinement(part, across);
    if (refinement.segments().empty()) continue;
    overlap_ += refinement.length();
    const RowFunctions functions(pair.coupling, refinement, {});
    const auto ownTrace = [&](int element, const EdgeValues& phi) {
      NodeValues trace;
      const EdgeNodes nodes = part.nodesOf(element);
      for (Eigen::Index k = 0; k < nodes.size(); ++k) trace.emplace_back(part.number(nodes[k]), phi[k]);
      return trace;
    };
    const auto mortarTrace = [&](const Segment& segment, const FacingPair& facing) {
      const int a = across.nodes[segment.mortar];
      const int b = across.nodes[segment.mortar + 1];
      const int triangle = behind.at(sideOf(std::array{a, b}));
      const std::span nodes(mortarMesh.nodes.of(static_cast<size_t>(triangle)),
                            static_cast<size_t>(mortarMesh.nodes.perElement()));
      const double xi = facing.psi[1] + (facing.psi.size() > 2 ? facing.psi[2] / 2 : 0);
      Eigen::Vector3d at = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) at[k] = nodes[k] == a ? 1 - xi : nodes[k] == b ? xi : 0;
      Point x = Point::Zero();
      const EdgeNodes own = part.nodesOf(segment.nonmortar);
      for (Eigen::Index k = 0; k < own.size(); ++k)
        x += facing.phi[k] * nonmortarMesh.nodes.places[part.number(own[k])];
      distance_ = std::max(distance_, std::abs(facing.distance));
      return Opposite{triangle, extended<2>(nodes, placesOf<2>(mortarMesh.nodes, nodes), at, x)};
    };
    std::vector<int> rowOf;
    for (const int node : functions.nodes())
      rowOf.push_back(jumps.row(part.number(node), static_cast<int>(number)));
    const auto rowsAt = [&](const EdgeNodes& rows) {
      std::vector<int> all;
      for (const int row : rows)
        if (row >= 0) all.push_back(rowOf[row]);
      return all;
    };
    for (int e = 0; e < part.elements(); ++e) jumps.join(rowsAt(functions.at(e)));
    for (size_t i = 0; atNodes && i < rowOf.size(); ++i) {
      const int node = functions.nodes()[i];
      const auto [facing, place] = refinement.facingOfNode(node);
      jumps.add(rowOf[i], 1, {{part.number(node), 1}}, mortarTrace(place, facing).values);
    }
    atLobattoPoints(
        refinement, functions,
        [&](const Segment& segment, const EdgeNodes& rows, double s, const EdgeValues& chi, double weight) {
          const FacingPair facing = refinement.pairAt(segment, s);
          const double xi = part.partAt(segment.nonmortar, s);
          const double depth = options.axisymmetric ? circumference(part.at(segment.nonmortar, xi)) : 1;
          const NodeValues own = ownTrace(segment.nonmortar, facing.phi);
          const Opposite opposite = mortarTrace(segment, facing);
          const int e = segment.nonmortar;
          const double ds = weight * facing.stretch * depth;
          jumps.addPoint(own, opposite, ownBehind.at(sideOf(std::array{part.nodes[e], part.nodes[e + 1]})),
                         ds, part.s[e + 1] - part.s[e]);
          for (Eigen::Index i = 0; i < rows.size() && !atNodes; ++i)
            if (rows[i] >= 0) jumps.addAtPoint(rowOf[rows[i]], ds * chi[i], own, opposite.values);
        });
  }
  if (jumps.rowOf.empty()) refuseWithoutRows(sidesText(pair, nonmortarMesh.mesh, mortarMesh.mesh));
  overlap_ /= length;
  setRows(jumps, options);
}

Tie::Tie(const ContactPair& pair, const SpaceContactMesh& nonmortarMesh, const SpaceContactMesh& mortarMesh,
         const TieOptions& options)
    : pair_(pair), dimension_(3) {
  if (options.kind != TieKind::surface) {
    followPoint(nonmortarMesh, {pair.mortar.body, mortarMesh}, options);
    return;
  }
  ContactSurface nonmortar(nonmortarMesh.mesh, nonmortarMesh.nodes, pair.nonmortar.label);
  ContactSurface mortar(mortarMesh.mesh, mortarMesh.nodes, pair.mortar.label);
  shareNormals(nonmortar, mortar);
  const TriangleTree tree(mortar);
  SurfaceRefinement refinement(nonmortar, mortar, tree);
  const ElementsBehind behind = elementsBehind(mortarMesh.mesh, pair.mortar.label);
  const ElementsBehind ownBehind = elementsBehind(nonmortarMesh.mesh, pair.nonmortar.label);
  const auto& vertices = nonmortarMesh.nodes.places;
  const auto mortarTrace = [&](int triangle, const Eigen::Vector3d& mu, const SpacePoint& x) {
    const auto& corners = mortar.triangles[triangle];
    const int element = behind.at(sideOf(std::array{corners[0], corners[1], corners[2]}));
    const std::span nodes(mortarMesh.nodes.of(static_cast<size_t>(element)),
                          static_cast<size_t>(mortarMesh.nodes.perElement()));
    Eigen::Vector4d at = Eigen::Vector4d::Zero();
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < 3; ++c)
        if (nodes[k] == corners[c]) at[k] = mu[c];
    return Opposite{element, extended<3>(nodes, placesOf<3>(mortarMesh.nodes, nodes), at, x)};
  };
  Jumps jumps = between(nonmortarMesh, mortarMesh.nodes.count(), options);
  const bool atNodes = pair.coupling == CouplingKind::interpolation;
  std::map<PartVertex, RayHit> hits;
  for (auto& [key, vertex] : refinement.vertices) {
    if (!vertex.faces) continue;
    if (atNodes) {
      const RayHit hit = tree.along(vertex.place, refinement.directionAt(vertex), refinement.reach);
      if (hit.triangle < 0) continue;
      hits.emplace(key, hit);
    }
    vertex.rows.emplace_back(jumps.row(key.first, key.second), 1);
  }
  shareFunctions(refinement.vertices);
  for (const auto& [key, hit] : hits) {
    const int node = key.first;
    distance_ = std::max(distance_, std::abs(hit.delta));
    jumps.add(jumps.row(node, key.second), 1, {{node, 1}},
              mortarTrace(hit.triangle, hit.mu, vertices[node]).values);
  }
  double covered = 0;
  for (const FacingTriangles& each : refinement.facing) {
    const auto& nodes = nonmortar.triangles[each.nonmortar];
    const auto& x = nonmortar.places[each.nonmortar];
    const double twiceArea = (x[1] - x[0]).cross(x[2] - x[0]).norm();
    std::array<const VertexFacts*, 3> corners;
    std::vector<int> rows;
    for (int k = 0; k < 3; ++k) {
      corners[k] = &refinement.vertices.at({nodes[k], nonmortar.parts[each.nonmortar]});
      for (const auto& [row, part] : corners[k]->rows) rows.push_back(row);
    }
    jumps.join(rows);
    const int element = ownBehind.at(sideOf(std::array{nodes[0], nodes[1], nodes[2]}));
    forEachTriangle(each.polygon, [&](const Point& p0, const Point& e1, const Point& e2, double part) {
      covered += part * twiceArea;
      for (const auto& [at, weight] : radonSeven) {
        const Point l = p0 + at[1] * e1 + at[2] * e2;
        const Eigen::Vector3d b(1 - l.sum(), l.x(), l.y());
        NodeValues own;
        const auto phi = traceShapes(nonmortar.degree, b);
        for (int k = 0; k < nonmortar.perTriangle(); ++k) own.emplace_back(nodes[k], phi[k]);
        const Eigen::Vector3d mu = each.at(l);
        distance_ = std::max(distance_, std::abs(mu.dot(each.delta)));
        const Opposite opposite = mortarTrace(each.mortar, mu, b[0] * x[0] + b[1] * x[1] + b[2] * x[2]);
        const double ds = weight * part * twiceArea;
        jumps.addPoint(own, opposite, element, ds, std::sqrt(twiceArea));
        for (int k = 0; k < 3 && !atNodes; ++k)
          for (const auto& [row, share] : corners[k]->rows)
            jumps.addAtPoint(row, ds * b[k] * share, own, opposite.values);
      }
    });
  }
  if (jumps.rowOf.empty()) refuseWithoutRows(sidesText(pair, nonmortarMesh.mesh, mortarMesh.mesh));
  overlap_ = covered / nonmortar.area;
  setRows(jumps, options);
}

template <class Contact>
void Tie::followPoint(const Contact& nonmortar, const RigidTrace& point, const TieOptions& options) {
  const std::map<int, double> parts = partsOfNodes(nonmortar, pair_.nonmortar.label, options.axisymmetric);
  if (parts.empty())
    throw InputError(nonmortar.mesh.name + " has no side with label " +
                     std::to_string(pair_.nonmortar.label));
  overlap_ = 1;
  Jumps jumps = between(nonmortar, point.nodes, options);
  if (options.kind == TieKind::distributing) {
    setMeanRows(parts, jumps, point, options);
    return;
  }
  pair_.coupling = CouplingKind::interpolation;
  for (const auto& [node, part] : parts)
    jumps.add(jumps.row(node, 0), 1, {{node, 1}}, point.at(jumps.placeOf(node)));
  setRows(jumps, options);
}

Vector Tie::heldJump(const std::vector<Vector>& u) const {
  Vector result = Vector::Zero(static_cast<Eigen::Index>(heldNodes_.size()));
  for (size_t k = 0; k < heldRows_.size(); ++k) result += heldRows_[k] * u[sides_[k].body];
  return result;
}

Vector Tie::jump(const std::vector<Vector>& u) const {
  Vector result = Vector::Zero(rows());
  for (const auto& [body, C, traces] : sides_) result += C * u[body];
  return result;
}

void Tie::subtractForces(const Vector& l, std::vector<Vector>& force) const {
  for (const auto& [body, C, traces] : sides_) force[body] -= C.transpose() * l;
}

Matrix Tie::jumpAtPoints(const std::vector<Vector>& u, const Vector& l) const {
  Matrix result = Matrix::Zero(dimension_, points_.weights.size());
  for (const auto& [body, C, traces] : sides_)
    forEachEntry(traces, [&, of = body](int point, int node, double value) {
      result.col(point) += value * u[of].segment(static_cast<Eigen::Index>(dimension_) * node, dimension_);
    });
  if (elastic()) result -= (layer_.transpose() * l).eval().reshaped(dimension_, points_.weights.size());
  for (int c = 0; c < dimension_; ++c)
    if (!along_[c]) result.row(c).setZero();
  return result;
}

}  // namespace mortier
