#include "bound/side_datum.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/quadrature_rules.h"

namespace mortier {
namespace {

constexpr double roundingOfMeans = 1e-13;

/// Mean of (values)^2, the values linear.
double meanSquare(const Eigen::Vector3d& v) {
  return (v.squaredNorm() + v.sum() * v.sum()) / 12;
}

/// A part of a triangle by the barycentric coordinates of its corners.
struct Part {
  Eigen::Matrix3d corners;  ///< columns
  double share = 1;
  Eigen::Vector3d values;
  double off = 0;    ///< |f - linear between its corners| at most
  double error = 0;  ///< the same of f and a polynomial of degree 4, or of its integral by Radon's rule
};

std::array<Eigen::Matrix3d, 4> quarters(const Eigen::Matrix3d& c) {
  Eigen::Matrix3d middle;  // column k: of the side opposite to corner k
  for (int k = 0; k < 3; ++k) middle.col(k) = (c.col((k + 1) % 3) + c.col((k + 2) % 3)) / 2;
  std::array<Eigen::Matrix3d, 4> result;
  for (int k = 0; k < 3; ++k) {
    result[k] = middle;
    result[k].col(k) = c.col(k);
  }
  result[3] = middle;
  return result;
}

Interval range(double a, double b, double c) {
  const auto [least, largest] = std::minmax({a, b, c});
  return {std::nextafter(least, -infinity), std::nextafter(largest, infinity)};
}

}  // namespace

double TriangleDatum::distanceTo(double value) const {
  return std::sqrt(variance + (mean - value) * (mean - value)) + off;
}

DataOnTriangles::DataOnTriangles(const std::vector<Datum>& values, double t, int triangles)
    : values_(values), t_(t) {
  constexpr double evaluations = 1e6;
  deepest_ = std::clamp(
      static_cast<int>(std::log(evaluations / (4. * std::max(triangles, 1))) / std::log(4.)), 1, 6);
  for (const Datum& value : values_) along_.push_back(value.along ? value.along() : Datum::Along());
}

TriangleDatum DataOnTriangles::on(int datum, const std::array<Point, 3>& corners) const {
  const Datum& value = values_[datum];
  const Datum::Along& along = along_[datum];
  TriangleDatum result;
  Eigen::Matrix<double, 2, 3> places;
  for (int k = 0; k < 3; ++k) places.col(k) = corners[k];
  const auto at = [&](const Eigen::Vector3d& coordinates) {
    const Point x = places * coordinates;
    return value(x.x(), x.y(), t_);
  };
  if (value.constant()) {
    result.mean = at({1, 0, 0});
    result.linear.fill(result.mean);
    return result;
  }
  const auto partOf = [&](const Eigen::Matrix3d& c, double share) {
    Part part{c, share, {at(c.col(0)), at(c.col(1)), at(c.col(2))}};
    if (!along) {  // some values are known
      const auto off = [&](double a, double b, double d) {
        const Eigen::Vector3d x = a * c.col(0) + b * c.col(1) + d * c.col(2);
        part.off = std::max(part.off, std::abs(at(x) - part.values.dot(Eigen::Vector3d(a, b, d))));
      };
      off(1. / 3, 1. / 3, 1. / 3);
      off(0.5, 0.5, 0);
      off(0, 0.5, 0.5);
      off(0.5, 0, 0.5);
      return part;
    }
    const Eigen::Matrix<double, 2, 3> x = places * c;
    const Interval first = range(x(0, 0), x(0, 1), x(0, 2));
    const Interval second = range(x(1, 0), x(1, 1), x(1, 2));
    double bend = 0;
    Interval values;
    for (int k = 0; k < 3; ++k) {
      const Point by = x.col((k + 1) % 3) - x.col(k);
      Taylor u = Taylor::constant(first);
      Taylor v = Taylor::constant(second);
      u.c[1] = {by.x(), by.x()};
      v.c[1] = {by.y(), by.y()};
      const Taylor f = along(u, v, Taylor::constant({t_, t_}));
      bend = std::max(bend, 2 * f.c[2].magnitude());
      values = f.c[0];
    }
    const double byValues =
        std::max(values.largest - part.values.minCoeff(), part.values.maxCoeff() - values.least);
    part.off = std::min(byValues, 5. / 18 * bend);
    if (std::isnan(part.off)) part.off = infinity;
    // Along all ways from the centroid at once: Taylor's remainder.
    const Eigen::Vector2d centre = x.rowwise().mean();
    Taylor u = Taylor::constant(first);
    Taylor v = Taylor::constant(second);
    u.c[1] = {first.least - centre.x(), first.largest - centre.x()};
    v.c[1] = {second.least - centre.y(), second.largest - centre.y()};
    const double fifth = along(u, v, Taylor::constant({t_, t_})).c[5].magnitude();
    part.error = fifth < part.off ? fifth : part.off;
    return part;
  };
  std::vector<Part> parts{partOf(Eigen::Matrix3d::Identity(), 1)};
  const auto project = [&] {
    Eigen::Vector3d moments = Eigen::Vector3d::Zero();  // over the area
    for (const Part& part : parts) {
      for (const auto& [place, weight] : radonSeven) {
        const Eigen::Vector3d x = part.corners * Eigen::Map<const Eigen::Vector3d>(place.data());
        moments += part.share * weight * at(x) * x;
      }
    }
    const Eigen::Vector3d linear = 12 * moments.array() - 3 * moments.sum();
    for (int k = 0; k < 3; ++k) result.linear[k] = linear[k];
    double square = 0;
    double rest = 0;
    double size = 0;
    result.mean = result.variance = result.error = 0;
    for (const Part& part : parts) result.mean += part.share * part.values.mean();
    for (const Part& part : parts) {
      const Eigen::Vector3d off = part.values - part.corners.transpose() * linear;
      square += part.share * meanSquare(off);
      rest += part.share * part.off * part.off;
      result.error += 2 * part.share * part.error;
      result.variance += part.share * meanSquare(part.values.array() - result.mean);
      size = std::max(size, part.values.cwiseAbs().maxCoeff());
    }
    result.off = std::sqrt(rest);
    result.rest = std::sqrt(square) + result.off;
    return std::array{square, rest, size};
  };
  for (int depth = 0; depth < deepest_; ++depth) {
    const auto [square, rest, size] = project();
    constexpr double enough = 0.01;
    constexpr double exact = 1e-7;
    const double nothing = roundingOfMeans * roundingOfMeans * size * size;
    if (rest <= std::max(enough * square, nothing) && result.error <= exact * size) break;
    std::vector<Part> finer;
    const double little = enough / 4 * std::max(square, nothing);
    for (const Part& part : parts) {
      if (part.off * part.off <= little && part.error <= exact / 4 * size) {
        finer.push_back(part);
        continue;
      }
      for (const Eigen::Matrix3d& quarter : quarters(part.corners))
        finer.push_back(partOf(quarter, part.share / 4));
    }
    parts = std::move(finer);
  }
  project();
  result.known = std::isfinite(result.rest);
  if (result.rest <=
      roundingOfMeans * std::sqrt(meanSquare({result.linear[0], result.linear[1], result.linear[2]})))
    result.rest = 0;
  return result;
}

}  // namespace mortier
