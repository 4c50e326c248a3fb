#include "commands/bound_of.h"

#include <new>

#include "base/interrupt.h"

namespace mortier {

EnergyBound boundOf(const Model& model, const State& state) {
  const KeepsResult keeps;
  EnergyBound none;
  try {
    return energyBound(model, state);
  } catch (const Interrupted&) {
    none.obstacle = "interrupted";
  } catch (const std::bad_alloc&) {
    none.obstacle = "there is no memory for it";
  }
  return none;
}

}  // namespace mortier
