// What is solved: bodies and the interfaces between them.
#pragma once

#include <vector>

#include "contact/interface.h"
#include "fem/body.h"

namespace mortier {

struct Model {
  std::vector<Body> bodies;
  std::vector<ContactInterface> interfaces;
};

enum class LinearEngine {
  multifrontal,  ///< our own, SuiteSparse where it fails
  suitesparse    ///< CHOLMOD or UMFPACK only
};

struct SolverOptions {
  double tolerance = 1e-10;  ///< material residual of a converged step [-]
  int maxIterations = 300;   ///< linear solves in one step before it is given up
  LinearEngine linear = LinearEngine::multifrontal;
  int threads = 1;
};

}  // namespace mortier
