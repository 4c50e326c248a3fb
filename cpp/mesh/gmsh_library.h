// Gmsh's library, from its start to its end, with one file. It is opened when a file needs it: linked, its
// own libraries would start with every run.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mesh/read.h"

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

}  // namespace mortier
