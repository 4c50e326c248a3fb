#include "scene/readers.h"

namespace mortier {
namespace {

/// Where a mean over a line begins and ends.
std::optional<QuantityDescription::Part> readPart(const TableReader& of) {
  if (of.table().inSpace) {
    of.rejectIfGiven({"from", "to", "margin"}, "none with dimension = 3: the mean is over the whole side");
    return std::nullopt;
  }
  if (!of.has("from") && !of.has("to")) {
    of.rejectIfGiven({"margin"}, "it only beside from and to");
    return std::nullopt;
  }
  for (const char* key : {"from", "to"})
    static_cast<void>(of.require(key, "[x, y], where the part of the line ends: from and to, or neither"));
  return QuantityDescription::Part{of.point("from"), of.point("to"), of.number("margin")};
}

/// Forces have moments, about axes in space; rigid bodies turn.
void readComponent(const TableReader& table, const BodyDescription* tool, QuantityDescription& quantity) {
  using enum Quantity::Component;
  const bool space = table.table().inSpace;
  const bool forces = quantity.kind != Quantity::Kind::displacement;
  std::vector<std::pair<std::string, Quantity::Component>> all{{"x", x}, {"y", y}};
  if (space) all.emplace_back("z", z);
  if (forces && space)
    all.insert(all.end(), {{"moment_x", momentX}, {"moment_y", momentY}, {"moment_z", momentZ}});
  else if (forces)
    all.emplace_back("moment", momentZ);
  else if (quantity.whole && space)
    all.insert(all.end(), {{"rotation_x", rotationX}, {"rotation_y", rotationY}, {"rotation_z", rotationZ}});
  else if (quantity.whole)
    all.emplace_back("rotation", rotationZ);
  Keys words;
  for (const auto& [word, component] : all) words.push_back(word);
  quantity.component = all[table.oneOf("component", words)].second;
  if (!isMoment(quantity.component))
    table.rejectIfGiven({"about"}, std::string("it only beside component = \"moment") +
                                       (space ? "_x\", \"moment_y\" or \"moment_z\"" : "\""));
  const SpacePoint about = tool != nullptr ? *tool->reference : SpacePoint(0, 0, 0);
  quantity.about =
      space ? table.spacePoint("about", about) : asSpacePoint(table.point("about", about.head<2>()));
}

}  // namespace

QuantityDescription readQuantity(const Node& node, const SceneDescription& scene) {
  using Kind = Quantity::Kind;
  const Node* name = node.find("name");
  const TableReader table(node, "quantity",
                          "quantity" + (name != nullptr && name->isString() ? " " + name->text : ""));
  QuantityDescription quantity;
  quantity.where = node.where;
  quantity.name = table.string("name");
  if (!isName(quantity.name)) table.reject("name", "letters, digits, _ and -");
  for (const QuantityDescription& other : scene.quantities)
    if (other.name == quantity.name)
      table.reject("name", "a name of its own, there is one at " + other.where);

  Keys kinds;  // the keys that are tables, in the order of Quantity::Kind
  for (const std::string& key : keysOf("quantity"))
    if (!keysOf("quantity." + key).empty()) kinds.push_back(key);
  int given = 0;
  const BodyDescription* tool = nullptr;
  for (size_t k = 0; k < kinds.size(); ++k) {
    const std::string& key = kinds[k];
    if (!table.has(key)) continue;
    ++given;
    const Kind kind = quantity.kind = static_cast<Kind>(k);
    const TableReader of(*table.find(key), "quantity." + key, "quantity " + quantity.name + ": " + key);
    quantity.body = nameOfBody(of, scene);
    const BodyDescription& body = scene.bodies[bodyIndex(scene, quantity.body)];
    if (body.isTool()) tool = &body;
    if (tool != nullptr && (kind == Kind::largestMises || kind == Kind::storedEnergy ||
                            kind == Kind::dissipatedEnergy || kind == Kind::thermalWork))
      of.reject("body", "one that strains: a tool has no stress and no energy");
    if (tool != nullptr && kind == Kind::reaction)
      of.rejectIfGiven({"label", "point"}, "none of a tool: it is held as a whole");
    if (of.has("point")) {
      of.rejectIfGiven({"label"}, "either label or point");
      if (node.inSpace)
        quantity.pointInSpace = of.spacePoint("point");
      else
        quantity.point = of.point("point");
      quantity.where = of.find("point")->where;
    } else if (tool != nullptr && !of.has("label") && hasComponent(kind)) {
      quantity.whole = true;
    } else if (ofLabel(kind)) {
      const auto [label, labelName] = of.label("label");
      quantity.label = label;
      quantity.labelName = labelName;
      quantity.where = of.find("label")->where;
    }
    if (kind == Kind::meanPressure) quantity.part = readPart(of);
    if (kind == Kind::contactLength && node.inSpace) table.reject(key, "contact_area with dimension = 3");
    if (kind == Kind::contactArea && !node.inSpace) table.reject(key, "contact_length without dimension = 3");
  }
  if (given != 1)
    table.refuse(
        node, std::string(given == 0 ? "none" : "more than one") + " of " + joined(kinds) + ", expected one");
  if (!hasComponent(quantity.kind)) {
    table.rejectIfGiven({"component", "about"}, "it only beside forces and displacements");
    return quantity;
  }
  readComponent(table, tool, quantity);
  return quantity;
}

}  // namespace mortier
