// Two unit squares of one cell each, the lower one elastic, mortar contact between them.
#pragma once

#include "material/perzyna.h"
#include "mesh/generate.h"
#include "solver/model.h"

namespace mortier {

inline Model blocksOfOneCell() {
  Model model;
  const Elasticity elasticity{100, 0.3};
  model.bodies.emplace_back("upper", crissCrossMesh({{0, 0}, {1, 1}, 1, 1}),
                            perzynaMaterial(elasticity, {1, 1}), Conditions{});
  model.bodies.emplace_back("lower", crissCrossMesh({{0, -1}, {1, 0}, 1, 1}), elasticMaterial(elasticity),
                            Conditions{});
  model.interfaces.emplace_back(ContactPair{{0, 1}, {1, 3}, CouplingKind::mortar}, model.bodies[0].mesh(),
                                model.bodies[1].mesh());
  return model;
}

}  // namespace mortier
