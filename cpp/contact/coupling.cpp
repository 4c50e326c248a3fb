#include "contact/coupling.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>

namespace mortier {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;
using Factor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

/// Values at s of the functions of the rows that belong to an element's two nodes (row -1: that node has
/// none, and the other one's function is 1).
Eigen::Vector2d rowFunctions(const Trace& trace, int element, const Eigen::Vector2i& row, double s) {
  if (row[0] < 0) return {0, 1};
  if (row[1] < 0) return {1, 0};
  return hats(trace, element, s);
}

/// Rows of the trace nodes, -1 for none, and the nodes that have one. The last node of a closed trace has
/// the row of the first.
struct Rows {
  std::vector<int> ofNode;
  std::vector<int> nodes;

  Rows(const Trace& nonmortar, const Trace& mortar, const std::vector<char>& merged, bool closed)
      : ofNode(nonmortar.size(), -1) {
    const Overlap overlap = overlapOf(nonmortar, mortar);
    if (!(overlap.length() > 0)) return;
    const size_t own = nonmortar.size() - (closed ? 1 : 0);
    for (size_t i = 0; i < own; ++i)
      if ((merged.empty() || merged[i] == 0) && nonmortar[i] >= overlap.begin &&
          nonmortar[i] <= overlap.end) {
        ofNode[i] = static_cast<int>(nodes.size());
        nodes.push_back(static_cast<int>(i));
      }
    if (closed) ofNode.back() = ofNode.front();
  }
  [[nodiscard]] Eigen::Vector2i at(int element) const { return {ofNode[element], ofNode[element + 1]}; }
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(nodes.size()); }
};

Eigen::SparseMatrix<double> assembled(Eigen::Index rows, Eigen::Index columns, const Triplets& entries) {
  Eigen::SparseMatrix<double> matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// The mortar element that holds s, the end elements beyond the ends.
int elementAt(const Trace& mortar, double s) {
  return static_cast<int>(std::upper_bound(mortar.begin() + 1, mortar.end() - 1, s) - mortar.begin()) - 1;
}

/// The 2 x 2 entries of one segment; those of rows that are none are left out.
void scatter(const Eigen::Matrix2d& values, const Eigen::Vector2i& rows, const Eigen::Vector2i& columns,
             Triplets& entries) {
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      if (rows[i] >= 0 && columns[j] >= 0) entries.emplace_back(rows[i], columns[j], values(i, j));
}

/// Entries of the inverse of a mass matrix fall by a factor of four from node to node: those below this part of the
/// largest change no bit of what is computed with them.
constexpr double nothing = 1e-25;

Eigen::SparseMatrix<double> sparse(const Matrix& values) {
  const double largest = values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0;
  return values.sparseView(largest, nothing);
}

/// Columns 2 node + component of weights by nodes, along a normal.
Eigen::SparseMatrix<double> timesNormal(const Eigen::SparseMatrix<double>& weights, const Point& n) {
  Triplets entries;
  for (int j = 0; j < weights.outerSize(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(weights, j); entry; ++entry)
      for (int c = 0; c < 2; ++c)
        if (n[c] != 0) entries.emplace_back(static_cast<int>(entry.row()), 2 * j + c, entry.value() * n[c]);
  return assembled(weights.rows(), 2 * weights.cols(), entries);
}

/// Gauss's rule of four points on every segment: calls at(segment, rows, s, values of the row functions, the same
/// times the weight).
template <class At>
void atGaussPoints(const SmoothPart& part, const FacingLine& mortar, const Rows& rows, At at) {
  constexpr std::array<double, 4> places{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                         0.8611363115940526};
  constexpr std::array<double, 4> weights{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                          0.3478548451374538};
  for (const Segment& segment : commonRefinement(part.s, mortar.s)) {
    const Eigen::Vector2i row = rows.at(segment.nonmortar);
    if (row.maxCoeff() < 0) continue;
    const double half = (segment.end - segment.begin) / 2;
    for (size_t k = 0; k < places.size(); ++k) {
      const double s = segment.begin + (1 + places[k]) * half;
      const Eigen::Vector2d chi = rowFunctions(part.s, segment.nonmortar, row, s);
      at(segment, row, s, chi, weights[k] * half * chi);
    }
  }
}

/// What the rows see of the bulges.
Vector bulgeOf(CouplingKind kind, const SmoothPart& part, const FacingLine& mortar, const Rows& rows,
               const Eigen::SparseMatrix<double>& mass) {
  Vector bulge = Vector::Zero(rows.count());
  const auto flat = [](const Arc& arc) { return !arc.known || arc.curvature == 0; };
  if (rows.count() == 0 || (std::all_of(part.arcs.begin(), part.arcs.end(), flat) &&
                            std::all_of(mortar.elements.begin(), mortar.elements.end(),
                                        [&](const FacingElement& element) { return flat(element.arc); })))
    return bulge;
  if (kind == CouplingKind::interpolation) {
    for (size_t i = 0; i < rows.nodes.size(); ++i) {
      const int node = rows.nodes[i];
      bulge[static_cast<Eigen::Index>(i)] =
          see(part, mortar, placeOf(part, mortar, node), part.s[node]).bulge;
    }
    return bulge;
  }
  atGaussPoints(part, mortar, rows,
                [&](const Segment& segment, const Eigen::Vector2i& row, double s, const Eigen::Vector2d&,
                    const Eigen::Vector2d& weighted) {
                  const Sight sight = see(part, mortar, segment, s);
                  for (int i = 0; i < 2; ++i)
                    if (row[i] >= 0) bulge[row[i]] += weighted[i] * sight.bulge;
                });
  return Factor(mass).solve(bulge);
}

/// A row at each node: its own motion against that of the mortar point which it sees.
void interpolate(const SmoothPart& part, const FacingLine& mortar, const std::vector<int>& nodes, Matrix& C1,
                 Matrix& C2) {
  C1.setZero();
  C2.setZero();
  for (size_t i = 0; i < nodes.size(); ++i) {
    const int node = nodes[i];
    const Segment place = placeOf(part, mortar, node);
    const Sight sight = see(part, mortar, place, part.s[node]);
    const auto row = static_cast<Eigen::Index>(i);
    C1.block<1, 2>(row, 2 * node) = sight.normal.transpose();
    for (int j = 0; j < 2; ++j)
      C2.block<1, 2>(row, 2 * (place.mortar + j)) -= sight.psi[j] * sight.normal.transpose();
  }
}

PartCoupling coupleCurved(CouplingKind kind, const SmoothPart& part, const FacingLine& mortar,
                          const std::vector<char>& merged) {
  const Rows rows(part.s, mortar.s, merged, part.closed);
  PartCoupling result;
  result.nodes = rows.nodes;
  Triplets mass;
  Matrix C1 = Matrix::Zero(rows.count(), 2 * static_cast<Eigen::Index>(part.nodes.size()));
  Matrix C2 = Matrix::Zero(rows.count(), 2 * static_cast<Eigen::Index>(mortar.nodes.size()));
  atGaussPoints(part, mortar, rows,
                [&](const Segment& segment, const Eigen::Vector2i& row, double s, const Eigen::Vector2d& chi,
                    const Eigen::Vector2d& weighted) {
                  const Sight sight = see(part, mortar, segment, s);
                  scatter(weighted * chi.transpose(), row, row, mass);
                  for (int i = 0; i < 2; ++i)
                    for (int j = 0; row[i] >= 0 && j < 2; ++j) {
                      C1.block<1, 2>(row[i], 2 * (segment.nonmortar + j)) +=
                          weighted[i] * sight.phi[j] * sight.normal.transpose();
                      C2.block<1, 2>(row[i], 2 * (segment.mortar + j)) -=
                          weighted[i] * sight.psi[j] * sight.normal.transpose();
                    }
                });
  result.M = assembled(rows.count(), rows.count(), mass);
  if (rows.count() > 0 && kind == CouplingKind::interpolation) {
    interpolate(part, mortar, result.nodes, C1, C2);
  } else if (rows.count() > 0) {
    const Factor factor(result.M);
    C1 = factor.solve(C1);
    C2 = factor.solve(C2);
  }
  result.C1 = sparse(C1);
  result.C2 = sparse(C2);
  return result;
}

}  // namespace

Coupling couple(CouplingKind kind, const Trace& nonmortar, const Trace& mortar,
                const std::vector<char>& merged) {
  const Rows rows(nonmortar, mortar, merged, false);
  const auto columns = static_cast<Eigen::Index>(mortar.size());
  Coupling result;
  result.nodes = rows.nodes;

  Triplets mass;
  Triplets own;
  Triplets mixed;
  bool allHats = true;  // chi = phi
  for (const Segment& segment : commonRefinement(nonmortar, mortar)) {
    const Eigen::Vector2i row = rows.at(segment.nonmortar);
    if (row.maxCoeff() < 0) continue;
    allHats = allHats && row.minCoeff() >= 0;
    // Simpson's rule is exact for products of linear functions.
    const double length = segment.end - segment.begin;
    const double points[] = {segment.begin, segment.begin + length / 2, segment.end};
    const double weights[] = {length / 6, 2 * length / 3, length / 6};
    Eigen::Matrix2d M = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d N = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d D = Eigen::Matrix2d::Zero();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d chi = rowFunctions(nonmortar, segment.nonmortar, row, points[k]);
      M += weights[k] * chi * chi.transpose();
      N += weights[k] * chi * hats(nonmortar, segment.nonmortar, points[k]).transpose();
      D += weights[k] * chi * hats(mortar, segment.mortar, points[k]).transpose();
    }
    scatter(M, row, row, mass);
    scatter(N, row, {segment.nonmortar, segment.nonmortar + 1}, own);
    scatter(D, row, {segment.mortar, segment.mortar + 1}, mixed);
  }
  result.M = assembled(rows.count(), rows.count(), mass);
  result.D = assembled(rows.count(), columns, mixed);
  result.A = Matrix::Zero(rows.count(), columns);
  result.B = Matrix::Zero(rows.count(), static_cast<Eigen::Index>(nonmortar.size()));
  for (size_t i = 0; i < rows.nodes.size(); ++i) result.B(static_cast<Eigen::Index>(i), rows.nodes[i]) = 1;
  if (rows.count() == 0) return result;
  if (kind == CouplingKind::interpolation) {
    for (size_t i = 0; i < rows.nodes.size(); ++i) {
      const double s = std::clamp(nonmortar[rows.nodes[i]], mortar.front(), mortar.back());
      const int element = elementAt(mortar, s);
      result.A.block<1, 2>(static_cast<Eigen::Index>(i), element) = hats(mortar, element, s).transpose();
    }
    return result;
  }
  const Factor factor(result.M);
  result.A = factor.solve(Matrix(result.D));
  if (!allHats) result.B = factor.solve(Matrix(assembled(rows.count(), result.B.cols(), own)));
  return result;
}

PartCoupling couple(CouplingKind kind, const SmoothPart& part, const FacingLine& mortar,
                    const std::vector<char>& merged) {
  PartCoupling result;
  if (part.straight) {
    Coupling scalar = couple(kind, part.s, mortar.s, merged);
    const Point& n = part.normals.front();
    result = {std::move(scalar.nodes),
              scalar.M,
              timesNormal(sparse(scalar.B), n),
              timesNormal(sparse(scalar.A), -n),
              {}};
  } else {
    result = coupleCurved(kind, part, mortar, merged);
  }
  const Rows rows(part.s, mortar.s, merged, part.closed);
  result.bulge = bulgeOf(kind, part, mortar, rows, result.M);
  return result;
}

}  // namespace mortier
