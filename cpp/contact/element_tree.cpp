#include "contact/element_tree.h"

#include <limits>

namespace mortier {

ElementTree::ElementTree(const std::vector<Point>& points)
    : elements_(std::max(0, static_cast<int>(points.size()) - 1)) {
  if (elements_ > 0) build(0, 0, elements_, points);
}

void ElementTree::build(size_t box, int begin, int end, const std::vector<Point>& points) {
  if (boxes_.size() <= box) boxes_.resize(box + 1);
  Box around{points[begin], points[begin]};
  for (int i = begin; i <= end; ++i) {
    around.low = around.low.cwiseMin(points[i]);
    around.high = around.high.cwiseMax(points[i]);
  }
  boxes_[box] = around;
  if (end - begin <= leaf) return;
  const int middle = (begin + end) / 2;
  build(2 * box + 1, begin, middle, points);
  build(2 * box + 2, middle, end, points);
}

int farthestNode(const std::vector<Point>& line, const std::vector<Point>& other) {
  const ElementTree tree(other);
  int farthest = 0;
  double distance = -1;
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    tree.near(line[i], nearest, [&](int e) {
      for (const int k : {e, e + 1}) nearest = std::min(nearest, (other[k] - line[i]).norm());
    });
    if (nearest > distance) {
      distance = nearest;
      farthest = static_cast<int>(i);
    }
  }
  return farthest;
}

}  // namespace mortier
