#include "commands/bound_of.h"

#include <functional>
#include <new>

#include "base/interrupt.h"
#include "time/scheme.h"

namespace mortier {
namespace {

/// What a bound needs to know of a quantity.
Functional functionalOf(const Quantity& quantity, bool atPoint) {
  using Kind = Functional::Kind;
  Functional result{quantity.kind == Quantity::Kind::reaction       ? Kind::reaction
                    : quantity.kind == Quantity::Kind::contactForce ? Kind::contactForce
                                                                    : Kind::displacement,
                    quantity.body, quantity.label};
  if (!hasComponent(quantity.kind)) result.obstacle = "only forces and mean displacements have one";
  if (quantity.component == Quantity::Component::moment) {
    result.turn = 1;
    result.about = quantity.about;
  } else {
    result.direction = Point::Unit(quantity.component == Quantity::Component::x ? 0 : 1);
  }
  if (atPoint) result.obstacle = "displacements at a point have none, means of a label have";
  return result;
}

template <class Bound>
Bound found(const std::function<Bound()>& find) {
  const KeepsResult keeps;
  Bound none;
  try {
    return find();
  } catch (const Interrupted&) {
    none.obstacle = "interrupted";
  } catch (const std::bad_alloc&) {
    none.obstacle = "there is no memory for it";
  }
  return none;
}

}  // namespace

EnergyBound boundOf(const Attempt& attempt) {
  return found<EnergyBound>([&] {
    const std::vector<Quantity>& quantities = attempt.facts.quantities;
    std::vector<Functional> functionals;
    functionals.reserve(quantities.size());
    for (size_t i = 0; i < quantities.size(); ++i)
      functionals.push_back(functionalOf(quantities[i], attempt.scene().quantities[i].point.has_value()));
    return energyBound(*attempt.model, attempt.solved.state, functionals);
  });
}

StepBound stepBoundOf(const Attempt& attempt) {
  return found<StepBound>([&] {
    const StepReport& last = attempt.solved.last;
    const TimePlan& time = attempt.scene().time;
    if (!time.controlled() && last.rejections > 0) {
      StepBound none;
      none.obstacle = "step " + std::to_string(last.step) + " was cut into parts";
      return none;
    }
    const Tableau steps = last.guarded ? twoHalfSteps() : tableau(time.scheme);
    return stepBound(*attempt.model, attempt.solved.state, steps.stages.back().diagonal * last.timeStep);
  });
}

}  // namespace mortier
