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
      {"body.force.", {dimensions::bodyForce, {"x", "y"}}},
      {"body.boundary.", {dimensions::length, {"ux", "uy", "un", "ut"}}},
      {"contact.", {dimensions::length, {"gap"}}},
      {"quantity.",
       {dimensions::length,
        {"about", "displacement.point", "mean_pressure.from", "mean_pressure.to", "mean_pressure.margin"}}},
      {"time.", {dimensions::time, {"end", "breaks"}}}};
  static const std::pair<const char*, Dimension> materials[] = {{"young", dimensions::stress},
                                                                {"yield_stress", dimensions::stress},
                                                                {"viscosity", dimensions::viscosity},
                                                                {"reference_stress", dimensions::stress},
                                                                {"kinematic_hardening", dimensions::stress},
                                                                {"isotropic_hardening", dimensions::stress},
                                                                {"young1", dimensions::stress},
                                                                {"young2", dimensions::stress},
                                                                {"young3", dimensions::stress},
                                                                {"shear12", dimensions::stress},
                                                                {"stiffness", dimensions::stress},
                                                                {"reference_rate", dimensions::rate},
                                                                {"relaxation_time", dimensions::time}};
  static const std::map<std::string, Dimension> keys = [] {
    std::map<std::string, Dimension> all{{"body.boundary.tx", dimensions::stress},
                                         {"body.boundary.ty", dimensions::stress},
                                         {"body.boundary.pressure", dimensions::stress},
                                         {"contact.shear_limit", dimensions::stress},
                                         {"accuracy.max_seconds", dimensions::time}};
    for (const auto& [table, of] : tables)
      for (const char* key : of.second) all[table + key] = of.first;
    for (const auto& [key, dimension] : materials)
      for (const char* table : {"body.material.", "body.region.material."})
        all[std::string(table) + key] = dimension;
    return all;
  }();
  const auto found = keys.find(path);
  return found == keys.end() ? nullptr : &found->second;
}

class Converter {
 public:
  explicit Converter(const Units& units) : units_(units), ofTheClock_(units) {
    ofTheClock_.time = "s";
    ofTheClock_.timeInSi = Units().timeInSi;
  }

  void convertTable(Node& table, const std::string& path) const {
    for (Node& member : table.members) {
      const std::string at = path + (path.empty() ? "" : ".") + member.key;
      if (const Dimension* dimension = dimensionOf(at)) {
        convert(member, member.key, *dimension, at == "accuracy.max_seconds" ? ofTheClock_ : units_);
      } else {
        convertTable(member, at);
        for (Node& element : member.elements) convertTable(element, at);
      }
    }
  }

 private:
  /// A value, a list of them, or a table in time.
  static void convert(Node& node, const std::string& key, const Dimension& dimension, const Units& units) {
    for (Node& element : node.elements) convert(element, key, dimension, units);
    for (Node& member : node.members)
      convert(member, member.key, member.key == "time" ? dimensions::time : dimension, units);
    if (!node.isString()) return;
    const auto read = numberAndUnit(node.text);
    if (!read) return;
    const auto reject = [&](const std::string& expected) {
      throw InputError(node.where + ": " + key + " = " + node.quoted() + ", expected " + expected);
    };
    if (!units.given)
      reject("a number, or units = \"m, N, Pa\" at the top of the scene: without them no number has a unit");
    const auto unit = unitOf(read->unit);
    if (!unit || !(unit->dimension == dimension))
      reject("a number in " + units.nameOf(dimension) + " or what can be converted to it" +
             (unit ? "" : "; " + read->unit + " is no unit that is known"));
    node.kind = Node::Kind::number;
    node.value = units.in({read->number * unit->factor, unit->decades, unit->dimension});
    node.text.clear();
  }

  const Units& units_;
  Units ofTheClock_;  ///< wall time is in seconds
};

}  // namespace

Units readUnits(const Node& scene) {
  const Node* node = scene.find("units");
  if (node == nullptr) return {};
  const auto reject = [&](const std::string& expected) {
    throw InputError(node->where + ": units = " + node->quoted() + ", " + expected);
  };
  if (!node->isString())
    reject("expected a length, a force and a stress, as in \"mm, N, MPa\", and a time where it is not s");
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
