#include "base/error.h"
#include "scene/readers.h"

namespace mortier {
namespace {

/// A difference of temperatures in K; its inverse. None of other units.
std::optional<double> kelvins(const std::string& unit) {
  if (unit == "K" || unit == "degC" || unit == "\u00b0C") return 1;
  if (unit == "degF" || unit == "\u00b0F") return 5.0 / 9;
  return std::nullopt;
}
std::optional<double> perKelvin(const std::string& unit) {
  const auto one = unit.rfind("1/", 0) == 0 ? kelvins(unit.substr(2)) : std::nullopt;
  return one ? std::optional(1 / *one) : std::nullopt;
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
      const Key* key = findKey(path, member.key);
      const bool isTable =
          !keysOf(at).empty() && (at != "body.temperature" || member.find("file") != nullptr);
      if (key != nullptr && !isTable && key->unit == "K") {
        convert(member, member.key, units_, byFactor("K", kelvins));
      } else if (key != nullptr && !isTable && key->unit == "1/K") {
        convert(member, member.key, units_, byFactor("1/K", perKelvin));
      } else if (key != nullptr && !isTable && key->dimension) {
        const Units& units = at == "accuracy.max_seconds" ? ofTheClock_ : units_;
        Dimension dimension = *key->dimension;
        // Of tools, forces on whole rings and in space.
        if ((path == "tool" || path == "body.point") && dimension.force > 0 && !units.perDepth)
          ++dimension.length;
        convert(member, member.key, units, byDimension(dimension, units));
      } else {
        convertTable(member, at);
        for (Node& element : member.elements) convertTable(element, at);
      }
    }
  }

 private:
  [[noreturn]] static void reject(const Node& node, const std::string& key, const std::string& expected) {
    throw InputError(node.where + ": " + key + " = " + node.quoted() + ", expected " + expected);
  }
  /// The number and the unit of a text that has both.
  static std::optional<NumberAndUnit> measureIn(const Node& node, const std::string& key,
                                                const Units& units) {
    const auto read = node.isString() ? numberAndUnit(node.text) : std::nullopt;
    if (read && !units.given)
      reject(node, key,
             "a number, or units = \"m, N, Pa\" at the top of the scene: without them no number has a unit");
    return read;
  }
  /// What number a measure is, whose node and key a message names.
  using ToNumber = std::function<double(const NumberAndUnit& read, const Node& node, const std::string& key)>;

  static ToNumber byDimension(const Dimension& dimension, const Units& units) {
    return [dimension, &units](const NumberAndUnit& read, const Node& node, const std::string& key) {
      const auto unit = unitOf(read.unit);
      if (!unit || !(unit->dimension == dimension))
        reject(node, key,
               "a number in " + units.nameOf(dimension) + " or what can be converted to it" +
                   (unit ? "" : "; " + read.unit + " is no unit that is known"));
      return units.in({read.number * unit->factor, unit->decades, unit->dimension});
    };
  }
  /// Of what `units` say nothing of; factorOf(unit) in K or 1/K.
  template <class FactorOf>
  static ToNumber byFactor(const std::string& name, FactorOf factorOf) {
    return [name, factorOf](const NumberAndUnit& read, const Node& node, const std::string& key) {
      const auto factor = factorOf(read.unit);
      if (!factor) reject(node, key, "a number in " + name + " or of degC or degF in its place");
      return read.number * *factor;
    };
  }
  /// A value, a list of them, or a table in time.
  static void convert(Node& node, const std::string& key, const Units& units, const ToNumber& toNumber) {
    for (Node& element : node.elements) convert(element, key, units, toNumber);
    for (Node& member : node.members)
      convert(member, member.key, units,
              member.key == "time" ? byDimension(dimensions::time, units) : toNumber);
    const auto read = measureIn(node, key, units);
    if (!read) return;
    node.value = toNumber(*read, node, key);
    node.kind = Node::Kind::number;
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
