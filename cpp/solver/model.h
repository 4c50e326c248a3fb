// What is solved: bodies and the interfaces between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/ranks.h"
#include "contact/interface.h"
#include "fem/body.h"
#include "linear/condensing_solver.h"

namespace mortier {

// A run distributed over several ranks: every triangle belongs to one rank, whose model has the part of each
// body made of its triangles (fem/body.h), with local numbering. Nodes shared by several ranks are identified
// by global numbers.

/// The part of a body that a rank has.
struct BodyPart {
  BodyCut cut;
  int wholePoints = 0;
  int pointsOfTriangle = 1;
  std::vector<char> own;  ///< by nodes, whether a triangle of this rank has it
  std::vector<char>
      owned;  ///< by nodes, whether this rank adds what all have of it: one of those that own it
  /// Nodes that several ranks have, ascending, and the place of each among those of all ranks: those of
  /// triangles of several, the labelled boundary, and supports.
  std::vector<int> shared;
  std::vector<int> places;
  int placesOfAll = 0;
  Matrix motions;  ///< rigid ones of the whole body, by dofs of the part

  // On the first rank alone.

  const Body* whole = nullptr;
  /// By ranks: the triangles, and the nodes that they are owned for; numbers in the whole body.
  std::vector<std::vector<int>> trianglesOf = {};
  std::vector<std::vector<int>> nodesOf = {};
};

/// By bodies, the rank of each triangle: the bodies one after the other are cut into as many equal shares as
/// there are ranks; a body of several shares is cut where few of its nodes lie. Collective.
std::vector<std::vector<int>> ownersOf(const std::vector<Body>& bodies, Ranks& ranks);

/// The part of this rank. \param owner  rank of each triangle
BodyPart partOf(const Body& whole, const std::vector<int>& owner, Ranks& ranks);

/// A nodal sum (dofs) over the triangles of each rank becomes that of all, where several have a node.
/// Collective.
void sumAtNodes(const BodyPart& part, Ranks& ranks, Vector& nodal);
/// A nodal vector (dofs) that is known where this rank owns a node becomes known at all nodes that it has.
/// Collective.
void completeAtNodes(const BodyPart& part, Ranks& ranks, Vector& nodal);
/// Nodal vectors (dofs) and columns by points, of all ranks: of the whole body on the first rank, empty on
/// others. Collective.
Vector gatheredNodes(const BodyPart& part, Ranks& ranks, const Vector& nodal);
Matrix gatheredPoints(const BodyPart& part, Ranks& ranks, const Matrix& columns);
/// The reverse, from what this rank has of the whole.
Vector nodesOfPart(const BodyPart& part, const Vector& nodal);
Matrix pointsOfPart(const BodyPart& part, const Matrix& columns);

/// Of the bodies, all of it or the parts of one rank; interfaces are whole, in the numbers of these bodies.
/// A rank has the displacements of all its nodes, and so gaps, slips and contact forces; what is summed
/// over triangles or the largest of them is that of its own.
struct Model {
  std::vector<Body> bodies;
  /// Those that follow the bodies change as the bodies move (StepTaker), which is no change of the model.
  mutable std::vector<ContactInterface> interfaces;
  std::vector<BodyPart> parts = {};  ///< of the bodies; empty where they are whole
  Ranks* ranks = nullptr;            ///< where there are parts

  [[nodiscard]] bool inParts() const { return !parts.empty(); }

  // What ranks have found becomes that of all; nothing where bodies are whole. Collective.

  void sum(double* values, size_t count) const {
    if (inParts()) ranks->sum(values, count);
  }
  [[nodiscard]] double sum(double value) const {
    sum(&value, 1);
    return value;
  }
  /// NaN counts as infinite.
  void largest(double* values, size_t count) const {
    if (!inParts()) return;
    std::replace_if(
        values, values + count, [](double value) { return std::isnan(value); }, INFINITY);
    ranks->largest(values, count);
  }
  [[nodiscard]] double largest(double value) const {
    largest(&value, 1);
    return value;
  }
  [[nodiscard]] bool any(bool own) const { return inParts() ? anyOf(*ranks, own) : own; }
  /// Of nodal sums over triangles.
  void sumAtNodes(size_t body, Vector& nodal) const {
    if (inParts()) mortier::sumAtNodes(parts[body], *ranks, nodal);
  }
  /// Points of a body, of all ranks.
  [[nodiscard]] int points(size_t body) const {
    return inParts() ? parts[body].wholePoints : bodies[body].points();
  }
};

/// The model of this rank's parts. `whole` must outlive it on the first rank. Collective.
Model inParts(const Model& whole, Ranks& ranks);

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
  /// Equations of a skeleton (linear/skeleton.h) from which on its factor is distributed.
  int distributedFrom = distributedSkeletonFrom;
  // Where two methods begin; their results do not depend on it.
  double proximalWeight = 1e-9;  ///< solver/complementarity.h [-]
  double firstOverstress = 100;  ///< of the interior point method, in yield stresses, far beyond any [-]
};

/// Of a body: large linear bodies in space have factors in single precision, as corrections with them cost
/// little, and those that have a symmetric tangent where the options demand it.
LinearEngine engineOf(const Model& model, const Body& body, const SolverOptions& options);

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
