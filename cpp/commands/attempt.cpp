#include "commands/attempt.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <utility>

#include "base/interrupt.h"
#include "base/ranks.h"
#include "commands/command_line.h"
#include "linear/versions.h"
#include "plan/loads.h"
#include "scene/build.h"
#include "scene/load_courses.h"
#include "scene/versions.h"
#include "time/scheme.h"

namespace mortier {
namespace {

RunFacts factsOf(const SceneDescription& scene, const AttemptOptions& options) {
  RunFacts facts;
  facts.sceneText = scene.text;
  facts.accuracy = scene.accuracy.asked();
  facts.aim = scene.accuracy.quantity;
  facts.scene = scene.path;
  facts.title = scene.title;
  facts.units = scene.units;
  facts.plane = scene.inSpace() ? "space" : word(scene.plane);
  facts.settings = scene.settings;
  facts.scheme = word(scene.time.scheme);
  facts.plannedSteps = scene.time.steps;
  facts.tolerance = scene.time.tolerance;
  facts.threads = options.threads;
  facts.solver = scene.solver;
  facts.versions = {{"mortier", version}, {"compiler", __VERSION__}};
  for (const auto& libraries : {linearLibraries(), sceneLibraries()})
    facts.versions.insert(facts.versions.end(), libraries.begin(), libraries.end());
  std::set<std::string> projections;
  for (const BodyDescription& body : scene.bodies)
    for (const MaterialDescription* material : materialsOf(body))
      if (const auto* flow = material->as<Viscoplasticity>()) projections.insert(word(flow->projection));
  std::set<std::string> nonmortars;
  for (const ContactDescription& contact : scene.contacts) {
    facts.variants.push_back(word(contact.variant));
    facts.choices.push_back(contact.choice);
    nonmortars.insert(contact.nonmortar().body);
  }
  facts.contact = joined({facts.variants.begin(), facts.variants.end()}, "none");
  facts.nonmortar = joined(nonmortars, "none");
  facts.projection = joined(projections, "none");
  return facts;
}

/// Beside the times of the scene, the courses of the data for steps that are chosen by their error.
void lookAhead(SceneDescription& scene, const Model& model) {
  if (!scene.time.controlled()) return;
  LoadCourses loads = loadCourses(scene, model);
  scene.time.breaks = std::move(loads.breaks);
  scene.time.data = std::move(loads.data);
}

/// What needs whole bodies.
std::string reasonNotToShare(const SceneDescription& scene, const Model& model) {
  if (scene.accuracy.asked() > 0) return "rounds of [accuracy] refine whole meshes";
  for (const Body& body : model.bodies)
    if (body.rigid()) return "tools are moved as a whole";
  if (scene.accuracy.bound) return "bounds are found of whole bodies";
  if (scene.inSpace()) return "bodies in space are not divided";
  if (anyFollows(model)) return "contact follows the bodies (sliding = \"finite\")";
  if (solvesSparse(model, scene.solver)) return "the contact matrices of a line this long are sparse";
  return "";
}

}  // namespace

Attempt::Attempt(ResolvedScene scene, const AttemptOptions& options) : resolved(std::move(scene)) {
  SceneDescription& description = resolved.description;
  model = std::make_unique<Model>(buildModel(resolved));
  error = std::make_unique<CurrentSpaceError>(*model, options.threads);
  description.solver.threads = options.threads;
  facts = factsOf(description, options);
  description.time.quantities = facts.quantities = buildQuantities(description, *model);
  lookAhead(description, *model);
  if (options.share) whyNotShared = reasonNotToShare(description, *model);
  if (options.share && whyNotShared.empty()) share();
  solved.state = initialState(solvedModel());
}

void Attempt::share() {
  Ranks& ranks = Ranks::all();
  parts = std::make_unique<Model>(inParts(*model, ranks));
  for (Quantity& quantity : resolved.description.time.quantities) quantity = ofParts(quantity, *parts);
  if (!ranks.first()) {
    model = std::move(parts);
    error = std::make_unique<CurrentSpaceError>(*model);
  }
  ranks.releaseFreeMemory();
}

namespace {

/// A quantity as a bound takes it.
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
