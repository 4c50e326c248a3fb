// contact.csv: per kept step and nonmortar node its place as meshed, gap [m], positive where the bodies are
// apart, nodal force p [N/m], pressure Phi^-1 p [Pa], and whether it is active (p > 0). Vertices and
// interfaces count from 0.
#pragma once

#include <vector>

#include "report/output_file.h"
#include "time/march.h"

namespace mortier {

/// One interface at one state, by nonmortar node.
struct ContactFields {
  std::vector<int> vertex;
  std::vector<Point> place;  ///< as meshed [m]
  Vector gap;                ///< positive where the bodies are apart [m]
  Vector force;              ///< [N/m]
  Vector pressure;           ///< [Pa]
};
ContactFields contactFields(const Model& model, const State& state, size_t interface);

class ContactTable {
 public:
  ContactTable(const std::string& folder, const Model& model);
  /// Goes on after what `keep` records.
  ContactTable(const std::string& folder, const Model& model, const FileRecord& keep)
      : model_(model), file_(folder + "/contact.csv", keep) {}
  void add(const State& state, int step);
  /// Brings everything to the disk. \returns what is written so far.
  FileRecord sync() { return file_.sync(); }
  FileRecord close() { return file_.close(); }

 private:
  const Model& model_;
  OutputFile file_;
};

}  // namespace mortier
