// The data of a body at a time, on its matched mesh: linear tractions on sides, constant forces and initial
// stresses on triangles, by which stresses and displacements are made, and bounds of what they leave. In each
// triangle there are
//
//   a stress s_D that carries the tractions and forces that are left, without tractions on other sides,
//   a displacement w, zero on other sides, the remainder of prescribed displacements and gaps,
//
// so that s^ + s_D and u^ + w are admissible for the data as given (docs/bounds.md has the proofs).
#pragma once

#include <string>
#include <vector>

#include "bound/composite_triangle.h"
#include "bound/matched_meshes.h"
#include "bound/side_datum.h"
#include "bound/side_tractions.h"

namespace mortier {

struct BodyData {
  /// What moves beside linear functions on a side: integral of w over it [m^2].
  struct Moved {
    int label = 0;
    Point integral{0, 0};
    double error = 0;  ///< of it
  };

  std::string obstacle;              ///< data that are not bounded
  std::string beyond;                ///< the first that is not linear, or constant; empty where all are
  std::vector<BodyLoad> forces;      ///< by triangles
  std::vector<KnownTraction> known;  ///< by sides
  Vector load;                       ///< nodal forces of these (dofs) [N/m]
  Vector carried;                    ///< |s_D| by triangles, at most [sqrt(J/m)]
  Vector strained;                   ///< |E eps(w) + what initial stresses vary by|, the same
  std::vector<Stress> meanCarried;   ///< integrals of what is known of these stresses [N]
  std::vector<Stress> meanStrained;
  std::vector<Moved> moved;
  double error = 0;  ///< of moments of tractions and forces, at most [N/m]
  bool curvedSupport = false;

  [[nodiscard]] bool linear() const { return beyond.empty(); }
};

/// A body on its matched mesh, its law linearised.
struct MatchedBody {
  const Body& own;  ///< on its own mesh
  const CutMesh& cut;
  Body body;  ///< on the matched mesh
  Sides sides;
  Vector displacement;                       ///< u_h
  std::vector<Eigen::Matrix3d> moduli;       ///< by triangles, on (p, q, r) of strains [Pa]
  std::vector<Eigen::Matrix3d> compliances;  ///< on (s11, s22, s12)
};

BodyData readData(const MatchedBody& place, double t);

/// Adds a displacement w = datum times `along` on a side of the boundary. \param side  of MatchedBody::sides
void moveSide(const MatchedBody& place, int side, const Point& along, const SideDatum& datum, BodyData& data);
/// The energy norm of such a w, at most.
double movedEnergy(const MatchedBody& place, int side, const Point& along, const SideDatum& datum);

}  // namespace mortier
