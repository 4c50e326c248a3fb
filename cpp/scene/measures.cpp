#include "scene/measures.h"

#include <map>
#include <utility>
#include <vector>

#include "base/error.h"

namespace mortier {
namespace {

/// What keys of the schema mean; data have their dimension at all times.
const Dimension* dimensionOf(const std::string& path) {
  static const std::map<std::string, std::pair<Dimension, std::vector<const char*>>> tables = {
      {"body.mesh.",
       {dimensions::length,
        {"size", "lower", "upper", "focus", "corners", "centre", "inner", "outer", "lowest", "radius",
         "core"}}},
      {"body.initial_stress.", {dimensions::stress, {"s11", "s22", "s12", "s33"}}},
      {"body.region.initial_stress.", {dimensions::stress, {"s11", "s22", "s12", "s33"}}},
      {"body.material.",
       {dimensions::stress, {"young", "yield_stress", "young1", "young2", "young3", "shear12", "stiffness"}}},
      {"body.region.material.",
       {dimensions::stress, {"young", "yield_stress", "young1", "young2", "young3", "shear12", "stiffness"}}},
      {"body.force.", {dimensions::bodyForce, {"x", "y"}}},
      {"body.boundary.", {dimensions::length, {"ux", "uy", "un", "ut"}}},
      {"contact.", {dimensions::length, {"gap"}}},
      {"quantity.", {dimensions::length, {"about", "displacement.point"}}},
      {"time.", {dimensions::time, {"end", "breaks"}}},
      {"accuracy.", {dimensions::time, {"max_seconds"}}}};
  static const std::map<std::string, Dimension> keys = [] {
    std::map<std::string, Dimension> all{{"body.material.viscosity", dimensions::viscosity},
                                         {"body.region.material.viscosity", dimensions::viscosity},
                                         {"body.boundary.tx", dimensions::stress},
                                         {"body.boundary.ty", dimensions::stress},
                                         {"body.boundary.pressure", dimensions::stress}};
    for (const auto& [table, of] : tables)
      for (const char* key : of.second) all[table + key] = of.first;
    return all;
  }();
  const auto found = keys.find(path);
  return found == keys.end() ? nullptr : &found->second;
}

class Converter {
 public:
  explicit Converter(const Units& units) : units_(units) {}

  void convertTable(Node& table, const std::string& path) const {
    for (Node& member : table.members) {
      const std::string at = path + (path.empty() ? "" : ".") + member.key;
      if (const Dimension* dimension = dimensionOf(at)) {
        convert(member, member.key, *dimension);
      } else {
        convertTable(member, at);
        for (Node& element : member.elements) convertTable(element, at);
      }
    }
  }

 private:
  /// A value, a list of them, or a table in time.
  void convert(Node& node, const std::string& key, const Dimension& dimension) const {
    for (Node& element : node.elements) convert(element, key, dimension);
    for (Node& member : node.members)
      convert(member, member.key, member.key == "time" ? dimensions::time : dimension);
    if (!node.isString()) return;
    const auto read = numberAndUnit(node.text);
    if (!read) return;
    const auto reject = [&](const std::string& expected) {
      throw InputError(node.where + ": " + key + " = " + node.quoted() + ", expected " + expected);
    };
    if (!units_.given)
      reject("a number, or units = \"m, N, Pa\" at the top of the scene: without them no number has a unit");
    const auto unit = unitOf(read->unit);
    if (!unit || !(unit->dimension == dimension))
      reject("a number in " + units_.nameOf(dimension) + " or what can be converted to it" +
             (unit ? "" : "; " + read->unit + " is no unit that is known"));
    node.kind = Node::Kind::number;
    node.value = units_.in({read->number * unit->factor, unit->decades, unit->dimension});
    node.text.clear();
  }

  const Units& units_;
};

}  // namespace

Units readUnits(const Node& scene) {
  const Node* node = scene.find("units");
  if (node == nullptr) return {};
  const auto reject = [&](const std::string& expected) {
    throw InputError(node->where + ": units = " + node->quoted() + ", " + expected);
  };
  if (!node->isString()) reject("expected a length, a force and a stress, as in \"mm, N, MPa\"");
  try {
    return Units::from(node->text);
  } catch (const InputError& error) {
    reject(error.what());
  }
  return {};
}

void convertMeasures(Node& scene, const Units& units) {
  Converter(units).convertTable(scene, "");
}

}  // namespace mortier
