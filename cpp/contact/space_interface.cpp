// A contact interface between two surfaces: rows as in coupling.h, integrals over the common refinement of
// their triangles (SurfaceRefinement). Each point of a rule adds a pair of opposite forces along the line
// through x1 and x2: rows balance in force and moment.
//
// Row functions are the hat functions of the nonmortar vertices, whatever the degree: quadratic functions
// have no mean on a triangle (int chi_vertex = 0), so that forces at vertices say nothing of the pressure. A
// vertex has a row for each smooth part of the surface that meets there if it faces the mortar surface
// itself. The functions of the others go to neighbours with rows in equal parts, neighbour by neighbour, so
// that row functions still add up to 1.
//
// With friction a row has two beside it for the slip, along the tangents of its node, turned with the normal
// where that is another one. The mass of their projection is that of the rows times these turns.
//
// Where rows follow the bodies all this is done again for the surfaces as moved. Then every vertex that no
// support holds has its row, which is empty where the vertex faces nothing.
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/quadrature_rules.h"
#include "contact/interface_entries.h"
#include "contact/point_entries.h"
#include "contact/row_functions.h"
#include "contact/surface.h"
#include "contact/tangents.h"

namespace mortier {
namespace {

/// What makes distances of the rows between two surfaces of those given at nodes: a distance moves a
/// nonmortar node along the normal of the row; where a row has means of motions it has the same of distances.
/// \param nodes  of the rows
Eigen::SparseMatrix<double> rowsOfDistance(CouplingKind kind, const ConstraintRows& C1,
                                           const std::vector<SpacePoint>& normals,
                                           const std::vector<int>& nodes) {
  Triplets entries;
  Vector all = Vector::Zero(C1.rows());
  const auto add = [&](int row, int node, double value) {
    entries.emplace_back(row, node, value);
    all[row] += value;
  };
  for (int row = 0; row < C1.rows(); ++row) {
    if (!hasMeans(kind)) add(row, nodes[row], 1);
    for (ConstraintRows::InnerIterator entry(C1, row); entry && hasMeans(kind); ++entry)
      add(row, static_cast<int>(entry.col()) / 3, entry.value() * normals[row][entry.col() % 3]);
  }
  return all.cwiseInverse().asDiagonal() * assembled(C1.rows(), C1.cols() / 3, entries);
}

/// The rows of a square matrix by those of another one.
Eigen::SparseMatrix<double> spread(const Eigen::SparseMatrix<double>& rows, const std::vector<int>& rowOf,
                                   Eigen::Index count) {
  Triplets entries;
  forEachEntry(rows, [&](int row, int column, double value) {
    entries.emplace_back(rowOf[row], rowOf[column], value);
  });
  return assembled(count, count, entries);
}

}  // namespace

ContactInterface::ContactInterface(const ContactPair& pair, const SpaceContactMesh& nonmortarMesh,
                                   const SpaceContactMesh& mortarMesh, const InterfaceOptions& options)
    : dimension_(3), pair_(pair), friction_(options.friction), given_(options.gap) {
  ContactSurface nonmortar(nonmortarMesh.mesh, nonmortarMesh.nodes, pair.nonmortar.label);
  ContactSurface mortar(mortarMesh.mesh, mortarMesh.nodes, pair.mortar.label);
  shareNormals(nonmortar, mortar);
  const std::string names = sidesText(pair, nonmortarMesh.mesh, mortarMesh.mesh);
  if (pair.coupling != CouplingKind::weighted && nonmortar.degree > 1)
    throw InputError(names + ": in space variant = \"weighted\" is known, and for linear displacements " +
                     "\"mortar\" and \"interpolation\"");
  C1_.resize(0, 3 * static_cast<Eigen::Index>(nonmortarMesh.nodes.count()));
  C2_.resize(0, 3 * static_cast<Eigen::Index>(mortarMesh.nodes.count()));
  mortarNodes_ = mortar.nodes();
  const double reach = std::min(nonmortar.extent, mortar.extent);
  if (options.follows) {
    drawSurfaces(std::move(nonmortar), std::move(mortar), options);
    follow(Vector::Zero(C1_.cols()), Vector::Zero(C2_.cols()));
  } else {
    RefinedSurfaces surfaces(nonmortar, mortar, false);
    if (surfaces.refinement.facing.empty()) throw InputError(names + " do not face each other");
    findRows(surfaces, options);
    if (surfaces.rowOf.empty()) refuseWithoutRows(names);
    assemble(surfaces, options);
  }
  if (rows() == 0) refuseWithoutRows(names);
  if (!options.gap) {
    settleDistance(options.initial, reach, names);
    return;
  }
  N_ = rowsOfDistance(pair.coupling, C1_, normals_, nonmortarNodes_);
  for (int node = 0; node < nonmortarMesh.nodes.count(); ++node)
    if (N_.col(node).nonZeros() > 0 || points_.traces[0].col(node).nonZeros() > 0)
      gapNodes_.emplace_back(node, nonmortarMesh.nodes.places[node]);
  distance_ = N_ * givenAt(0);
  points_.distances = points_.traces[0] * givenAt(0);
}

/// Of each vertex that faces the other surface, but for ends that supports hold.
void ContactInterface::findRows(RefinedSurfaces& surfaces, const InterfaceOptions& options) {
  auto& [nonmortar, mortar, tree, refinement, rowOf, slipsAlong] = surfaces;
  const bool interpolates = pair_.coupling == CouplingKind::interpolation;
  const bool mayMerge = nonmortar.degree == 1 && options.nonmortarHeld;
  const auto held = [&](const auto& each) {
    return mayMerge && options.nonmortarHeld(each.first.first, refinement.directionAt(each.second));
  };
  const bool allHeld = std::ranges::all_of(
      refinement.vertices, [&](const auto& each) { return !each.second.faces || held(each); });
  for (const auto& each : refinement.vertices) {
    const auto& [key, vertex] = each;
    if (!vertex.faces) continue;
    const SpacePoint n = refinement.directionAt(vertex);
    const RayHit hit = interpolates ? tree.along(vertex.place, n, refinement.reach) : RayHit();
    if (interpolates && hit.triangle < 0) continue;
    if (!allHeld && held(each)) {
      bool across = true;  // whether the other side is held there too
      for (int k = 0; k < 3 && interpolates; ++k)
        across = across && options.mortarHeld &&
                 (std::abs(hit.mu[k]) < 1e-9 || options.mortarHeld(mortar.triangles[hit.triangle][k], n));
      if (across) {
        ++heldEnds_;
        continue;
      }
    }
    rowOf.emplace(key, static_cast<int>(nonmortarNodes_.size()));
    nonmortarNodes_.push_back(key.first);
  }
}

void ContactInterface::assemble(RefinedSurfaces& surfaces, const InterfaceOptions& options) {
  auto& [nonmortar, mortar, tree, refinement, rowOf, slipsAlong] = surfaces;
  const double reach = refinement.reach;
  VertexTable& vertices = refinement.vertices;
  const int slipRows = options.friction.any() ? 2 : 0;  // of a node
  const auto keyOf = [&](int triangle, int k) {
    return PartVertex{nonmortar.triangles[triangle][k], nonmortar.parts[triangle]};
  };

  // Rows.
  const auto rows = static_cast<Eigen::Index>(nonmortarNodes_.size());
  std::vector<RayHit> hits(rows);
  std::vector<double> distances(rows, reach);
  std::vector<std::pair<int, SurfaceRow>> facing;
  constexpr double ofNonmortar = 1.5;  // as little blurs the ends of contact, as much evens out tetrahedra
  const SurfaceSpacing spacing(mortar);
  const SurfaceSpacing ownSpacing(nonmortar);
  const auto mortarIsHeld = [&](const RayHit& hit, const SpacePoint& n) {
    bool all = hit.triangle >= 0 && options.mortarHeld;
    for (int k = 0; k < 3 && all; ++k) all = options.mortarHeld(mortar.triangles[hit.triangle][k], n);
    return all;
  };
  // The tangents along which a vertex and what faces it are fixed.
  const auto fixedTangents = [&](int node, const RayHit& hit, const SpacePoint& n) {
    constexpr double rounding = 1e-9;
    std::vector<SpacePoint> fixed;
    if (!options.nonmortarFixed || !options.mortarFixed || hit.triangle < 0) return fixed;
    for (const SpacePoint& d : options.nonmortarFixed(node)) {
      bool across = std::abs(d.dot(n)) < rounding && (fixed.empty() || std::abs(d.dot(fixed[0])) < rounding);
      for (int k = 0; k < 3 && across; ++k)
        across = std::abs(hit.mu[k]) < rounding ||
                 std::ranges::any_of(options.mortarFixed(mortar.triangles[hit.triangle][k]),
                                     [&](const SpacePoint& e) { return d.cross(e).norm() < rounding; });
      if (across) fixed.push_back(d);
    }
    return fixed;
  };
  faces_.assign(rows, 0);
  normals_.resize(rows);
  tangents_.resize(slipRows > 0 ? rows : 0);
  std::vector<double> slips(slipRows * rows, 1);  // by rows of T, 0 where both sides are fixed
  for (const auto& [key, row] : rowOf) {
    VertexFacts& vertex = vertices.at(key);
    const SpacePoint n = refinement.directionAt(vertex);
    normals_[row] = n;
    const RayHit hit = vertex.faces ? tree.along(vertex.place, n, reach) : RayHit();
    if (slipRows > 0) {
      const std::vector<SpacePoint> fixed = fixedTangents(key.first, hit, n);
      const SpacePoint first = !fixed.empty() ? fixed[0]
                               : slipsAlong.empty()
                                   ? tangentsTo(n)[0]
                                   : SpacePoint(n.cross(slipsAlong[row]).cross(n).normalized());
      tangents_[row] = {first, n.cross(first)};
      for (size_t a = 0; a < fixed.size(); ++a) slips[slipRows * row + a] = 0;
    }
    if (!vertex.faces || (pair_.coupling == CouplingKind::interpolation && hit.triangle < 0)) continue;
    faces_[row] = 1;
    vertex.rows.emplace_back(row, 1);
    hits[row] = hit;
    distances[row] =
        hit.triangle < 0 ? infinity : mortar.distanceAlong(n, hit.delta * n, hit.triangle, hit.mu);
    const Eigen::Matrix3d opposite = spacing.at(hit);
    facing.push_back({row,
                      {vertex.place, n, key.second, mortarIsHeld(hit, n) ? Eigen::Matrix3d::Zero() : opposite,
                       opposite + ofNonmortar * ownSpacing.ofVertices(key.first)}});
  }
  shareFunctions(vertices);
  const Eigen::Index columns1 = C1_.cols();
  const Eigen::Index columns2 = C2_.cols();
  const bool projects = pair_.coupling == CouplingKind::mortar;
  Triplets mass, D, M;
  Triplets slipMass, slipD, slipM;
  // The directions of slip of a row where the normal is n.
  const auto tangentAt = [&](Eigen::Index row, int a, const SpacePoint& n) {
    return turnedWith(tangents_[row][a], normals_[row], n);
  };
  const auto slipRow = [](int row, int a) { return 2 * row + a; };
  PointEntries points, nearestPoints;
  Vector distance = Vector::Zero(rows);
  Vector least = Vector::Constant(rows, infinity);
  lengths_ = Vector::Zero(rows);
  std::vector<DistanceError> errors;
  const auto add = [](Triplets& entries, Eigen::Index row, int node, double value, const SpacePoint& n) {
    for (int c = 0; c < 3; ++c)
      if (const double entry = value * n[c]; entry != 0)
        entries.emplace_back(static_cast<int>(row), 3 * node + c, entry);
  };
  for (const FacingTriangles& each : refinement.facing) {
    const auto& x = nonmortar.places[each.nonmortar];
    const SpacePoint& n = refinement.directions[each.nonmortar];
    const double twiceArea = (x[1] - x[0]).cross(x[2] - x[0]).norm();
    const auto& x2 = mortar.places[each.mortar];
    const double mortarSize = std::sqrt((x2[1] - x2[0]).cross(x2[2] - x2[0]).norm());
    std::vector<int> own;  // rows whose functions are not 0 on this triangle
    std::array<const VertexFacts*, 3> corners;
    for (int k = 0; k < 3; ++k) {
      corners[k] = &vertices[keyOf(each.nonmortar, k)];
      for (const auto& [row, part] : corners[k]->rows) own.push_back(row);
    }
    if (own.empty()) continue;
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    const auto count = static_cast<Eigen::Index>(own.size());
    Matrix parts = Matrix::Zero(count, 3);  // of the corners' hat functions
    for (int k = 0; k < 3; ++k)
      for (const auto& [row, part] : corners[k]->rows)
        parts(std::lower_bound(own.begin(), own.end(), row) - own.begin(), k) += part;
    const auto& nodes1 = nonmortar.triangles[each.nonmortar];
    const auto& nodes2 = mortar.triangles[each.mortar];
    const auto distanceAt = [&](const Point& l) {
      const Eigen::Vector3d mu = each.at(l);
      const SpacePoint apart =
          mu.dot(each.delta) * n - nonmortar.offset(each.nonmortar, {1 - l.sum(), l.x(), l.y()});
      return squareOfCosine(nonmortar, mortar, each, n, l) * mortar.distanceAlong(n, apart, each.mortar, mu);
    };
    // Calls at(values of the traces, barycentric coordinates, distance) at a point of the refinement.
    const auto atPoint = [&](const Point& l, auto&& at) {
      const Eigen::Vector3d b(1 - l.x() - l.y(), l.x(), l.y());
      at(traceShapes(nonmortar.degree, b), traceShapes(mortar.degree, each.at(l)), b, distanceAt(l));
    };
    const auto addTo = [&](PointEntries& to) {
      return [&](const auto& phi, const auto& psi, const auto& chi, double delta) {
        for (int k = 0; k < nonmortar.perTriangle(); ++k) to.add(to.trace1, nodes1[k], phi[k]);
        for (int k = 0; k < mortar.perTriangle(); ++k) to.add(to.trace2, nodes2[k], psi[k]);
        for (Eigen::Index i = 0; i < count; ++i) to.add(to.functions, own[i], parts.row(i).dot(chi));
        to.distances.push_back(delta);
        to.sizes[0].push_back(std::sqrt(twiceArea));
        to.sizes[1].push_back(mortarSize);
        to.normals.push_back(n);
      };
    };
    // Integrals of the corners' hat functions times those of the corners, the traces, the distance and one.
    Eigen::Matrix3d hats = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 6> traces1 = Eigen::Matrix<double, 3, 6>::Zero();
    Eigen::Matrix<double, 3, 6> traces2 = traces1;
    Eigen::Vector3d apart = Eigen::Vector3d::Zero();
    Eigen::Vector3d covered = Eigen::Vector3d::Zero();
    forEachTriangle(each.polygon, [&](const Point& p0, const Point& e1, const Point& e2, double part) {
      const double area = part * twiceArea;
      for (const auto& [at, weight] : radonSeven)
        atPoint(p0 + at[1] * e1 + at[2] * e2,
                [&, weight = weight](const auto& phi, const auto& psi, const auto& chi, double delta) {
                  const Eigen::Vector3d w = weight * area * chi;
                  hats += w * chi.transpose();
                  traces1 += w * Eigen::Map<const Eigen::Matrix<double, 1, 6>>(phi.data());
                  traces2 += w * Eigen::Map<const Eigen::Matrix<double, 1, 6>>(psi.data());
                  apart += delta * w;
                  covered += w;
                });
      atPoint(p0 + (e1 + e2) / 3, addTo(points));
      points.areas.push_back(area);
    });
    // The least distance of a piece, which does not jump where another piece vanishes.
    const Point lowest = lowestIn(each.polygon, nonmortar.planar && mortar.planar ? 0 : 9, distanceAt);
    const double nearest = distanceAt(lowest);
    if (!options.gap && options.initial != InitialGap::close) atPoint(lowest, addTo(nearestPoints));
    errors.push_back({nearest, errorBetween(nonmortar, mortar, each)});
    for (Eigen::Index i = 0; i < count; ++i) {
      const int row = own[i];
      lengths_[row] += parts.row(i).dot(covered);
      distance[row] += parts.row(i).dot(apart);
      least[row] = std::min(least[row], nearest);
      const Eigen::RowVector3d products = parts.row(i) * hats;
      for (Eigen::Index j = 0; j < count && pair_.coupling != CouplingKind::weighted; ++j) {
        const double entry = products.dot(parts.row(j));
        mass.emplace_back(row, own[j], entry);
        if (!projects) continue;
        // Of the difference from the motions of the rows' own vertices.
        add(D, row, nonmortarNodes_[own[j]], -entry, normals_[own[j]]);
        for (int a = 0; a < slipRows; ++a) {
          const SpacePoint there = tangentAt(row, a, normals_[own[j]]);
          add(slipD, slipRow(row, a), nonmortarNodes_[own[j]], -entry, there);
          for (int b = 0; b < slipRows; ++b)
            slipMass.emplace_back(slipRow(row, a), slipRow(own[j], b),
                                  entry * there.dot(tangents_[own[j]][b]));
        }
      }
      const auto addJump = [&](Triplets& to1, Triplets& to2, int at, const SpacePoint& along) {
        for (int k = 0; k < nonmortar.perTriangle(); ++k)
          add(to1, at, nodes1[k], parts.row(i).dot(traces1.col(k)), along);
        for (int k = 0; k < mortar.perTriangle(); ++k)
          add(to2, at, nodes2[k], -parts.row(i).dot(traces2.col(k)), along);
      };
      addJump(D, M, row, n);
      for (int a = 0; a < slipRows; ++a) addJump(slipD, slipM, slipRow(row, a), tangentAt(row, a, n));
    }
  }
  for (int row = 0; row < rows; ++row) {  // no force has a pressure there
    if (lengths_[row] == 0 && pair_.coupling != CouplingKind::interpolation) faces_[row] = 0;
    if (hasMeans(pair_.coupling) && faces_[row] != 0) mass.emplace_back(row, row, lengths_[row]);
    if (faces_[row] != 0) continue;
    mass.emplace_back(row, row, 1);
    for (int a = 0; a < slipRows; ++a) slipMass.emplace_back(slipRow(row, a), slipRow(row, a), 1);
    distances[row] = distance[row] = least[row] = reach;
  }
  const std::array<int, 2> nodes{static_cast<int>(columns1) / 3, static_cast<int>(columns2) / 3};
  points_ = points.assembled(nodes, rows);
  nearest_ = nearestPoints.assembled(nodes, rows);
  overlap_ = points_.areas.sum() / std::min(nonmortar.area, mortar.area);

  if (pair_.coupling == CouplingKind::weighted) {
    mass_ = assembled(rows, rows, mass);
    weights_ = mass_.diagonal();
    const Vector inverse = weights_.cwiseInverse();  // products copy an expression for each column
    C1_ = inverse.asDiagonal() * assembled<ConstraintRows>(rows, columns1, D);
    C2_ = inverse.asDiagonal() * assembled<ConstraintRows>(rows, columns2, M);
    const Vector ofSlips = inverse.transpose().replicate(slipRows, 1).reshaped();
    T1_ = ofSlips.asDiagonal() * assembled<ConstraintRows>(slipRows * rows, columns1, slipD);
    T2_ = ofSlips.asDiagonal() * assembled<ConstraintRows>(slipRows * rows, columns2, slipM);
    distance_ = inverse.cwiseProduct(distance);
  } else {
    mass_ = assembled(rows, rows, mass);
    weights_ = mass_ * Vector::Ones(rows);
    Triplets own, opposite, slipOwn, slipOpposite;
    for (int row = 0; row < rows; ++row) {
      if (faces_[row] == 0) continue;
      const auto addNode = [&](Triplets& nonmortarRows, Triplets& mortarRows, int at,
                               const SpacePoint& along) {
        add(nonmortarRows, at, nonmortarNodes_[row], 1, along);
        for (int k = 0; k < 3 && !projects; ++k)
          add(mortarRows, at, mortar.triangles[hits[row].triangle][k], -hits[row].mu[k], along);
      };
      addNode(own, opposite, row, normals_[row]);
      for (int a = 0; a < slipRows; ++a) addNode(slipOwn, slipOpposite, slipRow(row, a), tangents_[row][a]);
    }
    C1_ = assembled<ConstraintRows>(rows, columns1, own);
    C2_ = assembled<ConstraintRows>(rows, columns2, opposite);
    T1_ = assembled<ConstraintRows>(slipRows * rows, columns1, slipOwn);
    T2_ = assembled<ConstraintRows>(slipRows * rows, columns2, slipOpposite);
    distance_ = Eigen::Map<const Vector>(distances.data(), rows);
    if (!projects) {
      const Vector exact = assembled<ConstraintRows>(rows, columns2, M).transpose() * Vector::Ones(rows);
      const Vector off = C2_.transpose() * weights_ - exact;
      const double largest = exact.cwiseAbs().maxCoeff();
      patchError_ = largest > 0 ? off.cwiseAbs().maxCoeff() / largest : 0;
    }
    if (projects) {
      using Factor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;
      const auto projected = [](const Factor& factor, Eigen::Index columns, const Triplets& entries) {
        // By its columns that have entries.
        const Eigen::SparseMatrix<double> B = assembled(factor.rows(), columns, entries);
        Triplets all;
        for (Eigen::Index j = 0; j < columns; ++j) {
          if (B.col(j).nonZeros() == 0) continue;
          const Vector column = factor.solve(Vector(B.col(j)));
          constexpr double nothing = 1e-17;
          for (Eigen::Index i = 0; i < column.size(); ++i)
            if (std::abs(column[i]) > nothing) all.emplace_back(i, j, column[i]);
        }
        return assembled<ConstraintRows>(factor.rows(), columns, all);
      };
      const Factor factor(mass_);
      C1_ += projected(factor, columns1, D);
      C2_ = projected(factor, columns2, M);
      if (slipRows > 0) {
        const Factor ofSlips(assembled(slipRows * rows, slipRows * rows, slipMass));
        T1_ += projected(ofSlips, columns1, slipD);
        T2_ = projected(ofSlips, columns2, slipM);
      }
      distance_ = lifted(factor.solve(distance), distance_, least);
    }
  }
  for (ConstraintRows* T : {&T1_, &T2_}) {
    *T = Eigen::Map<const Vector>(slips.data(), T->rows()).asDiagonal() * *T;
    T->prune(0.0);
  }
  if (pair_.coupling != CouplingKind::interpolation) {
    std::vector<int> pressable;
    std::vector<SurfaceRow> surfaceRows;
    for (const auto& [row, facts] : facing) {
      if (faces_[row] == 0) continue;
      pressable.push_back(row);
      surfaceRows.push_back(facts);
    }
    const Vector areas = lengths_(pressable);
    const PressureCompliance yielding = pressureCompliance(surfaceRows, areas, options.mortarCompliance);
    stabilised_ = options.stabilised;
    if (options.stabilised) compliance_ = spread(yielding.S, pressable, rows);
    means_ = spread(yielding.means, pressable, rows);
    fits_ = spread(linearFits(surfaceRows, areas), pressable, rows);
    mortarSpacing_ = Vector::Zero(rows);
    mortarSpacing_(pressable) = yielding.spacing;
  }
  if (!options.gap) sagitta_ = visibleError(errors);
}

}  // namespace mortier
