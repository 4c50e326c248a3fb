#include "bound/composite_triangle.h"

#include <Eigen/Dense>
#include <numbers>

namespace mortier {
namespace {

/// A x, a column after the other: small matrices that lie in few cache lines.
template <class Columns>
Eigen::Matrix<double, Columns::RowsAtCompileTime, 1> times(const Columns& A, const Moments& x) {
  Eigen::Matrix<double, Columns::RowsAtCompileTime, 1> result = x[0] * A.col(0);
  for (int c = 1; c < 12; ++c) result += x[c] * A.col(c);
  return result;
}

const CompositeReference& reference() {
  return compositeReference();
}

}  // namespace

CompositeTriangle::CompositeTriangle(const std::array<Point, 3>& corners, const Eigen::Matrix3d& compliance)
    : x_(corners) {
  F_ << x_[1] - x_[0], x_[2] - x_[0];
  J_ = F_.determinant();
  inverse_ = F_.inverse();
  const double a = F_(0, 0);
  const double b = F_(0, 1);
  const double c = F_(1, 0);
  const double d = F_(1, 1);
  Eigen::Matrix3d P;
  P << a * a, b * b, 2 * a * b,  //
      c * c, d * d, 2 * c * d,   //
      a * c, b * d, a * d + b * c;
  P /= J_;
  fromReference_ = P;
  reference_ = J_ * P.transpose().lazyProduct(compliance.lazyProduct(P).eval());
}

namespace {

MomentMatrix weighted(const Eigen::Matrix3d& C, const std::array<MomentMatrix, 6>& energies) {
  return C(0, 0) * energies[0] + C(1, 1) * energies[1] + C(2, 2) * energies[2] + C(0, 1) * energies[3] +
         C(0, 2) * energies[4] + C(1, 2) * energies[5];
}

}  // namespace

MomentMatrix CompositeTriangle::energy() const {
  const MomentMatrix inReference = weighted(reference_, reference().energies);
  MomentMatrix energy;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      energy.block<2, 2>(2 * i, 2 * j) =
          inverse_.transpose() * inReference.block<2, 2>(2 * i, 2 * j) * inverse_;
  return energy;
}

Moments CompositeTriangle::momentsOf(const Stress& stress) const {
  Moments result;
  for (int e = 0; e < 3; ++e) {
    const Point t = tractionMatrix(acrossFrom(x_[e], x_[(e + 1) % 3])) * stress;
    result.segment<2>(4 * e) = t / 2;
    result.segment<2>(4 * e + 2) = t / 2;
  }
  return result;
}

Moments CompositeTriangle::momentsOfLoad(const BodyLoad& f) const {
  const Point centre = (x_[0] + x_[1] + x_[2]) / 3;
  Moments result;
  for (int e = 0; e < 3; ++e) {
    const std::array<Point, 2> ends{x_[e] - centre, x_[(e + 1) % 3] - centre};
    const auto n = tractionMatrix(acrossFrom(x_[e], x_[(e + 1) % 3]));
    const auto traction = [&](const Point& y) -> Point {
      return n * Stress(-f.x() * y.x(), -f.y() * y.y(), 0);
    };
    for (int end = 0; end < 2; ++end)
      result.segment<2>(4 * e + 2 * end) = traction(ends[end]) / 3 + traction(ends[1 - end]) / 6;
  }
  for (int i = 0; i < 6; ++i)
    result.segment<2>(2 * i) += f[2] / J_ * F_ * reference().turnMoments.segment<2>(2 * i);
  return result;
}

Eigen::Matrix<double, 9, 3> CompositeTriangle::valuesOf(const Moments& m, const BodyLoad& f) const {
  const Eigen::Matrix<double, 27, 1> all = times(reference().stresses, momentsInReference(m));
  Eigen::Matrix<double, 9, 3> values = Eigen::Map<const Eigen::Matrix<double, 9, 3>>(all.data());
  if (f.isZero(0)) return values;
  const Point centre = (x_[0] + x_[1] + x_[2]) / 3;
  const Eigen::Matrix3d toReference = fromReference_.inverse();
  for (int part = 0; part < 3; ++part)
    for (int k = 0; k < 3; ++k) {
      const Point y = k == 2 ? Point(0, 0) : Point(x_[(part + k) % 3] - centre);
      values.row(3 * part + k) += (toReference * Stress(-f.x() * y.x(), -f.y() * y.y(), 0)).transpose();
    }
  for (int c = 0; c < 3; ++c) values.col(c) += f[2] / J_ * reference().turn.segment<9>(9 * c);
  return values;
}

Moments CompositeTriangle::loadProduct(const BodyLoad& f) const {
  const Eigen::Matrix<double, 9, 3> weighted = reference().mass * valuesOf(Moments::Zero(), f) * reference_;
  Moments moments = Moments::Zero();
  for (int c = 0; c < 3; ++c)
    moments += reference().stresses.middleRows<9>(9 * c).transpose() * weighted.col(c);
  Moments result;
  for (int i = 0; i < 6; ++i) result.segment<2>(2 * i) = inverse_.transpose() * moments.segment<2>(2 * i);
  return result;
}

AiryModes CompositeTriangle::airyLoadProduct(const BodyLoad& f) const {
  return momentsOfAiry(x_).transpose() * loadProduct(f);
}

double CompositeTriangle::energyOf(const Moments& m, const BodyLoad& f) const {
  const Eigen::Matrix<double, 9, 3> values = valuesOf(m, f);
  return values.cwiseProduct(reference().mass.lazyProduct(values.lazyProduct(reference_).eval())).sum();
}
double CompositeTriangle::loadEnergy(const BodyLoad& f) const {
  return energyOf(Moments::Zero(), f);
}

AiryModes CompositeTriangle::airyOf(const Moments& m) const {
  AiryModes modes;
  double value = 0;
  Point gradient(0, 0);
  for (int k = 0; k < 3; ++k) {
    const Point side = x_[(k + 1) % 3] - x_[k];
    const Point mean(gradient.x() - m[4 * k + 1], gradient.y() + m[4 * k]);
    modes.segment<3>(3 * k) << value, gradient;
    modes[9 + k] = cross(mean, side) / side.norm();
    gradient = {mean.x() - m[4 * k + 3], mean.y() + m[4 * k + 2]};
    value += mean.dot(side);
  }
  return modes;
}

/// As a function of the reference triangle an Airy function has the gradient F' grad, and the stress J S.
MomentMatrix CompositeTriangle::airyEnergy() const {
  constexpr double slope = std::numbers::sqrt2 / 2;
  const std::array<Point, 3> normals{Point(0, -1), Point(slope, slope), Point(-1, 0)};  // of the reference
  MomentMatrix K = weighted(reference_ / (J_ * J_), reference().airyEnergies);
  for (int half = 0; half < 2; ++half) {  // columns, then rows
    for (int k = 0; k < 3; ++k) {
      const Point side = x_[(k + 1) % 3] - x_[k];
      const Point normal = F_ * normals[k];
      // The derivative along the normal of the reference by (Phi(Q) - Phi(P)) and the mean derivative.
      const double along = normal.dot(side) / side.squaredNorm();
      K.col(3 * k) -= along * K.col(9 + k);
      K.col(3 * ((k + 1) % 3)) += along * K.col(9 + k);
      K.col(9 + k) *= cross(normal, side) / side.norm();
    }
    for (int i = 0; i < 3; ++i)
      K.middleCols<2>(3 * i + 1) = K.middleCols<2>(3 * i + 1).lazyProduct(F_.transpose()).eval();
    K.transposeInPlace();
  }
  return K;
}

Eigen::Matrix<double, 2, 3> CompositeTriangle::nodalForces(const BodyLoad& f) const {
  return (f[2] / J_ * F_ * reference().turnForces).colwise() + J_ / 6 * f.head<2>();
}

Eigen::Matrix<double, 2, 3> CompositeTriangle::turningForce() const {
  Eigen::Matrix<double, 2, 3> result;  // J(X - centroid) has the couple 1/18 in the reference triangle
  for (int k = 0; k < 3; ++k) {
    const Point y = referenceCorners[k] - Point(1, 1) / 3;
    result.col(k) = 18 / (J_ * J_) * F_ * Point(-y.y(), y.x());
  }
  return result;
}
double CompositeTriangle::restNorm() const {
  return std::sqrt(reference_.cwiseProduct(reference().restEnergies).sum()) / J_;
}
Stress CompositeTriangle::restMean() const {
  return fromReference_ * reference().restMean;
}

Moments CompositeTriangle::momentsInReference(const Moments& m) const {
  Moments result;
  for (int i = 0; i < 6; ++i) result.segment<2>(2 * i) = inverse_ * m.segment<2>(2 * i);
  return result;
}

std::array<Stress, 9> CompositeTriangle::stressOf(const Moments& m, const BodyLoad& f) const {
  const Eigen::Matrix<double, 9, 3> values = valuesOf(m, f);
  std::array<Stress, 9> result;
  for (int i = 0; i < 9; ++i) result[i] = fromReference_ * values.row(i).transpose();
  return result;
}

double CompositeTriangle::defect(const Moments& m) const {
  const Moments moments = momentsInReference(m);
  const Eigen::Matrix<double, 30, 1> left = times(reference().defects, moments);
  return left.cwiseAbs().maxCoeff() / std::max(moments.cwiseAbs().maxCoeff(), 1e-300) *
         m.cwiseAbs().maxCoeff();
}

MomentMatrix momentsOfAiry(const std::array<Point, 3>& corners) {
  MomentMatrix result = MomentMatrix::Zero();
  const auto J = [](const Point& v) { return Point(v.y(), -v.x()); };
  for (int k = 0; k < 3; ++k) {
    const int last = (k + 1) % 3;
    const Point side = corners[last] - corners[k];
    const double length = side.norm();
    Eigen::Matrix<double, 2, 12> mean = Eigen::Matrix<double, 2, 12>::Zero();
    mean.col(3 * k) = -J(side) / (length * length);
    mean.col(3 * last) = J(side) / (length * length);
    mean.col(9 + k) = J(J(side)) / length;
    result.middleRows<2>(4 * k) += mean;
    result.middleRows<2>(4 * k + 2) -= mean;
    for (int c = 0; c < 2; ++c) {
      result.block<2, 1>(4 * k, 3 * k + 1 + c) -= J(Point::Unit(c));
      result.block<2, 1>(4 * k + 2, 3 * last + 1 + c) += J(Point::Unit(c));
    }
  }
  return result;
}

}  // namespace mortier
