#include "scene/scene.h"

#include <algorithm>
#include <filesystem>

#include "base/fault_error.h"
#include "scene/document.h"
#include "scene/overrides.h"
#include "scene/table_reader.h"

namespace mortier {

namespace {

const Keys couplingWords{"interpolation", "mortar"};                   // in the order of CouplingKind
const Keys initialWords{"as-meshed", "close", "reject"};               // in the order of InitialGap
const Keys projectionWords{"elasticity", "frobenius", "compliance"};   // in the order of Projection
const Keys schemeWords{"backward-euler", "crank-nicolson", "sdirk2"};  // in the order of Scheme
const Keys methodWords{"newton", "penalty-duality"};                   // in the order of Method
const Keys linearWords{"multifrontal", "suitesparse"};                 // in the order of LinearEngine

MaterialDescription readMaterial(const Node& node, const std::string& path, const std::string& subject) {
  const TableReader table(node, path, subject);
  MaterialDescription material;
  material.elasticity = {table.number("young", above(0)), table.number("poisson", between(-1, 0.5))};
  const auto projection = static_cast<Projection>(table.oneOf("projection", projectionWords, 1));
  if (table.find("viscosity") != nullptr || table.find("yield_stress") != nullptr) {
    material.viscoplasticity = Viscoplasticity{table.number("viscosity", above(0)),
                                               table.number("yield_stress", above(0)), projection};
  }
  return material;
}

/// Two data for one component of one label would have to be ordered by a rule that nobody remembers.
void addCondition(BodyDescription& body, const ConditionDescription& added) {
  for (const ConditionDescription& other : body.conditions) {
    if (other.label == added.label && other.labelName == added.labelName &&
        other.component == added.component) {
      constexpr const char* directions[] = {"component x", "component y", "the normal", "the tangent"};
      throw InputError(added.value.where + ", expected one condition for " + directions[added.component] +
                       " of label " +
                       (added.labelName.empty() ? std::to_string(added.label) : added.labelName) +
                       ", there is one at " + other.where);
    }
  }
  body.conditions.push_back(added);
}

void readBoundary(const Node& node, BodyDescription& body) {
  const TableReader table(node, "body.boundary", "body " + body.name);
  using Kind = ConditionDescription::Kind;
  const auto [label, labelName] = table.label("label");
  const size_t before = body.conditions.size();
  const struct {
    const char* key;
    Kind kind;
    int component;
  } data[] = {{"ux", Kind::displacement, alongX},      {"uy", Kind::displacement, alongY},
              {"un", Kind::displacement, alongNormal}, {"ut", Kind::displacement, alongTangent},
              {"tx", Kind::traction, alongX},          {"ty", Kind::traction, alongY}};
  for (const auto& [key, kind, component] : data) {
    if (const Node* value = table.find(key)) {
      addCondition(body, {kind, label, labelName, component, table.expression(key), value->where});
    }
  }
  if (const Node* value = table.find("pressure")) {
    addCondition(body, {Kind::traction, label, labelName, alongNormal, negated(table.expression("pressure")),
                        value->where});
  }
  if (body.conditions.size() == before) {
    throw InputError(table.message(
        node.where, "boundary label " + (labelName.empty() ? std::to_string(label) : labelName) +
                        " has no condition, expected one of ux, uy, un, ut, tx, ty, pressure"));
  }
}

StressDescription readInitialStress(const TableReader& owner, const std::string& path,
                                    const std::string& subject) {
  StressDescription stress;
  if (const Node* node = owner.find("initial_stress")) {
    const TableReader table(*node, path, subject);
    const std::string keys[] = {"s11", "s22", "s12"};
    for (size_t c = 0; c < 3; ++c) {
      if (table.find(keys[c]) != nullptr) {
        stress[c] = table.expression(keys[c]);
      }
    }
  }
  return stress;
}

void readRegion(const Node& node, BodyDescription& body) {
  const std::string subject = "body " + body.name;
  const TableReader table(node, "body.region", subject);
  RegionDescription region;
  const auto [label, labelName] = table.label("label");
  region.label = label;
  region.labelName = labelName;
  region.where = table.find("label")->where;
  for (const RegionDescription& other : body.regions) {
    if (other.label == region.label && other.labelName == region.labelName) {
      table.reject("label", "a region of its own, there is one at " + other.where);
    }
  }
  const std::string shown = labelName.empty() ? std::to_string(label) : labelName;
  const std::string here = subject + ", region " + shown;
  if (const Node* material = table.find("material")) {
    region.material = readMaterial(*material, "body.region.material", here);
  }
  region.initialStress = readInitialStress(table, "body.region.initial_stress", here);
  if (!region.material && table.find("initial_stress") == nullptr) {
    throw InputError(table.message(
        node.where, "region label " + shown + " says nothing, expected material or initial_stress"));
  }
  body.regions.push_back(std::move(region));
}

/// Mesh paths are relative to the scene that names them, those of the command line to the current folder.
std::string meshPath(const Node& node, const std::string& scenePath) {
  const std::filesystem::path path(node.text);
  if (path.is_absolute() || node.fromCommandLine) {
    return path.string();
  }
  return (std::filesystem::path(scenePath).parent_path() / path).lexically_normal().string();
}

/// Names become file names.
bool isName(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

BodyDescription readBody(const Node& node, const std::string& scenePath, size_t index) {
  const Node* name = node.find("name");
  const bool named = name != nullptr && name->isString();
  const TableReader table(node, "body", "body " + (named ? name->text : std::to_string(index)));
  BodyDescription body;
  body.where = node.where;
  body.name = table.string("name");
  if (!isName(body.name)) {
    table.reject("name", "letters, digits, _ and -");
  }
  const std::string subject = "body " + body.name;
  static_cast<void>(table.string("mesh"));
  const Node& mesh = *table.find("mesh");
  body.mesh = meshPath(mesh, scenePath);
  body.meshWhere = mesh.where;
  if (std::error_code ignored; !std::filesystem::is_regular_file(body.mesh, ignored)) {
    table.reject("mesh", "a Medit .mesh file (there is none at " + body.mesh + ")");
  }
  body.material =
      readMaterial(table.require("material", "{ young = ..., poisson = ... }"), "body.material", subject);
  body.initialStress = readInitialStress(table, "body.initial_stress", subject);
  for (const Node* region : table.tables("region")) {
    readRegion(*region, body);
  }
  if (const Node* force = table.find("force")) {
    const TableReader components(*force, "body.force", subject);
    for (const int c : {0, 1}) {
      const std::string key = c == 0 ? "x" : "y";
      if (components.find(key) != nullptr) {
        body.force[c] = components.expression(key);
      }
    }
  }
  for (const Node* boundary : table.tables("boundary")) {
    readBoundary(*boundary, body);
  }
  return body;
}

SideDescription readSide(const Node& node, const std::string& key, const SceneDescription& scene) {
  const TableReader table(node, "contact." + key,
                          key == "sides" ? "side of contact" : key + " side of contact");
  const auto [label, labelName] = table.label("label");
  SideDescription side{table.string("body"), label, labelName, table.find("label")->where};
  if (bodyIndex(scene, side.body) < 0) {
    Keys names;
    for (const BodyDescription& body : scene.bodies) {
      names.push_back(body.name);
    }
    table.reject("body", "one of " + joined(names));
  }
  return side;
}

/// `nonmortar` and `mortar`, or `sides` in any order.
void readSides(const TableReader& table, const SceneDescription& scene, ContactDescription& contact) {
  constexpr auto example = "{ body = \"...\", label = ... }";
  const std::vector<const Node*> sides = table.tables("sides");
  contact.sidesGiven = sides.empty();
  if (contact.sidesGiven) {
    contact.nonmortar = readSide(table.require("nonmortar", example), "nonmortar", scene);
    contact.mortar = readSide(table.require("mortar", example), "mortar", scene);
    return;
  }
  for (const char* other : {"nonmortar", "mortar"}) {
    if (const Node* node = table.find(other)) {
      throw InputError(table.message(
          node->where, std::string(other) + " beside sides, expected either sides or nonmortar and mortar"));
    }
  }
  if (sides.size() != 2) {
    table.reject("sides", std::string("two tables [") + example + ", " + example + "]");
  }
  contact.nonmortar = readSide(*sides[0], "sides", scene);
  contact.mortar = readSide(*sides[1], "sides", scene);
}

void readContact(const Node& node, SceneDescription& scene) {
  const TableReader table(node, "contact", "contact");
  ContactDescription contact;
  contact.where = node.where;
  readSides(table, scene, contact);
  contact.variant = static_cast<CouplingKind>(table.oneOf("variant", couplingWords, 1));
  contact.initial = static_cast<InitialGap>(table.oneOf("initial", initialWords, 0));
  if (const Node* gap = table.find("gap")) {
    contact.gap = table.expression("gap");
    if (table.find("initial") != nullptr) {
      throw InputError(table.message(gap->where, "gap beside initial, expected one of them"));
    }
  }
  if (table.boolean("swap", false)) {
    std::swap(contact.nonmortar, contact.mortar);
  }
  if (contact.nonmortar.body == contact.mortar.body) {
    throw FaultError(table.message(contact.mortar.where,
                                   "both sides are body " + contact.mortar.body + ", expected two bodies"),
                     "same-body");
  }
  for (const ContactDescription& other : scene.contacts) {
    if (other.nonmortar.body == contact.nonmortar.body && other.nonmortar.label == contact.nonmortar.label &&
        other.nonmortar.labelName == contact.nonmortar.labelName && contact.sidesGiven && other.sidesGiven) {
      throw InputError(table.message(contact.nonmortar.where,
                                     "label " + std::to_string(contact.nonmortar.label) + " of body " +
                                         contact.nonmortar.body + " is nonmortar twice, expected once"));
    }
  }
  scene.contacts.push_back(contact);
}

std::vector<double> readBreaks(const TableReader& time, double end) {
  std::vector<double> breaks;
  const Node* node = time.find("breaks");
  if (node == nullptr) {
    return breaks;
  }
  const std::string expected = "an array of times between 0 and end = " + shortest(end);
  if (!node->isArray()) {
    time.reject("breaks", expected);
  }
  for (const Node& element : node->elements) {
    if (!element.isNumeric() || !(element.value > 0 && element.value < end)) {
      throw InputError(
          time.message(element.where, "breaks has " + element.quoted() + ", expected " + expected));
    }
    breaks.push_back(element.value);
  }
  std::sort(breaks.begin(), breaks.end());
  return breaks;
}

TimePlan readTime(const Node& node) {
  const TableReader time(node, "time", "time");
  TimePlan plan;
  plan.end = time.number("end", above(0));
  plan.scheme = static_cast<Scheme>(time.oneOf("scheme", schemeWords, 0));
  if (time.find("tolerance") == nullptr) {
    plan.steps = time.integer("steps", 1);
    for (const char* key : {"max_steps", "breaks"}) {
      if (time.find(key) != nullptr) {
        time.reject(key, "it only beside tolerance: without, steps are equal");
      }
    }
    return plan;
  }
  plan.tolerance = time.number("tolerance", between(0, 1));
  plan.steps = time.integer("steps", 1, 0);
  plan.maxSteps = time.integer("max_steps", 1, plan.maxSteps);
  plan.breaks = readBreaks(time, plan.end);
  if (plan.scheme == Scheme::crankNicolson) {
    time.reject("scheme", "sdirk2 or backward-euler beside tolerance: crank-nicolson has no error estimate");
  }
  return plan;
}

void readOptions(const TableReader& root, SceneDescription& scene) {
  scene.time = readTime(root.require("time", "a table [time] with end, steps"));
  if (const Node* node = root.find("solver")) {
    const TableReader solver(*node, "solver", "solver");
    scene.solver.tolerance = solver.number("tolerance", between(0, 1), scene.solver.tolerance);
    scene.solver.method = static_cast<Method>(solver.oneOf("method", methodWords, 0));
    if (scene.time.tolerance > 0 && scene.solver.method != Method::newton) {
      solver.reject("method", "newton beside time.tolerance: the error is estimated with its tangent");
    }
    scene.solver.maxIterations = solver.integer("max_iterations", 1, defaultIterations(scene.solver.method));
    scene.solver.linear = static_cast<LinearEngine>(solver.oneOf("linear", linearWords, 0));
  }
  if (const Node* node = root.find("output")) {
    scene.every = TableReader(*node, "output", "output").integer("every", 0, 0);
  }
  if (const Node* node = root.find("check")) {
    scene.allowed = TableReader(*node, "check", "check").strings("allow");
  }
}

}  // namespace

SceneDescription readScene(const std::string& path, const std::vector<std::string>& settings) {
  Node document = readDocument(path);
  for (const std::string& setting : settings) {
    applyOverride(document, setting);
  }
  const TableReader root(document, "", "");
  SceneDescription scene;
  scene.path = path;
  scene.title = root.string("title", "");
  readOptions(root, scene);
  const std::vector<const Node*> bodies = root.tables("body");
  if (bodies.empty()) {
    root.reject("body", "at least one table [[body]]");
  }
  for (size_t i = 0; i < bodies.size(); ++i) {
    BodyDescription body = readBody(*bodies[i], path, i);
    if (const int other = bodyIndex(scene, body.name); other >= 0) {
      throw InputError(body.where + ": body " + body.name + ": name = \"" + body.name +
                       "\", expected a name of its own, there is one at " + scene.bodies[other].where);
    }
    scene.bodies.push_back(std::move(body));
  }
  for (const Node* contact : root.tables("contact")) {
    readContact(*contact, scene);
  }
  return scene;
}

std::vector<double> breaksOf(const SceneDescription& scene) {
  std::vector<double> breaks;
  const auto add = [&](const Expression& data) {
    breaks.insert(breaks.end(), data.breaks.begin(), data.breaks.end());
  };
  for (const BodyDescription& body : scene.bodies) {
    for (const ConditionDescription& condition : body.conditions) {
      add(condition.value);
    }
    for (const std::optional<Expression>& force : body.force) {
      if (force) {
        add(*force);
      }
    }
  }
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  return breaks;
}

std::string word(CouplingKind kind) {
  return couplingWords[static_cast<size_t>(kind)];
}
std::string word(Projection projection) {
  return projectionWords[static_cast<size_t>(projection)];
}
std::string word(Scheme scheme) {
  return schemeWords[static_cast<size_t>(scheme)];
}

int bodyIndex(const SceneDescription& scene, const std::string& name) {
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

}  // namespace mortier
