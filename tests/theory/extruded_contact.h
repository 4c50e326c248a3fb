// The contact with a known end in space: extruded, in plane strain.
#pragma once

#include <algorithm>

#include "fem/tetrahedron.h"
#include "material/deviatoric.h"
#include "mesh/shape.h"
#include "theory/half_open_contact.h"

namespace mortier::scenes {

inline Datum steady(double value) {
  return [value](const SpacePoint&, double) { return value; };
}
inline Datum growing(double value) {
  return [value](const SpacePoint&, double t) { return value * t; };
}

/// Adds the energy of the error of a stress in space, squared, and that of the exact one.
inline void addSpaceEnergies(const Body& body, const Matrix& stress,
                             const std::function<SpaceStress(const SpacePoint&)>& exact, double& error,
                             double& norm) {
  const std::vector<SpaceRulePoint> rule = tetrahedronRule();
  const TetrahedronMesh& mesh = body.space()->mesh();
  const int points = body.pointsOfTriangle();
  for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto first = static_cast<Eigen::Index>(points * t);
    const double volume = body.weights()[first] * points;
    for (const auto& [at, weight] : rule) {
      const std::array<double, 4> b{1 - at.sum(), at.x(), at.y(), at.z()};
      SpacePoint x = SpacePoint::Zero();
      for (int k = 0; k < 4; ++k) x += b[k] * mesh.vertices[mesh.tetrahedra[t][k]];
      Matrix both(6, 2);
      both.col(0) = exact(x);
      both.col(1) = -both.col(0);
      for (int q = 0; q < points; ++q) {
        constexpr double far = QuadraticTetrahedron::far;
        const double shape = points == 1 ? 1 : (b[q] - far) / (QuadraticTetrahedron::near - far);
        both.col(1) += shape * stress.col(first + q);
      }
      Matrix strain;
      body.material().elasticStrain(both, strain);
      norm += 6 * weight * volume * both.col(0).dot(strain.col(0));
      error += 6 * weight * volume * both.col(1).dot(strain.col(1));
    }
  }
}

/// (s11, s22, s12) of the plane of x and z, in plane strain along y.
inline SpaceStress extruded(const Eigen::Vector3d& s, double poisson) {
  return fromSpaceCartesian(SpaceStress{s[0], poisson * (s[0] + s[1]), s[1], 0, s[2], 0});
}

struct Extruded {
  Elasticity elasticity;
  bool mirrored = false;
  [[nodiscard]] HalfOpenContact plane() const { return {elasticity, mirrored, Plane::strain}; }

  [[nodiscard]] SpaceStress stress(const SpacePoint& x) const {
    return extruded(plane().stress(x.x(), x.z()), elasticity.poisson);
  }

  [[nodiscard]] TetrahedronMesh mesh(int cells) const {
    const double lower = mirrored ? -1 : 0;
    const int across = (cells + 1) / 2;
    const double depth = 0.25;
    return cuboidMesh({{-0.9, 0, lower}, {1.1, depth, lower + 1}, {cells, std::max(1, cells / 8), across}});
  }

  [[nodiscard]] Body body(TetrahedronMesh tetrahedra, int degree) const {
    constexpr int front = 5;
    constexpr int back = 6;
    const HalfOpenContact exact = plane();
    const auto displacement = [exact](int component) {
      return [=](const SpacePoint& x, double t) { return t * exact.displacement(x.x(), x.z())[component]; };
    };
    const auto traction = [exact](int component, double sign) {
      return [=](const SpacePoint& x, double t) { return sign * t * exact.stress(x.x(), x.z())[component]; };
    };
    const int held = mirrored ? bottom : top;
    return {mirrored ? "lower" : "upper", std::move(tetrahedra), elasticMaterial(elasticity, Plane::none),
            Conditions{{{held, alongX, displacement(0)},
                        {held, alongZ, displacement(1)},
                        {front, alongY, steady(0)},
                        {back, alongY, steady(0)}},
                       {{right, alongX, traction(0, 1)},
                        {right, alongZ, traction(2, 1)},
                        {left, alongX, traction(0, -1)},
                        {left, alongZ, traction(2, -1)}}},
            degree};
  }
};

}  // namespace mortier::scenes
