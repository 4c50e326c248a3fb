// What is solved: bodies and the interfaces between them.
#pragma once

#include <string>
#include <vector>

#include "contact/tie.h"
#include "fem/body.h"
#include "linear/condensing_solver.h"

namespace mortier {

struct Model {
  std::vector<Body> bodies;
  /// Those that follow the bodies change as the bodies move (StepTaker), which is no change of the model.
  mutable std::vector<ContactInterface> interfaces;
  std::vector<Tie> ties;
};

/// Whether any interface has friction.
bool anyFriction(const Model& model);
/// Whether the rows of any interface follow the bodies.
bool anyFollows(const Model& model);
/// Lets them follow to these displacements (ContactInterface::follow).
void follow(const Model& model, const std::vector<Vector>& u, bool keepRows = false);
/// Whether the distance of any interface changes in time.
bool anyDistanceMoves(const Model& model);

/// Whether the supports of a body leave no more than rounding of a direction at a node.
bool holds(const Body& body, int node, const SpacePoint& direction);

/// Adds an interface between bodies of the model; which nodes their supports hold is taken from them.
/// \throws InputError
void addInterface(Model& model, const ContactPair& pair, InterfaceOptions options = {});
/// Adds a tie. \param offset  the third body, -1 for none \throws InputError
void addTie(Model& model, const ContactPair& pair, TieOptions options = {}, int offset = -1);

enum class LinearEngine {
  multifrontal,  ///< our own, SuiteSparse where it fails
  suitesparse,   ///< CHOLMOD or UMFPACK only
  single  ///< our own in single precision, what it leaves corrected; in double precision where it fails
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
  /// With friction, look for all solutions of the contact problem of every step (friction.h).
  bool listSolutions = false;
  /// Without friction, contact is solved without dense matrices (sparse_contact.h) where the cube of the
  /// number of its conditions is more than so many times the number of equations of the bodies.
  double denseWork = 8e4;
  // Where two methods begin; their results do not depend on it.
  double proximalWeight = 1e-9;  ///< solver/complementarity.h [-]
  double firstOverstress = 100;  ///< of the interior point method, in yield stresses, far beyond any [-]
};

/// Of a body: large linear bodies in space have factors in single precision, as corrections with them cost
/// little, and those that have a symmetric tangent where the options demand it.
LinearEngine engineOf(const Model& model, const Body& body, const SolverOptions& options);

/// A solver of that engine, or the engine of all processes.
std::unique_ptr<CondensingSolver> newSolver(LinearEngine engine, const SparsePattern& pattern,
                                            const std::vector<int>& kept, Threads& threads);

/// Whether contact is solved without dense matrices over its conditions.
bool solvesSparse(const Model& model, const SolverOptions& options);
bool solvesSparse(double conditions, double equations, bool rough, const SolverOptions& options);

// How many threads work on a model.

/// Threads that are worth their start, at most so many.
inline int threadsFor(const Model& model, int most) {
  constexpr size_t trianglesWorthThreads = 30000;
  constexpr size_t trianglesOfTetrahedron = 30;  // of as much work, fill of the factor included
  size_t triangles = 0;
  for (const Body& body : model.bodies)
    triangles += (body.space() != nullptr ? trianglesOfTetrahedron : 1) * body.elements();
  return triangles >= trianglesWorthThreads ? most : 1;
}

}  // namespace mortier
