// Contact problems of lines with many nodes under loads of every wave length: the compliances that half
// planes and beams have along their surface, and random loads.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "solver/complementarity.h"

namespace mortier::patterns {

enum class Line {
  halfPlane,      ///< compliance 1/k in the wave number
  twoHalfPlanes,  ///< two of them, on nodes that do not match
  beam,           ///< mostly 1/k^3, as thin bodies have it
  thinBeam,       ///< 1/k^4: condition numbers of 1e9 and more
  unsymmetric     ///< of a half plane, with a skew part of the same size
};
constexpr Line allLines[] = {Line::halfPlane, Line::twoHalfPlanes, Line::beam, Line::thinBeam,
                             Line::unsymmetric};

/// Cosine waves, orthonormal.
inline Matrix waves(int n) {
  Matrix Q(n, n);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i)
      Q(i, k) = std::sqrt((k == 0 ? 1.0 : 2.0) / n) * std::cos(std::numbers::pi * k * (i + 0.5) / n);
  return Q;
}

/// Compliances of the waves, 1/k^power up to what a mesh makes of it.
inline Vector compliances(int n, double power) {
  Vector result(n);
  for (int k = 0; k < n; ++k)
    result[k] = std::pow(std::max(0.5, 2 * n / std::numbers::pi * std::sin(std::numbers::pi * k / (2.0 * n))),
                         -power);
  return result;
}

/// Values at n nodes of a line of hat functions on m others, as the interpolation has them.
inline Matrix interpolation(int n, int m) {
  Matrix A = Matrix::Zero(n, m);
  for (int i = 0; i < n; ++i) {
    const double at = static_cast<double>(i) / (n - 1) * (m - 1);
    const int j = std::min(static_cast<int>(at), m - 2);
    A(i, j) = j + 1 - at;
    A(i, j + 1) = at - j;
  }
  return A;
}

inline Matrix compliance(Line line, int n) {
  const Matrix Q = waves(n);
  if (line == Line::halfPlane) return Q * compliances(n, 1).asDiagonal() * Q.transpose();
  if (line == Line::thinBeam) return Q * compliances(n, 4).asDiagonal() * Q.transpose();
  if (line == Line::beam)
    return Q * (compliances(n, 3) + 1e-3 * compliances(n, 1)).asDiagonal() * Q.transpose();
  if (line == Line::twoHalfPlanes) {
    const int m = 9 * n / 10;
    const Matrix P = interpolation(n, m) * waves(m);
    return compliance(Line::halfPlane, n) + P * compliances(m, 1).asDiagonal() * P.transpose();
  }
  Matrix inner = Matrix::Identity(n, n);
  for (int k = 0; k + 1 < n; ++k) {
    inner(k, k + 1) = 1;
    inner(k + 1, k) = -1;
  }
  const Vector root = compliances(n, 1).cwiseSqrt();
  return Q * root.asDiagonal() * inner * root.asDiagonal() * Q.transpose();
}

/// A load of unit size by nodes: noise, noise that decays with the wave number, or up to three waves, with a
/// mean or none.
inline Vector load(std::mt19937& random, int n) {
  std::normal_distribution<double> normal;
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Vector f = Vector::Zero(n);
  const int kind = static_cast<int>(random() % 4);
  if (kind == 0)
    for (double& value : f) value = normal(random);
  else if (kind == 1) {
    const double decay = within(0, 2);
    for (int k = 0; k < std::min(n, 200); ++k) {
      const double size = normal(random) * std::pow(1.0 + k, -decay);
      for (int i = 0; i < n; ++i) f[i] += size * std::cos(std::numbers::pi * k * (i + 0.5) / n);
    }
  } else
    for (int wave = kind == 2 ? 2 : 0; wave < 3; ++wave) {
      const double k = kind == 2 ? within(0, 2 * n) : std::exp(within(0, std::log(n)));
      const double phase = within(0, 7);
      const double slope = within(-1, 1);
      for (int i = 0; i < n; ++i)
        f[i] += std::sin(std::numbers::pi * k * i / n + phase) * (1 + slope * i / n);
    }
  f /= std::sqrt(f.squaredNorm() / n);
  const double means[] = {0, 0, 0.01, 0.3, 1, -0.3};
  return f.array() + means[random() % 6];
}

/// What a pattern asks of the contact problem: a load or a distance, and a set to begin with.
struct Pattern {
  Vector slack;
  Vector balance;
  std::vector<char> active;
};

/// With rigid motions the load presses.
inline Pattern pattern(std::mt19937& random, const ContactProblem& problem) {
  const auto n = static_cast<int>(problem.W.rows());
  const Vector f = load(random, n);
  const bool loaded = random() % 2 == 0;
  Pattern result;
  result.slack = loaded ? Vector(-problem.W * f) : f;
  result.balance = Vector::Zero(problem.G.cols());
  if (problem.G.cols() > 0) result.balance[0] = std::abs(f.sum()) + 0.01;
  const auto start = static_cast<int>(random() % 3);
  result.active.resize(n);
  for (char& each : result.active)
    each = start == 2 ? static_cast<char>(random() % 2) : static_cast<char>(start);
  return result;
}

}  // namespace mortier::patterns
