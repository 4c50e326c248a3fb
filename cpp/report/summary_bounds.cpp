// Guaranteed bounds in summary.json.
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/log.h"

namespace mortier {

namespace {

using Json = nlohmann::ordered_json;

Json over(double error, double norm) {
  const std::optional<double> relative = overExact(error, norm);
  return relative ? Json(*relative) : Json(nullptr);
}

/// Nothing under the key, for a reason.
Json withoutValue(const char* key, const std::string& reason) {
  return {{key, nullptr}, {"reason", reason}};
}

/// Bounds of viscoplastic strain and stress, of FlowBound or TotalBound, unless there is a reason.
template <class Bound>
Json strainAndStress(const Bound& bound, const std::string& reason, double strain, double stress) {
  if (!reason.empty()) return {{"viscoplastic_strain", nullptr}, {"stress", nullptr}, {"reason", reason}};
  return {{"viscoplastic_strain", over(strain, bound.strainNorm)},
          {"stress", over(stress, bound.stressNorm)}};
}

Json jsonOf(const EnergyBound& bound) {
  if (!bound.obstacle.empty()) return withoutValue("energy_error", bound.obstacle);
  return {{"energy_error", over(bound.bound, bound.norm)},
          {"absolute", bound.bound},
          {"norm", bound.norm},
          {"stress", bound.stress},
          {"lift", bound.lift},
          {"gap", std::sqrt(2 * bound.gap)},
          {"data", bound.oscillation}};
}

Json jsonOfStep(const EnergyBound& bound) {
  if (!bound.obstacle.empty()) return withoutValue("viscoplastic_strain", bound.obstacle);
  Json json = jsonOf(bound);
  json["viscoplastic_strain"] = over(bound.strain, bound.strainNorm);
  json["flow"] = bound.flow;
  return json;
}

Json jsonOf(const FlowBound& bound) {
  if (!bound.obstacle.empty()) return withoutValue("viscoplastic_strain", bound.obstacle);
  Json json = strainAndStress(bound, bound.moved, bound.strain, bound.stress);
  json["any_contact"] = nullptr;
  if (std::isfinite(bound.factor))
    json["any_contact"] =
        strainAndStress(bound, "", bound.factor * bound.strain, bound.factor * bound.stress);
  json["data"] = bound.data;
  return json;
}

Json jsonOf(const TotalBound& bound) {
  if (!bound.obstacle.empty()) return withoutValue("viscoplastic_strain", bound.obstacle);
  Json json = strainAndStress(bound, bound.moved, bound.fixed.strain, bound.fixed.stress);
  json["any_contact"] = strainAndStress(bound, bound.closes, bound.any.strain, bound.any.stress);
  json["lift"] = over(bound.lifted, bound.strainNorm);
  json["data"] = bound.data;
  return json;
}

}  // namespace

template <class Object>
Object jsonOfBound(const EnergyBound& bound, size_t quantity, double value) {
  if (bound.quantities.empty()) return withoutValue("error", bound.obstacle);
  const Enclosure& enclosure = bound.quantities[quantity];
  if (enclosure.obstacle.empty())
    return {{"error", enclosure.error(value)}, {"lower", enclosure.lower}, {"upper", enclosure.upper}};
  Object json = withoutValue("error", enclosure.obstacle);
  if (enclosure.estimate) json["estimate"] = *enclosure.estimate;
  return json;
}

template <class Object>
Object jsonOfBounds(const Accuracy& accuracy) {
  Object json = jsonOf(*accuracy.bound);
  if (accuracy.flow) json["time"] = jsonOf(*accuracy.flow);
  if (accuracy.total) json["total"] = jsonOf(*accuracy.total);
  if (accuracy.step) json["step"] = jsonOfStep(*accuracy.step);
  return json;
}

template nlohmann::ordered_json jsonOfBounds(const Accuracy&);
template nlohmann::ordered_json jsonOfBound(const EnergyBound&, size_t, double);

}  // namespace mortier
