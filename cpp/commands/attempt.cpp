#include "commands/attempt.h"

#include <utility>

#include "base/ranks.h"
#include "commands/command_line.h"
#include "linear/versions.h"
#include "plan/loads.h"
#include "scene/build.h"
#include "scene/load_courses.h"
#include "scene/versions.h"

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
    nonmortars.insert(contact.nonmortar.body);
  }
  facts.contact = joined({facts.variants.begin(), facts.variants.end()}, "none");
  facts.nonmortar = joined(nonmortars, "none");
  facts.projection = joined(projections, "none");
  return facts;
}

/// Beside the times of the scene, what its steps need to know of its data where they are chosen by their
/// error.
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
  state = initialState(solvedModel());
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

}  // namespace mortier
