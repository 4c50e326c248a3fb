#include "commands/freefem_materials.h"

#include <algorithm>
#include <map>
#include <variant>

#include "commands/freefem_expression.h"
#include "commands/freefem_text.h"
#include "scene/document.h"

namespace mortier {
namespace {

/// Relaxation time of every body and the part of its shear modulus that is left; 0 where it does not relax.
std::string relaxes(const SceneDescription& scene) {
  std::string text;
  bool any = false;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto* law = scene.bodies[b].material.as<Viscoelasticity>();
    any = any || law != nullptr;
    const std::string n = std::to_string(b + 1);
    text += "real tauM" + n + " = " + shortest(law ? law->relaxationTime : 0) + ", leftM" + n + " = " +
            shortest(law ? law->relaxedFraction : 0) + ";\n";
  }
  return any ? "macro relaxing yes //  shear relaxes: time [" + scene.units.time +
                   "] and the part that is left\n" + text
             : "";
}

/// Reference stress, rate and exponent of every body; a rate of 0 where it does not creep by Norton's law.
std::string creeps(const SceneDescription& scene) {
  std::string text;
  bool any = false;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto* creep = scene.bodies[b].material.as<NortonCreep>();
    any = any || creep != nullptr;
    const std::string n = std::to_string(b + 1);
    text += "real sigmaN" + n + " = " + shortest(creep ? creep->referenceStress : 1) + ", rateN" + n + " = " +
            shortest(creep ? creep->referenceRate : 0) + ", powerN" + n + " = " +
            shortest(creep ? creep->exponent : 1) + ";\n";
  }
  const std::string unit = "[" + scene.units.stress + "]";
  return any ? "macro norton yes //  creep: reference stress " + unit + " and rate [1/" + scene.units.time +
                   "], exponent\n" + text
             : "";
}

/// Flow by the overstress of every body; a yield stress of 0 where it has none.
std::string overstresses(const SceneDescription& scene) {
  std::string text;
  bool any = false;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto* given = scene.bodies[b].material.as<Overstress>();
    any = any || given != nullptr;
    const std::string n = std::to_string(b + 1);
    const Overstress law = given != nullptr ? *given : Overstress();
    text += "real yieldO" + n + " = " + shortest(law.yieldStress) + ", sigmaO" + n + " = " +
            shortest(law.referenceStress) + ", rateO" + n + " = " + shortest(law.referenceRate) + ", powerO" +
            n + " = " + shortest(law.exponent) + ", backO" + n + " = " + shortest(law.kinematicHardening) +
            ", growO" + n + " = " + shortest(law.isotropicHardening) + ";\n";
  }
  const std::string unit = "[" + scene.units.stress + "]";
  return any ? "macro overstressed yes //  yield stress, overstress " + unit + ", its rate [1/" +
                   scene.units.time + "], exponent, kinematic and isotropic hardening " + unit + "\n" + text
             : "";
}

/// One macro for all bodies whose moduli differ from point to point; none where there are none.
std::string anisotropies(const SceneDescription& scene) {
  std::string text;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& own = scene.bodies[b].material.anisotropy;
    if (!own) continue;
    const std::string begin =
        std::to_string(b + 1) + ", " + (own->angle ? "(" + freefemExpression(*own->angle) + ")" : "0.");
    const auto with = [](std::string all, const std::vector<double>& numbers) {
      for (const double number : numbers) all += ", " + shortest(number);
      return all + ") ";
    };
    if (const auto* o = std::get_if<Orthotropy>(&own->moduli)) {
      const auto orOne = [](double x, double other) { return std::isnan(x) ? other : x; };
      text += with("orthotropy(" + begin, {o->young[0], o->young[1], orOne(o->young[2], 1), o->poisson[0],
                                           orOne(o->poisson[1], 0), orOne(o->poisson[2], 0), o->shear});
      continue;
    }
    const Matrix& c = std::get<Matrix>(own->moduli);
    const auto across = [&](int j) { return c.rows() > 3 ? c(3, j) : 0; };
    text += with("stiffness(" + begin, {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2), across(0),
                                        across(1), across(2), across(3)});
  }
  for (size_t b = 0; b < scene.bodies.size(); ++b)
    if (scene.bodies[b].material.as<OwnLaw>() != nullptr) text += "ownLaw(" + std::to_string(b + 1) + ") ";
  return text.empty() ? text
                      : "macro anisotropic " + text +
                            "//  body, angle of axis 1, constants; bodies with a rate of their own\n";
}

/// A function of all bodies: rates by stress and strain, written as the scene has them. Names of parameters
/// become those of FreeFEM, which has no _ in names and words of its own.
class OwnRates {
 public:
  explicit OwnRates(const OwnLaw& law) : law_(law) {
    for (const char* name : {"s11", "s22", "s12", "s33", "e11", "e22", "e12", "e33"}) names_[name] = name;
  }
  std::string text() {
    std::string rates;
    for (size_t c = 0; c < law_.texts->rates.size(); ++c) {
      declare(law_.texts->rates[c]);
      rates += "    G(" + std::to_string(c) + ") = " + written(law_.texts->rates[c]) + ";\n";
    }
    return declared_ + rates;
  }

 private:
  [[nodiscard]] std::string written(const std::string& text) const {
    return freefemFormula(text, law_.where, names_);
  }
  /// What an expression needs, before it; the scene has been read: nothing holds itself.
  void declare(const std::string& text) {
    for (const std::string& name : namesIn(text)) {
      const auto found = law_.texts->named.find(name);
      if (found == law_.texts->named.end() || names_.count(name) > 0) continue;
      declare(found->second);
      names_[name] = "par" + std::to_string(names_.size() - 7);
      declared_ += "    real " + names_[name] + " = " + written(found->second) + ";  // " + name + "\n";
    }
  }

  const OwnLaw& law_;
  std::map<std::string, std::string> names_;
  std::string declared_;
};

std::string ownLaws(const SceneDescription& scene) {
  std::string rates;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto* law = scene.bodies[b].material.as<OwnLaw>();
    if (law == nullptr) continue;
    const std::string n = std::to_string(b + 1);
    rates += "  if (body == " + n + ") {\n" + OwnRates(*law).text() + "  }\n";
  }
  if (rates.empty()) return "";
  return "macro ownLaws yes //  G11, G22, G12, G33 [1/" + scene.units.time +
         "] of stress and strain\n"
         "func int ownRate(int body, real[int] & s, real[int] & e, real[int] & G) {\n"
         "  real s11 = s(0), s22 = s(1), s12 = s(2), s33 = s(3), e11 = e(0), e22 = e(1), e12 = e(2), "
         "e33 = e(3);\n"
         "  G = 0;\n" +
         rates + "  return 0;\n}\n";
}

/// One macro for all bodies with a temperature; none where there are none.
std::string temperatures(const SceneDescription& scene) {
  std::string text;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& temperature = scene.bodies[b].temperature;
    if (!temperature) continue;
    text += "temperature(" + std::to_string(b + 1) + ", " + shortest(scene.bodies[b].material.expansion[0]) +
            ", " +
            (temperature->file.empty() ? "\"\"" : freefemString(temperature->file, temperature->where)) +
            ", " + freefemExpression(temperature->value) + ") ";
  }
  return text.empty() ? text : "macro temperatures " + text + "//  body, expansion, file, factor\n";
}

}  // namespace

std::string freefemMaterials(const SceneDescription& scene) {
  return creeps(scene) + relaxes(scene) + overstresses(scene) + anisotropies(scene) + ownLaws(scene) +
         temperatures(scene);
}

std::string freefemPatches(const Model& model) {
  constexpr size_t ofALine = 20;
  constexpr size_t ofAList = 1000;  // FreeFEM takes 1024
  std::string numbers;
  std::string text;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const VolumePatches* patches = model.bodies[b].patches();
    if (patches == nullptr) continue;
    const std::vector<int>& patchOf = patches->patchOf();
    const std::string name = "patch" + std::to_string(b + 1);
    numbers += "int[int] " + name + "(" + std::to_string(patchOf.size()) + ");\n";
    for (size_t first = 0; first < patchOf.size(); first += ofAList) {
      const size_t end = std::min(first + ofAList, patchOf.size());
      numbers += "{ int[int] some = [";
      for (size_t t = first; t < end; ++t)
        numbers += (t == first ? "" : t % ofALine == 0 ? ",\n  " : ", ") + std::to_string(patchOf[t]);
      numbers +=
          "];\n  " + name + "(" + std::to_string(first) + ":" + std::to_string(end - 1) + ") = some; }\n";
    }
    text += "patchesOf(" + std::to_string(b + 1) + ", " + name + ") ";
  }
  return text.empty() ? text
                      : "macro averaged " + text + "//  body, of its triangles the patch, from 0\n" + numbers;
}

}  // namespace mortier
