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

/// Whether any interface has friction.
bool anyRough(const Model& model);
/// Whether the distance of any interface changes in time.
bool anyDistanceMoves(const Model& model);

/// Adds an interface between bodies of the model; which nodes their supports hold is taken from them.
/// \throws InputError
void addInterface(Model& model, const ContactPair& pair, InterfaceOptions options = {});

enum class LinearEngine {
  multifrontal,  ///< our own, SuiteSparse where it fails
  suitesparse    ///< CHOLMOD or UMFPACK only
};

enum class Method {
  newton,         ///< mixed Newton, contact by principal pivoting
  penaltyDuality  ///< the algorithm of the note: a constant matrix, multipliers for contact and material
};

/// An iteration of the second costs a fraction of one of the first.
constexpr int defaultIterations(Method method) {
  return method == Method::newton ? 4000 : 5000;
}

struct SolverOptions {
  Method method = Method::newton;
  double tolerance = 1e-10;                               ///< material residual of a converged step [-]
  int maxIterations = defaultIterations(Method::newton);  ///< linear solves in one step before it is given up
  LinearEngine linear = LinearEngine::multifrontal;
  int threads = 1;
  /// Leave out what changes nothing: factors of bodies in which nothing flows, steps in which nothing
  /// happens.
  bool reduce = true;
  /// With friction, look for all solutions of the contact problem of every step (friction_solutions.h).
  bool listSolutions = false;
  /// Without friction, contact is solved without dense matrices (sparse_contact.h) where the cube of the
  /// number of its conditions is more than so many times the number of equations of the bodies.
  double denseWork = 8e4;
  // Where two methods begin; their results do not depend on it.
  double proximalWeight = 1e-9;  ///< solver/complementarity.h [-]
  double firstOverstress = 100;  ///< of the interior point method, in yield stresses, far beyond any [-]
};

/// Whether contact is solved without dense matrices over its conditions.
bool solvesSparse(const Model& model, const SolverOptions& options);
bool solvesSparse(double conditions, double equations, bool rough, const SolverOptions& options);

}  // namespace mortier
