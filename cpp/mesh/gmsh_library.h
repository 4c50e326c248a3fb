// Gmsh's library, from its start to its end, with one file. It is opened when a file needs it: linked, its
// own libraries would start with every run.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "mesh/read.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

class Gmsh {
 public:
  explicit Gmsh(const MeshSource& source);
  Gmsh(const Gmsh&) = delete;
  Gmsh& operator=(const Gmsh&) = delete;
  ~Gmsh();

  /// \throws InputError with what Gmsh says.
  template <class Function, class... Arguments>
  void call(const char* name, Arguments... arguments) const {
    int error = 0;
    reinterpret_cast<Function*>(address(name))(arguments..., &error);
    if (error != 0) fail();
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
    free(array.data);
    return result;
  }

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  [[nodiscard]] void* address(const char* name) const;
  void free(void* data) const;
  [[noreturn]] void fail() const;

  std::string path_;
  void* library_ = nullptr;
};

/// The kind of a curve or surface that has a shape, not of one that is its mesh; else empty.
std::string shapeOf(const Gmsh& gmsh, int dimension, int entity);

/// Normals of a surface of Gmsh at its nodes, by their tags: of those that are on it, to a millionth of its
/// size, and have one.
std::map<size_t, SpacePoint> normalsOn(const Gmsh& gmsh, int surface);

// What the edges of Gmsh's curves stand for.

/// Nodes of a plane mesh of Gmsh.
struct PlaneNodes {
  std::map<size_t, Point> at;  ///< by tag [m]
  double z = 0;
};

/// Of an edge: the middle of what it stands for [m], not finite where that is not known, and the curve where
/// that is neither a circle nor straight.
struct KnownEdge {
  Point middle;
  EdgeCurve curve = {};
};

/// \param curve  of Gmsh  \param ends  tags of the nodes of its edges, two by two
std::vector<KnownEdge> knownEdges(const Gmsh& gmsh, int curve, const std::vector<size_t>& ends,
                                  const PlaneNodes& nodes);

// The constants that a geometry of Gmsh declares: DefineConstant[ name = value, ... ].

/// Gmsh overlooks a number that no constant of the geometry takes.
/// \throws InputError when a parameter is none of them.
void requireConstants(const MeshSource& source);

}  // namespace mortier
