// Points of the common refinement of two surfaces while an interface is put together.
#pragma once

#include <array>
#include <vector>

#include "contact/interface.h"

namespace mortier {

struct PointEntries {
  Triplets trace1, trace2, functions;
  std::vector<double> areas, distances;
  std::array<std::vector<double>, 2> sizes;
  std::vector<SpacePoint> normals;

  void add(Triplets& entries, int column, double value) const {
    entries.emplace_back(static_cast<int>(distances.size()), column, value);
  }
  [[nodiscard]] ContactInterface::SurfacePoints assembled(const std::array<int, 2>& nodes,
                                                          Eigen::Index rows) const {
    const auto count = static_cast<Eigen::Index>(distances.size());
    const auto vector = [](const std::vector<double>& list) {
      return Vector(Eigen::Map<const Vector>(list.data(), static_cast<Eigen::Index>(list.size())));
    };
    return {{mortier::assembled(count, nodes[0], trace1), mortier::assembled(count, nodes[1], trace2)},
            mortier::assembled(count, rows, functions),
            normals,
            vector(areas),
            vector(distances),
            {vector(sizes[0]), vector(sizes[1])}};
  }
};

/// Where a function is least in a convex polygon, nearly: in that of four parts of a triangle which is the
/// lowest by its corners, and again.
/// \param depth  how often
template <class Function>
Point lowestIn(const std::vector<Point>& polygon, int depth, const Function& at) {
  struct Corner {
    Point x;
    double value;
  };
  using Triangle = std::array<Corner, 3>;
  const auto cornerAt = [&](const Point& x) { return Corner{x, at(x)}; };
  const auto sum = [](const Triangle& t) { return t[0].value + t[1].value + t[2].value; };
  std::vector<Corner> all;
  for (const Point& x : polygon) all.push_back(cornerAt(x));
  const auto lower = [](const Corner& a, const Corner& b) { return a.value < b.value; };
  Corner lowest = *std::min_element(all.begin(), all.end(), lower);
  Triangle chosen{all[0], all[1], all[2]};
  for (size_t last = 3; last < all.size(); ++last)
    if (const Triangle next{all[0], all[last - 1], all[last]}; sum(next) < sum(chosen)) chosen = next;
  for (int i = 0; i < depth; ++i) {
    const auto& [a, b, c] = chosen;
    const Corner ab = cornerAt((a.x + b.x) / 2), bc = cornerAt((b.x + c.x) / 2),
                 ca = cornerAt((c.x + a.x) / 2);
    lowest = std::min({lowest, ab, bc, ca}, lower);
    Triangle best{ab, bc, ca};
    for (const Triangle& part : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}})
      if (sum(part) < sum(best)) best = part;
    chosen = best;
  }
  return lowest.x;
}

}  // namespace mortier
