// How far a quantity of the last state is off because of the meshes, estimated on these meshes alone.
//
// A reaction, a contact force, a displacement and a mean pressure are linear in the solution, and the first
// change of an energy is. With z the response of the linear problem (the bodies with the tangent of the run
// taken as one step, contact closed, sticking and slipping as it is, transposed) to the derivative of the
// quantity, and e(s), e(t) the estimated errors of the stress s and of t = E eps(z) (time/mesh_error.h),
//
//   J(u) - J(u_h) = a(u - u_h, z - z_h),    about    sum over triangles of (e(s), E^-1 e(t)),
//
// with the products of gaps of u and z on the contact line, and of data that the meshes do not resolve, as in
// the estimate of the energy. What flat sides in place of curves change is added (curve_error.h). Largest
// values, lengths and areas of contact: largest_error.h.
#pragma once

#include <string>
#include <vector>

#include "time/mesh_error.h"
#include "time/quantity.h"
#include "time/step_taker.h"

namespace mortier {

struct QuantityError {
  double size = 0;       ///< absolute
  std::string obstacle;  ///< why there is no estimate; empty where there is
  double order = 0;      ///< of a largest value: a, where stresses are unbounded there like r^-a
};

/// Takes back an estimate, unless equilibrium decides the value: its estimate is rounding then.
void withdraw(QuantityError& error, double value, const std::string& reason);

/// \param taker  at the end of the run; null where linear quantities are not asked for
/// \param begin  of the run [s]
/// \param error  of the meshes, at the last state
std::vector<QuantityError> quantityErrors(const std::vector<Quantity>& quantities, const Model& model,
                                          StepTaker* taker, double begin, CurrentMeshError& error);

}  // namespace mortier
