#include "scene/read_material.h"

#include <algorithm>

#include "base/error.h"
#include "scene/read_elasticity.h"
#include "scene/read_own_law.h"
#include "scene/words.h"

namespace mortier {
namespace {

/// Laws and their keys beside young and poisson.
enum Law { elastic, perzyna, norton, maxwell, standardSolid, viscoplastic, expression, registered };
const Keys lawWords{"elastic",        "perzyna",      "norton",    "maxwell",
                    "standard-solid", "viscoplastic", "expression"};
const Keys keysOfLaw[] = {{},
                          {"viscosity", "yield_stress", "projection"},
                          {"reference_stress", "reference_rate", "exponent"},
                          {"relaxation_time"},
                          {"relaxation_time", "relaxed_fraction"},
                          {"yield_stress", "viscosity", "reference_stress", "reference_rate", "exponent",
                           "kinematic_hardening", "isotropic_hardening"},
                          {"rate11", "rate22", "rate12", "rate33", "parameters", "isotropic"},
                          {"parameters", "isotropic"}};

bool has(const Keys& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Without `law` it is Perzyna's where a key of that says so.
int lawOf(const TableReader& table) {
  if (isRegistered(table)) return registered;
  const bool flows = table.find("viscosity") != nullptr || table.find("yield_stress") != nullptr;
  return table.oneOf("law", withRegistered(lawWords), flows ? perzyna : elastic);
}

void requireKeysOf(int law, const TableReader& table) {
  const bool given = table.find("law") != nullptr;
  for (size_t other = 0; other < std::size(keysOfLaw); ++other)
    for (const std::string& key : keysOfLaw[other]) {
      // An elastic body may keep the projection it had when it flowed; the linter names it.
      if (table.find(key) == nullptr || has(keysOfLaw[law], key) || (!given && key == "projection")) continue;
      std::string laws;
      for (size_t l = 0; l < lawWords.size(); ++l)
        if (has(keysOfLaw[l], key)) laws += (laws.empty() ? "\"" : " or \"") + lawWords[l] + '"';
      table.reject(key, "it beside law = " + laws + " only");
    }
}

/// By a viscosity, or a power of the overstress.
Overstress readOverstress(const TableReader& table) {
  Overstress law;
  law.yieldStress = table.number("yield_stress", above(0));
  if (table.find("viscosity") != nullptr) {
    for (const char* key : {"reference_stress", "reference_rate", "exponent"})
      if (table.find(key) != nullptr) table.reject(key, "either viscosity or a power of the overstress");
    law.setViscosity(table.number("viscosity", atLeast(0)));
  } else {
    law.referenceStress = table.number("reference_stress", above(0));
    law.referenceRate = table.number("reference_rate", above(0));
    law.exponent = table.number("exponent", atLeast(1));
  }
  law.kinematicHardening = table.number("kinematic_hardening", atLeast(0), 0);
  law.isotropicHardening = table.number("isotropic_hardening", atLeast(0), 0);
  return law;
}

}  // namespace

const Keys& lawsOfMortier() {
  return lawWords;
}

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
  if (law == viscoplastic) material.flow = readOverstress(table);
  if (law == expression) material.flow = readExpressionLaw(table);
  if (law == registered) material.flow = readRegisteredLaw(table);
  requireTakesElasticity(table, material);
  return material;
}

void requireRates(const BodyDescription& body, const SceneDescription& scene) {
  std::vector<const MaterialDescription*> materials{&body.material};
  for (const RegionDescription& region : body.regions)
    if (region.material) materials.push_back(&*region.material);
  const std::string asked = scene.time.scheme == Scheme::crankNicolson ? "scheme = \"crank-nicolson\""
                            : scene.time.controlled()                  ? "time.tolerance"
                            : scene.accuracy.asked() > 0               ? "accuracy"
                                                                       : "";
  for (const MaterialDescription* material : materials)
    if (const auto* law = material->as<Overstress>(); law != nullptr && !law->viscous() && !asked.empty())
      throw InputError(body.where + ": body " + body.name +
                       ": viscosity = 0, expected viscosity > 0 beside " + asked +
                       ": plasticity has no rate at a given stress");
}

}  // namespace mortier
