// The pair that bounds the error of a state: stresses and contact pressures (s^, p^) in equilibrium with all
// loads, from tractions that are balanced triangle by triangle (side_tractions.h) and relaxed by sweeps
// (relaxation.h), and a displacement u^ that penetrates nowhere (lift.h). What makes it strict is checked.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bound/checks.h"
#include "bound/lift.h"
#include "bound/loaded_body.h"
#include "bound/matched_meshes.h"

namespace mortier {

/// Contact at an earlier time, which has to go on: no gap may be smaller, nothing may press that did not.
/// Empty where it need not.
struct EarlierContact {
  std::vector<std::array<double, 2>> gaps;  ///< at begin and end of each piece [m]
  std::vector<Vector> pressures;            ///< coefficients of p^
};

/// Its members refer to each other.
struct Admissible {
  const Model& model;
  std::string obstacle;  ///< why there is none; empty where there is
  MatchedMeshes meshes;
  std::vector<LoadedBody> bodies;  ///< balanced: they have s^
  std::vector<Vector> spread;      ///< coefficients of p^ (pressures.h)
  Lift lifting;                    ///< u^
  Strictness strictness;
  std::string beyondLinear;  ///< the first of the data that is not linear on sides, or constant on triangles
  double opens = 1;          ///< G of u^ is at least this part of the linear one
  double defect = 0;  ///< bound of the energy norm of stresses that carry what rounding leaves [sqrt(J/m)]

  /// \param weight  time step times the scheme's diagonal coefficient, of bodies that flow [s]
  /// \throws Interrupted
  Admissible(const Model& of, const State& state, double weight = 0, const EarlierContact& earlier = {});
  /// The obstacle that model and data are, whatever the solution: the time is that of the state.
  static std::string foreseen(const Model& model, const State& state, double weight);
  Admissible(const Admissible&) = delete;
  Admissible& operator=(const Admissible&) = delete;

 private:
  explicit Admissible(const Model& of) : model(of) {}
  std::string place(const State& state, double weight, std::vector<SideDatum>& distances);
  std::string construct(const State& state, double weight, const EarlierContact& earlier);
  std::string moveGaps(const std::vector<SideDatum>& distances);
  void addDefect();
};

}  // namespace mortier
