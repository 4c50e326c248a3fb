// Bodies that turn about the axis x = 0: materials, supports and meshes that the tests of them share.
#pragma once

#include <numbers>
#include <string>

#include "material/deviatoric.h"
#include "theory/shaken_square.h"

namespace mortier::scenes {

constexpr double pi = std::numbers::pi;

/// Stress of a law of three dimensions: radial, axial, shear, around the axis, as the solver has it.
inline Eigen::Vector4d ringStress(double rr, double zz, double rz, double tt) {
  Eigen::Vector4d stress;
  stress << fromCartesian({rr, zz, rz}), tt;
  return stress;
}

/// A shaken square stretched to [inner, outer] x [lower, lower + height].
inline TriangleMesh shakenSection(double inner, double outer, double lower, double height, int cells,
                                  unsigned seed) {
  TriangleMesh mesh = shakenSquare(0, cells, seed);
  for (Point& x : mesh.vertices) x = {inner + (outer - inner) * x.x(), lower + height * x.y()};
  validate(mesh);
  return mesh;
}

/// The largest error of a stress that is the same everywhere, over its largest component.
inline double errorOfUniform(const Matrix& stress, const Eigen::Vector4d& exact) {
  return (stress.colwise() - Vector(exact)).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
}

}  // namespace mortier::scenes
