// The pair that bounds the error of a state: stresses and contact pressures (s^, p^) in equilibrium with all
// loads, from tractions that are balanced triangle by triangle (side_tractions.h) and relaxed by sweeps
// (relaxation.h), and a displacement u^ that penetrates nowhere (lift.h). What makes it strict is checked.
#pragma once

#include <string>
#include <vector>

#include "bound/checks.h"
#include "bound/lift.h"
#include "bound/loaded_body.h"
#include "bound/matched_meshes.h"

namespace mortier {

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
  double gapFraction = 1;    ///< G of u^ is at least this part of the linear one
  double defect = 0;  ///< bound of the energy norm of stresses that carry what rounding leaves [sqrt(J/m)]

  /// \pre all bodies are elastic \throws Interrupted
  Admissible(const Model& of, const State& state);
  /// The obstacle that model and data are, whatever the solution: the time is that of the state.
  static std::string foreseen(const Model& model, const State& state);
  Admissible(const Admissible&) = delete;
  Admissible& operator=(const Admissible&) = delete;

 private:
  explicit Admissible(const Model& of) : model(of) {}
  std::string place(const State& state, std::vector<SideDatum>& distances);
  std::string construct(const State& state);
  std::string moveGaps(const std::vector<SideDatum>& distances);
  void addDefect();
};

}  // namespace mortier
