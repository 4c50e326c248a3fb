#include "bound/composite_reference.h"

#include <Eigen/Dense>

namespace mortier {
namespace {

/// Integrals of products over the reference triangle, all three parts.
Eigen::Matrix<double, 9, 9> massMatrix() {
  Eigen::Matrix<double, 9, 9> mass = Eigen::Matrix<double, 9, 9>::Zero();
  for (int part = 0; part < 3; ++part)
    mass.block<3, 3>(3 * part, 3 * part) = (Eigen::Matrix3d::Ones() + Eigen::Matrix3d::Identity()) / 6 / 12;
  return mass;
}

constexpr int column(int part, int vertex, int component) {
  return 9 * component + 3 * part + vertex;
}

}  // namespace

CompositeReference::CompositeReference() : mass(massMatrix()) {
  Eigen::Matrix<double, 30, 27> conditions = Eigen::Matrix<double, 30, 27>::Zero();
  const Point centre = (referenceCorners[0] + referenceCorners[1] + referenceCorners[2]) / 3;
  const auto put = [&](int row, int part, int vertex, const Eigen::Matrix<double, 2, 3>& matrix) {
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < 2; ++i) conditions(row + i, column(part, vertex, c)) += matrix(i, c);
  };
  int row = 0;
  for (int e = 0; e < 3; ++e) {  // moments of the sides
    const auto n = tractionMatrix(acrossFrom(referenceCorners[e], referenceCorners[(e + 1) % 3]));
    for (int end = 0; end < 2; ++end, row += 2) {
      put(row, e, end, n / 3);
      put(row, e, 1 - end, n / 6);
    }
  }
  for (int e = 0; e < 3; ++e) {  // between part e and the one before, which meet at vertex e
    const auto n = tractionMatrix(acrossFrom(referenceCorners[e], centre));
    const int before = (e + 2) % 3;
    put(row, e, 0, n);
    put(row, before, 1, -n);
    put(row + 2, e, 2, n);
    put(row + 2, before, 2, -n);
    row += 4;
  }
  for (int e = 0; e < 3; ++e, row += 2) {  // divergence of part e, times twice its area
    const std::array<Point, 3> x{referenceCorners[e], referenceCorners[(e + 1) % 3], centre};
    for (int k = 0; k < 3; ++k) put(row, e, k, -tractionMatrix(acrossFrom(x[(k + 1) % 3], x[(k + 2) % 3])));
  }
  Eigen::Matrix<double, 30, 12> given = Eigen::Matrix<double, 30, 12>::Zero();
  given.topRows<12>().setIdentity();
  const Eigen::Matrix<double, 27, 12> all =
      Eigen::MatrixXd(conditions).colPivHouseholderQr().solve(Eigen::MatrixXd(given));
  stresses = all;
  const auto of = [&](int component) { return stresses.middleRows<9>(9 * component); };
  defects = conditions * all - given;
  const MomentMatrix airy = momentsOfAiry(referenceCorners);
  const std::array<std::array<int, 2>, 6> pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  for (int k = 0; k < 6; ++k) {
    const auto [a, b] = pairs[k];
    energies[k] = of(a).transpose() * mass * of(b);
    if (a != b) energies[k] += energies[k].transpose().eval();
    airyEnergies[k] = airy.transpose() * energies[k] * airy;
  }
}

const CompositeReference& compositeReference() {
  static const CompositeReference only;
  return only;
}

}  // namespace mortier
