#include "scene/read_material.h"

#include <algorithm>

#include "scene/read_elasticity.h"
#include "scene/words.h"

namespace mortier {
namespace {

/// Laws and their keys beside young and poisson.
enum Law { elastic, perzyna, norton, maxwell, standardSolid };
const Keys lawWords{"elastic", "perzyna", "norton", "maxwell", "standard-solid"};
const Keys keysOfLaw[] = {{},
                          {"viscosity", "yield_stress", "projection"},
                          {"reference_stress", "reference_rate", "exponent"},
                          {"relaxation_time"},
                          {"relaxation_time", "relaxed_fraction"}};

bool has(const Keys& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Without `law` it is Perzyna's where a key of that says so.
int lawOf(const TableReader& table) {
  const bool flows = table.find("viscosity") != nullptr || table.find("yield_stress") != nullptr;
  return table.oneOf("law", lawWords, flows ? perzyna : elastic);
}

void requireKeysOf(int law, const TableReader& table) {
  const bool given = table.find("law") != nullptr;
  for (size_t other = 0; other < std::size(keysOfLaw); ++other)
    for (const std::string& key : keysOfLaw[other]) {
      // An elastic body may keep the projection it had when it flowed; the linter names it.
      if (table.find(key) == nullptr || has(keysOfLaw[law], key) || (!given && key == "projection")) continue;
      std::string laws;
      for (size_t l = 0; l < std::size(keysOfLaw); ++l)
        if (has(keysOfLaw[l], key)) laws += (laws.empty() ? "\"" : " or \"") + lawWords[l] + '"';
      table.reject(key, "it beside law = " + laws + " only");
    }
}

}  // namespace

MaterialDescription readMaterial(const Node& node, const std::string& path, const std::string& subject) {
  const TableReader table(node, path, subject);
  MaterialDescription material;
  readElasticity(table, material);
  const auto projection = static_cast<Projection>(table.oneOf("projection", projectionWords, 1));
  const int law = lawOf(table);
  requireKeysOf(law, table);
  if (law == perzyna)
    material.flow = Viscoplasticity{table.number("viscosity", above(0)),
                                    table.number("yield_stress", above(0)), projection};
  if (law == norton)
    material.flow =
        NortonCreep{table.number("reference_stress", above(0)), table.number("reference_rate", above(0)),
                    table.number("exponent", atLeast(1))};
  if (law == maxwell) material.flow = Viscoelasticity{table.number("relaxation_time", above(0)), 0};
  if (law == standardSolid)
    material.flow = Viscoelasticity{table.number("relaxation_time", above(0)),
                                    table.number("relaxed_fraction", between(0, 1))};
  requireTakesElasticity(table, material);
  return material;
}

}  // namespace mortier
