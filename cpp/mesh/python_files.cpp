#include <charconv>

#include "base/child_process.h"
#include "base/error.h"
#include "base/shipped.h"
#include "base/whole_file.h"
#include "mesh/medit_parser.h"
#include "mesh/read.h"

namespace mortier {
namespace {

/// The number of quadratic cells and a line break, then Medit text.
std::string converted(const std::string& path) {
  const std::string name = "mesh_files.py";
  const auto folder = shippedFolder("views", name);
  if (!folder)
    throw InputError(path + ": read by views/" + name +
                     " of mortier, which is found neither above the program nor in share/mortier; expected a "
                     "Medit .mesh file");
  // A file that is none, or is too large to be read.
  static_cast<void>(readWhole(path, "a mesh"));
  return ChildProcess({pythonProgram(), "-B", (*folder / name).string(), path}, path + ": Python")
      .answer(gmshPatience);
}

template <class Parse>
auto parsed(const MeshSource& source, const Parse& parse) {
  const std::string text = converted(source.path);
  MeditText medit{source.path, text, true, 0};
  const auto end = std::from_chars(text.data(), text.data() + text.size(), medit.quadratic).ptr;
  medit.text.remove_prefix(static_cast<size_t>(end - text.data()));
  return parse(medit, source.regions);
}

}  // namespace

TriangleMesh readPythonFile(const MeshSource& source) {
  return parsed(source, parseMedit);
}

TetrahedronMesh readSpacePythonFile(const MeshSource& source) {
  return parsed(source, parseSpaceMedit);
}

}  // namespace mortier
