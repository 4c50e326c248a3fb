#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesh/shape.h"
#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

// Meshes of tetrahedra from those of triangles in the plane z = 0: moved along z, or turned about the axis
// x = 0, layer by layer.

struct Sweep {
  double length = 0;  ///< along z [m]; 0: the mesh turns
  double angle = 0;   ///< from the x axis towards the z axis [rad]; 2 pi to 1e-6: all the way
  int layers = 1;
};

/// In each layer a triangle becomes a prism, which is cut into three tetrahedra, or into fewer where it
/// touches the axis. Sides keep their labels and regions; the planes where the sweep begins and ends, if it
/// is not closed, have the two labels after the largest one, named "start" and "end". \throws InputError
/// where a vertex is on the wrong side of the axis, or layers turn by half a circle.
TetrahedronMesh sweptMesh(TriangleMesh plane, const Sweep& sweep);

/// Where the mesh of a body comes from.
struct MeshSource {
  std::string path;                        ///< as the program opens it; of a shape, its word
  std::optional<MeshShape> shape = {};     ///< in place of a file
  std::optional<SpaceShape> inSpace = {};  ///< the same in space
  std::optional<Sweep> sweep = {};         ///< of a plane mesh to one in space
  std::vector<std::string> regions = {};   ///< names or numbers of those that are the body; none: all
  double size = 0;  ///< longest edge where Gmsh meshes a geometry [m]; 0: the geometry's own
  std::map<std::string, double> parameters = {};  ///< of a .geo, which names them in DefineConstant
};

/// A shape, or a mesh file of any kind that is known: Medit by ourselves, others by Gmsh or by meshio,
/// quadrangles and the like cut into simplices (mesh/cut_cells.h). \throws InputError
TriangleMesh readMesh(const MeshSource& source);
TetrahedronMesh readSpaceMesh(const MeshSource& source);

/// The kinds of files beside Medit's that are read, and what to do with others, for messages.
std::string otherMeshFiles();
/// Whether a file is read as Medit's, by its extension.
bool isMeditFile(const std::string& path);

// Meshes that Python reads and hands over as Medit text (views/mesh_files.py): .inp of Abaqus and CalculiX by
// itself, .vtk, .vtu, .xdmf, .med and .meshb by meshio. Sets and groups become labels and regions as above.

/// Whether a file is one for Python, by its extension.
bool isPythonFile(const std::string& path);
/// \throws InputError with what is wrong with the file, or where Python or meshio are not there
TriangleMesh readPythonFile(const MeshSource& source);
TetrahedronMesh readSpacePythonFile(const MeshSource& source);

// Meshes and geometries that Gmsh reads: .msh (2.2, 4.1), .geo, CAD files, Nastran's. A geometry is meshed
// first.

/// Whether a file is one for Gmsh, by its extension.
bool isGmshFile(const std::string& path);

/// How long Gmsh may take for a file [s]: some 1e7 triangles; on damaged CAD files it may never end.
constexpr double gmshPatience = 600;

/// Physical curves become boundary labels, physical surfaces regions, with their numbers and names; where
/// there are none, the curves or surfaces themselves, without names. Of sides and elements in several groups
/// the scene chooses one (mesh/regions.h). \throws InputError when Gmsh cannot read the file, when it is no
/// sound plane mesh, when a parameter is none of the geometry's, when Gmsh takes longer than `seconds`, or
/// when this build has no Gmsh.
TriangleMesh readGmsh(const MeshSource& source, double seconds = gmshPatience);
/// The same in space: physical surfaces become boundary labels, physical volumes regions.
TetrahedronMesh readSpaceGmsh(const MeshSource& source, double seconds = gmshPatience);

// Medit .mesh files (ASCII), as FreeFEM and Gmsh read and write them; coordinates survive bit by bit. The
// format has no names for labels. They stand in lines after its End, which other readers skip:
//   # label 3 = top
//   # region 1 = punch

/// Reads and validates. Vertices, Edges, Triangles and Quadrilaterals are kept (vertex labels are not);
/// sections that only guide a mesher (Corners, RequiredVertices, ...) are skipped. Of the regions those that
/// are named (mesh/regions.h), all where none is. A third coordinate must be the same everywhere. End may be
/// missing where the last line is whole. \throws InputError `file:line: ...` on anything that is not a sound
/// mesh, unknown keywords included.
TriangleMesh readMedit(const std::string& path, const std::vector<std::string>& regions = {});
/// The same in space: the elements are Tetrahedra, Hexahedra, Prisms and Pyramids, Triangles and
/// Quadrilaterals the labelled boundary.
TetrahedronMesh readSpaceMedit(const std::string& path, const std::vector<std::string>& regions = {});

/// Writes the names of labels too, and each coordinate with the fewest digits (17 at most) that read back as
/// the same bits.
/// \throws OutputError when the file cannot be written.
void writeMedit(const TriangleMesh& mesh, const std::string& path);
void writeMedit(const TetrahedronMesh& mesh, const std::string& path);

/// What it writes.
std::string meditText(const TriangleMesh& mesh);
std::string meditText(const TetrahedronMesh& mesh);

}  // namespace mortier
