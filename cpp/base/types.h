#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>

namespace mortier {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;  ///< dense, column major
using Point = Eigen::Vector2d;
using SpacePoint = Eigen::Vector3d;

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of a sum of a few terms, over the largest of them.
inline constexpr double roundingOfSums = 16 * std::numeric_limits<double>::epsilon();

inline double largestOf(const Vector& v) {
  return v.size() == 0 ? 0 : v.cwiseAbs().maxCoeff();
}

/// By a right angle, anticlockwise.
inline Point turned(const Point& v) {
  return {-v.y(), v.x()};
}

inline SpacePoint asSpacePoint(const Point& x) {
  return {x.x(), x.y(), 0};
}

/// The third component of the vector product.
inline double cross(const Point& a, const Point& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A datum of the plane that varies in space and time: f(x [m], y [m], t [s]).
using Function = std::function<double(double x, double y, double t)>;

}  // namespace mortier
