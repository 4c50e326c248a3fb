// Random contact problems, and their solution by trial of all active sets.
#pragma once

#include <Eigen/LU>
#include <optional>
#include <random>
#include <vector>

#include "solver/complementarity.h"

namespace mortier {

struct RandomProblem {
  ContactProblem problem;
  Vector slack;
  Vector p0;
  Vector balance;
};

struct Enumerated {
  Vector p;
  Vector z;
};

class Randoms {
 public:
  explicit Randoms(unsigned seed) : random_(seed) {}
  double normal() { return normal_(random_); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  Vector vector(Eigen::Index n) {
    return Vector::NullaryExpr(n, [&](Eigen::Index) { return normal(); });
  }
  Matrix matrix(Eigen::Index rows, Eigen::Index columns) {
    return Matrix::NullaryExpr(rows, columns, [&](Eigen::Index, Eigen::Index) { return normal(); });
  }
  std::vector<char> set(Eigen::Index n) {
    std::vector<char> result(n);
    for (char& member : result) member = static_cast<char>(below(2));
    return result;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

inline Matrix symmetricPositive(Randoms& random, int n) {
  const Matrix B = random.matrix(n, n);
  return B * B.transpose() + 0.1 * Matrix::Identity(n, n);
}

/// Unsymmetric: positive definite, or a triangular matrix with large entries, a P-matrix that is far from
/// definite.
inline Matrix unsymmetricP(Randoms& random, int n, bool triangular) {
  if (!triangular) {
    const Matrix B = random.matrix(n, n);
    return symmetricPositive(random, n) + 2 * (B - B.transpose());
  }
  Matrix W = random.matrix(n, n).triangularView<Eigen::StrictlyUpper>();
  W *= 2;
  W.diagonal() = random.vector(n).cwiseAbs().array() + 0.2;
  return W;
}

/// The solution by trial of all active sets; none where no set has the right signs.
inline std::optional<Enumerated> enumerate(const RandomProblem& c) {
  const auto n = static_cast<int>(c.slack.size());
  const Eigen::Index motions = c.problem.G.cols();
  const double scale = c.slack.cwiseAbs().maxCoeff() + c.problem.W.cwiseAbs().maxCoeff();
  for (int bits = 0; bits < 1 << n; ++bits) {
    std::vector<int> active;
    for (int i = 0; i < n; ++i)
      if ((bits >> i & 1) != 0) active.push_back(i);
    const auto size = static_cast<Eigen::Index>(active.size());
    Vector dp = -c.p0;
    for (const int i : active) dp[i] = 0;
    Matrix K = Matrix::Zero(size + motions, size + motions);
    Vector f(size + motions);
    K.topLeftCorner(size, size) = c.problem.W(active, active);
    f.head(size) = -(c.slack + c.problem.W * dp)(active);
    if (motions > 0) {
      K.topRightCorner(size, motions) = -c.problem.G(active, Eigen::all);
      K.bottomLeftCorner(motions, size) = c.problem.G(active, Eigen::all).transpose();
      f.tail(motions) = c.balance - c.problem.G.transpose() * dp;
    }
    Vector z = Vector::Zero(motions);
    if (K.size() > 0) {
      const Eigen::FullPivLU<Matrix> lu(K);
      if (!lu.isInvertible()) continue;
      const Vector x = lu.solve(f);
      for (Eigen::Index i = 0; i < size; ++i) dp[active[i]] = x[i];
      z = x.tail(motions);
    }
    Vector s = c.slack + c.problem.W * dp;
    if (motions > 0) s -= c.problem.G * z;
    const Vector p = c.p0 + dp;
    if (s.minCoeff() >= -1e-11 * scale && p.minCoeff() >= -1e-11 * scale) return Enumerated{p, z};
  }
  return std::nullopt;
}

}  // namespace mortier
