// The tangent of a body in space: its pattern by nodes, and the sum over its tetrahedra and its patches.
#include <algorithm>

#include "fem/space_elements.h"
#include "fem/tetrahedron.h"

namespace mortier {
namespace {

/// Assembles items 0 to count - 1: threads compute the matrices of a batch, one thread adds them in the order
/// of the items. \param atOnce  items of a batch
template <class Make, class Add>
void makeAndAdd(size_t count, size_t atOnce, Threads& threads, const Make& make, const Add& add) {
  constexpr size_t ofABlock = 64;
  for (size_t first = 0; first < count; first += atOnce) {
    const size_t some = std::min(atOnce, count - first);
    threads.forEach(static_cast<int>((some + ofABlock - 1) / ofABlock), [&](int block) {
      for (size_t k = ofABlock * block; k < std::min(some, ofABlock * (block + 1)); ++k) make(first + k, k);
    });
    for (size_t k = 0; k < some; ++k) add(first + k, k);
  }
}

}  // namespace

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
    if (patches_) B.row(5).setZero();
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
  const auto n = static_cast<size_t>(nodes_.perElement());
  const int count = nodes_.count();
  std::vector<std::vector<int>> near(count);
  const auto couple = [&](std::span<const int> nodes) {
    for (const int b : nodes)
      for (const int a : nodes)
        if (!symmetric || a >= b) near[b].push_back(a);
  };
  for (int p = 0; patches_ && p < patches_->count(); ++p) couple(patches_->nodes(p));
  for (size_t e = 0; !patches_ && e < mesh_.tetrahedra.size(); ++e) couple({nodes_.of(e), n});
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

template <class Entry>
void SpaceElements::add(std::span<const int> nodes, const Entry& entry, std::vector<double>& values) const {
  const auto n = static_cast<int>(nodes.size());
  const bool symmetric = pattern_->symmetric;
  // Of the equations of a node, those before each component.
  const auto rank = [&](int node, int component) {
    int before = 0;
    for (int c = 0; c < component; ++c) before += equations_[3 * node + c] >= 0 ? 1 : 0;
    return before;
  };
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
            values[from + rank(node, r)] += entry(3 * a + r, 3 * b + c);
        }
      }
    }
  }
}

void SpaceElements::setPatch(int patch, const Matrix& moduli, PatchTangent& tangent) const {
  tangent.start(*patches_, patch);
  Eigen::Matrix3d inner = Eigen::Matrix3d::Zero();
  for (const int e : patches_->elements(patch)) {
    const int* local = patches_->local(e);
    const double w = weights_[e] * *patches_->basis(e);
    const Eigen::Matrix<double, 6, 6> D = spaceModuliAt(moduli, e);
    const double* G = &gradients_[9 * static_cast<size_t>(e)];
    const auto addNode = [&](int at, const SpacePoint& gradient) {
      Eigen::Matrix<double, 6, 3> B = strainOfNode(gradient.x(), gradient.y(), gradient.z());
      B.row(5).setZero();
      Eigen::Map<SpacePoint>(tangent.first(0) + at) += w * B.transpose() * D.col(5);
      Eigen::Map<SpacePoint>(tangent.second(0) + at) += w * B.transpose() * D.row(5).transpose();
    };
    SpacePoint sum = SpacePoint::Zero();
    for (int a = 1; a < 4; ++a, G += 3) {
      addNode(3 * local[a], {G[0], G[1], G[2]});
      sum += SpacePoint(G[0], G[1], G[2]);
    }
    addNode(3 * local[0], -sum);
    inner(0, 0) += w * *patches_->basis(e) * D(5, 5);
  }
  tangent.addInner(inner);
  const auto nodes = patches_->nodes(patch);
  for (size_t a = 0; a < nodes.size() && !turnedOf_.empty(); ++a)
    if (const int turned = turnedOf_[nodes[a]]; turned >= 0)
      tangent.turnNode(3 * a, [&](double* at) {
        Eigen::Map<SpacePoint> vector(at);
        vector = (supports_[turned].frame * vector).eval();
      });
}

void SpaceElements::tangent(const Matrix& moduli, std::vector<double>& values, Threads& threads) const {
  values.assign(pattern(moduli.rows() == 21).entries(), 0.0);
  withSpaceElement(nodes_.degree, [&](auto element) {
    using Element = decltype(element);
    constexpr size_t atOnce = 2048;
    const size_t all = mesh_.tetrahedra.size();
    std::vector<Eigen::Matrix<double, 3 * Element::nodes, 3 * Element::nodes>> matrices(
        std::min(atOnce, all));
    makeAndAdd(
        all, atOnce, threads,
        [&](size_t e, size_t k) { matrices[k] = elementTangent<Element>(static_cast<int>(e), moduli); },
        [&](size_t e, size_t k) {
          add({nodes_.of(e), Element::nodes}, matrices[k], values);
        });
  });
  if (!patches_) return;
  constexpr size_t atOnce = 1024;
  std::vector<std::vector<double>> memory(atOnce);
  makeAndAdd(
      patches_->count(), atOnce, threads,
      [&](size_t p, size_t k) {
        const auto patch = static_cast<int>(p);
        memory[k].resize(PatchTangent::need(*patches_, patch, 3));
        PatchTangent tangent(*patches_, patch, 3, memory[k].data());
        setPatch(patch, moduli, tangent);
      },
      [&](size_t p, size_t k) {
        const auto patch = static_cast<int>(p);
        add(patches_->nodes(patch), PatchTangent(*patches_, patch, 3, memory[k].data()), values);
      });
}

}  // namespace mortier
