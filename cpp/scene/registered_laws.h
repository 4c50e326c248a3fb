// User-defined laws by name, for scenes that say law = "name" (material/rate_law.h).
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "material/rate_law.h"
#include "scene/keys.h"

namespace mortier {

/// What a scene has under `parameters`.
class LawParameters {
 public:
  LawParameters(std::map<std::string, double> values, std::string where)
      : values_(std::move(values)), where_(std::move(where)) {}
  /// \throws InputError where there is none
  [[nodiscard]] double operator[](const std::string& name) const;
  [[nodiscard]] double orElse(const std::string& name, double fallback) const;
  /// All of them; then any name is one of the law.
  [[nodiscard]] const std::map<std::string, double>& all() const;
  /// \throws InputError for one that the law has not asked for
  void requireAllUsed() const;

 private:
  std::map<std::string, double> values_;
  std::string where_;
  mutable std::set<std::string> asked_;
  mutable bool askedForAll_ = false;
};

using LawMaker = std::function<std::shared_ptr<const RateLaw>(const LawParameters&)>;

/// Makes a law known to all scenes that are read from then on, in place of one of that name. Any thread may
/// call it. \throws InputError where the name is not letters, digits, _ and -, or that of a law of mortier's
void registerLaw(const std::string& name, LawMaker make);
/// Of a type as in rate_law.h: make(parameters) is one.
template <class Make>
void registerTypedLaw(const std::string& name, Make make) {
  registerLaw(name, [make](const LawParameters& parameters) { return rateLaw(make(parameters)); });
}
/// Forgets it; scenes that were read keep it.
void forgetLaw(const std::string& name);

/// None where it is not registered.
LawMaker registeredLaw(const std::string& name);
Keys registeredLaws();

}  // namespace mortier
