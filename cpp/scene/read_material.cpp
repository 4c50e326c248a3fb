#include "base/error.h"
#include "scene/readers.h"
#include "scene/registered_laws.h"

namespace mortier {
namespace {

/// As the words of the key.
enum Law { elastic, perzyna, norton, maxwell, standardSolid, viscoplastic, expression };

/// By a viscosity, or a power of the overstress.
Overstress readOverstress(const TableReader& table) {
  Overstress law;
  law.yieldStress = table.number("yield_stress");
  if (table.has("viscosity")) {
    table.rejectIfGiven({"reference_stress", "reference_rate", "exponent"},
                        "either viscosity or a power of the overstress");
    law.setViscosity(table.number("viscosity", {}, ">= 0"));
  } else {
    law.referenceStress = table.number("reference_stress");
    law.referenceRate = table.number("reference_rate");
    law.exponent = table.number("exponent");
  }
  law.kinematicHardening = table.number("kinematic_hardening");
  law.isotropicHardening = table.number("isotropic_hardening");
  return law;
}

FlowLaw readFlow(const TableReader& table) {
  const Node* named = table.find("law");
  if (named != nullptr && named->isString() && registeredLaw(named->text)) {
    table.requireBeside("law", "expression");
    table.rejectIfGiven({"rate11", "rate22", "rate12", "rate33", "rate13", "rate23"},
                        "it beside law = \"expression\" only");
    return readRegisteredLaw(table);
  }
  Keys words = keyAt("body.material", "law").words;
  const Keys registered = registeredLaws();
  words.insert(words.end(), registered.begin(), registered.end());
  // Without `law` it is Perzyna's where a key of that says so.
  const bool flows = table.has("viscosity") || table.has("yield_stress");
  const int law = table.oneOf("law", words, flows ? perzyna : elastic);
  const auto projection = table.choice<Projection>("projection");
  // An elastic body may keep the projection it had when it flowed; the linter names it.
  table.requireBeside("law", words[law], named == nullptr ? "projection" : "");
  switch (law) {
    case perzyna:
      return Viscoplasticity{table.number("viscosity"), table.number("yield_stress"), projection};
    case norton:
      return NortonCreep{table.number("reference_stress"), table.number("reference_rate"),
                         table.number("exponent")};
    case maxwell:
      return Viscoelasticity{table.number("relaxation_time"), 0};
    case standardSolid:
      return Viscoelasticity{table.number("relaxation_time"), table.number("relaxed_fraction")};
    case viscoplastic:
      return readOverstress(table);
    case expression:
      return readExpressionLaw(table);
    default:
      return {};
  }
}

}  // namespace

MaterialDescription readMaterial(const Node& node, const std::string& path, const std::string& subject) {
  const TableReader table(node, path, subject);
  MaterialDescription material;
  readElasticity(table, material);
  material.flow = readFlow(table);
  if (!material.flows() && table.has("projection"))
    material.unusedProjection = table.find("projection")->where;
  requireTakesElasticity(table, material);
  return material;
}

void requireRates(const BodyDescription& body, const SceneDescription& scene) {
  const std::string asked = scene.time.scheme == Scheme::crankNicolson ? "scheme = \"crank-nicolson\""
                            : scene.time.controlled()                  ? "time.tolerance"
                            : scene.accuracy.asked() > 0               ? "accuracy"
                                                                       : "";
  for (const MaterialDescription* material : materialsOf(body))
    if (const auto* law = material->as<Overstress>(); law != nullptr && !law->viscous() && !asked.empty())
      throw InputError(body.where + ": body " + body.name +
                       ": viscosity = 0, expected viscosity > 0 beside " + asked +
                       ": plasticity has no rate at a given stress");
}

}  // namespace mortier
