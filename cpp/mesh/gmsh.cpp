// In a process of its own: Gmsh crashes on some files, and a geometry is a program that could start others
// and write files.
#include "mesh/gmsh.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include "base/archive.h"
#include "base/child_process.h"
#include "base/error.h"
#include "mesh/geometry_constants.h"
#include "mesh/regions.h"

#ifdef MORTIER_GMSH
#include <gmshc.h>

#include "mesh/gmsh_curves.h"
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

TriangleMesh readGmsh(const MeshSource& source, double) {
  throw InputError(
      source.path +
      ": read by Gmsh, which this build is without (libgmsh-dev was not there); expected a Medit "
      ".mesh file, which gmsh -2 -format mesh writes");
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

PlaneNodes planeNodes(const Gmsh& gmsh) {
  Gmsh::Array<size_t> tags;
  Gmsh::Array<double> coordinates;
  Gmsh::Array<double> parameters;
  gmsh.call<decltype(gmshModelMeshGetNodes)>("gmshModelMeshGetNodes", &tags.data, &tags.size,
                                             &coordinates.data, &coordinates.size, &parameters.data,
                                             &parameters.size, -1, -1, 0, 0);
  const std::vector<size_t> tag = gmsh.take(tags);
  const std::vector<double> x = gmsh.take(coordinates);
  gmsh.take(parameters);
  PlaneNodes result{{}, x.size() > 2 ? x[2] : 0};
  for (size_t i = 0; i < tag.size(); ++i) {
    if (x[3 * i + 2] != x[2])
      throw InputError(gmsh.path() + ": node " + std::to_string(tag[i]) +
                       " is at z = " + std::to_string(x[3 * i + 2]) +
                       ", expected all nodes in one plane z = " + std::to_string(x[2]));
    result.at[tag[i]] = {x[3 * i], x[3 * i + 1]};
  }
  return result;
}

TriangleMesh readHere(const MeshSource& source) {
  constexpr int line = 1;
  constexpr int triangle = 2;
  const std::string& path = source.path;
  requireConstants(source);
  const Gmsh gmsh(source);
  gmsh.call<decltype(gmshOpen)>("gmshOpen", path.c_str());
  if (elementTypes(gmsh, 2).empty())
    gmsh.call<decltype(gmshModelMeshGenerate)>("gmshModelMeshGenerate", 2);
  else if (source.size > 0)
    throw InputError(path + ": size, expected only for a geometry: this file is a mesh");
  for (const int type : elementTypes(gmsh, 2))
    if (type != triangle)
      throw InputError(path + ": elements of Gmsh's type " + std::to_string(type) +
                       ", expected linear triangles (type 2) only");

  const PlaneNodes nodes = planeNodes(gmsh);
  TriangleMesh mesh;
  std::map<size_t, int> vertexOf;
  const auto vertex = [&](size_t tag) {
    const auto [found, isNew] = vertexOf.try_emplace(tag, static_cast<int>(mesh.vertices.size()));
    if (isNew) {
      const auto node = nodes.at.find(tag);
      if (node == nodes.at.end())
        throw InputError(path + ": an element has node " + std::to_string(tag) + ", which is not there");
      mesh.vertices.push_back(node->second);
    }
    return found->second;
  };
  for (const Group& group : groups(gmsh, 2)) {
    if (!group.name.empty()) mesh.regionNames[group.name] = group.number;
    for (const int entity : group.entities) {
      const std::vector<size_t> corners = elements(gmsh, triangle, entity);
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
      const std::vector<size_t> ends = elements(gmsh, line, entity);
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
  mesh.name = path;
  if (source.regions.empty())
    dropInnerEdges(mesh);
  else
    keepRegions(mesh, source.regions);
  validate(mesh);
  return mesh;
}

}  // namespace

TriangleMesh readGmsh(const MeshSource& source, double seconds) {
  const std::string& path = source.path;
  if (std::error_code ignored; !std::filesystem::is_regular_file(path, ignored))
    throw InputError(path + ": not a file, expected a mesh or a geometry for Gmsh");
  const auto work = [&] {
    TriangleMesh mesh = readHere(source);
    ArchiveWriter writer;
    writer(mesh);
    return writer.bytes;
  };
  const std::string bytes = inChildProcess(work, path + ": Gmsh", seconds);
  TriangleMesh mesh;
  ArchiveReader reader(bytes);
  reader(mesh);
  return mesh;
}

#endif

}  // namespace mortier
