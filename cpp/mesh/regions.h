// Parts drawn together: the regions of a mesh that make one body.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

/// Keeps the regions with these names or numbers, and of the labelled edges those on their boundary, which
/// may have been inside the mesh. Vertices that two of them share stay shared; those that a region shares
/// with those that are left out become its own. \throws InputError that lists the regions of the mesh.
void keepRegions(TriangleMesh& mesh, const std::vector<std::string>& regions);
void keepRegions(TetrahedronMesh& mesh, const std::vector<std::string>& regions);

/// Drops labelled edges between two triangles, which are of no use as a boundary.
void dropInnerEdges(TriangleMesh& mesh);
/// The same of labelled triangles between two tetrahedra.
void dropInnerTriangles(TetrahedronMesh& mesh);

// Groups of a file (physical groups of Gmsh, sets of Abaqus) may share sides and elements, of which a mesh
// has one label each. What is in several groups has a label of its own, until it gets that of the group that
// the scene names.

/// Makes a mesh sound whose sides and elements stand in it once for each of their groups: they become one,
/// the regions are kept as above, sides between elements are dropped. \throws InputError
void takeGroups(TriangleMesh& mesh, const std::vector<std::string>& regions);
void takeGroups(TetrahedronMesh& mesh, const std::vector<std::string>& regions);

/// Gives sides and elements in several groups the one that the scene names. \param labels, regions  those
/// that it names. \throws FaultError `label-twice` with two groups where it names several of them
void chooseGroups(TriangleMesh& mesh, const std::set<int>& labels, const std::set<int>& regions);
void chooseGroups(TetrahedronMesh& mesh, const std::set<int>& labels, const std::set<int>& regions);

/// Labels or regions that a scene may name. \param shared  `sharedLabels` or `sharedRegions` of the mesh
std::set<int> knownNumbers(const std::vector<int>& present, const std::map<int, std::vector<int>>& shared);

}  // namespace mortier
