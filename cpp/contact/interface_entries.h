// What an interface as meshed and one that follows the bodies have in common while they are put together.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "contact/interface.h"
#include "contact/surface.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

struct ContactInterface::Entries {
  Triplets nonmortar, mortar;  ///< of C1 and C2, by dofs of their meshes
  Triplets mass;
  Triplets compliance;  ///< S
  Triplets means;
  Triplets ends;
  std::vector<std::pair<int, double>> spacings;  ///< of the mortar nodes, by rows
  Triplets given;                                ///< of N

  /// \param rowOf  by rows of the coupling
  void add(const Coupling& coupling, const CommonRefinement& refinement, const std::vector<int>& rowOf);
};

/// Two surfaces, as meshed or moved, and their rows.
struct ContactInterface::RefinedSurfaces {
  /// Both surfaces must outlive it. \param continuous  SurfaceRefinement
  RefinedSurfaces(const ContactSurface& nonmortarSurface, const ContactSurface& mortarSurface,
                  bool continuous)
      : nonmortar(nonmortarSurface),
        mortar(mortarSurface),
        tree(mortarSurface),
        refinement(nonmortarSurface, mortarSurface, tree, continuous) {}

  const ContactSurface& nonmortar;
  const ContactSurface& mortar;
  TriangleTree tree;
  SurfaceRefinement refinement;
  std::map<PartVertex, int> rowOf;  ///< rows of vertices that do not face the other surface are empty
  /// The first direction of slip by rows, nearly; empty: that nearest to an axis.
  std::vector<SpacePoint> slipsAlong;
};

/// Both sides in a message, `a.mesh label 1 "bottom" and b.mesh label 3 "top"`.
template <class Mesh>
std::string sidesText(const ContactPair& pair, const Mesh& nonmortar, const Mesh& mortar) {
  return nonmortar.name + " " + labelText(nonmortar, pair.nonmortar.label) + " and " + mortar.name + " " +
         labelText(mortar, pair.mortar.label);
}

/// Of sides that face each other in part. \throws InputError
[[noreturn]] void refuseWithoutRows(const std::string& sides);

/// A closed nonmortar line that faces an open one begins where it is farthest off.
std::vector<SmoothPart> partsFacing(const BoundaryLine& line, const BoundaryLine& mortar);

/// The ends of the nonmortar line that are merged into their neighbours, as flags by the nodes of the part.
std::vector<char> mergedNodes(const CommonRefinement& refinement, CouplingKind kind,
                              const InterfaceOptions& options);

/// The ends of the nonmortar line that are held along it, on an axis of symmetry, as flags by the nodes of
/// the part.
std::vector<char> symmetricEnds(const CommonRefinement& refinement, const InterfaceOptions& options);

/// Where two parts meet at a corner that faces a point of the other line (CornerContact) one of them has the
/// row there: merges the vertices of a part that another one has, and adds the others.
/// \param corners  node numbers of the corners that have their row
void mergeCorners(const CommonRefinement& refinement, std::vector<int>& corners, std::vector<char>& merged);

/// The largest sagitta of the elements that face each other and whose curve is not known [m].
double unknownSagitta(const CommonRefinement& refinement);

}  // namespace mortier
