// What a scene leaves to its meshes, decided once: between reading (scene.h) and building (build.h).
#pragma once

#include <optional>
#include <vector>

#include "base/error.h"
#include "mesh/triangle_mesh.h"
#include "scene/scene.h"

namespace mortier {

/// A scene and the meshes of its bodies, in their order. Every label is a number that the mesh has, every
/// point of a support a vertex, and every contact has its nonmortar side: what comes later reads them and
/// decides none.
struct ResolvedScene {
  SceneDescription description;
  std::vector<TriangleMesh> meshes;               ///< none in space
  std::vector<TetrahedronMesh> spaceMeshes = {};  ///< none in the plane
};

/// Reads or makes the mesh of a body. \throws InputError
TriangleMesh meshOf(const BodyDescription& body);

/// Reads the meshes and decides. \throws InputError with one line that names the scene's file and line, or
/// the mesh's: unreadable meshes, labels and points that a mesh does not have.
ResolvedScene resolveScene(SceneDescription scene);

/// Decides what can be decided in a scene that may be wrong: meshes that could not be read are nullptr, a
/// name that a mesh does not have gets a number that no mesh has, and a contact with such a side and a point
/// that is no vertex stay as they were written. \returns what is wrong with groups that share sides or
/// elements
std::vector<InputError> resolveWhatCanBe(SceneDescription& scene, const std::vector<TriangleMesh*>& meshes);

// Parts of it.

/// Where the vertex lies that a scene means by a point: the nearest one, no further off than a thousandth of
/// the shortest edge there.
/// \throws InputError, headed by `place`, with that vertex and its distance.
Point vertexPoint(const TriangleMesh& mesh, const Point& point, const std::string& place);

// Which volumetric strain the material of a body gets where the scene leaves it open (`volumes`).

/// Whether a material is elastically next to incompressible where the thickness cannot make up for it; in
/// space on linear tetrahedra.
bool nearlyIncompressible(const SceneDescription& scene, const MaterialDescription& material);

/// Whether flow, which keeps the volume, locks on the elements of a mesh: linear ones, but in plane strain as
/// quarters of cells with both diagonals. \param mesh  null in space
bool flowLocks(const SceneDescription& scene, const MaterialDescription& material, const TriangleMesh* mesh);

/// The part of the triangles that are quarters of cells with both diagonals: they have a vertex with four
/// triangles.
double crossedPart(const TriangleMesh& mesh);
/// Averages the volumetric strain of bodies with such a material, and says why in `volumeChoice`; beside
/// accuracy.bound none. A second call changes nothing.
void decideVolumes(SceneDescription& scene);

// Which side of a contact is nonmortar where the scene leaves it open (`sides`), as measured in
// docs/benchmarks.md: the finer mesh along the contact, or the softer body where the other is far stiffer
// (but with interpolation).

/// Young's modulus of the body of one side over that of the other's. A side whose normal motion is prescribed
/// is infinitely stiff.
double stiffnessRatio(const SceneDescription& scene, const SideDescription& one, const SideDescription& other,
                      const std::vector<const TriangleMesh*>& meshes);

/// What the body of a side yields by under a load on a half-plane, (1 - nu^2)/E, or 1/E in plane stress, of
/// the stiffest region at the side; 0 where its normal motion is prescribed [1/Pa]. \pre its mesh is there
double surfaceCompliance(const SceneDescription& scene, const SideDescription& side,
                         const std::vector<const TriangleMesh*>& meshes);
/// The same in space, on a half-space, whether or not the motion is prescribed.
double surfaceCompliance(const SceneDescription& scene, const SideDescription& side,
                         const TetrahedronMesh& mesh);

/// Puts the chosen side first in every contact that leaves the choice open, and says why in `choice`; labels
/// are numbers (scene/resolve.h). A second call changes nothing. Contacts with a mesh that is missing
/// (nullptr) or a label that the mesh lacks stay as they are.
void decideSides(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes);
void decideSides(SceneDescription& scene, const std::vector<TetrahedronMesh>& meshes);

// Which displacements of a mesh the conditions of a body prescribe along x and y.

/// The axis (0: x, 1: y) along which a component (fem/supports.h) of an edge is; none where it is oblique.
std::optional<int> axisOf(int component, const Point& from, const Point& to);

/// Per dof 2 vertex + axis, whether a displacement is prescribed.
std::vector<char> heldDofs(const TriangleMesh& mesh, const std::vector<ConditionDescription>& conditions);

}  // namespace mortier
