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

}  // namespace

template <class Object>
Object jsonOfBound(const EnergyBound& bound) {
  if (!bound.obstacle.empty()) return withoutValue("energy_error", bound.obstacle);
  return {{"energy_error", over(bound.bound, bound.norm)},
          {"absolute", bound.bound},
          {"norm", bound.norm},
          {"stress", bound.stress},
          {"lift", bound.lift},
          {"gap", std::sqrt(2 * bound.gap)},
          {"data", bound.oscillation}};
}

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

template nlohmann::ordered_json jsonOfBound(const EnergyBound&);
template nlohmann::ordered_json jsonOfBound(const EnergyBound&, size_t, double);

}  // namespace mortier
