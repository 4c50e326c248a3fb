// fields.pvd and one .vtu per body and kept step, for ParaView: Float64, raw binary.
//   points: displacement (x, y, 0 or z) [m]; of bodies with a nonmortar side contact_pressure [Pa] and
//           gap [m], nonmortar (1 at nodes that have them, elsewhere they are 0); middles of sides have the
//           mean of both ends
//   cells:  stress (s11, s22, s12; in space s11, s22, s33, s12, s23, s13) [Pa], von_mises [Pa],
//           viscoplastic_strain (e11, e22, e12) [-], viscoplastic (1 where the stress is beyond yield),
//           region (label of the triangle), error (estimated, of the stress: share of the triangle in the
//           energy norm of its body) [-]
// Points and cells are numbered as in the mesh, from 0. A cell with several material points shows their mean,
// and stress_at_points (the components at each point, one point after the other) [Pa].
#pragma once

#include <cstdint>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "report/manifest.h"
#include "time/march.h"
#include "time/mesh_error.h"

namespace mortier {

/// <body>_<step>.vtu
std::string fieldName(const std::string& body, int step);

/// A step whose fields are written.
struct KeptFields {
  int step = 0;
  double time = 0;                          ///< [s]
  std::map<std::string, FileRecord> files;  ///< one a body, by name
};

/// Of all nodes of one body; empty where it has no nonmortar side.
struct ContactOfNodes {
  std::vector<double> pressure;  ///< [Pa]
  std::vector<double> gap;       ///< [m]
  std::vector<uint8_t> has;      ///< whether a node has them: 0 stands where it does not
};

class Fields {
 public:
  /// \param error  of the states that are added
  /// \param kept  what an earlier part of the run has written.
  Fields(std::string folder, const Model& model, CurrentMeshError& error, std::vector<KeptFields> kept = {})
      : folder_(std::move(folder)),
        model_(model),
        error_(error),
        kept_(std::move(kept)),
        synced_(kept_.size()) {}
  /// Writes <body>_<step>.vtu for every body; large ones while the run goes on, from a copy of the state.
  /// \throws OutputError, also when a field is not finite,
  /// at the latest in the next call of any function here.
  void add(const State& state, int step);
  /// Brings everything to the disk. \returns what is written so far. \throws OutputError
  const std::vector<KeptFields>& sync();
  /// Writes fields.pvd. \returns all that was written, by name.
  std::map<std::string, FileRecord> close();

 private:
  void write(const State& state, const std::vector<ErrorEstimate>& estimates,
             const std::vector<ContactOfNodes>& contact, KeptFields& kept);
  /// Until the last step is written.
  void wait();

  std::string folder_;
  const Model& model_;
  CurrentMeshError& error_;
  std::vector<KeptFields> kept_;
  size_t synced_;
  std::future<void> writing_;
};

/// What is shown of one body's cells; one column (or entry) a triangle or a tetrahedron.
struct CellFields {
  Matrix stress;              ///< s11, s22, s12, in plane strain s33; in space as ParaView has it [Pa]
  Matrix stressAtPoints;      ///< the same at the material points, one point below the other [Pa]
  Vector vonMises;            ///< [Pa]
  Matrix viscoplasticStrain;  ///< e11, e22, e12, in plane strain e33 [-]
  std::vector<int> viscoplastic;
};
CellFields cellFields(const Body& body, const BodyState& state);

}  // namespace mortier
