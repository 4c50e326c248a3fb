#pragma once

#include <memory>

#include "material/interior_path.h"

namespace mortier {

/// The path of plane strain: on the deviator that of Perzyna's law, where its cone is a circular one; the pressure follows
/// the strain. \param shear, bulk  E/(1+nu), E/(1-2 nu) [Pa]  \param theta  weight/(2 lambda) [1/Pa]
std::unique_ptr<InteriorPath> planeStrainPath(double shear, double bulk, double yieldStress, double theta,
                                              const Matrix& stress0);

}  // namespace mortier
