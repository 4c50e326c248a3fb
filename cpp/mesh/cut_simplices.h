// Triangles or tetrahedra while edges of them are cut (mesh/refine_space.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace mortier {

/// Simplices of n vertices that are cut in place, and where they are.
template <size_t n>
class CutSimplices {
 public:
  using Simplex = std::array<int, n>;

  CutSimplices(const std::vector<Simplex>& simplices, size_t vertices) : all_(simplices), at_(vertices) {
    for (size_t i = 0; i < all_.size(); ++i)
      for (const int v : all_[i]) at_[v].push_back(static_cast<int>(i));
    parents_.resize(all_.size());
    std::iota(parents_.begin(), parents_.end(), 0);
  }

  [[nodiscard]] size_t count() const { return all_.size(); }
  [[nodiscard]] const std::vector<Simplex>& all() const { return all_; }
  [[nodiscard]] const Simplex& operator[](int i) const { return all_[i]; }
  [[nodiscard]] int parent(int i) const { return parents_[i]; }

  [[nodiscard]] const std::vector<int>& at(int v) const { return at_[v]; }
  [[nodiscard]] bool has(int v) const { return v < static_cast<int>(at_.size()) && !at_[v].empty(); }

  /// Those with an edge, ascending.
  [[nodiscard]] std::vector<int> around(const std::array<int, 2>& edge) const {
    std::vector<int> found;
    if (std::max(edge[0], edge[1]) >= static_cast<int>(at_.size())) return found;
    const bool first = at_[edge[0]].size() < at_[edge[1]].size();
    for (const int i : at_[edge[first ? 0 : 1]])
      if (std::find(all_[i].begin(), all_[i].end(), edge[first ? 1 : 0]) != all_[i].end()) found.push_back(i);
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Cuts one at vertex m of its edge: the half at its first end stays, the other one is put last.
  void cut(int i, const std::array<int, 2>& edge, int m) {
    at_.resize(std::max(at_.size(), static_cast<size_t>(m) + 1));
    const auto last = static_cast<int>(all_.size());
    Simplex second = all_[i];
    std::replace(all_[i].begin(), all_[i].end(), edge[1], m);
    std::replace(second.begin(), second.end(), edge[0], m);
    std::vector<int>& left = at_[edge[1]];
    left.erase(std::find(left.begin(), left.end(), i));
    at_[m].push_back(i);
    for (const int v : second) at_[v].push_back(last);
    all_.push_back(second);
    parents_.push_back(parents_[i]);
  }

  /// The same in the order of their parents.
  [[nodiscard]] std::vector<int> byParents() const {
    std::vector<int> order(all_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return parents_[i] < parents_[j]; });
    return order;
  }

 private:
  std::vector<Simplex> all_;
  std::vector<int> parents_;
  std::vector<std::vector<int>> at_;  ///< by vertices
};

}  // namespace mortier
