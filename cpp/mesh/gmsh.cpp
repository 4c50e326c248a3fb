// In a process of its own: Gmsh crashes on some files, and a geometry is a program that could start others
// and write files.
#include "mesh/read.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "base/archive.h"
#include "base/child_process.h"
#include "base/error.h"
#include "mesh/cut_cells.h"
#include "mesh/regions.h"

#ifdef MORTIER_GMSH
#include <gmshc.h>

#include "mesh/gmsh_cells.h"
#include "mesh/gmsh_library.h"
#endif

namespace mortier {

#ifndef MORTIER_GMSH

namespace {

[[noreturn]] void refuse(const MeshSource& source, const char* dimension) {
  throw InputError(
      source.path +
      ": read by Gmsh, which this build is without (libgmsh-dev was not there); expected a Medit "
      ".mesh file, which gmsh -" +
      dimension + " -format mesh writes");
}

}  // namespace

TriangleMesh readGmsh(const MeshSource& source, double) {
  refuse(source, "2");
}
TetrahedronMesh readSpaceGmsh(const MeshSource& source, double) {
  refuse(source, "3");
}

#else

/// For the way between the processes.
template <class Archive>
void visitMembers(Archive& archive, TriangleMesh& mesh) {
  auto& [name, vertices, triangles, regions, boundaryEdges, boundaryLabels, labelNames, regionNames,
         edgeMiddles, edgeCurves, sharedLabels, sharedRegions, changed] = mesh;
  archive(name, vertices, triangles, regions, boundaryEdges, boundaryLabels, labelNames, regionNames,
          edgeMiddles, edgeCurves, sharedLabels, sharedRegions, changed);
}

template <class Archive>
void visitMembers(Archive& archive, TetrahedronMesh& mesh) {
  auto& [name, vertices, tetrahedra, regions, boundaryTriangles, boundaryLabels, labelNames, regionNames,
         sharedLabels, sharedRegions, changed, boundaryNormals, geometry] = mesh;
  archive(name, vertices, tetrahedra, regions, boundaryTriangles, boundaryLabels, labelNames, regionNames,
          sharedLabels, sharedRegions, changed, boundaryNormals, geometry.triangles, geometry.numbers);
}

template <class Archive>
void visitMembers(Archive& archive, EdgeCurve& edge) {
  SampledCurve curve = edge.known() ? *edge.curve : SampledCurve{};
  archive(curve.knots, curve.points, edge.from, edge.to);
  if (!curve.points.empty()) edge.curve = std::make_shared<const SampledCurve>(std::move(curve));
}

namespace {

/// Physical groups of a dimension, as entities of a number and a name.
struct Group {
  int number = 0;
  std::string name;
  std::vector<int> entities;
};

std::vector<Group> groups(const Gmsh& gmsh, int dimension) {
  Gmsh::Array<int> pairs;
  gmsh.call<decltype(gmshModelGetPhysicalGroups)>("gmshModelGetPhysicalGroups", &pairs.data, &pairs.size,
                                                  dimension);
  const std::vector<int> physical = gmsh.take(pairs);
  std::vector<Group> result;
  for (size_t i = 0; i + 1 < physical.size(); i += 2) {
    Group group{physical[i + 1], "", {}};
    char* name = nullptr;
    gmsh.call<decltype(gmshModelGetPhysicalName)>("gmshModelGetPhysicalName", dimension, group.number, &name);
    if (name != nullptr) {
      group.name = name;
      gmsh.take(Gmsh::Array<char>{name, 0});
    }
    Gmsh::Array<int> tags;
    gmsh.call<decltype(gmshModelGetEntitiesForPhysicalGroup)>(
        "gmshModelGetEntitiesForPhysicalGroup", dimension, group.number, &tags.data, &tags.size);
    group.entities = gmsh.take(tags);
    result.push_back(std::move(group));
  }
  if (!result.empty()) return result;
  Gmsh::Array<int> entities;
  gmsh.call<decltype(gmshModelGetEntities)>("gmshModelGetEntities", &entities.data, &entities.size,
                                            dimension);
  const std::vector<int> all = gmsh.take(entities);
  for (size_t i = 0; i + 1 < all.size(); i += 2) result.push_back({all[i + 1], "", {all[i + 1]}});
  return result;
}

/// Places of all nodes by their tags.
std::map<size_t, SpacePoint> nodesOf(const Gmsh& gmsh) {
  Gmsh::Array<size_t> tags;
  Gmsh::Array<double> coordinates;
  Gmsh::Array<double> parameters;
  gmsh.call<decltype(gmshModelMeshGetNodes)>("gmshModelMeshGetNodes", &tags.data, &tags.size,
                                             &coordinates.data, &coordinates.size, &parameters.data,
                                             &parameters.size, -1, -1, 0, 0);
  const std::vector<size_t> tag = gmsh.take(tags);
  const std::vector<double> x = gmsh.take(coordinates);
  gmsh.take(parameters);
  std::map<size_t, SpacePoint> nodes;
  for (size_t i = 0; i < tag.size(); ++i) nodes[tag[i]] = {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
  return nodes;
}

PlaneNodes planeNodes(const Gmsh& gmsh) {
  const std::map<size_t, SpacePoint> nodes = nodesOf(gmsh);
  PlaneNodes result{{}, nodes.empty() ? 0 : nodes.begin()->second.z()};
  for (const auto& [tag, x] : nodes) {
    if (x.z() != result.z)
      throw InputError(gmsh.path() + ": node " + std::to_string(tag) + " is at z = " + std::to_string(x.z()) +
                       ", expected all nodes in one plane z = " + std::to_string(result.z) +
                       ", or dimension = 3 at the top of the scene");
    result.at[tag] = x.head<2>();
  }
  return result;
}

/// Opens the file, and meshes it where it is a geometry.
void open(const Gmsh& gmsh, const MeshSource& source, int dimension) {
  gmsh.call<decltype(gmshOpen)>("gmshOpen", source.path.c_str());
  if (elementTypes(gmsh, dimension).empty())
    gmsh.call<decltype(gmshModelMeshGenerate)>("gmshModelMeshGenerate", dimension);
  else if (source.size > 0)
    throw InputError(source.path + ": size, expected only for a geometry: this file is a mesh");
}

/// Numbers of the vertices of a mesh by the tags of Gmsh's nodes; a node becomes a vertex where it is first
/// asked for.
template <class Place>
class VertexNumbers {
 public:
  VertexNumbers(const std::string& path, const std::map<size_t, Place>& nodes, std::vector<Place>& vertices)
      : path_(path), nodes_(nodes), vertices_(vertices) {}
  int operator()(size_t tag) {
    const auto [found, isNew] = numbers_.try_emplace(tag, static_cast<int>(vertices_.size()));
    if (isNew) {
      const auto node = nodes_.find(tag);
      if (node == nodes_.end())
        throw InputError(path_ + ": an element has node " + std::to_string(tag) + ", which is not there");
      vertices_.push_back(node->second);
    }
    return found->second;
  }

 private:
  const std::string& path_;
  const std::map<size_t, Place>& nodes_;
  std::vector<Place>& vertices_;
  std::map<size_t, int> numbers_;
};

/// Cells of the dimension of the mesh, or one lower, as simplices with the numbers of their groups.
/// \param entities  those of the geometry of which they are
template <size_t n, class Numbers>
ChangedCells addCells(const Gmsh& gmsh, int dimension, Numbers& vertex,
                      std::vector<std::array<int, n> >& simplices, std::vector<int>& numbers,
                      std::map<std::string, int>& names, std::vector<int>* entities = nullptr) {
  ChangedCells changed;
  for (const Group& group : groups(gmsh, dimension)) {
    if (!group.name.empty()) names[group.name] = group.number;
    for (const int entity : group.entities)
      forCornersOn(gmsh, dimension, entity, [&](const CellType& type, const std::vector<size_t>& corners) {
        for (size_t i = 0; i < corners.size(); i += type.corners) {
          std::vector<int> cell;
          for (size_t k = 0; k < type.corners; ++k) cell.push_back(vertex(corners[i + k]));
          cutCell(cell, simplices);
        }
        numbers.resize(simplices.size(), group.number);
        if (entities != nullptr) entities->resize(simplices.size(), entity);
        changed.quadratic = changed.quadratic || (type.quadratic && !corners.empty());
        changed.cut = changed.cut || (type.corners != n && !corners.empty());
      });
  }
  return changed;
}

TriangleMesh planeMesh(const Gmsh& gmsh, const MeshSource& source) {
  open(gmsh, source, 2);
  const PlaneNodes nodes = planeNodes(gmsh);
  TriangleMesh mesh;
  mesh.name = source.path;
  VertexNumbers vertex(source.path, nodes.at, mesh.vertices);
  mesh.changed = addCells(gmsh, 2, vertex, mesh.triangles, mesh.regions, mesh.regionNames).text("triangles");
  // Surfaces of a geometry may be turned over.
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    if (doubleArea(mesh, static_cast<int>(t)) < 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  const auto used = static_cast<int>(mesh.vertices.size());
  for (const Group& group : groups(gmsh, 1)) {
    if (!group.name.empty()) mesh.labelNames[group.name] = group.number;
    for (const int entity : group.entities)
      forCornersOn(gmsh, 1, entity, [&](const CellType& /*line*/, const std::vector<size_t>& ends) {
        const std::vector<KnownEdge> known = knownEdges(gmsh, entity, ends, nodes);
        for (size_t i = 0; i + 1 < ends.size(); i += 2) {
          const std::array<int, 2> edge{vertex(ends[i]), vertex(ends[i + 1])};
          if (std::max(edge[0], edge[1]) >= used) continue;  // curves of no surface have other vertices
          mesh.boundaryEdges.push_back(edge);
          mesh.boundaryLabels.push_back(group.number);
          mesh.edgeMiddles.push_back(known[i / 2].middle);
          mesh.edgeCurves.push_back(known[i / 2].curve);
        }
      });
  }
  mesh.vertices.resize(static_cast<size_t>(used));
  if (std::none_of(mesh.edgeMiddles.begin(), mesh.edgeMiddles.end(),
                   [](const Point& p) { return p.allFinite(); }))
    mesh.edgeMiddles.clear();
  if (std::none_of(mesh.edgeCurves.begin(), mesh.edgeCurves.end(),
                   [](const EdgeCurve& c) { return c.known(); }))
    mesh.edgeCurves.clear();
  takeGroups(mesh, source.regions);
  return mesh;
}

/// The triangles on all surfaces that have a shape, in groups or not.
template <class Numbers>
void addGeometry(const Gmsh& gmsh, Numbers& vertex, BoundaryGeometry& geometry) {
  Gmsh::Array<int> pairs;
  gmsh.call<decltype(gmshModelGetEntities)>("gmshModelGetEntities", &pairs.data, &pairs.size, 2);
  const std::vector<int> all = gmsh.take(pairs);
  for (size_t i = 1; i < all.size(); i += 2) {
    if (shapeOf(gmsh, 2, all[i]).empty()) continue;
    forCornersOn(gmsh, 2, all[i], [&](const CellType& type, const std::vector<size_t>& corners) {
      for (size_t k = 0; type.corners == 3 && k < corners.size(); k += 3)
        geometry.triangles.push_back({vertex(corners[k]), vertex(corners[k + 1]), vertex(corners[k + 2])});
      geometry.numbers.resize(geometry.triangles.size(), all[i]);
    });
  }
}

/// Leaves out triangles with further vertices.
void keepVertices(BoundaryGeometry& geometry, int count) {
  size_t kept = 0;
  for (size_t i = 0; i < geometry.triangles.size(); ++i) {
    const auto& triangle = geometry.triangles[i];
    if (*std::max_element(triangle.begin(), triangle.end()) >= count) continue;
    geometry.triangles[kept] = triangle;
    geometry.numbers[kept++] = geometry.numbers[i];
  }
  geometry.triangles.resize(kept);
  geometry.numbers.resize(kept);
}

TetrahedronMesh spaceMesh(const Gmsh& gmsh, const MeshSource& source) {
  open(gmsh, source, 3);
  const std::map<size_t, SpacePoint> nodes = nodesOf(gmsh);
  TetrahedronMesh mesh;
  mesh.name = source.path;
  VertexNumbers vertex(source.path, nodes, mesh.vertices);
  mesh.changed =
      addCells(gmsh, 3, vertex, mesh.tetrahedra, mesh.regions, mesh.regionNames).text("tetrahedra");
  const auto used = static_cast<int>(mesh.vertices.size());
  TetrahedronMesh sides;
  std::vector<int> surfaces;
  addCells(gmsh, 2, vertex, sides.boundaryTriangles, sides.boundaryLabels, mesh.labelNames, &surfaces);
  addGeometry(gmsh, vertex, mesh.geometry);
  std::map<int, std::map<int, SpacePoint> > normals;  // by surfaces and vertices
  for (const int surface : std::set<int>(surfaces.begin(), surfaces.end()))
    for (const auto& [node, normal] : normalsOn(gmsh, surface)) normals[surface][vertex(node)] = normal;
  mesh.vertices.resize(static_cast<size_t>(used));  // surfaces of no volume have others
  keepVertices(mesh.geometry, used);
  for (size_t i = 0; i < sides.boundaryTriangles.size(); ++i) {
    const std::array<int, 3>& side = sides.boundaryTriangles[i];
    if (*std::max_element(side.begin(), side.end()) >= used) continue;
    mesh.boundaryTriangles.push_back(side);
    mesh.boundaryLabels.push_back(sides.boundaryLabels[i]);
    std::array<SpacePoint, 3>& known = mesh.boundaryNormals.emplace_back();
    for (size_t k = 0; k < 3; ++k) {
      const auto found = normals[surfaces[i]].find(side[k]);
      known[k] = found != normals[surfaces[i]].end()
                     ? found->second
                     : SpacePoint::Constant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  takeGroups(mesh, source.regions);
  return mesh;
}

/// Other programs have files of this name, which Gmsh runs as geometries.
void requireSections(const std::string& path) {
  if (std::filesystem::path(path).extension() != ".msh") return;
  std::ifstream file(path);
  if (char first = 0; !(file >> first) || first != '$')
    throw InputError(path +
                     ":1: expected $MeshFormat, with which meshes of Gmsh begin; files of other kinds: " +
                     otherMeshFiles());
}

/// In a process of its own. \param read  from (Gmsh, MeshSource) to a mesh
template <class Read>
auto readInChild(const MeshSource& source, double seconds, const Read& read) {
  const std::string& path = source.path;
  if (std::error_code ignored; !std::filesystem::is_regular_file(path, ignored))
    throw InputError(path + ": not a file, expected a mesh or a geometry for Gmsh");
  requireSections(path);
  const auto work = [&] {
    requireConstants(source);
    const Gmsh gmsh(source);
    auto mesh = read(gmsh, source);
    ArchiveWriter writer;
    writer(mesh);
    return writer.bytes;
  };
  const std::string bytes = inChildProcess(work, path + ": Gmsh", seconds);
  decltype(read(std::declval<const Gmsh&>(), source)) mesh;
  ArchiveReader reader(bytes);
  reader(mesh);
  return mesh;
}

}  // namespace

TriangleMesh readGmsh(const MeshSource& source, double seconds) {
  return readInChild(source, seconds, planeMesh);
}

TetrahedronMesh readSpaceGmsh(const MeshSource& source, double seconds) {
  TetrahedronMesh mesh = readInChild(source, seconds, spaceMesh);
  if (!mesh.geometry.triangles.empty()) mesh.geometry.surfaces = gmshSurfaces(source);
  return mesh;
}

#endif

}  // namespace mortier
