#pragma once

#include <Eigen/Core>
#include <functional>

namespace mortier {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;  ///< dense, column major
using Point = Eigen::Vector2d;

/// A datum that varies in space and time: f(x [m], y [m], t [s]).
using Function = std::function<double(double x, double y, double t)>;

}  // namespace mortier
