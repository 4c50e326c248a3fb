#include "mesh/element_sides.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/disjoint_sets.h"
#include "base/interrupt.h"

namespace mortier {

template <size_t n>
ElementSides<n - 1> sortedSides(const std::vector<std::array<int, n>>& elements, size_t vertices) {
  const auto sorted = [&](size_t place) {
    ElementSide<n - 1> side{sideOf(elements[place / n], static_cast<int>(place % n)),
                            static_cast<int>(place)};
    std::sort(side.vertices.begin(), side.vertices.end());
    return side;
  };
  ElementSides<n - 1> sides(n * elements.size());
  std::vector<size_t> next(vertices + 1, 0);
  for (size_t place = 0; place < sides.size(); ++place) ++next[sorted(place).vertices[0] + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (size_t place = 0; place < sides.size(); ++place) {
    const ElementSide<n - 1> side = sorted(place);
    sides[next[side.vertices[0]]++] = side;
  }
  for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    stopIfInterrupted();
    while (end < sides.size() && sides[end].vertices[0] == sides[begin].vertices[0]) ++end;
    std::sort(sides.data() + begin, sides.data() + end, [](const auto& a, const auto& b) {
      return std::tie(a.vertices, a.place) < std::tie(b.vertices, b.place);
    });
  }
  return sides;
}

template ElementSides<2> sortedSides(const std::vector<std::array<int, 3>>&, size_t);
template ElementSides<3> sortedSides(const std::vector<std::array<int, 4>>&, size_t);

EdgeComponents edgeComponents(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.triangles.size());
  forEachPlace(sortedSides(mesh), [&](const auto& sides) {
    for (const auto& each : sides) sets.join(sides[0].element(), each.element());
  });
  EdgeComponents result;
  result.of.resize(mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    result.of[t] = sets.of(t) == t ? result.count++ : result.of[sets.of(t)];
  return result;
}

}  // namespace mortier
