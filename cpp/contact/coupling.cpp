#include "contact/coupling.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "contact/end_rows.h"
#include "contact/row_functions.h"
#include "mesh/triangle_mesh.h"

namespace mortier {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Factor = Eigen::SimplicialLDLT<Sparse>;

/// Smaller entries of C, which has no unit, change no bit of what is computed with them.
constexpr double negligible = 1e-25;

/// Entries of a row at the nodes of an element: columns 2 node + component.
void addEntries(int row, const EdgeNodes& nodes, const EdgeValues& values, const Point& direction,
                Triplets& entries) {
  for (Eigen::Index k = 0; k < nodes.size(); ++k)
    for (int c = 0; c < 2; ++c)
      if (const double value = values[k] * direction[c]; value != 0)
        entries.emplace_back(row, 2 * nodes[k] + c, value);
}

/// What the projections are made of.
struct Integrals {
  Triplets mass;
  Triplets D;  ///< of the difference from the motions of the rows' own nodes, where these are given
  Triplets M;
  Triplets N;  ///< of the shape functions themselves
  Vector distance;
  Vector least;  ///< distance at a point of the row [m]
  Vector lengths;
  Vector moments;  ///< of the row functions about s = 0
};

/// \param own  directions of contact at the nodes of the rows, or empty: no motion is subtracted
Integrals integrate(const CommonRefinement& refinement, const DistanceAt& distance, const RowFunctions& rows,
                    const std::vector<Point>& own, bool axisymmetric) {
  const SmoothPart& part = refinement.part();
  Integrals result;
  result.distance = Vector::Zero(rows.count());
  result.least = Vector::Constant(rows.count(), std::numeric_limits<double>::infinity());
  result.lengths = Vector::Zero(rows.count());
  result.moments = Vector::Zero(rows.count());
  atLobattoPoints(
      refinement, rows,
      [&](const Segment& segment, const EdgeNodes& row, double s, const EdgeValues& chi, double weight) {
        const FacingPair facing = refinement.pairAt(segment, s);
        const double g0 = distance(segment.nonmortar, s, facing);
        const EdgeNodes nodes = part.nodesOf(segment.nonmortar);
        const EdgeNodes across = refinement.mortar().nodesOf(segment.mortar);
        const double depth =
            axisymmetric ? circumference(part.at(segment.nonmortar, part.partAt(segment.nonmortar, s))) : 1;
        for (Eigen::Index i = 0; i < row.size(); ++i) {
          if (row[i] < 0) continue;
          const double w = weight * facing.stretch * chi[i] * depth;
          result.lengths[row[i]] += weight * facing.stretch * chi[i];
          for (Eigen::Index j = 0; j < row.size(); ++j)
            if (row[j] >= 0) result.mass.emplace_back(row[i], row[j], w * chi[j]);
          for (Eigen::Index k = 0; k < nodes.size(); ++k) {
            Point value = facing.phi[k] * facing.normal;
            if (!own.empty() && row[k] >= 0) value -= chi[k] * own[row[k]];
            addEntries(row[i], nodes.segment(k, 1), EdgeValues::Constant(1, w), value, result.D);
          }
          addEntries(row[i], across, -w * facing.psi, facing.normal, result.M);
          for (Eigen::Index k = 0; k < nodes.size(); ++k)
            result.N.emplace_back(row[i], nodes[k], w * facing.phi[k]);
          result.distance[row[i]] += w * g0;
          result.moments[row[i]] += w * s;
          result.least[row[i]] = std::min(result.least[row[i]], g0);
        }
      });
  return result;
}

/// Phi^-1 B
Sparse projected(const Factor& mass, const Sparse& B) {
  Triplets entries;
  for (int j = 0; j < B.outerSize(); ++j) {
    if (B.col(j).nonZeros() == 0) continue;
    const Vector column = mass.solve(Vector(B.col(j)));
    for (Eigen::Index i = 0; i < column.size(); ++i)
      if (std::abs(column[i]) > negligible) entries.emplace_back(static_cast<int>(i), j, column[i]);
  }
  return assembled(B.rows(), B.cols(), entries);
}

/// The rows that are no more than `steps` neighbours away from those that `columns` of B begin with. The
/// farthest of them come last, from `edge` on; none where all rows are there.
struct Neighbourhood {
  std::vector<int> rows;
  size_t edge = 0;
};

Neighbourhood around(const Sparse& Phi, const Sparse& B, int begin, int end, int steps,
                     std::vector<int>& placeOf) {
  Neighbourhood result;
  const auto add = [&](int row) {
    if (placeOf[row] >= 0) return;
    placeOf[row] = static_cast<int>(result.rows.size());
    result.rows.push_back(row);
  };
  for (int j = begin; j < end; ++j)
    for (Sparse::InnerIterator b(B, j); b; ++b) add(static_cast<int>(b.row()));
  for (int step = 0; step < steps; ++step) {
    const size_t before = std::exchange(result.edge, result.rows.size());
    for (size_t k = before; k < result.edge; ++k)
      for (Sparse::InnerIterator m(Phi, result.rows[k]); m; ++m) add(static_cast<int>(m.row()));
  }
  return result;
}

/// The same for long lines. Columns of Phi^-1 fall off from node to node: some at a time are solved for on
/// the rows around them, as many as are more than nothing.
Sparse projected(const Sparse& Phi, const Sparse& B) {
  constexpr int atOnce = 256;
  constexpr int usual = 64;
  Triplets entries;
  std::vector<int> placeOf(Phi.rows(), -1);
  for (int begin = 0; begin < B.outerSize(); begin += atOnce) {
    const int end = std::min(begin + atOnce, static_cast<int>(B.outerSize()));
    for (int steps = usual;; steps *= 2) {
      const size_t entriesBefore = entries.size();
      const Neighbourhood near = around(Phi, B, begin, end, steps, placeOf);
      if (near.rows.empty()) break;
      Triplets block;
      for (size_t k = 0; k < near.rows.size(); ++k)
        for (Sparse::InnerIterator m(Phi, near.rows[k]); m; ++m)
          if (placeOf[m.row()] >= 0) block.emplace_back(placeOf[m.row()], static_cast<int>(k), m.value());
      const auto n = static_cast<Eigen::Index>(near.rows.size());
      const Factor factor(assembled(n, n, block));
      bool all = true;
      for (int j = begin; j < end && all; ++j) {
        if (B.col(j).nonZeros() == 0) continue;
        Vector column = Vector::Zero(n);
        for (Sparse::InnerIterator b(B, j); b; ++b) column[placeOf[b.row()]] = b.value();
        column = factor.solve(column).eval();
        for (Eigen::Index i = 0; i < n; ++i) {
          if (!(std::abs(column[i]) > negligible)) continue;
          all = all && i < static_cast<Eigen::Index>(near.edge);
          entries.emplace_back(near.rows[i], j, column[i]);
        }
      }
      for (const int row : near.rows) placeOf[row] = -1;
      if (all || n == Phi.rows()) break;
      entries.resize(entriesBefore);
    }
  }
  return assembled(B.rows(), B.cols(), entries);
}

/// Whether these are lines that have moved and were straight.
bool drawnStraight(const CommonRefinement& refinement) {
  const auto isStraight = [](const auto& drawn) { return drawn && drawn->straight; };
  return isStraight(refinement.part().drawn) &&
         std::all_of(refinement.segments().begin(), refinement.segments().end(), [&](const Segment& piece) {
           return isStraight(refinement.mortar().geometry[piece.mortar].drawn);
         });
}

/// A corner contact and the row of its vertex.
struct PointRow {
  CornerContact corner;
  int row = 0;
};

std::vector<PointRow> pointRows(const CommonRefinement& refinement, const RowFunctions& rows) {
  std::vector<PointRow> result;
  for (const CornerContact& corner : refinement.corners()) {
    const auto found = std::find(rows.nodes().begin(), rows.nodes().end(), corner.vertex);
    if (found != rows.nodes().end())
      result.push_back({corner, static_cast<int>(found - rows.nodes().begin())});
  }
  return result;
}

/// Replaces a row, in the part of the weight of the corner, by the jump at the corner.
void putPointRow(const CommonRefinement& refinement, const CornerContact& corner, int row,
                 const DistanceAt& distance, Coupling& coupling) {
  const int e = corner.nonmortar;
  const double weight = corner.weight;
  const FacingPair facing = refinement.pairAt({e, corner.mortar, corner.s, corner.s}, corner.s);
  Triplets point1;
  Triplets point2;
  Triplets given;
  const EdgeNodes nodes = refinement.part().nodesOf(e);
  addEntries(row, nodes, weight * facing.phi, facing.normal, point1);
  addEntries(row, refinement.mortar().nodesOf(corner.mortar), -weight * facing.psi, facing.normal, point2);
  for (Eigen::Index k = 0; k < nodes.size(); ++k) given.emplace_back(row, nodes[k], weight * facing.phi[k]);
  Vector kept = Vector::Ones(coupling.distance.size());
  kept[row] = 1 - weight;
  const auto put = [&](Sparse& rows, const Triplets& point) {
    const Sparse other = kept.asDiagonal() * rows;
    rows = (other + assembled(rows.rows(), rows.cols(), point)).pruned();
  };
  put(coupling.C1, point1);
  put(coupling.C2, point2);
  put(coupling.N, given);
  coupling.distance[row] = kept[row] * coupling.distance[row] + weight * distance(e, corner.s, facing);
}

/// \param moments  of the row functions about s = 0
/// \param least  distance at a point of a row
void stabilise(const CommonRefinement& refinement, const Stabilisation& by, const Vector& moments,
               const Vector& least, Coupling& coupling) {
  const auto n = static_cast<Eigen::Index>(coupling.nodes.size());
  std::vector<double> mirrors;
  std::vector<char> goesOn = by.merged;
  for (size_t i = 0; i < goesOn.size(); ++i) {
    if (by.symmetric[i] == 0) continue;
    goesOn[i] = 1;
    mirrors.push_back(refinement.part().s[i]);
  }
  coupling.yielding = pressureCompliance(refinement, coupling.nodes, coupling.mass * Vector::Ones(n),
                                         coupling.lengths, mirrors, by.mortarCompliance);
  if (!by.applied) {
    coupling.yielding.S.setZero();
    return;
  }
  const Vector places = Factor(coupling.mass).solve(moments);
  coupling.ends = endRows(refinement, coupling.nodes, places, goesOn);
  const Sparse& T = coupling.ends;
  if (T.nonZeros() == n) return;
  coupling.C1 = (T * coupling.C1).pruned();
  coupling.C2 = (T * coupling.C2).pruned();
  coupling.N = (T * coupling.N).pruned();
  // What is extrapolated of a convex distance may be below the least one: bodies that touch would press.
  const Vector moved = T * coupling.distance;
  for (Eigen::Index row = 0; row < n; ++row)
    if (moved[row] < coupling.distance[row])
      coupling.distance[row] = std::max(moved[row], std::min(least[row], coupling.distance[row]));
    else
      coupling.distance[row] = moved[row];
  coupling.yielding.S = T * coupling.yielding.S * T.transpose();
  coupling.lengths = forcesAtEnds(T, coupling.lengths);
}

}  // namespace

Coupling couple(CouplingKind kind, const CommonRefinement& refinement, const DistanceAt& distance,
                const std::vector<char>& merged, bool axisymmetric, const std::vector<char>& only,
                const Stabilisation& stabilisation) {
  const SmoothPart& part = refinement.part();
  const MortarLine& mortar = refinement.mortar();
  const RowFunctions rows(kind, refinement, merged, only);
  const Eigen::Index n = rows.count();
  std::vector<FacingNode> atRows;  // what their nodes face
  std::vector<Point> own;          // directions there
  Triplets ownMotion;
  Vector distances(n);
  if (!hasMeans(kind))
    for (int i = 0; i < n; ++i) {
      atRows.push_back(refinement.facingOfNode(rows.nodes()[i]));
      const auto& [facing, place] = atRows.back();
      own.push_back(facing.normal);
      addEntries(i, EdgeNodes{{rows.nodes()[i]}}, EdgeValues::Ones(1), own.back(), ownMotion);
      distances[i] = distance(place.nonmortar, place.begin, facing);
    }
  const auto matrix = [n](const ElementLine& line, const Triplets& entries) {
    return assembled(n, 2 * static_cast<Eigen::Index>(line.traceNodes()), entries);
  };
  if (n == 0) return {{}, Sparse(0, 0), matrix(part, {}), matrix(mortar, {}), Vector(), {}, Vector(), {}, {}};
  Integrals integrals = integrate(refinement, distance, rows, own, axisymmetric);
  std::vector<PointRow> atCorners = pointRows(refinement, rows);
  for (auto& [corner, row] : atCorners) {
    // Where the node itself faces nothing it has no value, where nothing else does it has no mean.
    const bool hasValue = kind != CouplingKind::interpolation || refinement.faces(corner.vertex);
    if (!hasValue || !(integrals.lengths[row] > 0)) corner.weight = 1;
    if (integrals.lengths[row] > 0) continue;
    const int e = corner.nonmortar;
    const double half = (part.s[e + 1] - part.s[e]) / 2;
    integrals.lengths[row] = half;
    integrals.mass.emplace_back(row, row, half * (axisymmetric ? circumference(part.at(e, 0.5)) : 1));
  }

  Coupling result;
  result.nodes = rows.nodes();
  result.distance = distances;
  result.lengths = integrals.lengths;
  result.mass = assembled(n, n, integrals.mass);
  result.C1 = matrix(part, ownMotion);
  Triplets atNodes;  // what is given holds at the nodes
  for (int i = 0; i < n; ++i) atNodes.emplace_back(i, rows.nodes()[i], 1);
  result.N = assembled(n, part.traceNodes(), hasMeans(kind) ? integrals.N : atNodes);
  if (kind == CouplingKind::interpolation) {
    Triplets opposite;
    for (int i = 0; i < n; ++i)
      addEntries(i, mortar.nodesOf(atRows[i].place.mortar), -atRows[i].facing.psi, atRows[i].facing.normal,
                 opposite);
    result.C2 = matrix(mortar, opposite);
  } else if (kind == CouplingKind::mortar) {
    constexpr Eigen::Index longLine = 512;
    const Factor mass(result.mass);
    const auto project = [&](const Sparse& B) {
      return n > longLine ? projected(result.mass, B) : projected(mass, B);
    };
    result.C1 += project(matrix(part, integrals.D));
    result.C2 = project(matrix(mortar, integrals.M));
    // Pressure bends straight lines: their distance is not convex, and lifted it would not follow C u.
    result.distance = mass.solve(integrals.distance);
    if (!drawnStraight(refinement)) result.distance = lifted(result.distance, distances, integrals.least);
  } else {
    const Vector w = result.mass * Vector::Ones(n);
    const Vector inverse = w.cwiseInverse();  // products copy an expression for each column
    result.C1 = inverse.asDiagonal() * matrix(part, integrals.D);
    result.C2 = inverse.asDiagonal() * matrix(mortar, integrals.M);
    result.distance = inverse.cwiseProduct(integrals.distance);
    result.N = inverse.asDiagonal() * result.N;
    result.mass = Sparse(w.asDiagonal());
  }
  for (const auto& [corner, row] : atCorners) putPointRow(refinement, corner, row, distance, result);
  if (kind != CouplingKind::interpolation)
    stabilise(refinement, stabilisation, integrals.moments, integrals.least, result);
  return result;
}

}  // namespace mortier
