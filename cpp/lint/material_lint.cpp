#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "base/digits.h"
#include "lint/lint.h"

namespace mortier {
namespace {

/// One of the materials of a body, and where the scene says it.
struct PlacedMaterial {
  const MaterialDescription& description;
  std::string subject;
  std::function<std::string(const std::string& key)> where;
};

std::vector<PlacedMaterial> placedMaterials(const LintInput& input, size_t b) {
  const BodyDescription& body = input.scene.bodies[b];
  std::vector<PlacedMaterial> materials{
      {body.material, "body " + body.name + ": ", [&input, b](const std::string& key) {
         return input.where({"body", "material", key}, b);
       }}};
  for (const RegionDescription& region : body.regions)
    if (region.material)
      materials.push_back({*region.material,
                           "body " + body.name + ", region " +
                               (region.labelName.empty() ? std::to_string(region.label) : region.labelName) +
                               ": ",
                           [&region](const std::string&) { return region.where; }});
  return materials;
}

/// What relaxes fastest: in plane strain the deviator, elsewhere the mean of s11 and s22.
double relaxingModulus(const Elasticity& elasticity, Plane plane) {
  return plane != Plane::stress ? elasticity.moduli()[1] : elasticity.moduli().maxCoeff();
}

/// Bodies that keep their volume on elements that lock.
void checkVolume(const LintInput& input, size_t b, const PlacedMaterial& material, Faults& faults) {
  const SceneDescription& scene = input.scene;
  const bool space = scene.inSpace();
  if (scene.bodies[b].volume == Volume::averaged) return;
  if (nearlyIncompressible(scene, material.description))
    faults.add("poisson-limit", material.where("poisson"),
               material.subject + "poisson = " + shortest(material.description.elasticity.poisson) +
                   (space                          ? " on linear tetrahedra"
                    : scene.plane == Plane::strain ? " in plane strain"
                                                   : " in axisymmetric bodies") +
                   " is nearly incompressible");
  if ((space || input.meshes[b] != nullptr) &&
      flowLocks(scene, material.description, space ? nullptr : input.meshes[b]))
    faults.add("flow-locks", material.where("law"),
               material.subject + "flow keeps the volume: linear " +
                   (space                          ? "tetrahedra lock"
                    : scene.plane == Plane::strain ? "triangles lock, but as quarters of cells with both "
                                                     "diagonals"
                                                   : "triangles about an axis lock or have wrong pressures"));
}

void checkElasticity(const LintInput& input, const PlacedMaterial& material, double nominal, Faults& faults) {
  constexpr double large = 0.05;
  const Elasticity& e = material.description.elasticity;
  const std::string& subject = material.subject;
  const std::string& unit = input.scene.units.stress;
  if (e.poisson < 0)
    faults.add("poisson-negative", material.where("poisson"),
               subject + "poisson = " + shortest(e.poisson) + " is negative");
  if (nominal > large * e.young)
    faults.add("large-strain", material.where("young"),
               subject + "the loads are of the order of " + digits(nominal, 4) + " " + unit +
                   ", young = " + shortest(e.young) + " " + unit + ": strains of " +
                   shortest(std::round(100 * nominal / e.young)) + " %");
}

/// The flow beyond a yield stress as that of Perzyna's law, by its rate at twice the yield stress; a
/// viscosity of 0 is plasticity. Nothing for other laws.
std::optional<Viscoplasticity> beyondYield(const MaterialDescription& material) {
  if (const auto* flow = material.as<Viscoplasticity>()) return *flow;
  const auto* law = material.as<Overstress>();
  if (law == nullptr) return std::nullopt;
  const double rate = law->referenceRate * std::pow(law->yieldStress / law->referenceStress, law->exponent);
  return Viscoplasticity{law->viscous() ? law->yieldStress / (3 * rate) : 0, law->yieldStress};
}

/// Equal steps, and how far each goes beside the yield stress and the time of relaxation.
void checkSteps(const LintInput& input, const PlacedMaterial& material, const Viscoplasticity& flow,
                double largest, double afterFirstStep, Faults& faults) {
  constexpr double far = 3;
  constexpr double tooStiff = 1e13;
  const TimePlan& time = input.scene.time;
  const std::string& subject = material.subject;
  const std::string& unit = input.scene.units.stress;
  const double step = time.step();
  const double relaxation =
      2 * flow.viscosity / relaxingModulus(material.description.elasticity, input.scene.plane);
  if (step > tooStiff * relaxation)
    faults.add("viscosity-small", material.where("viscosity"),
               subject + "a step is " + digits(step / relaxation, 4) +
                   " relaxation times long, rounding begins at 1e13");
  if (afterFirstStep > far * flow.yieldStress)
    faults.add("yields-at-once", input.where({"time", "steps"}),
               subject + "the first step goes to " + digits(afterFirstStep, 4) + " " + unit +
                   ", with yield_stress = " + shortest(flow.yieldStress) + " " + unit);
  constexpr int few = 10;
  if (time.scheme == Scheme::backwardEuler && largest > flow.yieldStress && time.steps < few)
    faults.add("few-steps-across-yield", input.where({"time", "steps"}),
               subject + "backward-euler is of first order, " + counted(time.steps, "step") +
                   " across yield " + (time.steps == 1 ? "leaves" : "leave") + " an error of about " +
                   shortest(std::round(100.0 / time.steps)) + " %");
}

void checkFlow(const LintInput& input, const PlacedMaterial& material, const Viscoplasticity& flow,
               double largest, double afterFirstStep, Faults& faults) {
  constexpr double unreachable = 20;
  constexpr double frozen = 1e-3;
  constexpr double plastic = 0.1;
  const double e = relaxingModulus(material.description.elasticity, input.scene.plane);
  const TimePlan& time = input.scene.time;
  const std::string& subject = material.subject;
  const std::string yield = "yield_stress = " + shortest(flow.yieldStress) + " " + input.scene.units.stress;
  const std::string yieldPlace = material.where("yield_stress");
  if (flow.yieldStress > plastic * e) {
    faults.add("yield-over-young", yieldPlace,
               subject + yield + " is " + shortest(std::round(100 * flow.yieldStress / e)) +
                   " % of Young's modulus");
    return;
  }
  if (largest > 0 && largest * unreachable < flow.yieldStress) {
    faults.add("never-yields", yieldPlace,
               subject + yield + ", the loads are at most of the order of " + digits(largest, 4) + " " +
                   input.scene.units.stress);
    return;
  }
  const double relaxation = 2 * flow.viscosity / e;
  const std::string unit = " " + input.scene.units.time;
  if (time.duration() < frozen * relaxation)
    faults.add("viscosity-large", material.where("viscosity"),
               subject + "relaxes in 2 viscosity/E = " + digits(relaxation, 4) + unit + ", the run ends at " +
                   shortest(time.end) + unit + ": nothing has time to flow");
  if (!time.controlled() && flow.viscosity > 0)
    checkSteps(input, material, flow, largest, afterFirstStep, faults);
}

/// The creep that the loads make, in all and in a step, beside the elastic strain.
void checkCreep(const LintInput& input, const PlacedMaterial& material, const NortonCreep& creep,
                double largest, Faults& faults) {
  constexpr double frozen = 1e-6;  // where stresses concentrate there is more
  constexpr double tooStiff = 1e13;
  if (!(largest > 0)) return;
  const TimePlan& time = input.scene.time;
  const double rate = creep.referenceRate * std::pow(largest / creep.referenceStress, creep.exponent) *
                      relaxingModulus(material.description.elasticity, input.scene.plane) /
                      largest;  // elastic strains [1/s]
  const std::string loads = material.subject + "under loads of the order of " + digits(largest, 4) + " " +
                            input.scene.units.stress + " ";
  if (rate * time.duration() < frozen)
    faults.add("viscosity-large", material.where("reference_rate"),
               loads + "the run of " + shortest(time.duration()) + " " + input.scene.units.time +
                   " creeps by " + digits(rate * time.duration(), 4) +
                   " of the elastic strain: nothing has time to flow");
  if (!time.controlled() && rate * time.step() > tooStiff)
    faults.add("viscosity-small", material.where("reference_rate"),
               loads + "a step creeps by " + digits(rate * time.step(), 4) +
                   " times the elastic strain, more than doubles resolve");
}

void checkRelaxation(const LintInput& input, const PlacedMaterial& material,
                     const Viscoelasticity& viscoelasticity, Faults& faults) {
  constexpr double frozen = 1e-3;
  const std::string unit = " " + input.scene.units.time;
  if (input.scene.time.duration() < frozen * viscoelasticity.relaxationTime)
    faults.add("viscosity-large", material.where("relaxation_time"),
               material.subject + "relaxation_time = " + shortest(viscoelasticity.relaxationTime) + unit +
                   ", the run ends at " + shortest(input.scene.time.end) + unit +
                   ": nothing has time to flow");
}

}  // namespace

void lintVolumes(const SceneDescription& scene, Faults& faults) {
  const LintInput input{{scene, {}}, {}};
  for (size_t b = 0; b < scene.bodies.size(); ++b)
    for (const PlacedMaterial& material : placedMaterials(input, b)) checkVolume(input, b, material, faults);
}

void lintMaterials(const LintInput& input, Faults& faults) {
  const std::vector<SampledDatum> data = sampledData(input);
  const TimePlan& time = input.scene.time;
  const double largest = nominalStress(input.scene, data);
  const double afterFirstStep =
      time.controlled() ? 0 : nominalStress(input.scene, data, time.begin + time.step());
  double stiffest = 0;
  for (size_t b = 0; b < input.scene.bodies.size(); ++b) {
    if (input.scene.bodies[b].isTool()) continue;
    double onBody = 0;
    for (const SampledDatum& datum : data) {
      if (datum.body != b ||
          (datum.kind != SampledDatum::Kind::traction && datum.kind != SampledDatum::Kind::force))
        continue;
      onBody = std::max(onBody, datum.largestIn(time) * datum.stressOfUnit(input.scene));
    }
    for (const PlacedMaterial& material : placedMaterials(input, b)) {
      checkVolume(input, b, material, faults);
      checkElasticity(input, material, onBody, faults);
      if (const auto* creep = material.description.as<NortonCreep>())
        checkCreep(input, material, *creep, largest, faults);
      if (const auto* viscoelasticity = material.description.as<Viscoelasticity>()) {
        stiffest = std::max(stiffest, time.step() / 2 / viscoelasticity->relaxationTime);
        checkRelaxation(input, material, *viscoelasticity, faults);
      }
      const std::optional<Viscoplasticity> flow = beyondYield(material.description);
      if (!flow) continue;
      checkFlow(input, material, *flow, largest, afterFirstStep, faults);
      if (flow->viscosity == 0) continue;
      stiffest = std::max(stiffest, time.step() / (4 * flow->viscosity) *
                                        relaxingModulus(material.description.elasticity, input.scene.plane));
    }
    if (const std::string& place = input.scene.bodies[b].material.unusedProjection; !place.empty())
      faults.add("projection-unused", place,
                 "body " + input.scene.bodies[b].name + " is elastic, projection has no meaning in it");
  }
  constexpr double ringing = 10;
  if (time.scheme == Scheme::crankNicolson && stiffest > ringing)
    faults.add("scheme-rings", input.where({"time", "scheme"}),
               "crank-nicolson multiplies an overstress by almost -1 in every step: a step is " +
                   digits(2 * stiffest, 4) + " relaxation times long");
}

}  // namespace mortier
