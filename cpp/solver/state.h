// The state of a run at one time, and what is reported of the step that led to it.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"
#include "material/material.h"

namespace mortier {

/// What was done on a body since the run began [J/m]; 0 where it is not counted (time/count_work.cpp).
struct WorkDone {
  double external = 0;    ///< by loads and supports
  double contact = 0;     ///< by other bodies
  double dissipated = 0;  ///< integral of s : G, what the body has turned into heat
  double thermal = 0;     ///< by thermal strain: minus the integral of s : its rate
};

struct BodyState {
  Vector displacement;        ///< 2 node + component [m]
  Matrix stress;              ///< components x points, basis of material/stress.h [Pa]
  Matrix viscoplasticStrain;  ///< components x points [-]
  WorkDone work = {};
  Matrix thermalStrain = {};  ///< components x points [-]; empty where the body has no temperature
};

struct State {
  double time = 0;  ///< [s]
  std::vector<BodyState> bodies;
  std::vector<Vector> contactForce;  ///< per interface and nonmortar node, p >= 0 [N/m]
  /// g per interface and nonmortar node [m], the sum of its changes: taken from the displacements anew, their
  /// rounding would open and close what is in contact.
  std::vector<Vector> gap;
  // Per interface and nonmortar node; empty where an interface has no friction.
  std::vector<Vector> frictionForce;               ///< t: what the nonmortar body exerts along the line [N/m]
  std::vector<std::vector<signed char>> slipping;  ///< sign of t where the node slipped last, 0: it stuck
  double frictionWork = 0;                         ///< dissipated by friction so far [J/m]
  std::vector<double> frictionWorkOf;              ///< the same by interfaces; 0 without friction
  double gapWork = 0;                 ///< done on the bodies so far by distances that change in time [J/m]
  std::vector<Vector> tieForce = {};  ///< per tie and row [N/m]
};

/// What the file of a state begins with, before its time (report/stored_state.h). Changes with any member.
constexpr const char* stateKind = "mortier state 1, t = ";

/// The state of the solver itself that a run needs to resume, per body; empty before the first step.
struct SolverMemory {
  std::vector<char> enginesGivenUp;  ///< of linear algebra, one after the other: how many
  std::vector<char> elasticFactors;  ///< whether the factors are those of elasticity
};

/// Residuals of a converged step, all free of units.
struct Certificate {
  double forceBalance =
      0;  ///< |F - sum |T| B' s - C' p|_inf over the largest nodal force, of the load or of a triangle
  double materialResidual =
      0;                   ///< |H^-1 r| over the yield stress or the largest stress of the body, if larger
  double gapOnActive = 0;  ///< |g| on active nodes over the largest extent or |u|, or its forces if rounding
  double openPenetration = 0;  ///< largest g of a node that is not active, over the same
  double sign = 0;             ///< largest negative contact force over the largest nodal force
  double complementarity = 0;  ///< max |p g| over (largest contact force times that length)
  /// Slip of nodes that stick, or against t, over the length of gapOnActive; t beyond its bound over that
  /// force.
  double friction = 0;
  /// What the rounding of meshes and displacements makes of stresses, over the same as materialResidual:
  /// epsilon |H^-1| |u|/h. No residual shows it.
  double rounding = 0;
};

/// Contact conditions without a force of their own.
struct SpecialConditions {
  int idle = 0;       ///< no free motion changes them, both sides are held: they stay inactive
  int dependent = 0;  ///< others imply them: the forces are one choice of many
};

/// A solution of the contact problem of a step with friction.
struct ListedSolution {
  int index = 1;        ///< sign of det A (solver/friction.h)
  double residual = 0;  ///< how far it is off its conditions, over the largest force [-]
  double contact = 0;   ///< sum of p [N/m]
  double friction = 0;  ///< sum of t [N/m]
  std::string sets;     ///< by nodes: o open, c closed (no friction), s sticks, +, - slips (sign of t)
};

/// What is known of the solutions of a step.
struct StepSolutions {
  /// Whether sets with det A < 0 were met: for some gaps and slips these bodies have several solutions.
  bool ambiguous = false;
  std::vector<ListedSolution> listed = {};  ///< where they were looked for; the first one was taken
};

enum class Status { converged, failed, unheld };

/// The method that solved a step, in the order of cost (docs/theory.md).
enum class SolutionMethod { rest, newton, continuation, interiorPoint, path, penaltyDuality, cut };

/// As in history.csv and summary.json.
const char* nameOf(SolutionMethod method);

struct StepReport {
  int step = 0;
  double time = 0;      ///< at the end of the step [s]
  double timeStep = 0;  ///< [s]
  Status status = Status::converged;
  std::string reason;                              ///< one line when the status is not converged
  SolutionMethod method = SolutionMethod::newton;  ///< the hardest of its parts
  bool guarded = false;                            ///< done again as two half steps of backward Euler
  int rejections = 0;      ///< attempts that were not good enough or could not be solved
  double estimate = 0;     ///< of the error in time so far, relative; 0 with equal steps
  int iterations = 0;      ///< linear solves with a new tangent
  int factorisations = 0;  ///< matrices factorised, all bodies
  int active = 0;          ///< active contact nodes, and how many joined and left in this step
  int joined = 0;
  int left = 0;
  double penetration = 0;   ///< integral of the positive part of the jump, all interfaces [m^2]
  double maxPressure = 0;   ///< largest contact pressure Phi^-1 p [Pa]
  double contactForce = 0;  ///< sum of nodal contact forces p >= 0, all interfaces: no resultant [N/m]
  double resultantX = 0;    ///< resultant of the contact forces on the nonmortar bodies, all interfaces [N/m]
  double resultantY = 0;
  std::optional<double> resultantZ;  ///< in space
  double vonMises = 0;               ///< largest [Pa]
  double displacement = 0;           ///< largest length [m]
  double motion = 0;                 ///< largest displacement of a body over its extent
  double energy = 0;                 ///< elastic, integral of s : E^-1 s / 2 [J/m]
  double viscoplasticFraction = 0;   ///< share of the area beyond yield
  Certificate certificate;
  std::vector<double> quantities;    ///< values of those of the plan (time/quantity.h)
  std::vector<double> frictionWork;  ///< of each interface with friction, dissipated so far [J/m]
  StepSolutions solutions;           ///< with friction
};

// The total strain of a state, for laws that depend on it.

/// E^-1 s and the viscoplastic strain [-]: since t = 0, with the elastic strain of the stress that was there.
inline Matrix totalStrain(const Material& material, const BodyState& state) {
  Matrix strain;
  material.elasticStrain(state.stress, strain);
  strain += state.viscoplasticStrain;
  return strain;
}

/// That, where the law depends on it; nothing elsewhere.
inline Matrix strainOfLaw(const Material& material, const BodyState& state) {
  return material.needsTotalStrain() ? totalStrain(material, state) : Matrix();
}

}  // namespace mortier
