#include "commands/attempt.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>

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

/// Nothing that is not finite may end the run: it is no bound.
void requireFinite(std::initializer_list<double> numbers, std::string& obstacle) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](double each) { return std::isfinite(each); }))
    obstacle = "it is not finite";
}
void requireFinite(EnergyBound& bound) {
  requireFinite({bound.bound, bound.stress, bound.flow, bound.lift, bound.gap, bound.norm, bound.oscillation,
                 bound.strain, bound.strainNorm},
                bound.obstacle);
  for (Enclosure& each : bound.quantities) {
    if (each.obstacle.empty()) requireFinite({each.lower, each.upper}, each.obstacle);
    if (each.estimate && !std::isfinite(*each.estimate)) each.estimate.reset();
    if (!bound.obstacle.empty()) each = {bound.obstacle};
  }
}

void requireFinite(FlowBound& bound) {
  requireFinite({bound.strain, bound.stress, bound.strainNorm, bound.stressNorm, bound.data}, bound.obstacle);
}
void requireFinite(TotalBound& bound) {
  requireFinite({bound.fixed.strain, bound.fixed.stress, bound.any.strain, bound.any.stress, bound.lifted,
                 bound.strainNorm, bound.stressNorm, bound.data},
                bound.obstacle);
}

template <class Bound>
Bound found(const std::function<Bound()>& find) {
  const KeepsResult keeps;
  Bound none;
  try {
    Bound bound = find();
    requireFinite(bound);
    return bound;
  } catch (const Interrupted&) {
    none.obstacle = "interrupted";
  } catch (const std::exception& error) {
    none.obstacle = reasonOf(error);
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

EnergyBound stepBoundOf(const Attempt& attempt) {
  return found<EnergyBound>([&] {
    const StepReport& last = attempt.solved.last;
    const TimePlan& time = attempt.scene().time;
    if (!time.controlled() && last.rejections > 0) {
      EnergyBound none;
      none.obstacle = "step " + std::to_string(last.step) + " was cut into parts";
      return none;
    }
    const Tableau steps = last.guarded ? twoHalfSteps() : tableau(time.scheme);
    return energyBound(*attempt.model, attempt.solved.state, {},
                       steps.stages.back().diagonal * last.timeStep);
  });
}

FlowBound flowBoundOf(const FlowBoundRecord& record, const State& state) {
  return found<FlowBound>([&] { return record.atEnd(state); });
}

TotalBound totalBoundOf(const TotalBoundRecord& record, const State& state, const FlowBound& steps) {
  return found<TotalBound>([&] { return record.atEnd(state, steps); });
}

}  // namespace mortier
