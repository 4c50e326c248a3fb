#include <algorithm>
#include <charconv>

#include "base/whole_file.h"
#include "mesh/read.h"
#include "mesh/simplices.h"

namespace mortier {
namespace {

bool isOneLine(const std::string& name) {
  return !name.empty() && std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' '; });
}

template <class Number>
void append(std::string& out, Number value, char after) {
  char digits[32];
  out.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  out += after;
}

/// Items with vertex numbers and a label.
template <size_t n>
void appendItems(std::string& out, const char* section, const std::vector<std::array<int, n>>& items,
                 const std::vector<int>& labels) {
  out.append("\n").append(section).append("\n");
  append(out, items.size(), '\n');
  for (size_t i = 0; i < items.size(); ++i) {
    for (const int v : items[i]) append(out, v + 1, ' ');
    append(out, labels[i], '\n');
  }
}

template <class Mesh>
std::string textOf(const Mesh& mesh) {
  std::string out = "MeshVersionFormatted 2\nDimension ";
  out += ofTetrahedra<Mesh> ? "3\n\nVertices\n" : "2\n\nVertices\n";
  append(out, mesh.vertices.size(), '\n');
  for (const auto& p : mesh.vertices) {
    for (const double x : p) append(out, x, ' ');
    out += "0\n";
  }
  appendItems(out, ofTetrahedra<Mesh> ? "Triangles" : "Edges", labelledSides(mesh), mesh.boundaryLabels);
  appendItems(out, ofTetrahedra<Mesh> ? "Tetrahedra" : "Triangles", elementsOf(mesh), mesh.regions);
  out += "\nEnd\n";
  const auto appendNames = [&](const char* of, const std::map<std::string, int>& names) {
    for (const auto& [name, number] : names)
      if (isOneLine(name)) out += std::string("# ") + of + ' ' + std::to_string(number) + " = " + name + '\n';
  };
  appendNames("label", mesh.labelNames);
  appendNames("region", mesh.regionNames);
  return out;
}

}  // namespace

std::string meditText(const TriangleMesh& mesh) {
  return textOf(mesh);
}
std::string meditText(const TetrahedronMesh& mesh) {
  return textOf(mesh);
}

void writeMedit(const TriangleMesh& mesh, const std::string& path) {
  writeWhole(path, meditText(mesh));
}
void writeMedit(const TetrahedronMesh& mesh, const std::string& path) {
  writeWhole(path, meditText(mesh));
}

}  // namespace mortier
