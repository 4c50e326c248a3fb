// `mortier law`: tries the law of every body and region that flows (material/law_check.h) and prints what it
// finds.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

#include "base/digits.h"
#include "base/error.h"
#include "base/printable.h"
#include "commands/command_line.h"
#include "material/law_check.h"
#include "material/stress.h"
#include "plan/loads.h"
#include "scene/build.h"

namespace mortier {
namespace {

struct LawOptions : SceneOptions {
  double stress = 0;  ///< largest that is tried; 0: that of the scene's data
  double strain = 0;  ///< largest that is tried; 0: that stress over Young's modulus
  int samples = 100;
};

std::string atStress(const Vector& stress, const std::string& unit) {
  if (stress.size() == 0) return "";
  const auto listed = [&](std::initializer_list<std::pair<const char*, double>> components) {
    std::string text;
    for (const auto& [name, value] : components)
      text += std::string(text.empty() ? " at " : ", ") + name + " = " + digits(value, 3);
    return text;
  };
  if (stress.size() >= 6) {
    const SpaceStress s = toSpaceCartesian(stress.head<6>());
    return listed(
               {{"s11", s[0]}, {"s22", s[1]}, {"s12", s[3]}, {"s33", s[2]}, {"s13", s[4]}, {"s23", s[5]}}) +
           " " + unit;
  }
  const Eigen::Vector3d s = toCartesian(stress.head<3>());
  std::string text = listed({{"s11", s[0]}, {"s22", s[1]}, {"s12", s[2]}});
  if (stress.size() > 3) text += ", s33 = " + digits(stress[3], 3);
  return text + " " + unit;
}

/// A line for each thing that is tried.
class Verdicts {
 public:
  void line(const char* what, bool right, const std::string& text) {
    wrong_ = wrong_ || !right;
    std::printf("  %-12s %s%s\n", what, right ? "" : "WRONG: ", text.c_str());
  }
  [[nodiscard]] bool wrong() const { return wrong_; }

 private:
  bool wrong_ = false;
};

void judge(const LawCheck& check, const Material& material, bool isotropic, const SceneDescription& scene,
           Verdicts& verdicts) {
  constexpr double tangentIsRight = 1e-4;
  constexpr double turns = 1e-9;
  constexpr double makesEnergy = -1e-9;
  const std::string& unit = scene.units.stress;
  const bool everywhere = check.numbers == check.samples;
  verdicts.line("rate", everywhere,
                "a number at " + std::to_string(check.numbers) + " of " + std::to_string(check.samples) +
                    " stresses" + (everywhere ? "" : ", the least without" + atStress(check.overflow, unit)));
  if (everywhere && check.overflow.size() > 0)
    verdicts.line("overflow", true, "beyond these stresses" + atStress(check.overflow, unit));
  if (check.lipschitz == 0) {
    verdicts.line("flow", true, "none at these stresses");
    return;
  }
  verdicts.line("tangent", check.tangent <= tangentIsRight,
                digits(check.tangent, 3) + " off differences, over ten decades of the step" +
                    (check.tangent <= tangentIsRight ? "" : "," + atStress(check.worstTangent, unit)));
  const bool turned = check.turning <= turns;
  verdicts.line("isotropy", turned || !isotropic,
                digits(check.turning, 3) +
                    (turned ? " off when axes turn" : " off when axes turn: it is not isotropic") +
                    (isotropic ? "" : ", and not said to be"));
  const bool dissipates = check.dissipation >= makesEnergy;
  verdicts.line("dissipation", dissipates || material.needsTotalStrain(),
                "s : G is at least " + digits(check.dissipation, 3) + " |s| |G|" +
                    (dissipates                    ? ""
                     : material.needsTotalStrain() ? ": it gives back what the strain has stored"
                                                   : ": it makes energy"));
  const bool anyStep = check.monotone() && !material.needsTotalStrain();
  verdicts.line("monotone", true,
                std::string(check.monotone() ? "yes" : "no") + ", least slope " + digits(check.monotony, 3) +
                    " of the largest");
  const double longest = scene.time.end / scene.time.steps;
  const double limit = 1 / check.lipschitz;
  std::string steps = "steps below " + digits(limit, 3) + " s have one solution (Proposition 1)";
  if (anyStep)
    steps += ", and all others, as it is monotone";
  else if (!scene.time.controlled() && longest >= limit)
    steps += "; those of the scene are " + digits(longest / limit, 3) + " times as long";
  verdicts.line("Lipschitz", std::isfinite(check.lipschitz),
                digits(check.lipschitz, 3) + " 1/" + scene.units.time + atStress(check.steepest, unit));
  verdicts.line("steps", true, steps);
}

/// \returns 0, or 1 where a law is wrong: no number, a tangent that is not its derivative, energy made of
/// nothing, or not as isotropic as it is said to be. \throws InputError
int tryLaws(const LawOptions& command) {
  ResolvedScene resolved = resolveScene(readScene(command.scene, command.settings));
  const Model model = buildModel(resolved);
  const SceneDescription& scene = resolved.description;
  const double stress =
      command.stress > 0 ? command.stress : nominalStress(scene, sampledData(meshedScene(scene, model)));
  if (!(stress > 0))
    throw InputError(command.scene + ": no datum of the scene asks for a stress, expected --stress");
  Verdicts verdicts;
  for (const BodyDescription& body : scene.bodies)
    for (const MaterialDescription* description : materialsOf(body)) {
      MaterialDescription inItsAxes = *description;
      if (inItsAxes.anisotropy) inItsAxes.anisotropy->angle.reset();
      const auto material = buildMaterial(inItsAxes, scene.inSpace() ? Plane::none : scene.plane);
      const auto* own = description->as<OwnLaw>();
      const double strain = command.strain > 0 ? command.strain : stress / description->elasticity.young;
      std::string name = "body " + body.name;
      for (const RegionDescription& region : body.regions)
        if (region.material && &*region.material == description)
          name += " region " + std::to_string(region.label);
      const std::string where = scene.inSpace() ? "in space" : "plane " + word(scene.plane);
      std::printf("%s: %s, %s, stresses up to %s %s\n", printable(name).c_str(),
                  material->laws().front().text().c_str(), where.c_str(), digits(stress, 3).c_str(),
                  scene.units.stress.c_str());
      if (!description->flows())
        std::puts("  elastic");
      else
        judge(checkLaw(*material, {stress, strain, command.samples}), *material,
              own == nullptr || own->isotropic, scene, verdicts);
    }
  return verdicts.wrong() ? exitFailed : exitDone;
}

}  // namespace

Command addLaw(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "law", "try the laws of a scene at random stresses (docs/check.md); exit code 0 or 1");
  const auto options = std::make_shared<LawOptions>();
  options->addScene(*command);
  options->addSettings(*command);
  command->add_option("--stress", options->stress, "largest stress (default: that of the scene's data)")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  command->add_option("--strain", options->strain, "largest strain (default: that stress over young)")
      ->check(CLI::PositiveNumber)
      ->type_name("E");
  command->add_option("--samples", options->samples, "how many stresses (default 100)")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  return {command, [options] {
            options->requireScene();
            return tryLaws(*options);
          }};
}

}  // namespace mortier
