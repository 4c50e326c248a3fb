// Boxes around the elements of a polygonal line in a binary tree: what is near a point is found in
// logarithmic time.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/types.h"

namespace mortier {

/// The side of the line x + d n on which a box lies, by the sign of (y - x) x n; 0: the line may cross it.
inline int sideOfLine(const Point& low, const Point& high, const Point& x, const Point& n) {
  constexpr double rounding = 1e-9;
  const Point half = (high - low) / 2;
  const double middle = cross(low + half - x, n);
  const double reach = half.x() * std::abs(n.y()) + half.y() * std::abs(n.x());
  if (std::abs(middle) <= reach + rounding * (std::abs(middle) + half.sum())) return 0;
  return middle > 0 ? 1 : -1;
}

class ElementTree {
 public:
  /// Of the elements between each point and the next.
  explicit ElementTree(const std::vector<Point>& points);

  /// Calls visit(element) for all elements that may be closer to x than `bound`, nearer boxes first. A visit
  /// may lower the bound [m]. Boxes of which matters(lower left, upper right corner) is false are left out.
  template <class Visit, class Matters>
  void near(const Point& x, const double& bound, Visit visit, Matters matters) const {
    near(x, x, bound, visit, matters);
  }
  /// The same for a box in place of the point, by its lower left and its upper right corner.
  template <class Visit, class Matters>
  void near(const Point& low, const Point& high, const double& bound, Visit visit, Matters matters) const {
    if (elements_ > 0) descend(0, 0, elements_, {low, high}, bound, visit, matters);
  }
  template <class Visit>
  void near(const Point& x, const double& bound, Visit visit) const {
    near(x, x, bound, visit);
  }
  template <class Visit>
  void near(const Point& low, const Point& high, const double& bound, Visit visit) const {
    near(low, high, bound, visit, [](const Point& /*low*/, const Point& /*high*/) { return true; });
  }

 private:
  static constexpr int leaf = 8;  ///< elements in a box that is not divided
  struct Box {
    Point low, high;
    [[nodiscard]] double distance(const Box& other) const {
      return (low - other.high).cwiseMax(other.low - high).cwiseMax(0).norm();
    }
  };

  void build(size_t box, int begin, int end, const std::vector<Point>& points);

  template <class Visit, class Matters>
  void descend(size_t box, int begin, int end, const Box& x, const double& bound, Visit& visit,
               Matters& matters) const {
    constexpr double rounding = 1 - 1e-12;
    if (rounding * boxes_[box].distance(x) > bound || !matters(boxes_[box].low, boxes_[box].high)) return;
    if (end - begin <= leaf) {
      for (int e = begin; e < end; ++e) visit(e);
      return;
    }
    const int middle = (begin + end) / 2;
    const size_t first = 2 * box + 1;
    const bool secondIsNearer = boxes_[first + 1].distance(x) < boxes_[first].distance(x);
    if (secondIsNearer) descend(first + 1, middle, end, x, bound, visit, matters);
    descend(first, begin, middle, x, bound, visit, matters);
    if (!secondIsNearer) descend(first + 1, middle, end, x, bound, visit, matters);
  }

  int elements_ = 0;
  std::vector<Box> boxes_;
};

/// The point of the first line, closed, that is farthest from the nodes of the second one: its index.
int farthestNode(const std::vector<Point>& line, const std::vector<Point>& other);

}  // namespace mortier
