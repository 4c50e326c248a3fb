#include "lint/fault.h"

#include <algorithm>
#include <stdexcept>

namespace mortier {

const FaultKind& faultKind(const std::string& id) {
  const auto& kinds = faultKinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const FaultKind& kind) { return kind.id == id; });
  if (found == kinds.end()) throw std::logic_error("no fault is called " + id);
  return *found;
}

void Faults::add(const std::string& id, const std::string& place, const std::string& message) {
  const FaultKind& kind = faultKind(id);
  if (kind.severity == Severity::warning && allowed_.count(id) != 0) return;
  // Said once of what several components of a condition or several bodies of a mesh share.
  const auto known = [&](const Fault& fault) {
    return fault.kind == &kind && fault.place == place && fault.message == message;
  };
  if (std::none_of(faults_.begin(), faults_.end(), known)) faults_.push_back({&kind, place, message});
}

int Faults::count(Severity severity) const {
  return static_cast<int>(std::count_if(
      faults_.begin(), faults_.end(), [&](const Fault& fault) { return fault.kind->severity == severity; }));
}

std::string counted(size_t n, const std::string& what) {
  if (n == 1) return "1 " + what;
  return std::to_string(n) + " " + (what == "vertex" ? "vertices" : what + "s");
}

std::string oneLine(const Fault& fault) {
  return fault.place + ": " + word(fault.kind->severity) + ": " + withRemedy(fault);
}

std::string withRemedy(const Fault& fault) {
  return fault.message + "; " + fault.kind->remedy + " [" + fault.kind->id + "]";
}

std::string word(Severity severity) {
  return severity == Severity::warning ? "warning" : "error";
}

}  // namespace mortier
