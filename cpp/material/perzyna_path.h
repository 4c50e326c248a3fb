#pragma once

#include <memory>

#include "material/interior_path.h"

namespace mortier {

/// What the path needs of Perzyna's law.
struct PerzynaPathData {
  Eigen::Array3d e;        ///< eigenvalues of the elasticity tensor on p, q, r [Pa]
  Eigen::Array3d a;        ///< of the yield function [-]
  Eigen::Array3d b;        ///< a over the weights of the projection's norm [-]
  double yieldStress = 0;  ///< sigma_Y [Pa]
  double theta = 0;        ///< weight/(2 lambda) [1/Pa]
};

std::unique_ptr<InteriorPath> perzynaPath(const PerzynaPathData& law, const Matrix& stress0);

}  // namespace mortier
