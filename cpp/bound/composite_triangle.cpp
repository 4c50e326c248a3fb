#include "bound/composite_triangle.h"

#include <Eigen/Dense>

namespace mortier {
namespace {

/// Values of one component at the vertices of the parts: part e has side e, its first and last vertex, and
/// the centroid.
using Values = Eigen::Matrix<double, 9, 1>;
using Table = Eigen::Matrix<double, 9, 12>;

const std::array<Point, 3> referenceCorners{Point(0, 0), Point(1, 0), Point(0, 1)};

/// Outward normal times length of the way from a to b, the body to its left.
Point across(const Point& a, const Point& b) {
  return {b.y() - a.y(), -(b.x() - a.x())};
}

/// (s n) for s = (s11, s22, s12), as a matrix on s.
Eigen::Matrix<double, 2, 3> tractionMatrix(const Point& n) {
  Eigen::Matrix<double, 2, 3> result;
  result << n.x(), 0, n.y(), 0, n.y(), n.x();
  return result;
}

/// Integrals of products over the reference triangle, all three parts.
Eigen::Matrix<double, 9, 9> massMatrix() {
  Eigen::Matrix<double, 9, 9> mass = Eigen::Matrix<double, 9, 9>::Zero();
  for (int part = 0; part < 3; ++part)
    mass.block<3, 3>(3 * part, 3 * part) = (Eigen::Matrix3d::Ones() + Eigen::Matrix3d::Identity()) / 6 / 12;
  return mass;
}

struct Reference {
  Eigen::Matrix<double, 27, 12> stresses;  ///< values of the stress with given moments, by components
  std::array<Table, 3> stress;             ///< the same
  Eigen::Matrix<double, 9, 9> mass = massMatrix();
  /// Of components a, b = 00, 11, 22, 01, 02, 12: the energy of moments by a coefficient.
  std::array<MomentMatrix, 6> energies;
  std::array<MomentMatrix, 6> airyEnergies;  ///< the same by Airy modes
  Eigen::Matrix<double, 30, 12> defects;     ///< what is off in the stress of moments

  static constexpr int column(int part, int vertex, int component) {
    return 9 * component + 3 * part + vertex;
  }

  Reference() {
    Eigen::Matrix<double, 30, 27> conditions = Eigen::Matrix<double, 30, 27>::Zero();
    const Point centre = (referenceCorners[0] + referenceCorners[1] + referenceCorners[2]) / 3;
    const auto put = [&](int row, int part, int vertex, const Eigen::Matrix<double, 2, 3>& matrix) {
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 2; ++i) conditions(row + i, column(part, vertex, c)) += matrix(i, c);
    };
    int row = 0;
    for (int e = 0; e < 3; ++e) {  // moments of the sides
      const auto n = tractionMatrix(across(referenceCorners[e], referenceCorners[(e + 1) % 3]));
      for (int end = 0; end < 2; ++end, row += 2) {
        put(row, e, end, n / 3);
        put(row, e, 1 - end, n / 6);
      }
    }
    for (int e = 0; e < 3; ++e) {  // between part e and the one before, which meet at vertex e
      const auto n = tractionMatrix(across(referenceCorners[e], centre));
      const int before = (e + 2) % 3;
      put(row, e, 0, n);
      put(row, before, 1, -n);
      put(row + 2, e, 2, n);
      put(row + 2, before, 2, -n);
      row += 4;
    }
    for (int e = 0; e < 3; ++e, row += 2) {  // divergence of part e, times twice its area
      const std::array<Point, 3> x{referenceCorners[e], referenceCorners[(e + 1) % 3], centre};
      for (int k = 0; k < 3; ++k) put(row, e, k, -tractionMatrix(across(x[(k + 1) % 3], x[(k + 2) % 3])));
    }
    Eigen::Matrix<double, 30, 12> given = Eigen::Matrix<double, 30, 12>::Zero();
    given.topRows<12>().setIdentity();
    const Eigen::Matrix<double, 27, 12> all =
        Eigen::MatrixXd(conditions).colPivHouseholderQr().solve(Eigen::MatrixXd(given));
    stresses = all;
    for (int c = 0; c < 3; ++c) stress[c] = all.middleRows<9>(9 * c);
    defects = conditions * all - given;
    const MomentMatrix airy = momentsOfAiry(referenceCorners);
    const std::array<std::array<int, 2>, 6> pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
    for (int k = 0; k < 6; ++k) {
      const auto [a, b] = pairs[k];
      energies[k] = stress[a].transpose() * mass * stress[b];
      if (a != b) energies[k] += energies[k].transpose().eval();
      airyEnergies[k] = airy.transpose() * energies[k] * airy;
    }
  }
};

/// A x, a column after the other: small matrices that lie in few cache lines.
template <class Columns>
Eigen::Matrix<double, Columns::RowsAtCompileTime, 1> times(const Columns& A, const Moments& x) {
  Eigen::Matrix<double, Columns::RowsAtCompileTime, 1> result = x[0] * A.col(0);
  for (int c = 1; c < 12; ++c) result += x[c] * A.col(c);
  return result;
}

const Reference& reference() {
  static const Reference only;
  return only;
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

/// As a function of the reference triangle an Airy function has the gradient F' grad, and the stress J S.
MomentMatrix CompositeTriangle::airyEnergy() const {
  MomentMatrix A = weighted(reference_ / (J_ * J_), reference().airyEnergies);
  std::array<double, 3> along{};   // (Phi(Q) - Phi(P)) in the derivative along the normal of the reference
  std::array<double, 3> normal{};  // and the mean normal derivative
  for (int k = 0; k < 3; ++k) {
    const Point n = F_ * across(referenceCorners[k], referenceCorners[(k + 1) % 3]).normalized();
    const Point side = sideOf(k);
    const double square = side.squaredNorm();
    along[k] = n.dot(side) / square;
    normal[k] = n.dot(Point(side.y(), -side.x())) / std::sqrt(square);
  }
  const auto toModes = [&](auto&& column) {
    for (int k = 0; k < 3; ++k) {
      column(3 * k) -= along[k] * column(9 + k);
      column(3 * ((k + 1) % 3)) += along[k] * column(9 + k);
      column(9 + k) *= normal[k];
    }
    for (int i = 0; i < 3; ++i) {
      const auto x = column(3 * i + 1).eval();
      column(3 * i + 1) = F_(0, 0) * x + F_(0, 1) * column(3 * i + 2);
      column(3 * i + 2) = F_(1, 0) * x + F_(1, 1) * column(3 * i + 2);
    }
  };
  toModes([&](int c) { return A.col(c); });
  A.transposeInPlace();
  toModes([&](int c) { return A.col(c); });
  return A;
}

AiryModes CompositeTriangle::airyOf(const Moments& m) const {
  AiryModes modes = AiryModes::Zero();
  Point gradient(0, 0);
  double value = 0;
  for (int k = 0; k < 3; ++k) {
    const Point side = sideOf(k);
    const Point mean = gradient + Point(-m[4 * k + 1], m[4 * k]);
    modes[9 + k] = mean.dot(Point(side.y(), -side.x())) / side.norm();
    if (k == 2) break;
    gradient = mean + Point(-m[4 * k + 3], m[4 * k + 2]);
    value += mean.dot(side);
    modes.segment<3>(3 * k + 3) << value, gradient;
  }
  return modes;
}

double CompositeTriangle::energyOf(const Moments& m, const Point& f) const {
  Eigen::Matrix<double, 27, 1> values = times(reference().stresses, momentsInReference(m));
  if (f != Point(0, 0)) values += loadValues(f).reshaped();
  double energy = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      const auto a = values.segment<9>(9 * i);
      const auto b = values.segment<9>(9 * j);
      double product = a.dot(b);
      for (int part = 0; part < 9; part += 3)
        product += (a[part] + a[part + 1] + a[part + 2]) * (b[part] + b[part + 1] + b[part + 2]);
      energy += (i == j ? 1 : 2) * reference_(i, j) * product;
    }
  return energy / 72;
}

Moments CompositeTriangle::momentsOf(const Stress& stress) const {
  Moments result;
  for (int e = 0; e < 3; ++e) {
    const Point t = tractionMatrix(across(x_[e], x_[(e + 1) % 3])) * stress;
    result.segment<2>(4 * e) = t / 2;
    result.segment<2>(4 * e + 2) = t / 2;
  }
  return result;
}

Moments CompositeTriangle::momentsOfLoad(const Point& f) const {
  const Point centre = (x_[0] + x_[1] + x_[2]) / 3;
  Moments result;
  for (int e = 0; e < 3; ++e) {
    const std::array<Point, 2> ends{x_[e] - centre, x_[(e + 1) % 3] - centre};
    const auto n = tractionMatrix(across(x_[e], x_[(e + 1) % 3]));
    const auto traction = [&](const Point& y) -> Point {
      return n * Stress(-f.x() * y.x(), -f.y() * y.y(), 0);
    };
    for (int end = 0; end < 2; ++end)
      result.segment<2>(4 * e + 2 * end) = traction(ends[end]) / 3 + traction(ends[1 - end]) / 6;
  }
  return result;
}

/// Components of the reference triangle by vertices of the parts.
Eigen::Matrix<double, 9, 3> CompositeTriangle::loadValues(const Point& f) const {
  const Point centre = (x_[0] + x_[1] + x_[2]) / 3;
  const Eigen::Matrix3d toReference = fromReference_.inverse();
  Eigen::Matrix<double, 9, 3> values;
  for (int part = 0; part < 3; ++part)
    for (int k = 0; k < 3; ++k) {
      const Point y = k == 2 ? Point(0, 0) : Point(x_[(part + k) % 3] - centre);
      values.row(3 * part + k) = (toReference * Stress(-f.x() * y.x(), -f.y() * y.y(), 0)).transpose();
    }
  return values;
}

Moments CompositeTriangle::loadProduct(const Point& f) const {
  const Eigen::Matrix<double, 9, 3> weighted = reference().mass * loadValues(f) * reference_;
  Moments moments = Moments::Zero();
  for (int c = 0; c < 3; ++c) moments += reference().stress[c].transpose() * weighted.col(c);
  Moments result;
  for (int i = 0; i < 6; ++i) result.segment<2>(2 * i) = inverse_.transpose() * moments.segment<2>(2 * i);
  return result;
}

AiryModes CompositeTriangle::airyLoadProduct(const Point& f) const {
  return momentsOfAiry(x_).transpose() * loadProduct(f);
}

double CompositeTriangle::loadEnergy(const Point& f) const {
  const Eigen::Matrix<double, 9, 3> values = loadValues(f);
  return values.cwiseProduct(reference().mass * values * reference_).sum();
}

Moments CompositeTriangle::momentsInReference(const Moments& m) const {
  Moments result;
  for (int i = 0; i < 6; ++i) result.segment<2>(2 * i) = inverse_ * m.segment<2>(2 * i);
  return result;
}

std::array<Stress, 9> CompositeTriangle::stressOf(const Moments& m, const Point& f) const {
  Eigen::Matrix<double, 9, 3> values = loadValues(f);
  const Moments moments = momentsInReference(m);
  for (int c = 0; c < 3; ++c) values.col(c) += reference().stress[c] * moments;
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
  const auto turned = [](const Point& v) { return Point(v.y(), -v.x()); };  // J
  for (int k = 0; k < 3; ++k) {
    const int last = (k + 1) % 3;
    const Point side = corners[last] - corners[k];
    const double length = side.norm();
    Eigen::Matrix<double, 2, 12> mean = Eigen::Matrix<double, 2, 12>::Zero();
    mean.col(3 * k) = -turned(side) / (length * length);
    mean.col(3 * last) = turned(side) / (length * length);
    mean.col(9 + k) = turned(turned(side)) / length;
    result.middleRows<2>(4 * k) += mean;
    result.middleRows<2>(4 * k + 2) -= mean;
    for (int c = 0; c < 2; ++c) {
      result.block<2, 1>(4 * k, 3 * k + 1 + c) -= turned(Point::Unit(c));
      result.block<2, 1>(4 * k + 2, 3 * last + 1 + c) += turned(Point::Unit(c));
    }
  }
  return result;
}

}  // namespace mortier
