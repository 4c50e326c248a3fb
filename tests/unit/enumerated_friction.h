// Random contact problems with friction; their solutions by trial of all sets, and by Lemke's method on the
// linear complementarity problem with three unknowns a node (Klarbring 1986).
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "solver/friction.h"
#include "unit/enumerated_contact.h"

namespace mortier {

struct FrictionCase {
  ContactProblem problem;
  Vector q;
};

inline std::vector<int> allNodes(int n) {
  std::vector<int> nodes(n);
  for (int i = 0; i < n; ++i) nodes[i] = i;
  return nodes;
}

inline FrictionCase frictionCase(Matrix W, double mu, const Vector& q) {
  const auto n = static_cast<int>(W.rows() / 2);
  FrictionCase c{{std::move(W), true, Matrix(2 * n, 0)}, q};
  c.problem.along = {allNodes(n), {Vector::Constant(n, mu), Vector::Zero(n)}};
  return c;
}

/// Any positive definite compliance; more of the gaps than not are overlaps.
inline FrictionCase randomFriction(Randoms& random, int n, double mu) {
  Vector q = 2 * random.vector(2 * n);
  q.head(n).array() -= 1;
  return frictionCase(symmetricPositive(random, 2 * n), mu, q);
}

/// Compliance at the lower side of a sheared block of cells (nodes x 3, two triangles a cell), held above.
inline Matrix blockCompliance(int nodes, double young, double shear, double height) {
  const int layers = 3;
  const double nu = 0.3;
  const Matrix D = young / (1 - nu * nu) * Matrix{{1, nu, 0}, {nu, 1, 0}, {0, 0, (1 - nu) / 2}};
  const auto place = [&](int i, int j) {
    return Point(i + shear * j * height / layers, j * height / layers);
  };
  const int dofs = 2 * nodes * layers;  // the uppermost row is held
  Matrix K = Matrix::Zero(dofs, dofs);
  const auto add = [&](std::array<std::pair<int, int>, 3> corners) {
    Matrix B = Matrix::Zero(3, 6);
    std::array<Point, 3> x;
    for (int a = 0; a < 3; ++a) x[a] = place(corners[a].first, corners[a].second);
    const Point e1 = x[1] - x[0];
    const Point e2 = x[2] - x[0];
    const double twice = e1.x() * e2.y() - e1.y() * e2.x();
    for (int a = 0; a < 3; ++a) {
      const Point d = x[(a + 2) % 3] - x[(a + 1) % 3];
      B(0, 2 * a) = B(2, 2 * a + 1) = -d.y() / twice;
      B(1, 2 * a + 1) = B(2, 2 * a) = d.x() / twice;
    }
    const Matrix k = twice / 2 * B.transpose() * D * B;
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) {
        const auto dof = [&](int c) {
          return corners[c / 2].second == layers
                     ? -1
                     : 2 * (corners[c / 2].second * nodes + corners[c / 2].first) + c % 2;
        };
        if (dof(a) >= 0 && dof(b) >= 0) K(dof(a), dof(b)) += k(a, b);
      }
  };
  for (int j = 0; j < layers; ++j)
    for (int i = 0; i + 1 < nodes; ++i) {
      add({{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
      add({{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
    }
  const Matrix inverse = K.inverse();
  Matrix W(2 * nodes, 2 * nodes);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (int i = 0; i < nodes; ++i)
        for (int k = 0; k < nodes; ++k)
          W(a * nodes + i, b * nodes + k) = inverse(2 * i + 1 - a, 2 * k + 1 - b);
  return W;
}

/// Two sheared blocks, up to a hundred times as stiff as each other, pressed and moved along each other.
inline FrictionCase randomBlocks(Randoms& random, int nodes, double mu) {
  const Matrix upper = blockCompliance(nodes, 1, random.normal(), 0.5 + std::abs(random.normal()));
  Matrix lower = blockCompliance(nodes, std::pow(10.0, 1.0 * random.below(3)), random.normal(), 1);
  for (int a = 0; a < 2; ++a)  // seen from above: turned over
    for (int b = 0; b < 2; ++b)
      lower.block(a * nodes, b * nodes, nodes, nodes) =
          lower.block(a * nodes, b * nodes, nodes, nodes).reverse().eval();
  Vector q(2 * nodes);
  const double slope = random.normal();
  const double along = 2 * random.normal();
  for (int i = 0; i < nodes; ++i) {
    q[i] = -1 + slope * (i - (nodes - 1) / 2.0) + 0.5 * random.normal();
    q[nodes + i] = along + 0.3 * random.normal();
  }
  return frictionCase(upper + lower, mu, q);
}

struct EnumeratedFriction {
  Vector force;
  int index = 0;
};

/// All solutions of Coulomb's law, by trial of the 4^n sets.
inline std::vector<EnumeratedFriction> enumerateFriction(const FrictionCase& c) {
  constexpr double rounding = 1e-9;
  const auto n = static_cast<int>(c.problem.along.node.size());
  const Matrix& W = c.problem.W;
  std::vector<EnumeratedFriction> found;
  for (int code = 0; code < 1 << 2 * n; ++code) {
    const auto state = [&](int i) { return code >> 2 * i & 3; };  // open, stuck, v > 0, v < 0
    Matrix A = Matrix::Identity(2 * n, 2 * n);
    Vector right = Vector::Zero(2 * n);
    for (int i = 0; i < n; ++i) {
      const double unit = 1 / W(i, i);
      const double unitAlong = 1 / W(n + i, n + i);
      if (state(i) == 0) continue;
      A.row(i) = unit * W.row(i);
      right[i] = -unit * c.q[i];
      if (state(i) == 1) {
        A.row(n + i) = unitAlong * W.row(n + i);
        right[n + i] = -unitAlong * c.q[n + i];
      } else {
        A(n + i, i) = (state(i) == 2 ? 1 : -1) * c.problem.along.law.coefficient[i];
      }
    }
    const Eigen::PartialPivLU<Matrix> lu(A);
    const Vector x = lu.solve(right);
    if (!x.allFinite()) continue;
    const Vector w = c.q + W * x;
    const double small = rounding * x.cwiseAbs().maxCoeff();
    const double near = rounding * w.cwiseAbs().maxCoeff();
    bool right_ = true;
    for (int i = 0; i < n && right_; ++i) {
      const double mu = c.problem.along.law.coefficient[i];
      if (state(i) == 0) right_ = w[i] >= -near;
      if (state(i) != 0) right_ = x[i] >= -small;
      if (state(i) == 1) right_ = right_ && std::abs(x[n + i]) <= mu * x[i] + small;
      if (state(i) == 2) right_ = right_ && w[n + i] >= -near;
      if (state(i) == 3) right_ = right_ && w[n + i] <= near;
    }
    if (!right_) continue;
    bool again = false;  // sets that differ by ties
    for (const EnumeratedFriction& other : found)
      again = again || (other.force - x).norm() <= 1e-7 * x.norm();
    if (!again) found.push_back({x, lu.determinant() > 0 ? 1 : -1});
  }
  return found;
}

/// Lemke's method, the covering vector d with d_n > mu d_t > 0 and d_b > 0. \returns the forces (p, t), or
/// nothing after more pivots than are to be expected.
inline std::optional<Vector> lemke(const FrictionCase& c) {
  const auto n = static_cast<Eigen::Index>(c.problem.along.node.size());
  const Eigen::Index size = 3 * n;
  const auto mu = c.problem.along.law.coefficient.asDiagonal();
  const Matrix Wnn = c.problem.W.topLeftCorner(n, n);
  const Matrix Wnt = c.problem.W.topRightCorner(n, n);
  const Matrix Wtn = c.problem.W.bottomLeftCorner(n, n);
  const Matrix Wtt = c.problem.W.bottomRightCorner(n, n);
  Matrix M = Matrix::Zero(size, size);  // z = (p, a, v-), w = (g, v+, b): a = mu p + t, b = mu p - t
  M.topRows(n) << Wnn - Wnt * mu, Wnt, Matrix::Zero(n, n);
  M.middleRows(n, n) << Wtn - Wtt * mu, Wtt, Matrix::Identity(n, n);
  M.bottomRows(n).leftCols(n) = 2 * Matrix(mu);
  M.bottomRows(n).middleCols(n, n) = -Matrix::Identity(n, n);
  Vector q = Vector::Zero(size);
  q.head(2 * n) = c.q;
  Vector d = Vector::Zero(size);
  d.head(n).setOnes();
  d.segment(n, n) = 0.5 / (1 + c.problem.along.law.coefficient.array());
  d.tail(n).setOnes();
  // w - M z - d z0 = q, columns w, z, z0.
  Matrix tableau(size, 2 * size + 2);
  tableau << Matrix::Identity(size, size), -M, -d, q;
  const Eigen::Index z0 = 2 * size;
  std::vector<Eigen::Index> basis(size);
  for (Eigen::Index i = 0; i < size; ++i) basis[i] = i;
  const auto exchange = [&](Eigen::Index row, Eigen::Index column) {
    const double pivot = tableau(row, column);
    tableau.row(row) /= pivot;
    for (Eigen::Index i = 0; i < size; ++i)
      if (i != row) tableau.row(i) -= tableau(i, column) * tableau.row(row).eval();
    return std::exchange(basis[row], column);
  };
  Eigen::Index row = -1;
  double most = 0;
  for (Eigen::Index i = 0; i < size; ++i)
    if (-q[i] / d[i] > most) most = -q[row = i] / d[i];
  if (row < 0) return Vector::Zero(2 * n).eval();
  Eigen::Index left = exchange(row, z0);
  for (int pivots = 0; left != z0; ++pivots) {
    if (pivots > 60 * size) return std::nullopt;
    const auto last = std::find(basis.begin(), basis.end(), z0) - basis.begin();
    if (tableau(last, 2 * size + 1) <= 1e-12 * most) break;
    const Eigen::Index enters = left < size ? left + size : left - size;
    row = -1;
    double least = 0;
    for (Eigen::Index i = 0; i < size; ++i) {
      if (!(tableau(i, enters) > 1e-11)) continue;
      const double step = tableau(i, 2 * size + 1) / tableau(i, enters);
      // Of open nodes b = d_b z0 ends where z0 does.
      if (row < 0 || (basis[i] == z0 ? step <= least * (1 + 1e-9) : step * (1 + 1e-9) < least)) {
        least = step;
        row = i;
      }
    }
    if (row < 0) return std::nullopt;  // a ray
    left = exchange(row, enters);
  }
  Vector z = Vector::Zero(size);
  for (Eigen::Index i = 0; i < size; ++i)
    if (basis[i] >= size && basis[i] < z0) z[basis[i] - size] = tableau(i, 2 * size + 1);
  Vector force(2 * n);
  force << z.head(n), z.segment(n, n) - mu * z.head(n);
  return force;
}

}  // namespace mortier
