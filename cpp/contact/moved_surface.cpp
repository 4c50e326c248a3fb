// The surface of a body that displacements have moved.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <map>

#include "contact/surface.h"

namespace mortier {
namespace {

/// Of the trace at corner k of a triangle: its derivatives along both sides from there.
std::array<SpacePoint, 2> derivativesAt(int k, int degree, const std::array<SpacePoint, 6>& u) {
  std::array<SpacePoint, 2> result;
  for (const int side : {0, 1}) {
    const int other = (k + 1 + side) % 3;
    const SpacePoint& middle = u[side == 0 ? 3 + k : 3 + other];
    result[side] = degree == 1 ? SpacePoint(u[other] - u[k]) : SpacePoint(4 * middle - 3 * u[k] - u[other]);
  }
  return result;
}

}  // namespace

ContactSurface ContactSurface::moved(const Vector& u, const FixedDirections& fixed) const {
  constexpr double symmetric = 1e-9;
  ContactSurface result = *this;
  result.planar = false;
  result.area = 0;
  result.turns.clear();
  std::map<PartVertex, SpacePoint> sums;
  for (size_t t = 0; t < triangles.size(); ++t) {
    const auto& x = places[t];
    std::array<SpacePoint, 6> motion;
    for (int k = 0; k < perTriangle(); ++k) motion[k] = u.segment<3>(3 * triangles[t][k]);
    for (int k = 0; k < 3; ++k) result.places[t][k] += motion[k];
    const auto& moved = result.places[t];
    const SpacePoint twice = (moved[1] - moved[0]).cross(moved[2] - moved[0]);
    result.area += twice.norm() / 2;
    result.normals[t] = twice.normalized();
    std::array<Eigen::Matrix3d, 3>& turn = result.turns.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const SpacePoint first = x[(k + 1) % 3] - x[k];
      const SpacePoint second = x[(k + 2) % 3] - x[k];
      const auto [u1, u2] = derivativesAt(k, degree, motion);
      Eigen::Matrix3d before, after;
      before << first, second, normals[t];
      after << first + u1, second + u2, (first + u1).cross(second + u2).normalized();
      turn[k] = after * before.inverse();
      SurfaceNormal& normal = result.vertexNormals[t][k];
      normal.n = (turn[k].inverse().transpose() * normal.n).normalized();
      // Weights with which a sphere has its normals (Max 1999).
      const SpacePoint one = moved[(k + 1) % 3] - moved[k];
      const SpacePoint two = moved[(k + 2) % 3] - moved[k];
      const double weight = one.cross(two).norm() / (one.squaredNorm() * two.squaredNorm());
      if (normal.known)
        sums.try_emplace({triangles[t][k], parts[t]}, SpacePoint::Zero()).first->second += weight * normal.n;
    }
    for (int k = 0; k < 3; ++k) {
      Side& side = result.sides_[t][k];
      for (SpacePoint* each : {&side.even, &side.odd, &side.fourth}) *each = turn[k] * *each;
      if (degree > 1) side.even += 4 * motion[3 + k] - 2 * (motion[k] + motion[(k + 1) % 3]);
    }
  }
  for (size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      SurfaceNormal& normal = result.vertexNormals[t][k];
      if (!normal.known) continue;
      SpacePoint sum = sums.at({triangles[t][k], parts[t]});
      if (fixed)
        for (const SpacePoint& d : fixed(triangles[t][k]))
          if (std::abs(vertexNormals[t][k].n.dot(d)) < symmetric) sum -= d.dot(sum) * d;
      normal.n = sum.normalized();
    }
  return result;
}

void ContactSurface::faceAlongNormals(bool own) {
  for (auto& ofTriangle : curvatures) ofTriangle.fill(own ? 0 : 1);
}

}  // namespace mortier
