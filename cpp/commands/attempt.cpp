#include "commands/attempt.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <new>
#include <utility>

#include "base/interrupt.h"
#include "commands/command_line.h"
#include "linear/distributed_engine.h"
#include "linear/versions.h"
#include "plan/loads.h"
#include "report/stored_state.h"
#include "scene/build.h"
#include "scene/load_courses.h"
#include "scene/versions.h"

namespace mortier {
namespace {

std::string planeOf(const SceneDescription& scene) {
  return scene.inSpace() ? "space" : word(scene.plane);
}

RunFacts factsOf(const SceneDescription& scene, int threads) {
  RunFacts facts;
  facts.sceneText = scene.text;
  facts.accuracy = scene.accuracy.asked();
  facts.aim = scene.accuracy.quantity;
  facts.scene = scene.path;
  facts.title = scene.title;
  facts.units = scene.units;
  facts.plane = planeOf(scene);
  facts.settings = scene.settings;
  facts.scheme = word(scene.time.scheme);
  facts.plannedSteps = scene.time.steps;
  facts.tolerance = scene.time.tolerance;
  facts.threads = threads;
  facts.solver = scene.solver;
  facts.versions = {{"mortier", version}, {"compiler", __VERSION__}};
  if (const DistributedEngine* engine = DistributedEngine::ofProgram()) {
    facts.processes = engine->processes();
    facts.versions.emplace_back("MUMPS", engine->version());
  }
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
  for (const ContactDescription& tie : scene.ties) facts.ties.push_back(wordOfTie(tie));
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

}  // namespace

State startOf(const SceneDescription& scene, const Model& model) {
  if (scene.start.empty() && !scene.after.empty())
    throw InputError(scene.path + ": expected --set start=DIR, the result of stage " + scene.after +
                         ", or mortier run without stage=, which takes all stages in turn",
                     "start");
  if (scene.start.empty()) return initialState(model);
  const auto refuse = [&](const std::string& what) {
    throw InputError(scene.startWhere + ": start = \"" + scene.start + "\": " + what, "start");
  };
  State state;
  try {
    state = beginningWith(readState(scene.start + "/" + stateName), model, scene.units, planeOf(scene));
  } catch (const InputError& error) {
    refuse(error.what());
  }
  if (state.time != scene.time.begin) refuse("damaged");
  return state;
}

Attempt::Attempt(ResolvedScene scene, int threads) : resolved(std::move(scene)) {
  SceneDescription& description = resolved.description;
  model = std::make_unique<Model>(buildModel(resolved));
  stopIfInterrupted();
  error = std::make_unique<CurrentMeshError>(*model, threads);
  stopIfInterrupted();
  description.solver.threads = threads;
  facts = factsOf(description, threads);
  description.time.quantities = facts.quantities = buildQuantities(description, *model);
  lookAhead(description, *model);
  solved.state = startOf(description, *model);
  for (size_t b = 0; b < model->bodies.size(); ++b) {
    const BodyState& begins = solved.state.bodies[b];
    model->bodies[b].holdAt(begins.displacement);
    const bool atRest = begins.displacement.isZero(0) && begins.stress.isZero(0);
    if (!description.start.empty() && atRest) facts.asDrawn.insert(model->bodies[b].name());
  }
  facts.start = description.start;
  facts.startTime = solved.state.time;
}

namespace {

/// Nothing that is not finite may end the run: it is no bound.
void requireFinite(std::initializer_list<double> numbers, std::string& obstacle) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](double each) { return std::isfinite(each); }))
    obstacle = "it is not finite";
}
void requireFinite(EnergyBound& bound) {
  requireFinite({bound.bound, bound.stress, bound.lift, bound.gap, bound.norm, bound.oscillation},
                bound.obstacle);
  for (Enclosure& each : bound.quantities) {
    if (each.obstacle.empty()) requireFinite({each.lower, each.upper}, each.obstacle);
    if (each.estimate && !std::isfinite(*each.estimate)) each.estimate.reset();
    if (!bound.obstacle.empty()) each = {bound.obstacle};
  }
}

}  // namespace

EnergyBound boundOf(const Attempt& attempt) {
  EnergyBound bound;
  try {
    const std::vector<Quantity>& quantities = attempt.facts.quantities;
    bound = energyBound(*attempt.model, attempt.solved.state, quantities);
    for (size_t i = 0; i < quantities.size(); ++i)
      if (quantities[i].kind == Quantity::Kind::largestPressure)
        bound.quantities[i].estimate =
            largestPressureError(quantities[i], *attempt.model, attempt.solved.state);
    requireFinite(bound);
  } catch (const Interrupted&) {
    bound = {};
    bound.obstacle = "interrupted";
  } catch (const std::bad_alloc&) {
    bound = {};
    bound.obstacle = "there is no memory for it";
  } catch (const std::exception& error) {
    bound = {};
    bound.obstacle = error.what();
  }
  return bound;
}

}  // namespace mortier
