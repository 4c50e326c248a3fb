// contact.csv: per kept step and nonmortar node its place as meshed, gap [m], positive where the bodies are
// apart, nodal force p [N/m], pressure Phi^-1 p [Pa], and whether it is active (p > 0). Where any interface
// has friction also the nodal force t [N/m] and the shear stress Phi^-1 t [Pa] that the nonmortar body exerts
// along the line (its body to the left), by how much it has moved over the other since t = 0 [m], and 1 or -1
// where the node slipped in the last step, the sign of t, else 0. Vertices and interfaces count from 0.
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
  // Along the line; zero where there is no friction.
  Vector friction;                    ///< [N/m]
  Vector shear;                       ///< [Pa]
  Vector slip;                        ///< [m]
  std::vector<signed char> slipping;  ///< sign of t where the node slipped in the last step, else 0
};
ContactFields contactFields(const Model& model, const State& state, size_t interface);

class ContactTable {
 public:
  ContactTable(const std::string& folder, const Model& model);
  /// Goes on after what `keep` records.
  ContactTable(const std::string& folder, const Model& model, const FileRecord& keep)
      : model_(model), rough_(anyFriction(model)), file_(folder + "/contact.csv", keep) {}
  void add(const State& state, int step);
  /// Brings everything to the disk. \returns what is written so far.
  FileRecord sync() { return file_.sync(); }
  FileRecord close() { return file_.close(); }

 private:
  const Model& model_;
  bool rough_;
  OutputFile file_;
};

}  // namespace mortier
