// Parts drawn together: the regions of a mesh that make one body.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace mortier {

// Of meshes of triangles or tetrahedra.

/// Keeps the regions with these names or numbers, and of the labelled edges those on their boundary, which
/// may have been inside the mesh. Vertices that two of them share stay shared; those that a region shares
/// with those that are left out become its own. \throws InputError that lists the regions of the mesh.
template <class Mesh>
void keepRegions(Mesh& mesh, const std::vector<std::string>& regions);

/// Drops labelled sides between two elements, which are of no use as a boundary.
template <class Mesh>
void dropInnerSides(Mesh& mesh);

// Groups of a file (physical groups of Gmsh, sets of Abaqus) may share sides and elements, of which a mesh
// has one label each. What is in several groups has a label of its own, until it gets that of the group that
// the scene names.

/// Makes a mesh sound whose sides and elements stand in it once for each of their groups: they become one,
/// the regions are kept as above, sides between elements are dropped. \throws InputError
template <class Mesh>
void takeGroups(Mesh& mesh, const std::vector<std::string>& regions);

/// Gives sides and elements in several groups the one that the scene names. \param labels, regions  those
/// that it names. \throws InputError `label-twice` with two groups where it names several of them
template <class Mesh>
void chooseGroups(Mesh& mesh, const std::set<int>& labels, const std::set<int>& regions);

/// Labels or regions that a scene may name. \param shared  `sharedLabels` or `sharedRegions` of the mesh
std::set<int> knownNumbers(const std::vector<int>& present, const std::map<int, std::vector<int>>& shared);

}  // namespace mortier
