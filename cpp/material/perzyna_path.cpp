#include "material/perzyna_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace mortier {
namespace {

using Eigen::Array3d;

double dot(const Array3d& a, const Array3d& b) {
  return (a * b).sum();
}

/// The smallest t > 0 with c + 2 b t + a t^2 = 0.
double firstRoot(double c, double b, double a) {
  double first = std::numeric_limits<double>::infinity();
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return first;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  if (q / a > 0) first = std::min(first, q / a);
  if (c / q > 0) first = std::min(first, c / q);
  return first;
}

// With x the projected stress and y' = delta - y_0 x, everything is scaled by sigma_Y a^(-1/2):
//   compliance x - flow y' = strain + E^-1 s0,   compliance = scale/e,  flow = (1/e + theta) b scale.
struct IteratePoint {
  Array3d x = Array3d::Zero();      ///< projected stress, |x| < 1
  Array3d delta = Array3d::Zero();  ///< y' + y_0 x
  double y0 = 1;                    ///< flow
  double slack = 1;                 ///< 1 - |x|^2
};

/// A direction, and what linearise() left for it.
struct Direction {
  Array3d x = Array3d::Zero();
  double y0 = 0;
  double xx = 0;     ///< x . dx
  Array3d rest;      ///< second part of the complementarity that is to vanish
  double first = 0;  ///< first part
  Array3d r;
  double z = 0;
};

class PerzynaPath final : public InteriorPath {
 public:
  PerzynaPath(const PerzynaPathData& law, const Matrix& stress0)
      : stress0_(stress0),
        e_(law.e),
        b_(law.b),
        theta_(law.theta),
        unit_((1 / law.e.maxCoeff() + law.theta) * law.yieldStress),
        scale_(law.yieldStress / law.a.sqrt()),
        compliance_(scale_ / e_),
        flow_((1 / e_ + theta_) * b_ * scale_),
        points_(stress0.cols()),
        directions_(stress0.cols()) {}

  [[nodiscard]] double flowAtTwiceYield() const override { return unit_; }

  void begin(double flow) override {
    points_.assign(points_.size(), {});
    for (IteratePoint& point : points_) point.y0 = flow / unit_;
  }

  [[nodiscard]] double complementarity() const override {
    double sum = 0;
    for (const IteratePoint& point : points_) sum += product(point);
    return unit_ * sum;
  }
  [[nodiscard]] int points() const override { return static_cast<int>(points_.size()); }

  // The direction solves
  //   compliance dx - flow dy' = r,   dy' = -(rest + y_0 dx + x dy_0),   slack dy_0 - 2 y_0 x . dx = first,
  // where r holds the change of strain; eliminating leaves a diagonal matrix and one number.
  void linearise(const Matrix& strain, double target, bool correct, Linearisation& result) override {
    for (size_t i = 0; i < points_.size(); ++i) {
      const IteratePoint& point = points_[i];
      const auto& [x, delta, y0, slack] = point;
      Direction& d = directions_[i];
      double neglected = 0;
      Array3d rest = delta;
      if (correct) {
        const Array3d dy = -(d.rest + y0 * d.x + x * d.y0);
        neglected = dot(d.x, dy) + dot(delta, d.x);
        rest += d.y0 * d.x;
      }
      d.rest = rest;
      d.first = target / unit_ - product(point) - neglected + dot(x, rest);
      const Array3d diagonal = compliance_ + flow_ * y0;
      const Array3d right = 2 * y0 * x / diagonal;
      d.r = strain.col(i).array() + stress0_.col(i).array() / e_ - diagonal * x + flow_ * (delta - rest);
      d.z = slack + dot(right, flow_ * x);
      const double dy0 = (d.first + dot(right, d.r)) / d.z;
      const Array3d dx = (d.r - flow_ * x * dy0) / diagonal;
      const Array3d stretch = 1 + b_ * y0;
      result.predictor.col(i) = scale_ * (stretch * (x + dx) + b_ * (x * dy0 + rest - delta));
      const Array3d left = -theta_ * b_ * scale_ * scale_ / diagonal * x / d.z;
      Eigen::Matrix3d moduli = left.matrix() * right.matrix().transpose();
      moduli.diagonal().array() += scale_ * stretch / diagonal;
      storeModuli(moduli, result.moduli, static_cast<int>(i));
    }
  }

  double direct(const Matrix& strainChange) override {
    double largest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < points_.size(); ++i) {
      const auto& [x, delta, y0, slack] = points_[i];
      Direction& d = directions_[i];
      const Array3d diagonal = compliance_ + flow_ * y0;
      const Array3d r = d.r + strainChange.col(i).array();
      d.y0 = (d.first + 2 * y0 * dot(x, r / diagonal)) / d.z;
      d.x = (r - flow_ * x * d.y0) / diagonal;
      // Where the point flows x . dx is nothing but rounding of dx.
      d.xx = y0 > slack ? (slack * d.y0 - d.first) / (2 * y0) : dot(x, d.x);
      largest = std::min(largest, firstRoot(slack, -d.xx, -dot(d.x, d.x)));
      if (d.y0 < 0) largest = std::min(largest, -y0 / d.y0);
      // y_0^2 - |y'|^2 along the direction.
      const Array3d w = d.rest + y0 * d.x;
      const double det = y0 * y0 * slack + 2 * y0 * dot(delta, x) - dot(delta, delta);
      const double slope =
          y0 * d.y0 * slack - y0 * y0 * d.xx + dot(delta, w + x * d.y0) - y0 * dot(x, d.rest);
      const double curvature = d.y0 * d.y0 * slack - dot(w, w) - 2 * d.y0 * (dot(x, d.rest) + y0 * d.xx);
      largest = std::min(largest, firstRoot(det, slope, curvature));
    }
    return largest;
  }

  void advance(double step, Matrix& stress) override {
    for (size_t i = 0; i < points_.size(); ++i) {
      auto& [x, delta, y0, slack] = points_[i];
      const Direction& d = directions_[i];
      delta += step * (step * d.y0 * d.x - d.rest);
      slack -= step * (2 * d.xx + step * dot(d.x, d.x));
      x += step * d.x;
      y0 += step * d.y0;
      stress.col(static_cast<Eigen::Index>(i)) = scale_ * ((1 + b_ * y0) * x - b_ * delta);
    }
  }

 private:
  /// First component of x o y.
  static double product(const IteratePoint& point) {
    return point.y0 * point.slack + dot(point.x, point.delta);
  }

  const Matrix& stress0_;
  Array3d e_;
  Array3d b_;
  double theta_;
  double unit_;  ///< strain per y_0
  Array3d scale_;
  Array3d compliance_;
  Array3d flow_;
  std::vector<IteratePoint> points_;
  std::vector<Direction> directions_;
};

}  // namespace

std::unique_ptr<InteriorPath> perzynaPath(const PerzynaPathData& law, const Matrix& stress0) {
  return std::make_unique<PerzynaPath>(law, stress0);
}

}  // namespace mortier
