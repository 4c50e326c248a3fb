#include "scene/read_quantity.h"

#include <utility>

#include "base/error.h"
#include "scene/table_reader.h"
#include "scene/words.h"

namespace mortier {
namespace {

/// Where a mean over a line begins and ends.
std::optional<QuantityDescription::Part> readPart(const TableReader& of) {
  if (of.find("from") == nullptr && of.find("to") == nullptr) {
    if (of.find("margin") != nullptr) of.reject("margin", "it only beside from and to");
    return std::nullopt;
  }
  for (const char* key : {"from", "to"})
    static_cast<void>(of.require(key, "[x, y], where the part of the line ends: from and to, or neither"));
  return QuantityDescription::Part{of.point("from"), of.point("to"), of.number("margin", atLeast(0), 0)};
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

  int given = 0;
  for (size_t k = 0; k < quantityKeys.size(); ++k) {
    const std::string& key = quantityKeys[k];
    const Node* what = table.find(key);
    if (what == nullptr) continue;
    ++given;
    const Kind kind = quantity.kind = static_cast<Kind>(k);
    const TableReader of(*what, "quantity." + key, "quantity " + quantity.name + ": " + key);
    quantity.body = of.string("body");
    if (bodyIndex(scene, quantity.body) < 0) {
      Keys names;
      for (const BodyDescription& body : scene.bodies) names.push_back(body.name);
      of.reject("body", "one of " + joined(names));
    }
    if (kind != Kind::contactForce && of.find("point") != nullptr) {
      if (of.find("label") != nullptr) of.reject("label", "either label or point");
      quantity.point = of.point("point");
      quantity.where = of.find("point")->where;
    } else if (ofLabel(kind)) {
      std::tie(quantity.label, quantity.labelName) =
          std::pair(of.label("label").number, of.label("label").name);
      quantity.where = of.find("label")->where;
    }
    if (kind == Kind::meanPressure) quantity.part = readPart(of);
  }
  if (given != 1)
    throw InputError(table.message(node.where, std::string(given == 0 ? "none" : "more than one") + " of " +
                                                   joined(quantityKeys) + ", expected one"));
  if (!hasComponent(quantity.kind)) {
    for (const char* key : {"component", "about"})
      if (table.find(key) != nullptr) table.reject(key, "it only beside forces and displacements");
    return quantity;
  }
  const bool isForce = quantity.kind != Kind::displacement;
  quantity.component = static_cast<Quantity::Component>(
      table.oneOf("component", isForce ? componentWords : Keys{componentWords[0], componentWords[1]}));
  if (table.find("about") != nullptr) {
    if (quantity.component != Quantity::Component::moment)
      table.reject("about", "it only beside component = \"moment\"");
    quantity.about = table.point("about");
  }
  return quantity;
}

}  // namespace mortier
