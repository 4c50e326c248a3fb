// Elasticity by any symmetric elliptic tensor E in axes of its own, for laws whose rate G is a function of
// the stress. On p, q, r (and s33 in plane strain, stress.h) such a tensor is a symmetric matrix. Orthotropic
// bodies have three axes, the third across the plane, and the compliance
//   e_i = s_i/E_i - sum_j (nu_ji/E_j) s_j,   nu_ij/E_i = nu_ji/E_j,   2 e_12 = s_12/G_12
// (S. G. Lekhnitskii, Anisotropic Plates, 1968).
#pragma once

#include <array>
#include <variant>

#include "material/norton.h"
#include "material/perzyna.h"
#include "material/plane_strain.h"

namespace mortier {

struct Orthotropy {
  std::array<double, 3> young{};    ///< E1, E2, E3 [Pa]; E3 in plane strain only
  std::array<double, 3> poisson{};  ///< nu12, nu13, nu23: of axis j per strain along i, stressed along i [-]
  double shear = 0;                 ///< G12 [Pa]
};

/// E on p, q, r or p, q, r, s33 of its axes [Pa].
struct Anisotropy {
  Matrix stiffness;
  std::string name;  ///< "orthotropic", "general"
};

/// \throws InputError where the compliance is not positive, with its smallest eigenvalue.
Anisotropy anisotropyOf(const Orthotropy& orthotropy, Plane plane);

/// \param stiffness  (s11, s22, s12) of (e11, e22, 2 e12), in plane strain s33 and e33 after them [Pa]
/// \throws InputError unless it is symmetric and positive, with its smallest eigenvalue.
Anisotropy anisotropyOf(const Matrix& stiffness, Plane plane);

/// The same in axes turned by -angle [rad]: what lies along axis 1 then lies at the angle.
Anisotropy turned(const Anisotropy& anisotropy, double angle);

/// The law beside elasticity; the first: none.
using StressLaw = std::variant<std::monostate, Viscoplasticity, NortonCreep>;

/// \throws InputError where Perzyna's projection in plane stress is not `frobenius`.
std::shared_ptr<const Material> anisotropicMaterial(const Anisotropy& anisotropy, const StressLaw& flow,
                                                    Plane plane);

/// A material whose axes are turned by an angle of their own at every point [rad].
std::shared_ptr<const Material> turnedMaterial(std::shared_ptr<const Material> inner,
                                               const std::vector<double>& angles);

}  // namespace mortier
