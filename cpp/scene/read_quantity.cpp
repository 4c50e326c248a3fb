#include <array>

#include "scene/readers.h"

namespace mortier {
namespace {

/// Where a mean over a line begins and ends.
std::optional<QuantityDescription::Part> readPart(const TableReader& of) {
  if (!of.has("from") && !of.has("to")) {
    of.rejectIfGiven({"margin"}, "it only beside from and to");
    return std::nullopt;
  }
  for (const char* key : {"from", "to"})
    static_cast<void>(of.require(key, "[x, y], where the part of the line ends: from and to, or neither"));
  return QuantityDescription::Part{of.point("from"), of.point("to"), of.number("margin")};
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
  }
  if (given != 1)
    table.refuse(
        node, std::string(given == 0 ? "none" : "more than one") + " of " + joined(kinds) + ", expected one");
  if (!hasComponent(quantity.kind)) {
    table.rejectIfGiven({"component", "about"}, "it only beside forces and displacements");
    return quantity;
  }
  Keys components = keyAt("quantity", "component").words;
  const bool moves = quantity.kind == Kind::displacement;
  if (node.inSpace) {
    constexpr std::array ofSpace{Quantity::Component::x, Quantity::Component::y, Quantity::Component::z};
    quantity.component = ofSpace[table.oneOf("component", {"x", "y", "z"})];
    table.rejectIfGiven({"about"}, "none with dimension = 3, where no moment is known");
    return quantity;
  }
  components.resize(moves ? 2 : 3);
  if (moves && quantity.whole) components.emplace_back("rotation");
  const int component = table.oneOf("component", components);
  quantity.component = static_cast<Quantity::Component>(moves && component == 2 ? 3 : component);
  if (quantity.component != Quantity::Component::moment)
    table.rejectIfGiven({"about"}, "it only beside component = \"moment\"");
  quantity.about = table.point("about", tool != nullptr ? *tool->reference : Point(0, 0));
  return quantity;
}

}  // namespace mortier
