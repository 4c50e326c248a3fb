#include "scene/scene.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "scene/readers.h"
#include "solver/state.h"

namespace mortier {

namespace {

/// In plane stress there is no s33.
void requireInPlane(const BodyDescription& body, Plane plane) {
  const auto require = [&](const StressDescription& stress) {
    if (plane == Plane::stress && stress[3])
      throw InputError(
          stress[3]->where +
          ", expected plane = \"strain\" beside it, or \"axisymmetric\": s33 is 0 in plane stress");
  };
  require(body.initialStress);
  for (const RegionDescription& region : body.regions) require(region.initialStress);
  if (plane == Plane::stress && body.volume == Volume::averaged)
    throw InputError(body.volumeWhere +
                     ", expected plane = \"strain\" or \"axisymmetric\" beside it: in plane stress the "
                     "thickness keeps the volume");
}

/// What the bound of the error, refined meshes and the note's algorithm cannot have.
void requireKnownTo(const SceneDescription& scene, const BodyDescription& body) {
  for (const MaterialDescription* material : materialsOf(body)) {
    if (!material->anisotropy) continue;
    if (scene.accuracy.bound)
      throw InputError(material->anisotropy->where + ", expected \"isotropic\" beside accuracy.bound");
    if (scene.solver.method != Method::newton)
      throw InputError(material->anisotropy->where +
                       ", expected \"isotropic\" beside solver.method = \"penalty-duality\"");
  }
  if (scene.accuracy.bound && body.volume == Volume::averaged)
    throw InputError(
        body.volumeWhere +
        ", expected pointwise beside accuracy.bound: bounds need stresses that balance the loads "
        "on the strains of the displacements themselves");
  for (const ConditionDescription& c : body.conditions)
    if ((c.point || c.pointInSpace) && c.kind == ConditionDescription::Kind::traction && !body.isTool() &&
        (scene.accuracy.asked() > 0 || scene.accuracy.bound))
      throw InputError(c.where + ": body " + body.name +
                       ": a force at a point, expected none beside accuracy: its energy is infinite");
  if (!body.temperature) return;
  if (scene.accuracy.bound)
    throw InputError(body.temperature->where + ": temperature, expected none beside accuracy.bound");
  if (scene.accuracy.asked() > 0 && !body.temperature->file.empty())
    throw InputError(body.temperature->where +
                     ": temperature.file, expected a datum beside accuracy: refinement changes the vertices");
}

void readAccuracy(const TableReader& accuracy, SceneDescription& scene) {
  AccuracyGoal& goal = scene.accuracy;
  goal.bound = accuracy.boolean("bound");
  if (const Node* quantity = accuracy.find("quantity")) {
    if (accuracy.has("energy")) accuracy.reject("quantity", "either energy or quantity");
    if (!goal.bound) accuracy.rejectIfGiven({"bound"}, "true beside quantity, whose error is bounded");
    goal.bound = true;
    goal.quantity = accuracy.string("quantity");
    goal.where = quantity->where;
    goal.tolerance = accuracy.number("tolerance");
  } else {
    accuracy.rejectIfGiven({"tolerance"}, "it only beside quantity");
    goal.energy = accuracy.number("energy", goal.bound ? std::optional<double>(0) : std::nullopt);
  }
  if (goal.asked() == 0)
    return accuracy.rejectIfGiven({"max_unknowns", "max_seconds"}, "it only beside energy or quantity");
  goal.maxUnknowns = accuracy.number("max_unknowns");
  goal.maxSeconds = accuracy.number("max_seconds", INFINITY);
  if (!goal.quantity.empty()) return;
  if (scene.time.scheme == Scheme::crankNicolson)
    accuracy.reject("energy", "it only beside time.scheme = sdirk2 or backward-euler, whose error is known");
  if (scene.solver.method != Method::newton)
    accuracy.reject("energy", "it only beside solver.method = newton, by whose tangent errors are estimated");
}

/// At what refinement may aim.
void requireAim(const SceneDescription& scene) {
  const AccuracyGoal& goal = scene.accuracy;
  if (goal.quantity.empty()) return;
  const auto refuse = [&](const std::string& expected) {
    throw InputError(goal.where + ": accuracy: quantity = \"" + goal.quantity + "\", expected " + expected);
  };
  Keys names;
  for (const QuantityDescription& quantity : scene.quantities) names.push_back(quantity.name);
  const auto at = std::find(names.begin(), names.end(), goal.quantity);
  if (at == names.end())
    refuse(names.empty() ? "the name of a quantity, of which the scene has none" : "one of " + joined(names));
  const QuantityDescription& quantity = scene.quantities[at - names.begin()];
  const bool force = quantity.kind == Quantity::Kind::reaction && !quantity.point;
  if (!force && quantity.kind != Quantity::Kind::contactForce &&
      quantity.kind != Quantity::Kind::displacement && quantity.kind != Quantity::Kind::meanPressure)
    refuse("a reaction of a label, a contact_force, a displacement or a mean_pressure");
  if (scene.degree == 2)
    refuse("degree = 1 beside it: errors of quantities are known of linear displacements");
  for (const BodyDescription& body : scene.bodies) {
    if (mayFlow(body))
      refuse("elastic bodies beside it: body " + body.name + " flows, and no error of a quantity is known");
  }
}

/// What is not known of bodies that turn about an axis.
void requireAboutAxis(const TableReader& root, const SceneDescription& scene) {
  if (scene.plane != Plane::axisymmetric) return;
  if (scene.accuracy.bound)
    root.reject("plane", "stress or strain beside accuracy.bound: no bound is known of axisymmetric bodies");
  for (const QuantityDescription& quantity : scene.quantities)
    if (quantity.component == Quantity::Component::momentZ)
      throw InputError(quantity.where + ": quantity " + quantity.name +
                       ": component = \"moment\", expected x or y: forces of a whole ring have no moment");
}

void readOptions(const TableReader& root, SceneDescription& scene) {
  scene.time = readTime(root.require("time", "a table [time] with end, steps"));
  if (const Node* node = root.find("solver")) {
    const TableReader solver(*node, "solver", "solver");
    scene.solver.tolerance = solver.number("tolerance");
    scene.solver.method = solver.choice<Method>("method");
    if (scene.time.controlled() && scene.solver.method != Method::newton)
      solver.reject("method", "newton beside time.tolerance: the error is estimated with its tangent");
    scene.solver.maxIterations = solver.integer("max_iterations", defaultIterations(scene.solver.method));
    scene.solver.linear = solver.choice<LinearEngine>("linear");
    scene.solver.reduce = solver.boolean("reduce");
    scene.solver.listSolutions = solver.boolean("list_solutions");
  }
  if (const Node* node = root.find("accuracy"))
    readAccuracy(TableReader(*node, "accuracy", "accuracy"), scene);
  if (const Node* node = root.find("output")) {
    const TableReader output(*node, "output", "output");
    scene.every = output.integer("every");
    scene.keepsState = output.boolean("state");
  }
  if (const Node* node = root.find("check"))
    scene.allowed = TableReader(*node, "check", "check").strings("allow");
}

void requireOwnName(const SceneDescription& scene, const BodyDescription& body) {
  if (const int other = bodyIndex(scene, body.name); other >= 0)
    throw InputError(body.where + (body.isTool() ? ": tool " : ": body ") + body.name + ": name = \"" +
                     body.name + "\", expected a name of its own, there is one at " +
                     scene.bodies[other].where);
}

/// Tools are bodies after all others.
void readTools(const TableReader& root, SceneDescription& scene) {
  const std::vector<const Node*> tools = root.tables("tool");
  double stiffest = 0;  // what a displacement of a tool may press with
  for (const BodyDescription& body : scene.bodies)
    stiffest = std::max(stiffest, body.material.elasticity.young);
  for (size_t i = 0; i < tools.size(); ++i) {
    BodyDescription tool = readTool(*tools[i], scene, i);
    requireOwnName(scene, tool);
    const std::string subject = tool.where + ": tool " + tool.name + ": a tool, expected none beside ";
    if (scene.accuracy.bound)
      throw InputError(subject + "accuracy.bound: bounds are of bodies that all strain");
    if (scene.solver.method != Method::newton)
      throw InputError(subject + "solver.method = \"penalty-duality\"");
    tool.material.elasticity.young = stiffest;
    scene.bodies.push_back(std::move(tool));
  }
}

void requireToolsTouch(const SceneDescription& scene) {
  for (const BodyDescription& tool : scene.bodies) {
    std::vector<const ContactDescription*> contacts;
    forEachPair(scene, [&](const ContactDescription& contact) {
      if (contact.mortar().body == tool.name || contact.offset == tool.name) contacts.push_back(&contact);
    });
    const std::string subject = tool.where + ": tool " + tool.name + ": ";
    if (tool.isTool() && contacts.empty())
      throw InputError(subject + "in no contact, expected one with a body");
    const auto follows = [](const ContactDescription* c) { return c->sliding == SlidingKind::finite; };
    if (tool.turns() && !std::all_of(contacts.begin(), contacts.end(), follows) &&
        std::any_of(contacts.begin(), contacts.end(), follows))
      throw InputError(subject +
                       "it turns, and only some of its contacts have sliding = \"finite\", expected "
                       "all or none: rotations are finite or linear");
  }
}

/// \throws InputError where the estimate of the energy does not know the rows of a contact.
void requireEstimated(const ContactDescription& contact, int degree) {
  if (degree == 2 && contact.variant == CouplingKind::mortar)
    throw InputError(
        contact.where +
        ": contact: variant = \"mortar\", expected weighted beside accuracy and degree = 2: with no "
        "other does the estimate know the contact line");
  if (contact.variant == CouplingKind::interpolation)
    throw InputError(contact.where + ": contact: variant = \"interpolation\", expected " +
                     (degree == 2 ? "weighted" : "mortar") +
                     " beside accuracy: the estimate does not see the false stresses of interpolation");
}

/// The result with whose last state the run begins. \throws InputError beside what begins from bodies at rest
void readStart(const TableReader& root, SceneDescription& scene) {
  const Node* start = root.find("start");
  if (start == nullptr) {
    if (scene.after.empty()) return;
    // The result of the stage before is not there yet: its time is known.
    std::vector<std::string> before = scene.settings;
    before.push_back("stage=" + scene.after);
    scene.time.begin = readScene(scene.path, before).time.end;
    if (!(scene.time.end > scene.time.begin))
      throw InputError(scene.path + ": time.end = " + shortest(scene.time.end) + ", expected one after " +
                       shortest(scene.time.begin) + ", the end of stage " + scene.after);
    return;
  }
  static_cast<void>(root.string("start"));
  scene.start = pathOf(*start, scene.path);
  scene.startWhere = start->where;
  if (std::error_code none; !std::filesystem::is_regular_file(scene.start + "/state", none))
    root.reject("start", "a result with a state, of a run with output.state = true (there is no " +
                             scene.start + "/state)");
  // Its time; what is wrong with the file is found where the whole of it is read.
  std::string line;
  std::getline(std::ifstream(scene.start + "/state", std::ios::binary), line);
  if (line.starts_with(stateKind))
    scene.time.begin = std::strtod(line.c_str() + std::strlen(stateKind), nullptr);
  if (!(scene.time.end > scene.time.begin))
    root.reject("start", "a result that ends before time.end = " + shortest(scene.time.end) +
                             ", this one ends at t = " + shortest(scene.time.begin));
  if (root.has("accuracy"))
    root.reject("start", "none beside accuracy, whose estimates are of bodies that begin at rest");
  for (const BodyDescription& body : scene.bodies) {
    const auto given = [](const auto& component) { return component.has_value(); };
    bool stressed = std::ranges::any_of(body.initialStress, given);
    for (const RegionDescription& region : body.regions)
      stressed = stressed || std::ranges::any_of(region.initialStress, given);
    if (stressed)
      root.reject("start", "none beside initial_stress: body " + body.name + " has the stress of that state");
  }
}

void markInSpace(Node& node) {
  node.inSpace = true;
  for (Node& element : node.elements) markInSpace(element);
  for (Node& member : node.members) markInSpace(member);
}

}  // namespace

SceneDescription readScene(const std::string& path, const std::vector<std::string>& settings) {
  SceneDescription scene;
  scene.path = path;
  scene.settings = settings;
  scene.text = readSceneText(path);
  const auto read = std::make_shared<Node>(readDocument(path, scene.text));
  scene.document = read;
  Node& document = *read;
  scene.after = applySettings(document, settings);
  scene.units = readUnits(document);
  const TableReader root(document, "", "");
  scene.title = root.string("title", "");
  scene.dimension = root.integer("dimension");
  if (scene.dimension > 3) root.reject("dimension", "2 or 3");
  if (scene.inSpace()) markInSpace(document);
  scene.plane = root.choice<Plane>("plane");
  scene.units.inSpace = scene.inSpace();
  scene.units.perDepth = !scene.inSpace() && scene.plane != Plane::axisymmetric;
  convertMeasures(document, scene.units);
  scene.degree = root.integer("degree");
  if (scene.degree > 2) root.reject("degree", "1 or 2");
  readOptions(root, scene);
  const std::vector<const Node*> bodies = root.tables("body");
  if (bodies.empty()) root.reject("body", "at least one table [[body]]");
  for (size_t i = 0; i < bodies.size(); ++i) {
    BodyDescription body = readBody(*bodies[i], path, i);
    requireOwnName(scene, body);
    if (!scene.inSpace()) requireInPlane(body, scene.plane);
    requireRates(body, scene);
    requireKnownTo(scene, body);
    scene.bodies.push_back(std::move(body));
  }
  readTools(root, scene);
  readStart(root, scene);
  for (const Node* contact : root.tables("contact")) {
    ContactDescription described = readContact(*contact, scene);
    if (scene.accuracy.energy > 0) requireEstimated(described, scene.degree);
    (described.tied ? scene.ties : scene.contacts).push_back(std::move(described));
  }
  for (const Node* quantity : root.tables("quantity"))
    scene.quantities.push_back(readQuantity(*quantity, scene));
  requireToolsTouch(scene);
  for (const ContactDescription& contact : scene.contacts)
    scene.time.slidingAllowed.push_back(contact.sliding != SlidingKind::refuse);
  requireAboutAxis(root, scene);
  requireAim(scene);
  if (scene.inSpace()) requireKnownInSpace(root, scene);
  return scene;
}

bool BodyDescription::turns() const {
  return isTool() && std::any_of(conditions.begin(), conditions.end(), [](const ConditionDescription& c) {
           const bool held =
               c.kind == ConditionDescription::Kind::displacement && c.value.constant && !c.whereItIs;
           return c.turns() && !(held && c.value.value(0, 0, 0) == 0);
         });
}

std::vector<const MaterialDescription*> materialsOf(const BodyDescription& body) {
  std::vector<const MaterialDescription*> materials{&body.material};
  for (const RegionDescription& region : body.regions)
    if (region.material) materials.push_back(&*region.material);
  return materials;
}

bool mayFlow(const BodyDescription& body) {
  const auto materials = materialsOf(body);
  return std::any_of(materials.begin(), materials.end(),
                     [](const MaterialDescription* each) { return each->flows(); });
}

bool isFollowed(const SceneDescription& scene, const std::string& body) {
  return std::any_of(scene.contacts.begin(), scene.contacts.end(), [&](const ContactDescription& contact) {
    return contact.sliding == SlidingKind::finite &&
           (contact.nonmortar().body == body || contact.mortar().body == body);
  });
}

std::string nameOfPlace(const ConditionDescription& condition) {
  if (condition.onAxis) return "the axis";
  if (condition.point) return "point " + shortest(*condition.point);
  if (condition.pointInSpace) return "point " + shortest(*condition.pointInSpace);
  return "label " + (condition.labelName.empty() ? std::to_string(condition.label) : condition.labelName);
}

std::string word(Plane plane) {
  return keyAt("", "plane").words[static_cast<size_t>(plane)];
}
std::string word(CouplingKind kind) {
  return keyAt("contact", "variant").words[static_cast<size_t>(kind)];
}
std::string wordOfTie(const ContactDescription& tie) {
  if (tie.tieKind == TieKind::surface) return word(tie.variant);
  return keyAt("contact", "coupling").words[tie.tieKind == TieKind::kinematic ? 0 : 1];
}
std::string word(Projection projection) {
  return keyAt("body.material", "projection").words[static_cast<size_t>(projection)];
}
std::string word(Scheme scheme) {
  return keyAt("time", "scheme").words[static_cast<size_t>(scheme)];
}

std::string nameOfBody(const TableReader& table, const SceneDescription& scene) {
  std::string name = table.string("body");
  Keys names;
  for (const BodyDescription& body : scene.bodies) names.push_back(body.name);
  if (!isOneOf(name, names)) table.reject("body", "one of " + joined(names));
  return name;
}

bool isName(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

int bodyIndex(const SceneDescription& scene, const std::string& name) {
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace mortier
