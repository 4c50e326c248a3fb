// How a finished result takes the place of an older one, and what is done about runs that were killed on the
// way. At any moment the old or the new result stands in its place, whole, and every file of others stays:
//   1. DIR.tmp-PID gets its manifest: from here on the run is complete, and who finds it goes on with 2.
//   2. Names are exchanged: DIR is the new result, DIR.tmp-PID the old one. The run.lock in DIR names the
//      latter.
//   3. Files of others move from the old result into the new one; what the old one's manifest lists goes.
//   4. Stopped runs for DIR and an old DIR.failed go, run.lock last.
// Folders that are just being made or taken away are called DIR.mortier-PID.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mortier {

/// Where the results of runs for a folder stand.
class ResultPlace {
 public:
  /// \throws InputError  a link to nothing, the current folder or one above it
  explicit ResultPlace(const std::string& path);

  /// DIR, or DIR.failed for a run that stopped early; links resolved.
  [[nodiscard]] std::filesystem::path of(bool failedRun) const;
  [[nodiscard]] std::filesystem::path parent() const { return result_.parent_path(); }
  /// A folder beside the result that does not exist: its name, `middle` and the number of this process.
  [[nodiscard]] std::filesystem::path unused(const std::string& middle) const;
  /// Whether `name` is that of such a folder, of any process: names in locks are data of others.
  [[nodiscard]] bool isCalled(const std::string& name, const std::string& middle) const;
  /// Folders beside the result that are called so.
  [[nodiscard]] std::vector<std::filesystem::path> all(const std::string& middle) const;
  /// A folder here as the user calls it, for messages.
  [[nodiscard]] std::string shown(const std::filesystem::path& folder) const;

  /// \throws InputError  it holds what is no result of mortier; OutputError  this user cannot replace it.
  void requireReplaceable() const;

 private:
  void requireReplaceable(const std::filesystem::path& target) const;

  std::string given_;
  std::filesystem::path result_;
};

/// Step 2, for a folder with a manifest whose lock this process holds. \returns where the result is.
std::filesystem::path putInPlace(const ResultPlace& place, const std::filesystem::path& temporary);

/// Steps 3 and 4. \param target  has just been put in place  \param name  of its folder before that
void finish(const ResultPlace& place, const std::filesystem::path& target, const std::string& name);

/// Clears up after killed runs: complete results are put in place, those that cannot be resumed are
/// deleted.
/// \throws InputError  a living process writes there.
struct LeftBehind {
  std::vector<std::filesystem::path> stopped;  ///< temporary folders with a checkpoint, the latest first
  std::filesystem::path placed;  ///< where a complete result was put that had no place; empty: there was none
};
LeftBehind clearUp(const ResultPlace& place);

/// Deletes the files of the program in a folder, and the folder. Files of others move into `heir`;
/// where that is no result, they stay.
void discard(const ResultPlace& place, const std::filesystem::path& folder,
             const std::filesystem::path& heir);

}  // namespace mortier
