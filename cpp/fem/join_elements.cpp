// The patches of averaged volumetric strain: elements joined by a matching, again and again.
#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

#include "fem/volume_patches.h"
#include "mesh/element_sides.h"

namespace mortier {
namespace {

/// Parts that share sides: of each part the neighbours, ascending, and how many sides they share.
struct PartGraph {
  std::vector<int> from;
  std::vector<std::pair<int, int>> list;
};

/// Interior sides between elements of one region, as pairs of elements.
template <class Mesh>
std::vector<std::array<int, 2>> innerSides(const Mesh& mesh) {
  std::vector<std::array<int, 2>> pairs;
  forEachPlace(sortedSides(mesh), [&](const auto& sides) {
    if (sides.size() < 2) return;
    const std::array pair{sides[0].element(), sides[1].element()};
    if (mesh.regions[pair[0]] == mesh.regions[pair[1]]) pairs.push_back(pair);
  });
  return pairs;
}

PartGraph neighboursOf(const std::vector<std::array<int, 2>>& sides, const std::vector<int>& part,
                       int count) {
  std::vector<int> from(count + 1, 0);
  const auto forEachBoth = [&](auto visit) {
    for (const auto& [a, b] : sides) {
      if (part[a] == part[b]) continue;
      visit(part[a], part[b]);
      visit(part[b], part[a]);
    }
  };
  forEachBoth([&](int a, int) { ++from[a + 1]; });
  std::partial_sum(from.begin(), from.end(), from.begin());
  std::vector<int> all(from.back());
  std::vector<int> next(from.begin(), from.end() - 1);
  forEachBoth([&](int a, int b) { all[next[a]++] = b; });
  PartGraph result;
  result.from.assign(1, 0);
  for (int p = 0; p < count; ++p) {
    std::sort(all.begin() + from[p], all.begin() + from[p + 1]);
    for (int i = from[p]; i < from[p + 1]; ++i)
      if (i > from[p] && all[i] == all[i - 1])
        ++result.list.back().second;
      else
        result.list.emplace_back(all[i], 1);
    result.from.push_back(static_cast<int>(result.list.size()));
  }
  return result;
}

/// Joins parts in twos: first those with the fewest neighbours that are free, each with the free one that it
/// shares most sides with. One that stays alone joins the smallest neighbour. \returns how many there are
int joinInTwos(const std::vector<std::array<int, 2>>& sides, std::vector<int>& part, int count) {
  const PartGraph neighbours = neighboursOf(sides, part, count);
  const auto forEachNeighbour = [&](int p, auto visit) {
    for (int i = neighbours.from[p]; i < neighbours.from[p + 1]; ++i) visit(neighbours.list[i]);
  };
  std::vector<int> joined(count, -1);
  std::vector<int> size;
  std::vector<int> free(count);
  using Candidate = std::pair<int, int>;  // free neighbours, part
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> next;
  for (int p = 0; p < count; ++p) {
    free[p] = neighbours.from[p + 1] - neighbours.from[p];
    next.emplace(free[p], p);
  }
  while (!next.empty()) {
    const auto [freeThen, p] = next.top();
    next.pop();
    if (joined[p] >= 0 || freeThen != free[p]) continue;
    std::array<int, 3> best{0, 0, -1};
    forEachNeighbour(p, [&](const std::pair<int, int>& other) {
      const std::array<int, 3> candidate{-other.second, free[other.first], other.first};
      if (joined[other.first] < 0 && (best[2] < 0 || candidate < best)) best = candidate;
    });
    if (best[2] < 0) continue;
    for (const int of : {p, best[2]}) joined[of] = static_cast<int>(size.size());
    size.push_back(2);
    for (const int of : {p, best[2]})
      forEachNeighbour(of, [&](const std::pair<int, int>& other) {
        if (joined[other.first] < 0) next.emplace(--free[other.first], other.first);
      });
  }
  for (int p = 0; p < count; ++p) {
    if (joined[p] >= 0) continue;
    int smallest = -1;
    forEachNeighbour(p, [&](const std::pair<int, int>& other) {
      if (smallest < 0 || size[joined[other.first]] < size[smallest]) smallest = joined[other.first];
    });
    if (smallest < 0) {
      smallest = static_cast<int>(size.size());
      size.push_back(0);
    }
    joined[p] = smallest;
    ++size[smallest];
  }
  for (int& p : part) p = joined[p];
  return static_cast<int>(size.size());
}

/// Joins elements in twos, then those in twos, and so on.
std::vector<int> joinedInTwos(const std::vector<std::array<int, 2>>& sides, size_t elements, int times) {
  std::vector<int> patchOf(elements);
  std::iota(patchOf.begin(), patchOf.end(), 0);
  auto patches = static_cast<int>(elements);
  for (int i = 0; i < times; ++i) patches = joinInTwos(sides, patchOf, patches);
  // Numbered as their first elements are: neighbours in memory.
  std::vector<int> number(patches, -1);
  int next = 0;
  for (int& patch : patchOf) {
    if (number[patch] < 0) number[patch] = next++;
    patch = number[patch];
  }
  return patchOf;
}

}  // namespace

std::vector<int> volumePatches(const TriangleMesh& mesh, int degree) {
  return joinedInTwos(innerSides(mesh), mesh.triangles.size(), degree == 1 ? 2 : 1);
}

std::vector<int> volumePatches(const TetrahedronMesh& mesh) {
  return joinedInTwos(innerSides(mesh), mesh.tetrahedra.size(), 4);
}

}  // namespace mortier
