#include "commands/bound_of.h"

#include <functional>
#include <new>

#include "base/interrupt.h"
#include "time/scheme.h"

namespace mortier {
namespace {

/// What a bound needs to know of a quantity.
Functional functionalOf(const Quantity& quantity, const std::optional<Point>& point) {
  using Kind = Functional::Kind;
  Functional result{quantity.kind == Quantity::Kind::reaction       ? Kind::reaction
                    : quantity.kind == Quantity::Kind::contactForce ? Kind::contactForce
                    : quantity.kind == Quantity::Kind::meanPressure ? Kind::meanPressure
                                                                    : Kind::displacement,
                    quantity.body, quantity.label};
  result.part = quantity.part;
  if (!hasComponent(quantity.kind) && !quantity.part)
    result.obstacle = "only forces, mean displacements and mean pressures have one";
  if (quantity.component == Quantity::Component::moment) {
    result.turn = 1;
    result.about = quantity.about;
  } else {
    result.direction = Point::Unit(quantity.component == Quantity::Component::x ? 0 : 1);
  }
  if (point && quantity.kind == Quantity::Kind::displacement) result.point = point;
  if (point && quantity.kind == Quantity::Kind::reaction) result.obstacle = "forces at a point have none";
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
      functionals.push_back(functionalOf(quantities[i], attempt.scene().quantities[i].point));
    EnergyBound bound = energyBound(*attempt.model, attempt.solved.state, functionals);
    for (size_t i = 0; i < quantities.size(); ++i)
      if (quantities[i].kind == Quantity::Kind::largestPressure)
        bound.quantities[i].estimate =
            largestPressureError(quantities[i], *attempt.model, attempt.solved.state);
    return bound;
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
