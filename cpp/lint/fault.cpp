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
  constexpr size_t most = 20;
  const FaultKind& kind = faultKind(id);
  if (kind.severity == Severity::warning && allowed_.count(id) != 0) return;
  OfKind& known = kinds_[&kind];
  if (!known.seen.insert(std::hash<std::string>()(place + '\n' + message)).second) return;
  if (known.seen.size() > most) {
    ++faults_[known.last].more;
    return;
  }
  known.last = faults_.size();
  faults_.push_back({&kind, place, message});
}

void Faults::add(const std::string& id, const std::string& message) {
  const size_t end = message.find(": ");
  if (end == std::string::npos) return add(id, "", message);
  add(id, message.substr(0, end), message.substr(end + 2));
}

int Faults::count(Severity severity) const {
  size_t number = 0;
  for (const Fault& fault : faults_)
    if (fault.kind->severity == severity) number += 1 + fault.more;
  return static_cast<int>(number);
}

bool Faults::has(const std::string& id) const {
  return kinds_.count(&faultKind(id)) != 0;
}

void Faults::drop(const std::string& id) {
  const FaultKind& kind = faultKind(id);
  faults_.erase(
      std::remove_if(faults_.begin(), faults_.end(), [&](const Fault& fault) { return fault.kind == &kind; }),
      faults_.end());
  kinds_.erase(&kind);
  for (size_t i = 0; i < faults_.size(); ++i) kinds_[faults_[i].kind].last = i;
}

std::string listed(size_t n, const std::function<std::string(size_t)>& word) {
  constexpr size_t most = 20;
  std::string text;
  for (size_t i = 0; i < std::min(n, most); ++i) text += (i == 0 ? "" : ", ") + word(i);
  return n > most ? text + " and " + std::to_string(n - most) + " more" : text;
}

std::string oneLine(const Fault& fault) {
  return fault.place + ": " + word(fault.kind->severity) + ": " + withRemedy(fault);
}

std::string withRemedy(const Fault& fault) {
  return fault.message + "; " + fault.kind->remedy + " [" + fault.kind->id + "]" +
         (fault.more > 0 ? " and " + std::to_string(fault.more) + " more of this kind" : "");
}

std::string word(Severity severity) {
  return severity == Severity::warning ? "warning" : "error";
}

}  // namespace mortier
