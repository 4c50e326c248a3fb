// The library is opened when a file needs it (linked, its own libraries would start with every run), in a
// process of its own: it crashes on some files, and a geometry is a program that could start others and write
// files.
#include "mesh/gmsh.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <type_traits>

#include "base/archive.h"
#include "base/child_process.h"
#include "base/error.h"
#include "mesh/geometry_constants.h"
#include "mesh/regions.h"

#ifdef MORTIER_GMSH
#include <dlfcn.h>
#include <gmshc.h>
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

TriangleMesh readGmsh(const MeshSource& source) {
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
         edgeMiddles] = mesh;
  archive(name, vertices, triangles, regions, boundaryEdges, boundaryLabels, labelNames, regionNames,
          edgeMiddles);
}

namespace {

std::string decimal(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

/// Gmsh, from its start to its end, with one file.
class Gmsh {
 public:
  explicit Gmsh(const MeshSource& source) : path_(source.path) {
    library_ = dlopen(MORTIER_GMSH, RTLD_NOW);
    if (library_ == nullptr) throw InputError(path_ + ": Gmsh cannot be loaded: " + dlerror());
    // Later versions ask as well whether to run as a program.
    std::vector<std::string> words{"gmsh"};
    for (const auto& [name, value] : source.parameters)
      words.insert(words.end(), {"-setnumber", name, decimal(value)});
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    const int count = static_cast<int>(arguments.size());
    if constexpr (std::is_invocable_v<decltype(gmshInitialize), int, char**, int, int*>)
      call<decltype(gmshInitialize)>("gmshInitialize", count, arguments.data(), 0);
    else
      call<decltype(gmshInitialize)>("gmshInitialize", count, arguments.data(), 0, 0);
    call<decltype(gmshOptionSetNumber)>("gmshOptionSetNumber", "General.Terminal", 0.0);
    if (source.size > 0)
      call<decltype(gmshOptionSetNumber)>("gmshOptionSetNumber", "Mesh.MeshSizeMax", source.size);
  }
  Gmsh(const Gmsh&) = delete;
  Gmsh& operator=(const Gmsh&) = delete;
  ~Gmsh() {
    int ignored = 0;
    symbol<decltype(gmshFinalize)>("gmshFinalize")(&ignored);
  }

  /// \throws InputError with what Gmsh says.
  template <class Function, class... Arguments>
  void call(const char* name, Arguments... arguments) const {
    int error = 0;
    symbol<Function>(name)(arguments..., &error);
    if (error != 0) throw InputError(path_ + ": Gmsh: " + lastError());
  }

  template <class Value>
  struct Array {
    Value* data = nullptr;
    size_t size = 0;
  };
  /// Takes over an array that Gmsh made.
  template <class Value>
  std::vector<Value> take(const Array<Value>& array) const {
    std::vector<Value> result(array.data, array.data + array.size);
    symbol<decltype(gmshFree)>("gmshFree")(array.data);
    return result;
  }

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  template <class Function>
  [[nodiscard]] Function* symbol(const char* name) const {
    auto* found = reinterpret_cast<Function*>(dlsym(library_, name));
    if (found == nullptr) throw InputError(path_ + ": Gmsh lacks " + name);
    return found;
  }

  [[nodiscard]] std::string lastError() const {
    char* text = nullptr;
    int error = 0;
    symbol<decltype(gmshLoggerGetLastError)>("gmshLoggerGetLastError")(&text, &error);
    std::string result = text == nullptr || *text == 0 ? "cannot read it" : text;
    std::replace(result.begin(), result.end(), '\n', ' ');
    if (text != nullptr) symbol<decltype(gmshFree)>("gmshFree")(text);
    return result;
  }

  std::string path_;
  void* library_ = nullptr;
};

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

struct PlaneNodes {
  std::map<size_t, Point> at;  ///< by tag
  double z = 0;
};

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

/// Whether the curve has a shape that is not the line of its mesh: it comes from a geometry.
bool hasShape(const Gmsh& gmsh, int curve) {
  char* type = nullptr;
  gmsh.call<decltype(gmshModelGetType)>("gmshModelGetType", 1, curve, &type);
  const std::string word = type == nullptr ? "" : type;
  if (type != nullptr) gmsh.take(Gmsh::Array<char>{type, 0});
  return !word.empty() && word != "Line" && word.find("Discrete") == std::string::npos;
}

/// The point of a curve nearest to the middle of one of its edges; none where Gmsh finds none near it.
Point middleOn(const Gmsh& gmsh, int curve, double z, const Point& a, const Point& b) {
  const Point half = (b - a) / 2;
  std::array<double, 3> middle{a.x() + half.x(), a.y() + half.y(), z};
  Gmsh::Array<double> found;
  Gmsh::Array<double> parameter;
  gmsh.call<decltype(gmshModelGetClosestPoint)>("gmshModelGetClosestPoint", 1, curve, middle.data(),
                                                middle.size(), &found.data, &found.size, &parameter.data,
                                                &parameter.size);
  const std::vector<double> x = gmsh.take(found);
  gmsh.take(parameter);
  const Point none = Point::Constant(std::numeric_limits<double>::quiet_NaN());
  if (x.size() < 3) return none;
  const Point point(x[0], x[1]);
  return (point - a - half).norm() < half.norm() ? point : none;
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
      const bool shaped = hasShape(gmsh, entity);
      for (size_t i = 0; i + 1 < ends.size(); i += 2) {
        const int a = vertex(ends[i]);
        const int b = vertex(ends[i + 1]);
        mesh.boundaryEdges.push_back({a, b});
        mesh.boundaryLabels.push_back(group.number);
        mesh.edgeMiddles.push_back(shaped
                                       ? middleOn(gmsh, entity, nodes.z, mesh.vertices[a], mesh.vertices[b])
                                       : Point::Constant(std::numeric_limits<double>::quiet_NaN()));
      }
    }
  }
  if (std::none_of(mesh.edgeMiddles.begin(), mesh.edgeMiddles.end(),
                   [](const Point& p) { return p.allFinite(); }))
    mesh.edgeMiddles.clear();
  mesh.name = path;
  if (source.regions.empty())
    dropInnerEdges(mesh);
  else
    keepRegions(mesh, source.regions);
  validate(mesh);
  return mesh;
}

}  // namespace

TriangleMesh readGmsh(const MeshSource& source) {
  const std::string& path = source.path;
  if (std::error_code ignored; !std::filesystem::is_regular_file(path, ignored))
    throw InputError(path + ": not a file, expected a mesh or a geometry for Gmsh");
  const auto work = [&] {
    TriangleMesh mesh = readHere(source);
    ArchiveWriter writer;
    writer(mesh);
    return writer.bytes;
  };
  const std::string bytes = inChildProcess(work, path + ": Gmsh");
  TriangleMesh mesh;
  ArchiveReader reader(bytes);
  reader(mesh);
  return mesh;
}

#endif

}  // namespace mortier
