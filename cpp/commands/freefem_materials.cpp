#include <algorithm>
#include <map>
#include <variant>

#include "commands/freefem.h"
#include "scene/document.h"

namespace mortier {
namespace {

/// Numbers of one law for every body, under a macro; nothing where no body follows it. \param none  those of
/// the bodies that do not  \param comment  what the numbers are
template <class Law>
std::string lawNumbers(const SceneDescription& scene, const std::string& macro, const std::string& comment,
                       const Law& none, const std::vector<std::pair<const char*, double Law::*>>& numbers) {
  std::string text;
  bool any = false;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto* given = scene.bodies[b].material.as<Law>();
    any = any || given != nullptr;
    std::string line;
    for (const auto& [name, number] : numbers)
      line += (line.empty() ? "real " : ", ") + (name + std::to_string(b + 1)) + " = " +
              shortest((given != nullptr ? *given : none).*number);
    text += line + ";\n";
  }
  return any ? "macro " + macro + " yes //  " + comment + "\n" + text : "";
}

/// Creep, relaxation and flow by the overstress; a rate, a time or a yield stress of 0 where there is none.
std::string lawsWithNumbers(const SceneDescription& scene) {
  const std::string stress = "[" + scene.units.stress + "]";
  const std::string rate = "[1/" + scene.units.time + "]";
  return lawNumbers<NortonCreep>(scene, "norton",
                                 "creep: reference stress " + stress + " and rate " + rate + ", exponent",
                                 NortonCreep{1, 0, 1},
                                 {{"sigmaN", &NortonCreep::referenceStress},
                                  {"rateN", &NortonCreep::referenceRate},
                                  {"powerN", &NortonCreep::exponent}}) +
         lawNumbers<Viscoelasticity>(
             scene, "relaxing", "shear relaxes: time [" + scene.units.time + "] and the part that is left",
             Viscoelasticity(),
             {{"tauM", &Viscoelasticity::relaxationTime}, {"leftM", &Viscoelasticity::relaxedFraction}}) +
         lawNumbers<Overstress>(scene, "overstressed",
                                "yield stress, overstress " + stress + ", its rate " + rate +
                                    ", exponent, kinematic and isotropic hardening " + stress,
                                Overstress(),
                                {{"yieldO", &Overstress::yieldStress},
                                 {"sigmaO", &Overstress::referenceStress},
                                 {"rateO", &Overstress::referenceRate},
                                 {"powerO", &Overstress::exponent},
                                 {"backO", &Overstress::kinematicHardening},
                                 {"growO", &Overstress::isotropicHardening}});
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
                                           orOne(o->poisson[1], 0), orOne(o->poisson[2], 0), o->shear[0]});
      continue;
    }
    const Matrix& c = std::get<Matrix>(own->moduli);
    const auto across = [&](int j) { return c.rows() > 3 ? c(3, j) : 0; };
    text += with("stiffness(" + begin, {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2), across(0),
                                        across(1), across(2), across(3)});
  }
  for (size_t b = 0; b < scene.bodies.size(); ++b)
    if (scene.bodies[b].material.as<OwnLaw>() != nullptr) text += "ownLaw(" + std::to_string(b + 1) + ") ";
  return freefemMacro("anisotropic", text,
                      "body, angle of axis 1, constants; bodies with a rate of their own");
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
  return freefemMacro("temperatures", text, "body, expansion, file, factor");
}

}  // namespace

std::string freefemMaterials(const SceneDescription& scene) {
  return lawsWithNumbers(scene) + anisotropies(scene) + ownLaws(scene) + temperatures(scene);
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
  return freefemMacro("averaged", text, "body, of its elements the patch, from 0") + numbers;
}

}  // namespace mortier
