#include "contact/coupling.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace mortier {
namespace {

/// Values at s of the functions of the rows that belong to an element's two nodes (row -1: that node has
/// none, and the other one's function is 1).
Eigen::Vector2d rowFunctions(const Trace& trace, int element, const Eigen::Vector2i& row, double s) {
  if (row[0] < 0) return {0, 1};
  if (row[1] < 0) return {1, 0};
  return hats(trace, element, s);
}

Matrix interpolate(const Trace& nonmortar, const std::vector<int>& nodes, const Trace& mortar) {
  Matrix A = Matrix::Zero(static_cast<Eigen::Index>(nodes.size()), static_cast<Eigen::Index>(mortar.size()));
  for (size_t i = 0; i < nodes.size(); ++i) {
    const double s = std::clamp(nonmortar[nodes[i]], mortar.front(), mortar.back());
    const auto above = std::upper_bound(mortar.begin() + 1, mortar.end() - 1, s);
    const auto element = static_cast<int>(above - mortar.begin()) - 1;
    const Eigen::Vector2d psi = hats(mortar, element, s);
    A(i, element) = psi[0];
    A(i, element + 1) = psi[1];
  }
  return A;
}

}  // namespace

Coupling couple(CouplingKind kind, const Trace& nonmortar, const Trace& mortar) {
  Coupling result;
  const Overlap overlap = overlapOf(nonmortar, mortar);
  std::vector<int> row(nonmortar.size(), -1);
  for (size_t i = 0; i < nonmortar.size(); ++i)
    if (overlap.length() > 0 && nonmortar[i] >= overlap.begin && nonmortar[i] <= overlap.end) {
      row[i] = static_cast<int>(result.nodes.size());
      result.nodes.push_back(static_cast<int>(i));
    }
  const auto rows = static_cast<Eigen::Index>(result.nodes.size());
  const auto columns = static_cast<Eigen::Index>(mortar.size());

  std::vector<Eigen::Triplet<double>> mass;
  std::vector<Eigen::Triplet<double>> mixed;
  for (const Segment& segment : commonRefinement(nonmortar, mortar)) {
    const Eigen::Vector2i rowOf(row[segment.nonmortar], row[segment.nonmortar + 1]);
    if (rowOf.maxCoeff() < 0) continue;
    // Simpson's rule is exact for products of linear functions.
    const double length = segment.end - segment.begin;
    const double points[] = {segment.begin, segment.begin + length / 2, segment.end};
    const double weights[] = {length / 6, 2 * length / 3, length / 6};
    Eigen::Matrix2d M = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d D = Eigen::Matrix2d::Zero();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d phi = rowFunctions(nonmortar, segment.nonmortar, rowOf, points[k]);
      const Eigen::Vector2d psi = hats(mortar, segment.mortar, points[k]);
      M += weights[k] * phi * phi.transpose();
      D += weights[k] * phi * psi.transpose();
    }
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        if (rowOf[i] < 0) continue;
        if (rowOf[j] >= 0) mass.emplace_back(rowOf[i], rowOf[j], M(i, j));
        mixed.emplace_back(rowOf[i], segment.mortar + j, D(i, j));
      }
  }
  result.M.resize(rows, rows);
  result.M.setFromTriplets(mass.begin(), mass.end());
  result.D.resize(rows, columns);
  result.D.setFromTriplets(mixed.begin(), mixed.end());
  if (kind == CouplingKind::interpolation)
    result.A = interpolate(nonmortar, result.nodes, mortar);
  else if (rows > 0)
    result.A = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(result.M).solve(Matrix(result.D));
  return result;
}

}  // namespace mortier
