// The files of a result as a run goes on: history.csv, contact.csv, fields.
#pragma once

#include <string>
#include <vector>

#include "report/fields.h"
#include "report/tables.h"

namespace mortier {

/// How far the files had come at a checkpoint.
struct FilesSoFar {
  FileRecord history;
  FileRecord contact;
  std::vector<KeptFields> fields;
};

/// Takes the fields away that are in `files` and not in `kept`.
void removeFields(const std::string& folder, const FilesSoFar& files, const FilesSoFar& kept);

/// Copies files of a result to names of their own beside them, which no result keeps.
/// \throws OutputError
void keepAside(const std::string& folder, const std::map<std::string, FileRecord>& files);
/// Gives them their names again.
void bringBack(const std::string& folder, const std::map<std::string, FileRecord>& files);

class ResultFiles {
 public:
  /// \param error  of the states that are added
  ResultFiles(const std::string& folder, const Model& model, CurrentSpaceError& error,
              const std::vector<Quantity>& quantities, const Units& units);
  /// Goes on with files that are there; what they hold beyond `soFar` is cut off.
  ResultFiles(const std::string& folder, const Model& model, CurrentSpaceError& error,
              const FilesSoFar& soFar);

  /// Adds a step (or the initial state, step 0). \param kept  whether its fields and contact are
  void add(const State& state, const StepReport& report, bool kept);
  /// Brings everything to the disk.
  FilesSoFar sync();
  /// Keeps the last step and closes the files. \returns what was written, by name.
  std::map<std::string, FileRecord> close(const State& state, int lastStep);

 private:
  void keep(const State& state, int step);

  const Model& model_;
  OutputFile history_;
  OutputFile contact_;
  Fields fields_;
  int lastKept_;
};

}  // namespace mortier
