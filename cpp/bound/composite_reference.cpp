#include "bound/composite_triangle.h"

#include "base/dense_templates.h"

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

const Point referenceCentre = (referenceCorners[0] + referenceCorners[1] + referenceCorners[2]) / 3;

std::array<Point, 3> cornersOf(int part) {
  return {referenceCorners[part], referenceCorners[(part + 1) % 3], referenceCentre};
}
/// In a part, of no mean over the triangle and with the couple 1.
Point turningForce(int part) {
  double couple = 0;
  for (const Point& x : referenceCorners) couple += (x - referenceCentre).squaredNorm() / 54;
  return turned(cornersOf(part)[0] + cornersOf(part)[1] - 2 * referenceCentre) / (3 * couple);
}

/// Stresses that are quadratic in each part, by their values at corners and middles of sides: those of least
/// size without tractions on the sides of the triangle that carry a linear force which works on no rigid
/// motion and is given at the corners of the parts.
Eigen::Matrix<double, 18, 3> quadraticStress(const std::array<std::array<Point, 3>, 3>& force) {
  Matrix conditions = Matrix::Zero(54, 54);
  Vector given = Vector::Zero(54);
  const auto put = [&](int row, int part, int node, const Eigen::Matrix<double, 2, 3>& matrix) {
    for (int c = 0; c < 3; ++c) conditions.block<2, 1>(row, 18 * c + 6 * part + node) += matrix.col(c);
  };
  int row = 0;
  for (int e = 0; e < 3; ++e) {
    const std::array<Point, 3> x = cornersOf(e);
    for (const int node : {0, 1, 3}) put(2 * row++, e, node, tractionMatrix(acrossFrom(x[0], x[1])));
    // To the part before: nodes 0, 2 and their middle 5 are its 1, 2 and 4.
    for (const auto& [own, other] : {std::array{0, 1}, std::array{2, 2}, std::array{5, 4}}) {
      const auto n = tractionMatrix(acrossFrom(x[0], referenceCentre));
      put(2 * row, e, own, n);
      put(2 * row++, (e + 2) % 3, other, -n);
    }
    for (int at = 0; at < 3; ++at, ++row) {  // divergence there, times the area of the triangle
      const auto gradient = [&](int k) {
        return tractionMatrix(-3 * acrossFrom(x[(k + 1) % 3], x[(k + 2) % 3]));
      };
      for (int k = 0; k < 3; ++k) {
        put(2 * row, e, k, (k == at ? 3 : -1) * gradient(k) / 2);
        const int next = (k + 1) % 3;  // the middle behind corner k has 4 l_k l_next
        if (k == at) put(2 * row, e, 3 + k, 2 * gradient(next));
        if (next == at) put(2 * row, e, 3 + k, 2 * gradient(k));
      }
      given.segment<2>(2 * row) = -force[e][at] / 2;
    }
  }
  const Vector values = conditions.completeOrthogonalDecomposition().solve(given);
  return Eigen::Map<const Eigen::Matrix<double, 18, 3>>(values.data());
}

/// Integrals of products of the quadratic functions of a part.
Eigen::Matrix<double, 6, 6> quadraticMass() {
  Eigen::Matrix<double, 6, 6> mass;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      if (i < 3 && j < 3)
        mass(i, j) = i == j ? 6 : -1;
      else if (i < 3 || j < 3)  // the middle 3 + k is opposite to corner k + 2
        mass(i, j) = std::max(i, j) - 3 == (std::min(i, j) + 1) % 3 ? -4 : 0;
      else
        mass(i, j) = i == j ? 32 : 16;
    }
  return mass / 180 / 6;
}

}  // namespace

CompositeReference::CompositeReference() : mass(massMatrix()) {
  Matrix conditions = Matrix::Zero(30, 27);
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
    const auto n = tractionMatrix(acrossFrom(referenceCorners[e], referenceCentre));
    const int before = (e + 2) % 3;
    put(row, e, 0, n);
    put(row, before, 1, -n);
    put(row + 2, e, 2, n);
    put(row + 2, before, 2, -n);
    row += 4;
  }
  for (int e = 0; e < 3; ++e, row += 2) {  // divergence of part e, times twice its area
    const std::array<Point, 3> x = cornersOf(e);
    for (int k = 0; k < 3; ++k) put(row, e, k, -tractionMatrix(acrossFrom(x[(k + 1) % 3], x[(k + 2) % 3])));
  }
  Matrix given = Matrix::Zero(30, 12);
  given.topRows<12>().setIdentity();
  const Matrix all = conditions.colPivHouseholderQr().solve(given);
  stresses = all;
  Vector turning = Vector::Zero(18);  // twice the area of a part is 1/3
  for (int e = 0; e < 3; ++e) turning.segment<2>(12 + 2 * e) = -turningForce(e) / 3;
  turn = Vector(Matrix(conditions.bottomRows<18>()).completeOrthogonalDecomposition().solve(turning));
  turnMoments = conditions.topRows<12>() * turn;
  double couple = 0;
  for (const Point& x : referenceCorners) couple += (x - referenceCentre).squaredNorm() / 24;
  turnForces.setZero();
  std::array<std::array<Point, 3>, 3> rest;
  for (int e = 0; e < 3; ++e)
    for (int k = 0; k < 3; ++k) {
      // A hat function has 4/9 at the centroids of two parts and 1/9 at that of the one opposite.
      turnForces.col(k) += (k == (e + 2) % 3 ? 1 : 4) / 54. * turningForce(e);
      rest[e][k] = turned(cornersOf(e)[k] - referenceCentre) / couple - turningForce(e);
    }
  const Eigen::Matrix<double, 18, 3> quadratic = quadraticStress(rest);
  restMean.setZero();
  restEnergies.setZero();
  for (int e = 0; e < 3; ++e) {
    const Eigen::Matrix<double, 6, 3> values = quadratic.middleRows<6>(6 * e);
    restMean += values.bottomRows<3>().colwise().sum().transpose() / 18;
    restEnergies += values.transpose() * quadraticMass() * values;
  }
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
