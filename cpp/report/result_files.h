// The files of a result as a run goes on: history.csv, contact.csv, fields.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "report/fields.h"
#include "report/manifest.h"
#include "time/march.h"
#include "time/quantity.h"

namespace mortier {

// The tables of a result, a row each:
//   history.csv  per step, with everything that is reported of it; with friction whether several solutions
//                are possible and the work of each interface that has it; the quantities of the scene. Units
//                stand in the header.
//   contact.csv  per kept step and nonmortar node: its place as meshed (in space with z), gap [m],
//                positive where the bodies are apart, nodal force p [N/m], pressure Phi^-1 p [Pa], whether
//                it is active (p > 0). Where any interface has friction also the fields along the line.
//                Vertices and interfaces count from 0.

using HistoryValue = std::variant<int, double, std::string_view>;

/// The columns with their units, `time[s]`, and their values.
std::vector<std::string> historyColumns(const Model& model, const std::vector<Quantity>& quantities,
                                        const Units& units);
std::vector<HistoryValue> historyRow(const StepReport& report);
/// The initial state has one where something acts in it.
inline bool hasRow(const StepReport& report) {
  return report.step > 0 || report.motion > 0 || report.vonMises > 0;
}

/// One interface at one state, by nonmortar node.
struct ContactFields {
  std::vector<int> vertex;
  std::vector<SpacePoint> place;  ///< as meshed; z = 0 in the plane [m]
  Vector gap;                     ///< positive where the bodies are apart [m]
  Vector force;                   ///< [N/m]
  Vector pressure;                ///< [Pa]
  // By columns, along the line (the nonmortar body to the left), in space by three components along the axes;
  // zero where there is no friction.
  Matrix friction;  ///< nodal force t on the nonmortar body [N/m]
  Matrix shear;     ///< Phi^-1 t [Pa]
  Matrix slip;      ///< how far it has moved over the other body since t = 0 [m]
  std::vector<signed char>
      slipping;  ///< sign of t where the node slipped in the last step, 1 in space; else 0
};
ContactFields contactFields(const Model& model, const State& state, size_t interface);

// Lines of the files.
void writeHistoryHeader(OutputFile& file, const std::vector<std::string>& columns);
void writeHistoryRow(OutputFile& file, const StepReport& report);
void writeContactHeader(OutputFile& file, const Model& model);
void writeContactRows(OutputFile& file, const Model& model, const State& state, int step);

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
  ResultFiles(const std::string& folder, const Model& model, CurrentMeshError& error,
              const std::vector<Quantity>& quantities, const Units& units);
  /// Goes on with files that are there; what they hold beyond `soFar` is cut off.
  ResultFiles(const std::string& folder, const Model& model, CurrentMeshError& error,
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
