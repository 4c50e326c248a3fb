#include "solver/complementarity.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace mortier {
namespace {

std::vector<int> indices(const std::vector<char>& set) {
  std::vector<int> result;
  for (size_t i = 0; i < set.size(); ++i)
    if (set[i] != 0) result.push_back(static_cast<int>(i));
  return result;
}

/// dp with p0 + dp = 0 off the active set and zero slack on it.
Vector changeOn(const std::vector<int>& active, const Matrix& W, bool symmetric, const Vector& slack,
                const Vector& p0) {
  Vector dp = -p0;
  if (active.empty()) return dp;
  for (const int i : active) dp[i] = 0;
  const Vector right = -(slack + W * dp)(active);
  const Matrix block = W(active, active);
  dp(active) = symmetric ? Vector(block.llt().solve(right)) : Vector(block.partialPivLu().solve(right));
  return dp;
}

}  // namespace

Complementarity solveComplementarity(const Matrix& W, bool symmetric, const Vector& slack, const Vector& p0,
                                     std::vector<char> active) {
  // Signs are judged against rounding, slacks as the forces that would close them.
  constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
  constexpr int patience = 8;

  Complementarity result;
  const auto n = static_cast<int>(slack.size());
  const int limit = 20 * n + 100;
  int fewestWrong = n + 1;
  int tries = 0;
  for (result.pivots = 1; result.pivots <= limit; ++result.pivots) {
    const Vector dp = changeOn(indices(active), W, symmetric, slack, p0);
    const Vector s = slack + W * dp;
    result.p = p0 + dp;
    double largest = 0;
    for (int i = 0; i < n; ++i)
      largest = std::max({largest, std::abs(result.p[i]), std::abs(p0[i]), std::abs(slack[i]) / W(i, i)});
    std::vector<int> wrong;
    for (int i = 0; i < n; ++i) {
      const double value = active[i] != 0 ? result.p[i] : s[i] / W(i, i);
      if (!(value >= -rounding * largest)) wrong.push_back(i);
    }
    if (wrong.empty()) {
      result.p = result.p.cwiseMax(0);
      result.active = std::move(active);
      result.solved = true;
      return result;
    }
    if (static_cast<int>(wrong.size()) < fewestWrong) {
      fewestWrong = static_cast<int>(wrong.size());
      tries = 0;
    } else {
      ++tries;
    }
    if (tries > patience) wrong.resize(1);
    for (const int i : wrong) active[i] = active[i] != 0 ? 0 : 1;
  }
  result.active = std::move(active);
  return result;
}

}  // namespace mortier
