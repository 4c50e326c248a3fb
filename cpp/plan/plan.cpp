#include "plan/plan.h"

#include <algorithm>
#include <limits>
#include <set>

#include "base/digits.h"
#include "plan/loads.h"
#include "scene/document.h"
#include "scene/memory_need.h"

namespace mortier {
namespace {

class Planner {
 public:
  Planner(const SceneDescription& scene, const Model& model) : scene_(scene), model_(model) {
    if (scene.inSpace()) return;
    data_ = sampledData(meshedScene(scene, model));
    largest_ = nominalStress(scene, data_);
  }

  Plan make() {
    for (size_t b = 0; b < model_.bodies.size(); ++b) planBody(b);
    planContact();
    planTime();
    planMemory();
    if (inRounds())
      add("scene", true,
          "rounds on meshes that are refined until the estimated error is small enough; numbers of nodes and "
          "memory are those of the first ones",
          scene_.accuracy.quantity.empty() ? "accuracy.energy = " + shortest(scene_.accuracy.energy)
                                           : "accuracy.quantity = " + scene_.accuracy.quantity);
    const bool space = scene_.inSpace();
    if (scene_.degree == 2)
      add("scene", true, "quadratic displacements",
          space ? "degree = 2: ten nodes a tetrahedron, stresses at four points"
                : "degree = 2: six nodes a triangle, stresses at three points");
    if (space) {
      add("scene", true, "bodies in space", "dimension = 3");
      add("scene", false, "what data do between nodes and steps", "it is looked at in the plane only");
    }
    if (scene_.plane == Plane::strain)
      add("scene", true, "plane strain", "plane = \"strain\": e33 = 0, s33 is computed");
    if (scene_.plane == Plane::axisymmetric)
      add("scene", true, "bodies of revolution, forces and energies of whole rings",
          "plane = \"axisymmetric\": x is the distance from the axis, s33 the stress around it");
    const bool rough = anyFriction(model_);
    add("scene", false,
        std::string(rough ? "inertia" : "inertia, friction") +
            (anyFollows(model_) ? ", finite strains" : ", finite strains and slips"),
        rough ? "quasistatic, small strains" : "quasistatic, small strains, frictionless");
    return std::move(plan_);
  }

 private:
  void add(const std::string& part, bool modelled, const std::string& what, const std::string& why) {
    plan_.push_back({part, modelled, what, why});
  }

  [[nodiscard]] bool inRounds() const { return scene_.accuracy.asked() > 0; }

  void planBody(size_t b) {
    const Body& body = model_.bodies[b];
    const std::string part = "body " + body.name();
    if (body.rigid()) {
      add(part, true,
          "rigid: it moves as a whole, and contact alone holds " + counted(body.freeDofs(), "motion"),
          "it is a tool");
      return;
    }
    planPoints(b);
    const std::string& choice = scene_.bodies[b].volumeChoice;
    const std::string averaged = std::string("volumetric strain averaged over patches of ") +
                                 (scene_.inSpace() ? "tetrahedra" : "triangles");
    if (body.patches() != nullptr)
      add(part, true, averaged, choice.empty() ? "volume = \"averaged\"" : choice);
    else if (!choice.empty())
      add(part, false, averaged, choice);
    const bool symmetric = body.material().symmetricTangent();
    const std::string factor = symmetric ? "Cholesky" : "LU";
    if (body.material().linear()) {
      add(part, true,
          "linear: one " + factor + " factor for " + (inRounds() ? "each round" : "the whole run"),
          "it is elastic");
      return;
    }
    std::string projection;
    double yieldStress = INFINITY;
    std::string always;                                               // laws that flow at any stress
    const std::vector<LawDescription> laws = body.material().laws();  // in the order of materials
    size_t next = 0;
    for (const MaterialDescription* material : materialsOf(scene_.bodies[b])) {
      const LawDescription& named = laws[std::min(next++, laws.size() - 1)];
      if (!named.variant.empty()) projection = named.variant;
      if (const auto* perzyna = material->as<Viscoplasticity>())
        yieldStress = std::min(yieldStress, perzyna->yieldStress);
      else if (const auto* overstress = material->as<Overstress>())
        yieldStress = std::min(yieldStress, overstress->yieldStress);
      else if (material->flows())
        always = named.text();
    }
    const std::string law = !symmetric && projection.empty() ? "its tangent is unsymmetric"
                            : scene_.inSpace()               ? "its tangent is symmetric in space"
                            : scene_.plane != Plane::stress
                                ? "its tangent is symmetric " + (scene_.plane == Plane::strain
                                                                     ? std::string("in plane strain")
                                                                     : std::string("in three dimensions"))
                            : projection.empty()
                                ? "its tangent is symmetric"
                                : "projection " + projection + " makes its tangent " +
                                      (symmetric ? "symmetric" : "unsymmetric where it flows");
    add(part, true, factor + " in every iteration in which it flows", law);
    if (!always.empty()) {
      add(part, true, "flow", always + " flows at any stress");
      return;
    }
    add(part, false, "a new factor in elastic steps", "they reuse the elastic factorisation");
    const std::string loads = "loads of the order of " + digits(largest_) + " " + scene_.units.stress +
                              ", yield_stress " + shortest(yieldStress) + " " + scene_.units.stress;
    if (scene_.inSpace())
      add(part, true, "flow", "yield_stress " + shortest(yieldStress) + " " + scene_.units.stress);
    else if (largest_ < yieldStress)
      add(part, false, "flow, as none is expected", loads);
    else
      add(part, true, "flow", loads);
  }

  void planPoints(size_t b) {
    std::set<std::string> points;
    for (const ConditionDescription& c : scene_.bodies[b].conditions)
      if (c.point && c.kind == ConditionDescription::Kind::displacement) points.insert(shortest(*c.point));
    if (points.empty()) return;
    std::string list;
    for (const std::string& point : points) list += (list.empty() ? "" : ", ") + point;
    add("body " + scene_.bodies[b].name, true,
        (points.size() == 1 ? "held at " : "held at the points ") + list,
        "what takes rigid motions away and carries no force; the energy of a force at a point is infinite, "
        "displacements there grow as meshes are refined");
  }

  void planTie(size_t k) {
    const ContactDescription& tie = scene_.ties[k];
    const bool toPoint = tie.tieKind != TieKind::surface;
    const std::string what = wordOfTie(tie) + (toPoint ? " coupling of " : " tie at ") +
                             counted(model_.ties[k].nonmortarNodes().size(), "node") + " of " +
                             tie.nonmortar().body + " to " + tie.mortar().body;
    std::string why = tie.tieKind == TieKind::kinematic      ? "they move as a part of a rigid body"
                      : tie.tieKind == TieKind::distributing ? "their mean motion is that of the point"
                                                             : "its sides move as one";
    if (tie.stiffness > 0)
      why += " but for a layer of stiffness " + shortest(tie.stiffness) + " " + scene_.units.stress + "/" +
             scene_.units.length;
    if (!tie.offset.empty()) why += ", moved apart by " + tie.offset;
    for (size_t c = 0; c < (scene_.inSpace() ? 3 : 2); ++c)
      if (!tie.along[c]) why += std::string(", free along ") + "xyz"[c];
    if (!toPoint && !tie.choice.empty()) why += "; " + tie.choice;
    add("tie " + std::to_string(k), true, what, why);
  }

  void planContact() {
    for (size_t k = 0; k < model_.ties.size(); ++k) planTie(k);
    if (model_.interfaces.empty() && !model_.ties.empty()) return;
    if (model_.interfaces.empty()) {
      add("contact", false, "contact: bodies are solved separately",
          model_.bodies.size() == 1 ? "there is one body" : "the scene has none");
      return;
    }
    for (size_t k = 0; k < model_.interfaces.size(); ++k) {
      const ContactInterface& interface = model_.interfaces[k];
      const std::string part = "contact " + std::to_string(k);
      const std::string& choice = scene_.contacts[k].choice;
      add(part, true,
          "unilateral contact by " + word(scene_.contacts[k].variant) + " at " +
              counted(interface.rows(), "node") + " of " +
              model_.bodies[interface.pair().nonmortar.body].name(),
          "any of them may open" + std::string(choice.empty() ? "" : "; ") + choice);
      if (const Friction& friction = interface.friction(); friction.any())
        add(part, true, "friction: nodes stick or slip",
            friction.coefficient > 0 ? "friction = " + shortest(friction.coefficient)
                                     : "shear_limit = " + shortest(friction.limit));
    }
  }

  void planMemory() {
    SolverOptions options = scene_.solver;
    const MemoryNeed need = memoryNeed(model_, options);
    const std::string part = anyFriction(model_) ? forFriction(need) : "";
    std::string why = "factors of the bodies, and dense matrices over the contact nodes";
    if (solvesSparse(model_, options)) {
      options.denseWork = std::numeric_limits<double>::infinity();
      why = "contact in one sparse matrix with the bodies; dense ones over the contact nodes would take " +
            aboutMemory(memoryNeed(model_, options).all).substr(6);
    }
    add("scene", true, aboutMemory(need.all) + " of memory", part.empty() ? why : part);
  }

  void planTime() {
    const TimePlan& time = scene_.time;
    const bool elastic = std::all_of(model_.bodies.begin(), model_.bodies.end(),
                                     [](const Body& body) { return body.material().linear(); });
    const bool changes = (scene_.inSpace() && anyInSpaceChanges()) ||
                         std::any_of(data_.begin(), data_.end(),
                                     [&](const SampledDatum& datum) { return changesInTime(datum, time); });
    if (elastic && !changes) {
      add("time", true, "one step", "nothing depends on time");
      if (!time.controlled() && time.steps > 1)
        add("time", false, "the other " + counted(time.steps - 1, "step"), "they are at rest");
      return;
    }
    const double tolerance = stepTolerance(scene_);
    const bool forRounds = inRounds() && !elastic;
    const std::string equal =
        counted(time.steps, "step") + " of " + shortest(time.step()) + " " + scene_.units.time;
    const std::string chosen = "steps chosen by an error in time of " + shortest(tolerance) +
                               (forRounds ? " in the last round" : "");
    add("time", true, (tolerance > 0 ? chosen : equal) + ", " + word(time.scheme),
        changes ? "loads change" : "bodies flow");
    if (tolerance > 0 && !time.controlled())
      add("time", false, "the scene's " + equal,
          "beside an accuracy the steps of bodies that flow are chosen by their error");
  }

  [[nodiscard]] bool anyInSpaceChanges() const {
    return std::any_of(
               scene_.contacts.begin(), scene_.contacts.end(),
               [](const ContactDescription& contact) { return contact.gap && contact.gap->inTime; }) ||
           std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [](const BodyDescription& body) {
             const auto changes = [](const auto& force) { return force && force->inTime; };
             return std::any_of(body.conditions.begin(), body.conditions.end(),
                                [](const ConditionDescription& c) { return c.value.inTime; }) ||
                    (body.temperature && body.temperature->value.inTime) ||
                    std::any_of(std::begin(body.force), std::end(body.force), changes);
           });
  }

  const SceneDescription& scene_;
  const Model& model_;
  std::vector<SampledDatum> data_;
  double largest_ = 0;
  Plan plan_;
};

}  // namespace

Plan planOf(const SceneDescription& scene, const Model& model) {
  return Planner(scene, model).make();
}

std::string planText(const Plan& plan) {
  std::string text;
  for (const bool modelled : {true, false})
    for (const PlanItem& item : plan)
      if (item.modelled == modelled)
        text += (modelled ? "modelled   " : "left out   ") + item.part + ": " + item.what + " (" + item.why +
                ")\n";
  return text;
}

}  // namespace mortier
