// fields.pvd and one .vtu per body and kept step, for ParaView: Float64, raw binary.
//   points: displacement (x, y, 0) [m]
//   cells:  stress (s11, s22, s12) [Pa], von_mises [Pa], viscoplastic_strain (e11, e22, e12) [-],
//           viscoplastic (1 where the stress is beyond yield), region (label of the triangle)
// Points and cells are numbered as in the mesh, from 0. A cell with several material points shows their mean.
#pragma once

#include <string>

#include "time/march.h"

namespace mortier {

class Fields {
 public:
  Fields(std::string folder, const Model& model) : folder_(std::move(folder)), model_(model) {}
  /// Writes <body>_<step>.vtu for every body. \throws OutputError, also when a field is not finite.
  void add(const State& state, int step);
  /// Writes fields.pvd.
  void close();

 private:
  std::string folder_;
  const Model& model_;
  std::string entries_;
};

/// What is shown of one body's cells; one column (or entry) a triangle.
struct CellFields {
  Matrix stress;              ///< s11, s22, s12 [Pa]
  Vector vonMises;            ///< [Pa]
  Matrix viscoplasticStrain;  ///< e11, e22, e12 [-]
  std::vector<int> viscoplastic;
};
CellFields cellFields(const Body& body, const BodyState& state);

}  // namespace mortier
