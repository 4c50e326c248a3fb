// In a process of its own: Gmsh crashes on some files, and a geometry is a program that could start others
// and write files.
#include "mesh/read.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "base/archive.h"
#include "base/child_process.h"
#include "base/error.h"
#include "mesh/regions.h"

#ifdef MORTIER_GMSH
#include <gmshc.h>

#include "mesh/gmsh_library.h"
#endif

namespace mortier {

bool isGmshFile(const std::string& path) {
  static const std::set<std::string> known{".msh", ".geo",  ".geo_unrolled", ".brep", ".step",
                                           ".stp", ".iges", ".igs",          ".med",  ".unv"};
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return known.count(extension) > 0;
}

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
         edgeMiddles, edgeCurves] = mesh;
  archive(name, vertices, triangles, regions, boundaryEdges, boundaryLabels, labelNames, regionNames,
          edgeMiddles, edgeCurves);
}

template <class Archive>
void visitMembers(Archive& archive, TetrahedronMesh& mesh) {
  auto& [name, vertices, tetrahedra, regions, boundaryTriangles, boundaryLabels, labelNames, regionNames,
         boundaryNormals] = mesh;
  archive(name, vertices, tetrahedra, regions, boundaryTriangles, boundaryLabels, labelNames, regionNames,
          boundaryNormals);
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

/// Node tags of the elements of one type on an entity.
std::vector<size_t> elements(const Gmsh& gmsh, int type, int entity) {
  Gmsh::Array<size_t> tags;
  Gmsh::Array<size_t> nodes;
  gmsh.call<decltype(gmshModelMeshGetElementsByType)>("gmshModelMeshGetElementsByType", type, &tags.data,
                                                      &tags.size, &nodes.data, &nodes.size, entity, size_t{0},
                                                      size_t{1});
  gmsh.take(tags);
  return gmsh.take(nodes);
}

std::vector<int> elementTypes(const Gmsh& gmsh, int dimension) {
  Gmsh::Array<int> types;
  gmsh.call<decltype(gmshModelMeshGetElementTypes)>("gmshModelMeshGetElementTypes", &types.data, &types.size,
                                                    dimension, -1);
  return gmsh.take(types);
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

/// Opens the file, meshes it where it is a geometry. \throws InputError where it has other elements than
/// those of a type of Gmsh.
void open(const Gmsh& gmsh, const MeshSource& source, int dimension, int type, const char* expected) {
  gmsh.call<decltype(gmshOpen)>("gmshOpen", source.path.c_str());
  if (elementTypes(gmsh, dimension).empty())
    gmsh.call<decltype(gmshModelMeshGenerate)>("gmshModelMeshGenerate", dimension);
  else if (source.size > 0)
    throw InputError(source.path + ": size, expected only for a geometry: this file is a mesh");
  for (const int other : elementTypes(gmsh, dimension))
    if (other != type)
      throw InputError(source.path + ": elements of Gmsh's type " + std::to_string(other) + ", expected " +
                       expected + " (type " + std::to_string(type) + ") only");
}

constexpr int lineType = 1;
constexpr int triangleType = 2;
constexpr int tetrahedronType = 4;

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

TriangleMesh planeMesh(const Gmsh& gmsh, const MeshSource& source) {
  open(gmsh, source, 2, triangleType, "linear triangles");
  const PlaneNodes nodes = planeNodes(gmsh);
  TriangleMesh mesh;
  VertexNumbers vertex(source.path, nodes.at, mesh.vertices);
  for (const Group& group : groups(gmsh, 2)) {
    if (!group.name.empty()) mesh.regionNames[group.name] = group.number;
    for (const int entity : group.entities) {
      const std::vector<size_t> corners = elements(gmsh, triangleType, entity);
      for (size_t i = 0; i + 2 < corners.size(); i += 3) {
        mesh.triangles.push_back({vertex(corners[i]), vertex(corners[i + 1]), vertex(corners[i + 2])});
        mesh.regions.push_back(group.number);
        // Surfaces of a geometry may be turned over.
        if (doubleArea(mesh, static_cast<int>(mesh.triangles.size()) - 1) < 0)
          std::swap(mesh.triangles.back()[1], mesh.triangles.back()[2]);
      }
    }
  }
  for (const Group& group : groups(gmsh, 1)) {
    if (!group.name.empty()) mesh.labelNames[group.name] = group.number;
    for (const int entity : group.entities) {
      const std::vector<size_t> ends = elements(gmsh, lineType, entity);
      for (size_t i = 0; i + 1 < ends.size(); i += 2) {
        mesh.boundaryEdges.push_back({vertex(ends[i]), vertex(ends[i + 1])});
        mesh.boundaryLabels.push_back(group.number);
      }
      for (const KnownEdge& edge : knownEdges(gmsh, entity, ends, nodes)) {
        mesh.edgeMiddles.push_back(edge.middle);
        mesh.edgeCurves.push_back(edge.curve);
      }
    }
  }
  if (std::none_of(mesh.edgeMiddles.begin(), mesh.edgeMiddles.end(),
                   [](const Point& p) { return p.allFinite(); }))
    mesh.edgeMiddles.clear();
  if (std::none_of(mesh.edgeCurves.begin(), mesh.edgeCurves.end(),
                   [](const EdgeCurve& c) { return c.known(); }))
    mesh.edgeCurves.clear();
  mesh.name = source.path;
  if (source.regions.empty())
    dropInnerEdges(mesh);
  else
    keepRegions(mesh, source.regions);
  validate(mesh);
  return mesh;
}

TetrahedronMesh spaceMesh(const Gmsh& gmsh, const MeshSource& source) {
  open(gmsh, source, 3, tetrahedronType, "linear tetrahedra");
  const std::map<size_t, SpacePoint> nodes = nodesOf(gmsh);
  TetrahedronMesh mesh;
  VertexNumbers vertex(source.path, nodes, mesh.vertices);
  for (const Group& group : groups(gmsh, 3)) {
    if (!group.name.empty()) mesh.regionNames[group.name] = group.number;
    for (const int entity : group.entities) {
      const std::vector<size_t> corners = elements(gmsh, tetrahedronType, entity);
      for (size_t i = 0; i + 3 < corners.size(); i += 4) {
        std::array<int, 4>& added = mesh.tetrahedra.emplace_back();
        for (size_t k = 0; k < 4; ++k) added[k] = vertex(corners[i + k]);
        mesh.regions.push_back(group.number);
      }
    }
  }
  const SpacePoint unknown = SpacePoint::Constant(std::numeric_limits<double>::quiet_NaN());
  const size_t used = mesh.vertices.size();
  for (const Group& group : groups(gmsh, 2)) {
    if (!group.name.empty()) mesh.labelNames[group.name] = group.number;
    for (const int entity : group.entities) {
      const std::vector<size_t> corners = elements(gmsh, triangleType, entity);
      const std::map<size_t, SpacePoint> normals = normalsOn(gmsh, entity);
      const auto normal = [&](size_t tag) {
        const auto found = normals.find(tag);
        return found == normals.end() ? unknown : found->second;
      };
      for (size_t i = 0; i + 2 < corners.size(); i += 3) {
        const std::array<int, 3> added{vertex(corners[i]), vertex(corners[i + 1]), vertex(corners[i + 2])};
        if (*std::max_element(added.begin(), added.end()) >= static_cast<int>(used)) continue;
        mesh.boundaryTriangles.push_back(added);
        mesh.boundaryLabels.push_back(group.number);
        mesh.boundaryNormals.push_back({normal(corners[i]), normal(corners[i + 1]), normal(corners[i + 2])});
      }
    }
  }
  mesh.vertices.resize(used);  // surfaces of no volume have others
  mesh.name = source.path;
  if (source.regions.empty())
    dropInnerTriangles(mesh);
  else
    keepRegions(mesh, source.regions);
  validate(mesh);
  return mesh;
}

/// In a process of its own. \param read  from (Gmsh, MeshSource) to a mesh
template <class Read>
auto readInChild(const MeshSource& source, double seconds, const Read& read) {
  const std::string& path = source.path;
  if (std::error_code ignored; !std::filesystem::is_regular_file(path, ignored))
    throw InputError(path + ": not a file, expected a mesh or a geometry for Gmsh");
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
  return readInChild(source, seconds, spaceMesh);
}

#endif

}  // namespace mortier
