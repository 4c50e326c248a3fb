#pragma once

#include <Eigen/Core>
#include <functional>

namespace mortier {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;  ///< dense, column major
using Point = Eigen::Vector2d;

/// The third component of the vector product.
inline double cross(const Point& a, const Point& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A datum that varies in space and time: f(x [m], y [m], t [s]).
using Function = std::function<double(double x, double y, double t)>;

}  // namespace mortier
