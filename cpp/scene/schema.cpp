#include "scene/schema.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace mortier {

const Keys& keysOf(const std::string& path) {
  static const Keys materialKeys{"young",
                                 "poisson",
                                 "law",
                                 "viscosity",
                                 "yield_stress",
                                 "projection",
                                 "reference_stress",
                                 "reference_rate",
                                 "exponent",
                                 "relaxation_time",
                                 "relaxed_fraction",
                                 "kinematic_hardening",
                                 "isotropic_hardening",
                                 "rate11",
                                 "rate22",
                                 "rate12",
                                 "rate33",
                                 "parameters",
                                 "isotropic",
                                 "elasticity",
                                 "young1",
                                 "young2",
                                 "young3",
                                 "poisson12",
                                 "poisson13",
                                 "poisson23",
                                 "shear12",
                                 "stiffness",
                                 "angle",
                                 "expansion"};
  static const std::map<std::string, Keys> tables = {
      {"",
       {"title", "plane", "body", "contact", "quantity", "time", "solver", "output", "check", "degree",
        "accuracy", "units"}},
      {"body",
       {"name", "mesh", "material", "force", "boundary", "region", "initial_stress", "point", "temperature"}},
      {"body.mesh",
       {"file", "region", "size", "parameters", "shape", "cells", "cut", "lower", "upper", "focus", "grading",
        "corners", "centre", "inner", "outer", "span", "lowest", "radius", "core"}},
      {"body.initial_stress", {"s11", "s22", "s12", "s33"}},
      {"body.region", {"label", "material", "initial_stress"}},
      {"body.region.material", materialKeys},
      {"body.region.initial_stress", {"s11", "s22", "s12", "s33"}},
      {"body.material", materialKeys},
      {"body.force", {"x", "y"}},
      {"body.temperature", {"file", "factor"}},
      {"body.boundary", {"label", "ux", "uy", "un", "ut", "tx", "ty", "pressure"}},
      {"body.point", {"at", "ux", "uy"}},
      {"datum", {"time", "value"}},
      {"contact",
       {"nonmortar", "mortar", "sides", "variant", "swap", "initial", "gap", "friction", "shear_limit",
        "sliding"}},
      {"contact.sides", {"body", "label"}},
      {"contact.nonmortar", {"body", "label"}},
      {"contact.mortar", {"body", "label"}},
      {"quantity",
       {"name", "reaction", "contact_force", "displacement", "component", "about", "stored_energy",
        "dissipated_energy", "work", "external_work", "thermal_work", "largest_pressure", "contact_length",
        "largest_mises", "friction_work", "mean_pressure"}},
      {"quantity.reaction", {"body", "label", "point"}},
      {"quantity.contact_force", {"body", "label"}},
      {"quantity.displacement", {"body", "label", "point"}},
      {"quantity.stored_energy", {"body"}},
      {"quantity.dissipated_energy", {"body"}},
      {"quantity.work", {"body"}},
      {"quantity.external_work", {"body"}},
      {"quantity.thermal_work", {"body"}},
      {"quantity.largest_pressure", {"body", "label"}},
      {"quantity.contact_length", {"body", "label"}},
      {"quantity.friction_work", {"body", "label"}},
      {"quantity.largest_mises", {"body"}},
      {"quantity.mean_pressure", {"body", "label", "from", "to", "margin"}},
      {"time", {"end", "steps", "scheme", "tolerance", "max_steps", "breaks"}},
      {"solver",
       {"method", "tolerance", "max_iterations", "linear", "distributed_from", "reduce", "list_solutions"}},
      {"accuracy", {"energy", "quantity", "tolerance", "max_unknowns", "max_seconds", "bound"}},
      {"check", {"allow"}},
      {"output", {"every"}},
  };
  static const Keys none;
  const auto found = tables.find(path);
  return found == tables.end() ? none : found->second;
}

std::string joined(const Keys& keys) {
  std::string text;
  for (const std::string& key : keys) {
    text += (text.empty() ? "" : ", ") + key;
  }
  return text;
}

namespace {

/// Levenshtein distance.
size_t distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substituted = diagonal + (a[i - 1] != b[j - 1] ? 1 : 0);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest(const std::string& word, const Keys& keys) {
  std::string best;
  size_t least = 3 + word.size() / 5;  // beyond that a suggestion misleads
  for (const std::string& key : keys) {
    const size_t d = distance(word, key);
    if (d < least && d < std::max(word.size(), key.size())) {
      least = d;
      best = key;
    }
  }
  return best;
}

}  // namespace mortier
