#include "mesh/read.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/whole_file.h"
#include "mesh/medit_words.h"
#include "mesh/regions.h"

namespace mortier {
namespace {

// Sections without meaning for the solver, and how many numbers each of their items has in two dimensions.
struct SkippedSection {
  std::string_view keyword;
  int width;
};
constexpr SkippedSection skippedSections[] = {
    {"Corners", 1},
    {"RequiredVertices", 1},
    {"Ridges", 1},
    {"RequiredEdges", 1},
    {"RequiredTriangles", 1},
    {"Tangents", 2},
    {"Normals", 2},
    {"TangentAtVertices", 2},
    {"NormalAtVertices", 2},
    {"TangentAtEdges", 3},
    {"NormalAtTriangleVertices", 3},
    {"SubDomainFromMesh", 4},
    {"SubDomainFromGeom", 4},
    {"VertexOnGeometricVertex", 2},
    {"VertexOnGeometricEdge", 3},
    {"EdgeOnGeometricEdge", 2},
};

constexpr std::array<std::string_view, 4> foreignElements{"Quadrilaterals", "Hexahedra", "Prisms",
                                                          "Pyramids"};

class Parser {
 public:
  /// \param solid  whether it is of tetrahedra
  Parser(const std::string& path, std::string_view text, bool solid) : words_(path, text), solid_(solid) {
    mesh_.name = solidMesh_.name = path;
  }

  TriangleMesh parse(const std::vector<std::string>& regions) {
    readAll();
    mesh_.labelNames = std::move(labelNames_);
    mesh_.regionNames = std::move(regionNames_);
    if (!regions.empty() && verticesAreThere()) {
      keepRegions(mesh_, regions);
      validate(mesh_);
      return std::move(mesh_);
    }
    validate(mesh_, [this](MeshPart part, int index) { return words_.place(offset(part, index)); });
    return std::move(mesh_);
  }

  TetrahedronMesh parseSolid(const std::vector<std::string>& regions) {
    readAll();
    solidMesh_.labelNames = std::move(labelNames_);
    solidMesh_.regionNames = std::move(regionNames_);
    if (!regions.empty()) keepRegions(solidMesh_, regions);
    validate(solidMesh_);
    return std::move(solidMesh_);
  }

 private:
  struct Section {
    size_t begin = 0;  // offset of the first item; 0 when the file has no such section
    int width = 0;     // numbers of an item
  };

  size_t offset(MeshPart part, int index) const {
    const Section& section = part == MeshPart::vertex     ? vertices_
                             : part == MeshPart::triangle ? triangles_
                             : part == MeshPart::edge     ? edges_
                                                          : Section();
    if (section.begin == 0) return words_.lastEnd();
    return words_.offset(section.begin, size_t(index) * size_t(section.width));
  }

  void readAll() {
    readHeader();
    while (readSection()) {
    }
    readNames();
  }

  void readHeader() {
    std::string_view found = words_.next();
    if (found != "MeshVersionFormatted") words_.failAt(found, "MeshVersionFormatted as the first word");
    words_.number<int>("a version number");
    found = words_.next();
    if (found != "Dimension") words_.failAt(found, "Dimension");
    dimension_ = words_.number<int>("a dimension");
    if (dimension_ != 3 && (solid_ || dimension_ != 2))
      words_.fail(words_.lastEnd() - 1, "Dimension " + std::to_string(dimension_) +
                                            (solid_ ? ", expected 3" : ", expected 2 or 3"));
  }

  // Lines after the End of the format (medit.h).
  void readNames() {
    while (const auto name = words_.nextName()) {
      if (name->of == "label") labelNames_[std::string(name->name)] = name->number;
      if (name->of == "region") regionNames_[std::string(name->name)] = name->number;
    }
  }

  [[nodiscard]] bool verticesAreThere() const {
    const int n = int(mesh_.vertices.size());
    const auto isThere = [n](int v) { return v < n; };
    return std::all_of(mesh_.triangles.begin(), mesh_.triangles.end(),
                       [&](const auto& t) { return std::all_of(t.begin(), t.end(), isThere); }) &&
           std::all_of(mesh_.boundaryEdges.begin(), mesh_.boundaryEdges.end(),
                       [&](const auto& e) { return std::all_of(e.begin(), e.end(), isThere); });
  }

  // Returns whether another section may follow.
  bool readSection() {
    const std::string_view keyword = words_.next();
    if (keyword == "End") return false;
    if (keyword == "Vertices") {
      readVertices();
    } else if (keyword == "Triangles") {
      readTriangles();
    } else if (keyword == "Edges") {
      readEdges();
    } else if (keyword == "Tetrahedra" && solid_) {
      readTetrahedra();
    } else if (keyword == "Identifier" || keyword == "Geometry") {
      words_.skipString();
    } else if (keyword == "AngleOfCornerBound" || keyword == "MaximalAngleOfCorner") {
      words_.number<double>("an angle");
    } else if (keyword == "Tetrahedra" ||
               std::count(foreignElements.begin(), foreignElements.end(), keyword)) {
      const int n = count(keyword, 1);
      if (n > 0)
        words_.fail(words_.lastEnd(), std::to_string(n) + " " + std::string(keyword) + ", expected " +
                                          (solid_                    ? "tetrahedra only"
                                           : keyword == "Tetrahedra" ? "triangles only, or dimension = 3"
                                                                     : "triangles only"));
    } else {
      skipSection(keyword);
    }
    return true;
  }

  void skipSection(std::string_view keyword) {
    const auto* const section = std::find_if(std::begin(skippedSections), std::end(skippedSections),
                                             [&](const auto& s) { return s.keyword == keyword; });
    if (section == std::end(skippedSections)) words_.failAt(keyword, "Vertices, Edges, Triangles or End");
    const bool isVector = keyword == "Tangents" || keyword == "Normals";
    const int width = isVector ? dimension_ : section->width;
    const std::int64_t values = std::int64_t(count(keyword, width)) * width;
    for (std::int64_t i = 0; i < values; ++i) words_.number<double>("a number");
  }

  // The number of items that follow. The file must have room for them: a blank and a digit for each number.
  int count(std::string_view keyword, int width) {
    const auto n = words_.number<std::int64_t>("a count");
    const auto room = std::int64_t(words_.remaining()) / (2 * width);
    if (n >= 0 && n <= room && n <= std::numeric_limits<int>::max() / width) return int(n);
    words_.fail(words_.lastEnd() - 1, std::string(keyword) + " " + std::to_string(n) +
                                          ", expected a count from 0 to " + std::to_string(room) +
                                          ": more do not fit into the file");
  }

  int begin(std::string_view keyword, Section& section, int width) {
    if (section.begin != 0) words_.failAt(keyword, "this section once");
    const int n = count(keyword, width);
    section = {words_.at(), width};
    return n;
  }

  // From 1 in the file, from 0 in memory. The upper bound is checked by validate: Vertices may come last.
  int vertexNumber() {
    const int v = words_.number<int>("a vertex number");
    if (v < 1)
      words_.fail(words_.lastEnd() - 1, "vertex " + std::to_string(v) + ", expected a vertex number from 1");
    return v - 1;
  }

  void readVertices() {
    const int n = begin("Vertices", vertices_, dimension_ + 1);
    (solid_ ? solidMesh_.vertices.reserve(n) : mesh_.vertices.reserve(n));
    double plane = 0;
    for (int i = 0; i < n; ++i) {
      const double x = words_.number<double>("a coordinate");
      const double y = words_.number<double>("a coordinate");
      const double z = dimension_ == 3 ? words_.number<double>("a coordinate") : 0;
      if (i == 0) plane = z;
      if (z != plane && !solid_)
        words_.fail(words_.lastEnd() - 1,
                    "vertex " + std::to_string(i + 1) + " at z = " + std::to_string(z) +
                        ", expected all vertices in the plane z = " + std::to_string(plane));
      words_.number<int>("a label");
      if (solid_)
        solidMesh_.vertices.emplace_back(x, y, z);
      else
        mesh_.vertices.emplace_back(x, y);
    }
  }

  void readTriangles() {
    const int n = begin("Triangles", triangles_, 4);
    auto& triangles = solid_ ? solidMesh_.boundaryTriangles : mesh_.triangles;
    auto& labels = solid_ ? solidMesh_.boundaryLabels : mesh_.regions;
    triangles.reserve(n);
    labels.reserve(n);
    for (int i = 0; i < n; ++i) {
      const int a = vertexNumber(), b = vertexNumber(), c = vertexNumber();
      triangles.push_back({a, b, c});
      labels.push_back(words_.number<int>("a label"));
    }
  }

  void readTetrahedra() {
    const int n = begin("Tetrahedra", tetrahedra_, 5);
    solidMesh_.tetrahedra.reserve(n);
    solidMesh_.regions.reserve(n);
    for (int i = 0; i < n; ++i) {
      const int a = vertexNumber(), b = vertexNumber(), c = vertexNumber(), d = vertexNumber();
      solidMesh_.tetrahedra.push_back({a, b, c, d});
      solidMesh_.regions.push_back(words_.number<int>("a label"));
    }
  }

  void readEdges() {
    const int n = begin("Edges", edges_, 3);
    mesh_.boundaryEdges.reserve(n);
    mesh_.boundaryLabels.reserve(n);
    for (int i = 0; i < n; ++i) {
      const int a = vertexNumber(), b = vertexNumber();
      mesh_.boundaryEdges.push_back({a, b});
      mesh_.boundaryLabels.push_back(words_.number<int>("a label"));
    }
  }

  MeditWords words_;
  int dimension_ = 2;
  Section vertices_, triangles_, edges_, tetrahedra_;
  bool solid_ = false;
  TriangleMesh mesh_;
  TetrahedronMesh solidMesh_;
  std::map<std::string, int> labelNames_, regionNames_;
};

bool isOneLine(const std::string& name) {
  return !name.empty() && std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' '; });
}

template <class Number>
void append(std::string& out, Number value, char after) {
  char digits[32];
  out.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  out += after;
}

}  // namespace

TriangleMesh readMedit(const std::string& path, const std::vector<std::string>& regions) {
  const std::string text = readWhole(path, "a Medit mesh");
  return Parser(path, text, false).parse(regions);
}

TetrahedronMesh readSpaceMedit(const std::string& path, const std::vector<std::string>& regions) {
  const std::string text = readWhole(path, "a Medit mesh");
  return Parser(path, text, true).parseSolid(regions);
}

namespace {

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
void appendEnd(std::string& out, const Mesh& mesh) {
  out += "\nEnd\n";
  const auto appendNames = [&](const char* of, const std::map<std::string, int>& names) {
    for (const auto& [name, number] : names)
      if (isOneLine(name)) out += std::string("# ") + of + ' ' + std::to_string(number) + " = " + name + '\n';
  };
  appendNames("label", mesh.labelNames);
  appendNames("region", mesh.regionNames);
}

}  // namespace

std::string meditText(const TriangleMesh& mesh) {
  std::string out = "MeshVersionFormatted 2\nDimension 2\n\nVertices\n";
  append(out, mesh.vertices.size(), '\n');
  for (const Point& p : mesh.vertices) {
    append(out, p.x(), ' ');
    append(out, p.y(), ' ');
    out += "0\n";
  }
  appendItems(out, "Edges", mesh.boundaryEdges, mesh.boundaryLabels);
  appendItems(out, "Triangles", mesh.triangles, mesh.regions);
  appendEnd(out, mesh);
  return out;
}

std::string meditText(const TetrahedronMesh& mesh) {
  std::string out = "MeshVersionFormatted 2\nDimension 3\n\nVertices\n";
  append(out, mesh.vertices.size(), '\n');
  for (const SpacePoint& p : mesh.vertices) {
    for (const double x : p) append(out, x, ' ');
    out += "0\n";
  }
  appendItems(out, "Triangles", mesh.boundaryTriangles, mesh.boundaryLabels);
  appendItems(out, "Tetrahedra", mesh.tetrahedra, mesh.regions);
  appendEnd(out, mesh);
  return out;
}

void writeMedit(const TriangleMesh& mesh, const std::string& path) {
  writeWhole(path, meditText(mesh));
}
void writeMedit(const TetrahedronMesh& mesh, const std::string& path) {
  writeWhole(path, meditText(mesh));
}

}  // namespace mortier
