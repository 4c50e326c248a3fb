#include "material/interior_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "material/deviatoric.h"

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
  double pressure = 0;              ///< [Pa]
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
  double pressure = 0;      ///< as linearised
  double nextPressure = 0;  ///< at the end
};

/// A column of a matrix on the directions of the law; the pressure stays 0 in plane stress.
struct OnDirections {
  Array3d directions;
  double pressure = 0;
};

class ConePath final : public InteriorPath {
 public:
  ConePath(const ConeLaw& law, const Matrix& stress0, std::vector<int> points)
      : columns_(std::move(points)),
        e_(law.e),
        b_(law.b),
        theta_(law.theta),
        bulk_(law.bulk),
        unit_((1 / law.e.maxCoeff() + law.theta) * law.yieldStress),
        scale_(law.yieldStress / law.a.sqrt()),
        compliance_(scale_ / e_),
        flow_((1 / e_ + theta_) * b_ * scale_),
        points_(columns_.size()),
        directions_(columns_.size()) {
    for (const int column : columns_) stress0_.push_back(at(stress0, column));
  }

  [[nodiscard]] double flowAtTwiceYield() const override { return unit_; }

  void begin(double flow) override {
    points_.assign(points_.size(), {});
    for (IteratePoint& point : points_) point.y0 = flow / unit_;
    for (size_t i = 0; i < points_.size(); ++i) points_[i].pressure = stress0_[i].pressure;
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
      const auto& [x, delta, y0, slack, pressure] = point;
      const auto [ownStrain, volume] = at(strain, columns_[i]);
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
      d.r = ownStrain + stress0_[i].directions / e_ - diagonal * x + flow_ * (delta - rest);
      d.z = slack + dot(right, flow_ * x);
      const double dy0 = (d.first + dot(right, d.r)) / d.z;
      const Array3d dx = (d.r - flow_ * x * dy0) / diagonal;
      const Array3d stretch = 1 + b_ * y0;
      const Array3d predictor = scale_ * (stretch * (x + dx) + b_ * (x * dy0 + rest - delta));
      d.pressure = bulk_ ? stress0_[i].pressure + *bulk_ * volume : 0;
      put(predictor, d.pressure, columns_[i], result.predictor);
      const Array3d left = -theta_ * b_ * scale_ * scale_ / diagonal * x / d.z;
      Eigen::Matrix3d moduli = left.matrix() * right.matrix().transpose();
      moduli.diagonal().array() += scale_ * stretch / diagonal;
      putModuli(moduli, columns_[i], result);
    }
  }

  double direct(const Matrix& strainChange) override {
    double largest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < points_.size(); ++i) {
      const auto& [x, delta, y0, slack, pressure] = points_[i];
      const auto [ownChange, volumeChange] = at(strainChange, columns_[i]);
      Direction& d = directions_[i];
      d.nextPressure = bulk_ ? d.pressure + *bulk_ * volumeChange : 0;
      const Array3d diagonal = compliance_ + flow_ * y0;
      const Array3d r = d.r + ownChange;
      d.y0 = (d.first + 2 * y0 * dot(x, r / diagonal)) / d.z;
      d.x = (r - flow_ * x * d.y0) / diagonal;
      // Where the point flows x . dx is rounding of dx.
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
      auto& [x, delta, y0, slack, pressure] = points_[i];
      const Direction& d = directions_[i];
      delta += step * (step * d.y0 * d.x - d.rest);
      slack -= step * (2 * d.xx + step * dot(d.x, d.x));
      x += step * d.x;
      y0 += step * d.y0;
      pressure += step * (d.nextPressure - pressure);
      put(scale_ * ((1 + b_ * y0) * x - b_ * delta), pressure, columns_[i], stress);
    }
  }

 private:
  /// First component of x o y.
  static double product(const IteratePoint& point) {
    return point.y0 * point.slack + dot(point.x, point.delta);
  }

  [[nodiscard]] OnDirections at(const Matrix& m, int column) const {
    if (!bulk_) return {m.col(column).array()};
    const auto [k, h] = split(std::array<double, 4>{m(0, column), m(1, column), m(2, column), m(3, column)});
    return {Array3d(k[0], k[1], k[2]), h};
  }
  void put(const Array3d& x, double pressure, int column, Matrix& m) const {
    if (!bulk_)
      m.col(column) = x;
    else
      m.col(column) =
          Eigen::Map<const Eigen::Vector4d>(joined(Split<double>{{x[0], x[1], x[2]}, pressure}).data());
  }
  void putModuli(const Eigen::Matrix3d& D, int column, Linearisation& result) const {
    Eigen::Matrix3d H = D;
    if (bulk_) {
      std::array<double, 9> own;
      Eigen::Map<Eigen::Matrix3d>(own.data()) = D;
      const std::array<double, 16> all = joinedModuli(own, *bulk_);
      const Eigen::Map<const Eigen::Matrix4d> whole(all.data());
      H = whole.topLeftCorner<3, 3>();
      result.beyond.col(column).head<4>() = whole.row(3).transpose();
    }
    if (result.moduli.rows() == 6)
      result.moduli.col(column) << H(0, 0), H(1, 0), H(2, 0), H(1, 1), H(2, 1), H(2, 2);
    else
      result.moduli.col(column) = H.reshaped();
  }

  std::vector<int> columns_;  ///< of the points
  std::vector<OnDirections> stress0_;
  Array3d e_;
  Array3d b_;
  double theta_;
  std::optional<double> bulk_;
  double unit_;  ///< strain per y_0
  Array3d scale_;
  Array3d compliance_;
  Array3d flow_;
  std::vector<IteratePoint> points_;
  std::vector<Direction> directions_;
};

/// A law without such a path, linearised where the stress is.
class NewtonPath final : public InteriorPath {
 public:
  NewtonPath(const Material& material, const PathStart& start, std::vector<int> points)
      : material_(material), start_(start), columns_(std::move(points)) {}

  [[nodiscard]] double flowAtTwiceYield() const override { return 0; }
  void begin(double /*flow*/) override { stress_ = start_.stress0; }
  [[nodiscard]] double complementarity() const override { return 0; }
  [[nodiscard]] int points() const override { return 0; }

  void linearise(const Matrix& strain, double /*target*/, bool /*correct*/, Linearisation& result) override {
    const MaterialStep step{start_.weight, start_.stress0, strain, false, start_.strain0};
    for (const int i : columns_) material_.linearise(step, stress_, result, i, i + 1);
    law_ = result;
  }
  double direct(const Matrix& strainChange) override {
    for (const int i : columns_) law_.predictor.col(i) += stressOf(law_, strainChange.col(i), i);
    return std::numeric_limits<double>::infinity();
  }
  void advance(double step, Matrix& stress) override {
    for (const int i : columns_)
      stress_.col(i) = stress.col(i) += step * (law_.predictor.col(i) - stress.col(i));
  }

 private:
  const Material& material_;
  PathStart start_;
  std::vector<int> columns_;
  Matrix stress_;      ///< of the iterate
  Linearisation law_;  ///< of the last linearise(), the predictor moved by direct()
};

}  // namespace

std::unique_ptr<InteriorPath> conePath(const ConeLaw& law, const Matrix& stress0, std::vector<int> points) {
  return std::make_unique<ConePath>(law, stress0, std::move(points));
}

std::unique_ptr<InteriorPath> newtonPath(const Material& material, const PathStart& start,
                                         std::vector<int> points) {
  return std::make_unique<NewtonPath>(material, start, std::move(points));
}

}  // namespace mortier
