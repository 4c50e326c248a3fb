// Meshes that match on straight contact lines: every point of the common refinement becomes a vertex of both
// bodies. An edge a-b of the triangle a, b, c is cut from c, so no vertex is added inside a body, and linear
// displacements are the same functions on the new mesh.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "solver/model.h"

namespace mortier {

/// The mesh of a body with edges cut, and triangles over those that are cut often.
struct CutMesh {
  TriangleMesh mesh;
  std::vector<int> parents;  ///< of each triangle, that of the body's mesh of which it is a part
  struct Added {
    std::array<int, 2> ends{};  ///< vertices before it
    double part = 0;            ///< of the way from the first to the second
  };
  std::vector<Added> added;  ///< the vertices behind those of the body's mesh

  /// A nodal displacement of the body (dofs) on the new mesh.
  [[nodiscard]] Vector displacement(const Vector& u) const;
};

/// A piece of a contact line: an edge of both bodies.
struct MatchedPiece {
  int interface = 0;
  /// By side (nonmortar, mortar) the vertices at begin and end.
  std::array<std::array<int, 2>, 2> vertices{};
  Point normal{0, 0};                ///< outward of the nonmortar body
  std::array<double, 2> distance{};  ///< g0 at begin and end [m]
  double length = 0;                 ///< [m]
  /// By begin and end, the rows of C whose row functions are not zero on the piece (-1 for
  /// none), and their values.
  std::array<int, 2> rows{-1, -1};
  std::array<std::array<double, 2>, 2> values{};  ///< [row][begin, end]
};

struct MatchedMeshes {
  std::vector<CutMesh> bodies;
  std::vector<MatchedPiece> pieces;
  double apart = 0;  ///< points that are one in them are no farther apart [m]
  /// Why there are none: a line that is not straight, or whose sides are not parallel, to rounding.
  std::string obstacle;
};

/// \param loadsAt  a time at which sides are cut whose tractions are not linear, too
MatchedMeshes matchedMeshes(const Model& model, std::optional<double> loadsAt = std::nullopt);

}  // namespace mortier
