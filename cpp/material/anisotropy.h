// Elasticity by any symmetric elliptic tensor E in axes of its own, for laws whose rate G is a function of
// the stress. On p, q, r (and s33 in plane strain, stress.h), or six components in space, such a
// tensor is a symmetric matrix. Orthotropic bodies have three axes, the third across the plane, and the
// compliance
//   e_i = s_i/E_i - sum_j (nu_ji/E_j) s_j,   nu_ij/E_i = nu_ji/E_j,   2 e_ij = s_ij/G_ij
// (S. G. Lekhnitskii, Anisotropic Plates, 1968).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "material/elasticity.h"

namespace mortier {

struct Orthotropy {
  std::array<double, 3> young{};    ///< E1, E2, E3 [Pa]; E3 without effect in plane stress
  std::array<double, 3> poisson{};  ///< nu12, nu13, nu23: of axis j per strain along i, stressed along i [-]
  std::array<double, 3> shear{};    ///< G12, and in space G13, G23 [Pa]
};

/// E on the components of its axes [Pa].
struct Anisotropy {
  Matrix stiffness;
  std::string name;  ///< "orthotropic", "general"
};

/// \throws InputError where the compliance is not positive, with its smallest eigenvalue.
Anisotropy anisotropyOf(const Orthotropy& orthotropy, Plane plane);

/// \param stiffness  (s11, s22, s12) of (e11, e22, 2 e12), in plane strain s33 and e33 after them, in space
/// then s13, s23 and 2 e13, 2 e23 [Pa]
/// \throws InputError unless it is symmetric and positive, with its smallest eigenvalue.
Anisotropy anisotropyOf(const Matrix& stiffness, Plane plane);

/// The same of a body whose axes are the columns, orthonormal; in the plane turned about the third one.
Anisotropy turned(const Anisotropy& anisotropy, const Eigen::Matrix3d& axes);
/// The axes turned from those of the body by an angle about the third one [rad].
Eigen::Matrix3d axesAt(double angle);
/// The tensor that has these values along three axes, by the components of a plane.
Vector alongAxes(const std::array<double, 3>& values, const Eigen::Matrix3d& axes, Plane plane);

/// E0 = c 1, c the largest eigenvalue of E: Young's modulus c without Poisson's effect.
Elasticity stiffestOf(const Anisotropy& anisotropy);

/// \param isotropic  the law with the elasticity `stiffestOf(anisotropy)`, whose rate is a function of the
/// stress alone  \param angles  by which axes are turned about the third one, point by point [rad]; none:
/// nowhere
std::shared_ptr<const Material> anisotropicMaterial(const Anisotropy& anisotropy,
                                                    std::shared_ptr<const Material> isotropic,
                                                    const std::vector<double>& angles = {});

}  // namespace mortier
