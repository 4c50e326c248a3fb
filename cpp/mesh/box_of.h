// The bounding box of points.
#pragma once

#include <Eigen/Geometry>

namespace mortier {

/// Empty where there are none. \param points  Point or SpacePoint
template <class Points>
auto boxOf(const Points& points) {
  Eigen::AlignedBox<double, Points::value_type::SizeAtCompileTime> box;
  for (const auto& point : points) box.extend(point);
  return box;
}

}  // namespace mortier
