// The tangent of a body in space: its pattern by nodes, and the sum over its tetrahedra.
#include <algorithm>

#include "fem/space_elements.h"
#include "fem/tetrahedron.h"

namespace mortier {

template <class Element>
Eigen::Matrix<double, 3 * Element::nodes, 3 * Element::nodes> SpaceElements::elementTangent(
    int element, const Matrix& moduli) const {
  constexpr int n = 3 * Element::nodes;
  Eigen::Matrix<double, n, n> K = Eigen::Matrix<double, n, n>::Zero();
  for (int q = 0; q < Element::points; ++q) {
    const int i = Element::points * element + q;
    const double* G = &gradients_[static_cast<size_t>(n - 3) * i];
    Eigen::Matrix<double, 6, n> B;
    SpacePoint sum = SpacePoint::Zero();
    for (int a = 1; a < Element::nodes; ++a, G += 3) {
      B.template middleCols<3>(3 * a) = strainOfNode(G[0], G[1], G[2]);
      sum += SpacePoint(G[0], G[1], G[2]);
    }
    B.template leftCols<3>() = strainOfNode(-sum.x(), -sum.y(), -sum.z());
    const Eigen::Matrix<double, 6, n> DB = (weights_[i] * spaceModuliAt(moduli, i)) * B;
    K.noalias() += B.transpose() * DB;
  }
  const int* nodes = nodes_.of(element);
  for (int a = 0; a < Element::nodes && !turnedOf_.empty(); ++a)
    if (const int turned = turnedOf_[nodes[a]]; turned >= 0) {
      const Eigen::Matrix3d& Q = supports_[turned].frame;
      K.template middleRows<3>(3 * a) = (Q * K.template middleRows<3>(3 * a)).eval();
      K.template middleCols<3>(3 * a) = (K.template middleCols<3>(3 * a) * Q.transpose()).eval();
    }
  return K;
}

const SparsePattern& SpaceElements::pattern(bool symmetric) const {
  if (!pattern_ || pattern_->symmetric != symmetric) buildPattern(symmetric);
  return *pattern_;
}

void SpaceElements::buildPattern(bool symmetric) const {
  const int n = nodes_.perElement();
  const int count = nodes_.count();
  std::vector<std::vector<int>> near(count);
  for (size_t e = 0; e < mesh_.tetrahedra.size(); ++e) {
    const int* nodes = nodes_.of(e);
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a)
        if (!symmetric || nodes[a] >= nodes[b]) near[nodes[b]].push_back(nodes[a]);
  }
  const auto equationsOf = [&](int node) {
    return static_cast<int>(std::count_if(equations_.begin() + 3 * node, equations_.begin() + 3 * node + 3,
                                          [](int equation) { return equation >= 0; }));
  };
  SparsePattern pattern;
  pattern.symmetric = symmetric;
  pattern.size = freeDofs_;
  pattern.columnStart.assign(1, 0);
  neighbourStart_.assign(1, 0);
  neighbours_.clear();
  before_.clear();
  for (int j = 0; j < count; ++j) {
    std::vector<int>& of = near[j];
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
    int sum = 0;
    for (const int node : of) {
      neighbours_.push_back(node);
      before_.push_back(sum);
      sum += equationsOf(node);
    }
    neighbourStart_.push_back(static_cast<int>(neighbours_.size()));
    for (int c = 0; c < 3; ++c) {
      const int column = equations_[3 * j + c];
      if (column < 0) continue;
      for (const int node : of)
        for (int r = 0; r < 3; ++r)
          if (const int row = equations_[3 * node + r]; row >= 0 && (row >= column || !symmetric))
            pattern.rows.push_back(row);
      pattern.columnStart.push_back(static_cast<int>(pattern.rows.size()));
    }
    of = {};
  }
  pattern_ = std::move(pattern);
}

template <class Matrices>
void SpaceElements::add(const Matrices& matrices, size_t first, size_t count,
                        std::vector<double>& values) const {
  const int n = nodes_.perElement();
  const bool symmetric = pattern_->symmetric;
  // Of the equations of a node, those before each component.
  const auto rank = [&](int node, int component) {
    int before = 0;
    for (int c = 0; c < component; ++c) before += equations_[3 * node + c] >= 0 ? 1 : 0;
    return before;
  };
  for (size_t k = 0; k < count; ++k) {
    const auto& K = matrices[k];
    const int* nodes = nodes_.of(first + k);
    for (int b = 0; b < n; ++b) {
      const int of = nodes[b];
      const auto begin = neighbours_.begin() + neighbourStart_[of];
      const auto end = neighbours_.begin() + neighbourStart_[of + 1];
      for (int a = 0; a < n; ++a) {
        const int node = nodes[a];
        if (symmetric && node < of) continue;
        const int start = before_[std::lower_bound(begin, end, node) - neighbours_.begin()];
        for (int c = 0; c < 3; ++c) {
          const int column = equations_[3 * of + c];
          if (column < 0) continue;
          const int from = pattern_->columnStart[column] + start - (symmetric ? rank(of, c) : 0);
          for (int r = 0; r < 3; ++r) {
            const int row = equations_[3 * node + r];
            if (row >= 0 && (row >= column || !symmetric))
              values[from + rank(node, r)] += K(3 * a + r, 3 * b + c);
          }
        }
      }
    }
  }
}

void SpaceElements::tangent(const Matrix& moduli, std::vector<double>& values, Threads& threads) const {
  values.assign(pattern(moduli.rows() == 21).entries(), 0.0);
  withSpaceElement(nodes_.degree, [&](auto element) {
    using Element = decltype(element);
    // The matrices of some at once, then their sums in the order of the tetrahedra.
    constexpr size_t atOnce = 2048;
    constexpr size_t ofABlock = 64;
    const size_t all = mesh_.tetrahedra.size();
    std::vector<Eigen::Matrix<double, 3 * Element::nodes, 3 * Element::nodes>> matrices(
        std::min(atOnce, all));
    for (size_t first = 0; first < all; first += atOnce) {
      const size_t count = std::min(atOnce, all - first);
      threads.forEach(static_cast<int>((count + ofABlock - 1) / ofABlock), [&](int block) {
        for (size_t k = ofABlock * block; k < std::min(count, ofABlock * (block + 1)); ++k)
          matrices[k] = elementTangent<Element>(static_cast<int>(first + k), moduli);
      });
      add(matrices, first, count, values);
    }
  });
}

}  // namespace mortier
