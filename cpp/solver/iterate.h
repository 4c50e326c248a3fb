// The data of a step, and its unknowns during the iteration.
#pragma once

#include <vector>

#include "base/two_part_vector.h"
#include "solver/complementarity.h"
#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// What is asked of a step.
struct StepData {
  double time = 0;                     ///< t1: loads and prescribed displacements are taken here [s]
  double weight = 0;                   ///< time step times the scheme's diagonal coefficient [s]
  std::vector<Matrix> explicitStrain;  ///< per body, components x points; empty for none
  bool startSolved = false;            ///< the start of the step is the solution of the one before
  /// What of `explicitStrain` is a change of thermal strain, per body; empty for none.
  std::vector<Matrix> thermal = {};
  /// g at the start, per interface, by rows that follow the bodies to the end; empty: the state's
  std::vector<Vector> gap = {};
};

/// The same with the state at its start.
struct Step {
  const State& state0;
  const StepData& data;
  const std::vector<Vector>& loads;  ///< per body, nodal forces (dofs) at t1 [N/m]
  std::vector<Matrix>
      strains0;  ///< per body, B u0 + explicitStrain; empty where its law does not depend on it

  [[nodiscard]] const std::vector<Vector>& gap0() const { return data.gap.empty() ? state0.gap : data.gap; }
  [[nodiscard]] const Matrix* explicitStrain(size_t body) const {
    return data.explicitStrain.empty() ? nullptr : &data.explicitStrain[body];
  }
  /// What the strain of an iterate is added to for the total strain;
  /// null where the law does not depend on that.
  [[nodiscard]] const Matrix* strain0(size_t body) const {
    return strains0[body].size() == 0 ? nullptr : &strains0[body];
  }
};

/// Per interface and nonmortar node, whether it is held closed.
using ActiveSets = std::vector<std::vector<char>>;
/// Per interface with friction and row, the sign of t where it slips, 1 in space; 0: it sticks.
using SlipSets = std::vector<std::vector<signed char>>;

/// The unknowns of a body in a step.
struct BodyIterate {
  TwoPartVector increment;  ///< du (dofs) [m]
  Matrix stress;            ///< s
  Matrix strain;            ///< B du - explicitStrain, components x points, as of the last linearisation
};

/// The unknowns of a step.
struct Iterate {
  std::vector<BodyIterate> bodies;
  std::vector<Vector> contactForce;  ///< p per interface
  ActiveSets active;
  std::vector<Vector> frictionForce;  ///< t per interface
  SlipSets slipping;
  std::vector<std::vector<SlipDirection>> slipDirections = {};  ///< the same in space
  /// What the distances g0 change by in the step, per interface; empty where none does [m].
  std::vector<Vector> distanceChange = {};
  double largestTension =
      0;  ///< the largest negative p of the last linear solve, before it was set to 0 [N/m]
  std::vector<Vector> tieForce = {};  ///< per tie [N/m]
};

/// The sets with which a step from `state0` begins: where there was a force, or everywhere if there was none.
ActiveSets startingSets(const State& state0);

/// Nothing moved yet, contact forces and active sets as in `state0`.
Iterate startingIterate(const State& state0);

/// Adds the change of thermal strain from `state0` to its time to the data of a step.
void addThermalStrain(const Model& model, const State& state0, StepData& data);

/// Puts the change of the prescribed displacements and of the distances up to t1 into the iterate.
void prescribe(const Model& model, const Step& step, Iterate& iterate);

/// iterate.bodies[body].strain becomes B du - explicitStrain.
void updateStrain(const Model& model, const Step& step, size_t body, Iterate& iterate);

/// The largest |du| of any body [m].
double largestMotion(const Iterate& iterate);

std::vector<Vector> displacementsOf(const State& state);
/// u0 + du per body.
std::vector<Vector> displacements(const State& state0, const Iterate& iterate);

/// g = C (u0 + du) - g0 per interface: the gap of the state and what the increments add.
std::vector<Vector> gaps(const Model& model, const std::vector<Vector>& gap0, const Iterate& iterate);

/// The gaps of a solution: exactly 0 on active nodes, in place of what rounding left there.
std::vector<Vector> solvedGaps(const Model& model, const std::vector<Vector>& gap0, const Iterate& solution);

/// What distances that change do on the bodies in a step: less the means of the forces times the changes
/// [J/m].
double gapWork(const State& state0, const Iterate& solution);

/// C du - S dl per tie: what is left of its rows [m].
std::vector<Vector> jumps(const Model& model, const State& state0, const Iterate& iterate);

/// T du per interface: the slip of the step; empty where there is no friction.
std::vector<Vector> slips(const Model& model, const Iterate& iterate);

/// What friction does in a step where nodes slip or contact opens, per interface and row of T [J/m]: the mean
/// of force times slip at the beginning and the end of slip.
/// \param friction0  at the beginning of slip [N/m]
/// \param slip0, slip1  T du with the rows at the start and at the end
std::vector<Vector> frictionWork(const std::vector<Vector>& friction0, const Iterate& solution,
                                 const std::vector<Vector>& slip0, const std::vector<Vector>& slip1);

/// Whether any point of the state flows.
bool flows(const Model& model, const State& state);

}  // namespace mortier
