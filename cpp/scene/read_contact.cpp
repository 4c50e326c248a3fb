#include <algorithm>
#include <utility>

#include "base/error.h"
#include "scene/readers.h"

namespace mortier {

namespace {

enum TieCoupling { kinematic, distributing };

/// Of a tool whose outline has one, but for what closes it.
std::optional<int> onlyLabel(const BodyDescription& tool) {
  if (tool.point) return 1;
  if (!tool.isTool() || !tool.mesh.shape || tool.mesh.path == "rectangle") return std::nullopt;
  const std::vector<int>& labels = std::get<Outline>(tool.mesh.shape->of).labels;
  if (tool.mesh.path == "polygon" &&
      std::count(labels.begin(), labels.end(), labels[0]) != static_cast<std::ptrdiff_t>(labels.size()))
    return std::nullopt;
  return labels[0];
}

SideDescription readSide(const Node& node, const std::string& key, const SceneDescription& scene) {
  const TableReader table(node, "contact." + key,
                          key == "sides" ? "side of contact" : key + " side of contact");
  const std::string body = nameOfBody(table, scene);
  if (const auto only = onlyLabel(scene.bodies[bodyIndex(scene, body)]); only && !table.has("label"))
    return {body, *only, "", node.where};
  const auto [label, labelName] = table.label("label");
  return {body, label, labelName, table.find("label")->where};
}

/// `nonmortar` and `mortar`, or `sides` in any order.
void readSides(const TableReader& table, const SceneDescription& scene, ContactDescription& contact) {
  constexpr auto example = "{ body = \"...\", label = ... }";
  const std::vector<const Node*> sides = table.tables("sides");
  const bool swap = table.boolean("swap");
  const auto isTool = [&](const SideDescription& side) {
    return scene.bodies[bodyIndex(scene, side.body)].isTool();
  };
  if (sides.empty()) {
    contact.sides = {readSide(table.require("nonmortar", example), "nonmortar", scene),
                     readSide(table.require("mortar", example), "mortar", scene)};
    contact.nonmortarSide = swap ? 1 : 0;
    if (isTool(contact.nonmortar()))
      table.refuse(*table.find("nonmortar"),
                   "a tool as the nonmortar side, expected the body: pressures and conditions are its own");
    return;
  }
  for (const char* other : {"nonmortar", "mortar"})
    if (const Node* node = table.find(other))
      table.refuse(*node,
                   std::string(other) + " beside sides, expected either sides or nonmortar and mortar");
  if (sides.size() != 2) table.reject("sides", std::string("two tables [") + example + ", " + example + "]");
  contact.sides = {readSide(*sides[0], "sides", scene), readSide(*sides[1], "sides", scene)};
  contact.otherSide = swap;
  const auto tools = std::count_if(contact.sides.begin(), contact.sides.end(), isTool);
  if (tools == 0) return;
  if (tools == 2) table.refuse(*table.find("sides"), "two tools in contact, expected a body on one side");
  table.rejectIfGiven({"swap"}, "it only beside two bodies: of a tool and a body the body is nonmortar");
  contact.nonmortarSide = isTool(contact.sides[0]) ? 1 : 0;
  contact.choice = "nonmortar is the body, mortar the tool";
}

/// \throws InputError  where friction stands together with what does not support it
Friction readFriction(const TableReader& table, const SceneDescription& scene) {
  Friction friction{table.number("friction"), table.number("shear_limit")};
  if (!friction.any()) return friction;
  const char* key = friction.coefficient > 0 ? "friction" : "shear_limit";
  if (friction.coefficient > 0 && friction.limit > 0) table.reject("shear_limit", "friction or shear_limit");
  const auto refuse = [&](bool found, const std::string& what) {
    if (found) table.reject(key, "none: " + what + " does not support friction, remove one of them");
  };
  refuse(scene.solver.method != Method::newton, "solver.method = penalty-duality");
  refuse(scene.accuracy.bound, "accuracy.bound");
  refuse(!scene.accuracy.quantity.empty(), "accuracy.quantity");
  return friction;
}

/// \throws InputError  where finite sliding stands together with what does not support it
void refuseBesideFinite(const TableReader& table, const SceneDescription& scene,
                        const ContactDescription& contact) {
  const auto refuse = [&](bool found, const std::string& what) {
    if (found)
      table.reject("sliding",
                   "refuse or allow: " + what + " does not support finite sliding, remove one of them");
  };
  refuse(contact.gap.has_value(), "gap");
  refuse(contact.initial == InitialGap::close, "initial = \"close\"");
  refuse(scene.solver.method != Method::newton, "solver.method = penalty-duality");
  refuse(scene.accuracy.bound, "accuracy.bound");
  refuse(!scene.accuracy.quantity.empty(), "accuracy.quantity");
}

/// \throws InputError  where a tie stands together with what does not know it
void refuseBesideTies(const TableReader& table, const SceneDescription& scene) {
  table.rejectIfGiven({"stabilised", "initial", "gap", "friction", "shear_limit", "sliding"},
                      "none beside kind = \"tied\": the sides move as one, as far apart as they are drawn");
  const auto refuse = [&](bool found, const std::string& what) {
    if (found) table.reject("kind", "unilateral: " + what + " does not support ties, remove one of them");
  };
  refuse(scene.solver.method != Method::newton, "solver.method = penalty-duality");
  refuse(!scene.accuracy.quantity.empty(), "accuracy.quantity");
  refuse(scene.accuracy.bound, "accuracy.bound");
}

/// What follows what, and through which stiffness.
void readTie(const TableReader& table, const SceneDescription& scene, ContactDescription& contact) {
  const bool toPoint = scene.bodies[bodyIndex(scene, contact.mortar().body)].point;
  if (!contact.tied) {
    if (toPoint) table.reject("kind", "\"tied\" beside a tool of shape \"point\", which has no surface");
    table.rejectIfGiven({"coupling", "along", "stiffness", "offset"}, "it beside kind = \"tied\" only");
    return;
  }
  if (!toPoint) table.rejectIfGiven({"coupling"}, "it beside a tool of shape \"point\" only");
  if (toPoint) {
    contact.tieKind =
        table.choice<TieCoupling>("coupling") == kinematic ? TieKind::kinematic : TieKind::distributing;
    table.rejectIfGiven({"variant"}, "none beside a tool of shape \"point\": coupling says what follows it");
  }
  if (const std::vector<std::string> axes = table.strings("along"); table.has("along")) {
    contact.along.fill(false);
    const Keys known = scene.inSpace() ? Keys{"x", "y", "z"} : Keys{"x", "y"};
    for (const std::string& axis : axes) {
      const auto found = std::find(known.begin(), known.end(), axis);
      if (found == known.end()) table.reject("along", "a list of " + joined(known));
      contact.along[found - known.begin()] = true;
    }
    if (axes.empty()) table.reject("along", "one of " + joined(known) + " at least");
  }
  if (table.has("stiffness")) {
    contact.stiffness = table.number("stiffness");
    const bool atNodes =
        contact.tieKind == TieKind::kinematic || contact.variant == CouplingKind::interpolation;
    if (atNodes)
      table.reject("stiffness", toPoint ? "it beside coupling = \"distributing\""
                                        : "it beside variant = \"mortar\" or \"weighted\"");
  }
  if (!table.has("offset")) return;
  contact.offset = table.string("offset");
  const int tool = bodyIndex(scene, contact.offset);
  if (tool < 0 || !scene.bodies[tool].point) table.reject("offset", "the name of a tool of shape \"point\"");
  if (toPoint) table.reject("offset", "none beside a tool as a side: give that its motion");
}

/// Conditions are stabilised where the scene leaves the choice of rows to the program; ties never are.
void readStabilised(const TableReader& table, const SceneDescription& scene, ContactDescription& contact) {
  const bool other = contact.tied || contact.variant == CouplingKind::interpolation || scene.accuracy.bound;
  contact.stabilised =
      table.has("stabilised") ? table.boolean("stabilised") : !table.has("variant") && !other;
  if (!contact.stabilised || !other) return;
  table.reject("stabilised", contact.variant == CouplingKind::interpolation
                                 ? "false with variant = \"interpolation\""
                                 : "false beside accuracy.bound");
}

/// Two sides of one body may touch, as those of a slit. \throws InputError
void requireTwoSides(const TableReader& table, const SceneDescription& scene,
                     const ContactDescription& contact) {
  const auto& [one, other] = contact.sides;
  if (one.body != other.body) return;
  const std::string label =
      other.labelName.empty() ? std::to_string(other.label) : '"' + other.labelName + '"';
  if (one.label == other.label && one.labelName == other.labelName)
    throw InputError(table.message(other.where, "both sides are label " + label + " of body " + other.body +
                                                    ", expected two sides"),
                     "same-side");
  if (scene.accuracy.bound || !scene.accuracy.quantity.empty())
    throw InputError(table.message(other.where, "both sides are of body " + other.body +
                                                    ", expected two bodies beside accuracy." +
                                                    (scene.accuracy.bound ? "bound" : "quantity")));
}

}  // namespace

ContactDescription readContact(const Node& node, const SceneDescription& scene) {
  const TableReader table(node, "contact", "contact");
  ContactDescription contact;
  contact.where = node.where;
  enum class Kind { unilateral, tied };
  contact.tied = table.choice<Kind>("kind") == Kind::tied;
  readSides(table, scene, contact);
  if (contact.tied) refuseBesideTies(table, scene);
  const auto variant = scene.degree == 1 && !scene.inSpace() ? CouplingKind::mortar : CouplingKind::weighted;
  contact.variant = table.choice<CouplingKind>("variant", variant);
  readTie(table, scene, contact);
  readStabilised(table, scene, contact);
  contact.initial = table.choice<InitialGap>("initial");
  contact.gap = table.datum("gap");
  if (contact.gap && contact.gap->inTime && scene.accuracy.bound)
    table.reject("gap", "a distance that does not change in time beside accuracy.bound");
  if (contact.gap && table.has("initial"))
    table.refuse(*table.find("gap"), "gap beside initial, expected one of them");
  contact.friction = readFriction(table, scene);
  contact.sliding = table.choice<SlidingKind>("sliding");
  if (contact.sliding == SlidingKind::finite) refuseBesideFinite(table, scene, contact);
  requireTwoSides(table, scene, contact);
  for (const ContactDescription& other : contact.tied ? scene.ties : scene.contacts) {
    if (other.nonmortar().body == contact.nonmortar().body &&
        other.nonmortar().label == contact.nonmortar().label &&
        other.nonmortar().labelName == contact.nonmortar().labelName && contact.nonmortarSide &&
        other.nonmortarSide && !scene.bodies[bodyIndex(scene, contact.mortar().body)].isTool())
      throw InputError(table.message(contact.nonmortar().where,
                                     "label " + std::to_string(contact.nonmortar().label) + " of body " +
                                         contact.nonmortar().body + " is nonmortar twice, expected once"));
  }
  return contact;
}

}  // namespace mortier
