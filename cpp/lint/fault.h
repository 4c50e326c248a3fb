// What the linter reports. Every kind of fault has an id, a severity and a remedy; docs/check.md lists them
// all.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <unordered_set>
#include <vector>

namespace mortier {

enum class Severity {
  warning,  ///< doubtful, but a run would go on
  error,    ///< a run would refuse it as wrong input
  unheld    ///< a run would refuse it as nothing holds a body
};

struct FaultKind {
  std::string id;
  Severity severity = Severity::warning;
  std::string what;  ///< for the documentation
  std::string remedy;
};

/// All kinds, in the order of the documentation.
const std::vector<FaultKind>& faultKinds();

/// \pre the id is one of faultKinds().
const FaultKind& faultKind(const std::string& id);

struct Fault {
  const FaultKind* kind = nullptr;
  std::string place;    ///< `file:line`, or a mesh and what of it
  std::string message;  ///< what was found, with its numbers
  size_t more = 0;      ///< faults of this kind that are counted only, in the last one that is listed
};

/// A list of faults: some of each kind, and the number of further ones.
class Faults {
 public:
  /// \param allowed  ids of warnings that are not to be named.
  explicit Faults(const std::vector<std::string>& allowed = {}) : allowed_(allowed.begin(), allowed.end()) {}

  void add(const std::string& id, const std::string& place, const std::string& message);
  /// One whose message begins with its place, `file:line: ` or `file: `.
  void add(const std::string& id, const std::string& message);
  [[nodiscard]] const std::vector<Fault>& all() const { return faults_; }
  [[nodiscard]] int count(Severity severity) const;
  [[nodiscard]] bool has(const std::string& id) const;
  /// All of a kind, also those that are counted only.
  void drop(const std::string& id);

 private:
  struct OfKind {
    std::unordered_set<size_t> seen;  ///< hashes: several components or bodies may share a fault
    size_t last = 0;                  ///< index of the last one that is listed
  };
  std::set<std::string> allowed_;
  std::vector<Fault> faults_;
  std::map<const FaultKind*, OfKind> kinds_;
};

/// "a, b, c", of many words the first ones and how many there are beside them.
std::string listed(size_t n, const std::function<std::string(size_t)>& word);

/// `place: warning: message; remedy [id]`
std::string oneLine(const Fault& fault);

/// `message; remedy [id]`
std::string withRemedy(const Fault& fault);

/// "warning" or "error".
std::string word(Severity severity);

}  // namespace mortier
