// Distances that are given at the nonmortar nodes, in place of those of the bodies as meshed.
#include "contact/interface_entries.h"

namespace mortier {

// A distance moves a nonmortar node along the normal of the row: where a row has means of motions it has the
// same of distances.
Eigen::SparseMatrix<double> rowsOfDistance(CouplingKind kind, const ConstraintRows& C1,
                                           const std::vector<SpacePoint>& normals,
                                           const std::vector<int>& nodes) {
  Triplets entries;
  Vector all = Vector::Zero(C1.rows());
  const auto add = [&](Eigen::Index row, int node, double value) {
    entries.emplace_back(static_cast<int>(row), node, value);
    all[row] += value;
  };
  for (int column = 0; column < C1.cols() && hasMeans(kind); ++column)
    for (ConstraintRows::InnerIterator entry(C1, column); entry; ++entry)
      add(entry.row(), column / 3, entry.value() * normals[entry.row()][column % 3]);
  for (Eigen::Index row = 0; row < C1.rows() && !hasMeans(kind); ++row) add(row, nodes[row], 1);
  return all.cwiseInverse().asDiagonal() * assembled(C1.rows(), C1.cols() / 3, entries);
}

Vector ContactInterface::pointDistances(double t) const {
  return distanceMoves() ? Vector(points_.traces[0] * nodalGap(t)) : points_.distances;
}

Vector ContactInterface::nodalGap(double t) const {
  if (!distanceMoves()) return {};
  Vector gap = Vector::Zero(N_.cols());
  for (const auto& [node, place] : gapNodes_) gap[node] = gapInTime_(place, t);
  return gap;
}

Vector ContactInterface::distance(double t) const {
  return distanceMoves() ? Vector(N_ * nodalGap(t)) : distance_;
}

}  // namespace mortier
