// What a quantity asks of the pair z, (t, q) by which it is enclosed (quantity_bound.h): boundary values of
// z, the load l of t, and the jump r that [z.n] shall have.
#pragma once

#include <string>
#include <vector>

#include "bound/functional.h"
#include "bound/lift.h"
#include "bound/loaded_body.h"
#include "bound/matched_meshes.h"

namespace mortier {

struct AdmissiblePair {
  const Model& model;
  const MatchedMeshes& meshes;
  const std::vector<LoadedBody>& bodies;  ///< balanced: they have s^
  const std::vector<Vector>& spread;      ///< coefficients of p^ (pressures.h)
  const Lift& lifting;                    ///< u^
  double opens = 1;                       ///< G of u^ is at least this part of that in `lifting`
};

/// What is asked of z and t.
struct Goal {
  std::vector<Vector> held;   ///< boundary values of z by bodies (dofs)
  std::vector<Vector> loads;  ///< l by bodies (dofs)
  Vector r;                   ///< by facing vertices
  Point traction{0, 0};       ///< that is l, on the label [1/m]
  int triangle = -1;          ///< the same, on a triangle [1/m^2]
  Point force{0, 0};
  std::string obstacle;
};

/// Of a mean pressure r shall be continuous, and its weight may jump: p is nowhere negative, so the exact
/// value is between those of an r that is nowhere above the weight, and of one that is nowhere below.
enum class Against { below, above };

Goal goalOf(const AdmissiblePair& pair, const Functional& functional, Against side = Against::below);

}  // namespace mortier
