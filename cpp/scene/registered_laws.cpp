#include "scene/registered_laws.h"

#include <mutex>

#include "base/error.h"
#include "scene/scene.h"

namespace mortier {
namespace {

struct Registry {
  std::mutex mutex;
  std::map<std::string, LawMaker> laws;
};

/// Never taken down: laws may belong to an interpreter that has ended before.
Registry& registry() {
  static auto* const all = new Registry;
  return *all;
}

}  // namespace

double LawParameters::operator[](const std::string& name) const {
  asked_.insert(name);
  const auto found = values_.find(name);
  if (found == values_.end())
    throw InputError(where_ + ": parameters." + name + " is missing, expected a number");
  return found->second;
}

double LawParameters::orElse(const std::string& name, double fallback) const {
  asked_.insert(name);
  const auto found = values_.find(name);
  return found == values_.end() ? fallback : found->second;
}

const std::map<std::string, double>& LawParameters::all() const {
  askedForAll_ = true;
  return values_;
}

void LawParameters::requireAllUsed() const {
  if (askedForAll_) return;
  const Keys known(asked_.begin(), asked_.end());
  for (const auto& [name, value] : values_)
    if (asked_.count(name) == 0)
      throw InputError(where_ + ": unknown key parameters." + name +
                       (known.empty() ? ", expected none" : ", expected one of " + joined(known)));
}

void registerLaw(const std::string& name, LawMaker make) {
  const Keys& own = keyAt("body.material", "law").words;
  if (!isName(name)) throw InputError("law \"" + name + "\", expected a name of letters, digits, _ and -");
  if (isOneOf(name, own))
    throw InputError("law \"" + name +
                     "\", expected another name than those of mortier's own: " + joined(own));
  const std::scoped_lock locked(registry().mutex);
  registry().laws[name] = std::move(make);
}

void forgetLaw(const std::string& name) {
  const std::scoped_lock locked(registry().mutex);
  registry().laws.erase(name);
}

LawMaker registeredLaw(const std::string& name) {
  const std::scoped_lock locked(registry().mutex);
  const auto found = registry().laws.find(name);
  return found == registry().laws.end() ? LawMaker() : found->second;
}

Keys registeredLaws() {
  const std::scoped_lock locked(registry().mutex);
  Keys names;
  for (const auto& [name, make] : registry().laws) names.push_back(name);
  return names;
}

}  // namespace mortier
