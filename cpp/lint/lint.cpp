#include "lint/lint.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/digits.h"
#include "base/error.h"
#include "base/formatted.h"
#include "contact/interface.h"
#include "plan/loads.h"
#include "scene/build.h"
#include "scene/load_courses.h"
#include "scene/memory_need.h"
#include "scene/resolve.h"
#include "solver/free_rotation.h"
#include "solver/solve_step.h"
#include "time/initial_balance.h"

namespace mortier {
namespace {

/// A place that was computed: what is rounding beside the size of a body is 0.
std::string computedPlace(const Point& place, double size) {
  constexpr double rounding = 1e-12;
  return placeText((place.array().abs() < rounding * size).select(Point(0, 0), place));
}

/// How deep the bodies of a contact overlap, as meshed or as its gap says:
/// what is pressed together is no accident.
double interferenceOf(const ContactDescription& contact, const LintInput& input) {
  const auto side = [&](const SideDescription& description) {
    return ContactSide{bodyIndex(input.scene, description.body), description.label};
  };
  const ContactPair pair{side(contact.nonmortar()), side(contact.mortar()), contact.variant};
  const TriangleMesh* one = input.meshes[pair.nonmortar.body];
  const TriangleMesh* two = input.meshes[pair.mortar.body];
  if (one == nullptr || two == nullptr) return 0;
  InterfaceOptions options;
  options.initial = contact.initial;
  if (contact.gap) options.gap = contact.gap->value;
  try {
    requireMemory({one, two}, {{{0, pair.nonmortar.label}, {1, pair.mortar.label}, pair.coupling}},
                  input.scene.degree, {contact.friction.any()}, input.scene.solver);
    return std::max(0.0, -ContactInterface(pair, *one, *two, options).initialDistance().minCoeff());
  } catch (const InputError&) {
    return 0;  // named elsewhere
  }
}

/// Warnings that say nothing beside what causes them.
void dropConsequences(Faults& faults) {
  static const std::vector<std::string> ofLoads{
      "no-load",        "yields-at-once", "large-strain",          "large-displacement",
      "large-rotation", "never-yields",   "few-steps-across-yield"};
  static const std::vector<std::pair<std::string, std::vector<std::string>>> consequences{
      {"missing-label", ofLoads},
      {"data", ofLoads},
      {"contact-penetration", {"bodies-overlap"}},
      {"contact-missing", {"body-alone"}},
      {"bodies-overlap", {"body-alone"}}};
  for (const auto& [cause, others] : consequences)
    if (faults.has(cause))
      for (const std::string& id : others) faults.drop(id);
}

void runChecks(const LintInput& input, Faults& faults) {
  lintMeshes(input, faults);
  lintLabels(input, faults);
  lintBodies(input, faults);
  lintContacts(input, faults);
  lintDeformations(input, faults);
  lintMaterials(input, faults);
  lintLoads(input, faults);
  lintTime(input, faults);
  for (const std::string& id : input.scene.allowed) {
    const auto& kinds = faultKinds();
    if (std::none_of(kinds.begin(), kinds.end(), [&](const FaultKind& kind) { return kind.id == id; }))
      faults.add("allow-unknown", input.where({"check", "allow"}), "no fault is called " + id);
  }
}

/// Where contact alone holds bodies, whether it does: as the first step begins, and elastically at some times
/// of the run. What contact can balance depends on no material.
void requireHeld(const SceneDescription& scene, const Model& model) {
  StepSystem system(model, scene.solver);
  if (!system.contactHolds()) return;
  constexpr int count = 16;
  const TimePlan& plan = scene.time;
  const State begin = initialState(model);
  const double first = plan.end / (plan.steps > 0 ? plan.steps : 100);
  for (int i = actsAtOnce(model, begin) ? -1 : 0; i <= count; ++i) {
    const double time = i < 0 ? 0 : i == 0 ? first : plan.end * i / count;
    Iterate iterate = startingIterate(begin);
    StepData data{time, 0, {}};
    addThermalStrain(model, begin, data);
    const StepOutcome outcome = solveStep(system, begin, data, iterate);
    const std::string loose = outcome.converged() && i == 0 ? system.looseMotion(begin, iterate) : "";
    const std::string reason = outcome.unheld() ? outcome.detail
                               : loose.empty()  ? ""
                                                : "no closed contact holds " + loose;
    if (!reason.empty())
      throw UnheldBodyError("t = " + shortest(time) + " " + scene.units.time + ": " + reason);
  }
}

/// The scene as its run solves it: beside an accuracy bodies that flow have steps that are chosen by their
/// error, whatever the scene says of equal ones.
SceneDescription asSolved(SceneDescription scene) {
  scene.time.tolerance = stepTolerance(scene);
  return scene;
}

/// The input of the checks, with what several of them use.
LintInput inputOf(const SceneDescription& scene, std::vector<const TriangleMesh*> meshes) {
  LintInput input{{scene, std::move(meshes)}, {}};
  for (const TriangleMesh* mesh : input.meshes)
    input.topologies.push_back(mesh != nullptr ? topologyOf(*mesh) : Topology());
  for (const ContactDescription& contact : scene.contacts)
    input.interference.push_back(interferenceOf(contact, input));
  return input;
}

/// What only the model can say: data where they are used, and whether everything is held.
void build(ResolvedScene resolved, LintReport& report) {
  const SceneDescription& scene = resolved.description;
  try {
    Model model = buildModel(resolved);
    static_cast<void>(buildQuantities(scene, model));
    lintModel(asSolved(scene), model, report.faults);
    if (!scene.goesOn()) requireHeld(scene, model);  // from bodies at rest
    lintSettling(scene, findInitialEquilibrium(scene, model, initialState(model)), report.faults);
    report.model = std::move(model);
  } catch (const InputError& error) {
    addError(error, "data", report.faults);
  } catch (const UnheldBodyError& error) {
    report.faults.add("unheld-body", scene.path, error.what());
  }
}

void checkInSpace(const ResolvedScene& resolved, Faults& faults) {
  lintMeshes(resolved.spaceMeshes, faults);
  lintVolumes(resolved.description, faults);
}

/// Meshes, places, volumes and the model: checks of data, of contact and of deformations are of the plane.
void lintInSpace(LintReport& report) {
  ResolvedScene resolved;
  try {
    resolved = resolveScene(*report.scene);
  } catch (const InputError& error) {
    return addError(error, "mesh-file", report.faults);
  }
  report.scene = resolved.description;
  checkInSpace(resolved, report.faults);
  build(std::move(resolved), report);
}

}  // namespace

void addError(const InputError& error, const std::string& id, Faults& faults) {
  faults.add(error.fault().empty() ? id : error.fault(), error.what());
}

std::string LintInput::where(const std::vector<std::string>& keys, size_t body) const {
  const Node* at = scene.document.get();
  if (body >= scene.bodies.size() || scene.bodies[body].isTool()) return scene.path;
  for (const std::string& key : keys) {
    const Node* next = at->isTable() ? at->find(key) : nullptr;
    if (next == nullptr) break;
    at = key == "body" && keys.size() > 1 && next->isArray() ? &next->elements[body] : next;
  }
  return at->where;
}

LintReport lint(const std::string& path, const std::vector<std::string>& settings) {
  LintReport report;
  try {
    report.scene = readScene(path, settings);
  } catch (const InputError& error) {
    addError(error, "scene", report.faults);
    return report;
  }
  SceneDescription& scene = *report.scene;
  report.faults = Faults(scene.allowed);
  if (scene.inSpace()) {
    lintInSpace(report);
    return report;
  }
  std::vector<TriangleMesh*> known;
  std::vector<TriangleMesh> meshes;
  meshes.reserve(scene.bodies.size());
  for (const BodyDescription& body : scene.bodies) {
    known.push_back(nullptr);
    try {
      known.back() = &meshes.emplace_back(meshOf(body));
    } catch (const InputError& error) {
      addError(error, "mesh-file", report.faults);
    }
  }
  for (const InputError& error : resolveWhatCanBe(scene, known))
    addError(error, "label-twice", report.faults);
  const SceneDescription solved = asSolved(scene);
  runChecks(inputOf(solved, {known.begin(), known.end()}), report.faults);
  if (report.faults.count(Severity::error) == 0) build({scene, std::move(meshes)}, report);
  dropConsequences(report.faults);
  return report;
}

Faults lintResolved(const ResolvedScene& resolved) {
  const SceneDescription scene = asSolved(resolved.description);
  Faults faults(scene.allowed);
  if (scene.inSpace()) {
    checkInSpace(resolved, faults);
    return faults;
  }
  std::vector<const TriangleMesh*> meshes;
  for (const TriangleMesh& mesh : resolved.meshes) meshes.push_back(&mesh);
  runChecks(inputOf(scene, std::move(meshes)), faults);
  dropConsequences(faults);
  return faults;
}

namespace {

/// By how much the sides of a contact in space approach each other beyond touching, by order of magnitude
/// [m]: by what prescribed motions and loads of each body make of it as a whole.
double approachOf(const SceneDescription& scene, const std::vector<SampledDatum>& data,
                  const ContactInterface& interface) {
  double approach = -interface.initialDistance().minCoeff();
  for (const int body : {interface.pair().nonmortar.body, interface.pair().mortar.body}) {
    double motion = 0;
    for (const SampledDatum& datum : data)
      if (static_cast<int>(datum.body) == body && datum.kind != SampledDatum::Kind::temperature &&
          datum.kind != SampledDatum::Kind::distance)
        motion = std::max(motion, datum.stressOfUnit(scene) * datum.largestIn(scene.time) * datum.size /
                                      scene.bodies[datum.body].material.elasticity.young);
    approach += motion;
  }
  return approach;
}

void lintSurfaces(const SceneDescription& scene, const Model& model, Faults& faults) {
  constexpr double visible = 0.1;
  const std::vector<SampledDatum> data = sampledData(meshedScene(scene, model));
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    constexpr double exact = 1e-9;
    if (interface.patchError() > exact)
      faults.add("interpolation-unmatched", scene.contacts[k].where,
                 "nodal forces of a uniform pressure are off by up to " +
                     digits(100 * interface.patchError(), 2) + " % on the mortar side, expected " +
                     "variant = \"weighted\" or meshes that match");
    const double approach = approachOf(scene, data, interface);
    if (!(interface.sagitta() > visible * approach) || !(approach > 0)) continue;
    const std::string& length = scene.units.length;
    faults.add("contact-polygon", scene.contacts[k].where,
               "the distance of the curved surfaces is known to " + digits(interface.sagitta()) + " " +
                   length + " from these meshes, and the bodies approach each other by about " +
                   digits(approach) + " " + length);
  }
}

void lintTies(const SceneDescription& scene, const Model& model, Faults& faults) {
  constexpr double tiny = 0.25;
  constexpr double large = 0.5;
  for (size_t k = 0; k < model.ties.size(); ++k) {
    const Tie& tie = model.ties[k];
    const Body& one = model.bodies[tie.pair().nonmortar.body];
    const Body& other = model.bodies[tie.pair().mortar.body];
    const double smaller = std::min(one.extent(), other.extent());
    if (tie.overlap() < tiny)
      faults.add("contact-overlap", scene.ties[k].where,
                 "the tie covers " + digits(tie.overlap(), 2) + " of the side of body " + one.name());
    if (tie.distance() > large * smaller)
      faults.add("gap-large", scene.ties[k].where,
                 "the sides of the tie are up to " + digits(tie.distance(), 4) + " " + scene.units.length +
                     " apart, the smaller body is " + digits(smaller, 4) + " " + scene.units.length +
                     " wide");
  }
}

}  // namespace

void lintModel(const SceneDescription& scene, const Model& model, Faults& faults) {
  lintTies(scene, model, faults);
  if (scene.inSpace()) lintSurfaces(scene, model, faults);
  if (!scene.inSpace()) lintData(scene, model, faults);
  for (size_t b = 0; b < model.bodies.size() && !scene.inSpace(); ++b)
    if (const auto centre = freeRotation(model, static_cast<int>(b)))
      faults.add("free-rotation", scene.bodies[b].where,
                 "body " + scene.bodies[b].name + " may turn about " +
                     computedPlace(*centre, extent(model.bodies[b].mesh())) +
                     ": neither its supports nor contact without friction hold it");
  if (scene.time.controlled()) return;  // the error of steps has it
  for (const std::string& warning : loadsBetweenSteps(scene, model))
    faults.add("load-between-steps", warning);
}

void lintSettling(const SceneDescription& scene, const std::string& doubt, Faults& faults) {
  if (!doubt.empty()) faults.add("initial-stress", scene.path, doubt);
}

}  // namespace mortier
