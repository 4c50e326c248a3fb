// The pair that bounds the error of a state: stresses and contact pressures (s^, p^) in equilibrium with all
// loads, from tractions that are balanced triangle by triangle (side_tractions.h) and relaxed by sweeps
// (relaxation.h), and a displacement u^ that penetrates nowhere (lift.h). What makes it strict is checked.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bound/checks.h"
#include "bound/earlier_contact.h"
#include "bound/lift.h"
#include "bound/loaded_body.h"
#include "bound/matched_meshes.h"

namespace mortier {

/// Its members refer to each other.
struct Admissible {
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
  Admissible(const Model& model, const State& state, double weight = 0, const EarlierContact& earlier = {});
  Admissible(const Admissible&) = delete;
  Admissible& operator=(const Admissible&) = delete;

 private:
  std::string construct(const Model& model, const State& state, double weight, const EarlierContact& earlier);
  std::string moveGaps(const Model& model, const std::vector<SideDatum>& distances);
  void addDefect();
};

}  // namespace mortier
