// What is measured between two surfaces at the points of their common refinement.
#include <algorithm>

#include "contact/interface.h"

namespace mortier {

double ContactInterface::interpenetration(const Vector& uNonmortar, const Vector& uMortar, double t) const {
  if (dimension_ == 2) return penetration_.of(uNonmortar, uMortar, nodalGap(t));
  const Matrix jump = points_.jump(uNonmortar, uMortar);
  const Vector apart = pointDistances(t);
  double sum = 0;
  for (Eigen::Index i = 0; i < jump.cols(); ++i)
    sum += points_.areas[i] * std::max(0.0, points_.normals[i].dot(jump.col(i)) - apart[i]);
  return sum;
}

Vector ContactInterface::pointDistances(double t) const {
  return distanceMoves() ? Vector(points_.traces[0] * nodalGap(t)) : points_.distances;
}

Matrix ContactInterface::SurfacePoints::jump(const Vector& uNonmortar, const Vector& uMortar) const {
  const auto byNodes = [](const Vector& u) { return u.reshaped(3, u.size() / 3).transpose(); };
  return (traces[0] * byNodes(uNonmortar) - traces[1] * byNodes(uMortar)).transpose();
}

}  // namespace mortier
