#include "mesh/read.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/whole_file.h"
#include "mesh/cut_cells.h"
#include "mesh/medit_parser.h"
#include "mesh/medit_words.h"
#include "mesh/regions.h"
#include "mesh/simplices.h"

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

/// Sections of sides and elements.
struct ItemKind {
  std::string_view keyword;
  int corners;
  int dimension;
};
constexpr std::array<ItemKind, 7> itemKinds{{{"Edges", 2, 1},
                                             {"Triangles", 3, 2},
                                             {"Quadrilaterals", 4, 2},
                                             {"Tetrahedra", 4, 3},
                                             {"Prisms", 6, 3},
                                             {"Pyramids", 5, 3},
                                             {"Hexahedra", 8, 3}}};

class Parser {
 public:
  /// \param solid  whether it is of tetrahedra
  Parser(const MeditText& text, bool solid) : text_(text), words_(text_.path, text_.text), solid_(solid) {}

  template <class Mesh>
  Mesh parse(const std::vector<std::string>& regions) {
    constexpr int dimension = ofTetrahedra<Mesh> ? 3 : 2;
    readAll();
    Mesh mesh;
    mesh.name = text_.path;
    mesh.labelNames = std::move(labelNames_);
    mesh.regionNames = std::move(regionNames_);
    for (const SpacePoint& place : places_) mesh.vertices.push_back(place.head<dimension>());
    ChangedCells changed{false, text_.quadratic > 0};
    ChangedCells ofSides;
    mesh.regions = addItems(dimension, elementsOf(mesh), changed);
    mesh.boundaryLabels = addItems(dimension - 1, labelledSides(mesh), ofSides);
    mesh.changed = changed.text(elementsWord<Mesh>);
    const auto areThere = [n = static_cast<int>(places_.size())](const auto& items) {
      return std::all_of(items.begin(), items.end(), [n](const auto& item) {
        return std::all_of(item.begin(), item.end(), [n](int v) { return v < n; });
      });
    };
    const bool complete = areThere(elementsOf(mesh)) && areThere(labelledSides(mesh));
    if (text_.converted && complete) {
      if constexpr (!ofTetrahedra<Mesh>)
        for (size_t t = 0; t < mesh.triangles.size(); ++t)
          if (doubleArea(mesh, static_cast<int>(t)) < 0)
            std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
      takeGroups(mesh, regions);
    } else if (!regions.empty() && complete) {
      keepRegions(mesh, regions);
      validate(mesh);
    } else if constexpr (ofTetrahedra<Mesh>) {
      validate(mesh);
    } else {
      validate(mesh, [this](MeshPart part, int index) { return words_.place(offset(part, index)); });
    }
    return mesh;
  }

 private:
  struct Section {
    size_t begin = 0;  // offset of the first item; 0 when the file has no such section
    int width = 0;     // numbers of an item
  };
  /// Sides or elements of a kind, from 0: all corners one after the other.
  struct Items {
    Section section;
    std::vector<int> corners, labels;
  };

  /// Cuts the items of a dimension. \returns the labels of what they become
  template <size_t n>
  std::vector<int> addItems(int dimension, std::vector<std::array<int, n>>& simplices,
                            ChangedCells& changed) {
    std::vector<int> labels;
    for (size_t k = 0; k < itemKinds.size(); ++k) {
      if (itemKinds[k].dimension != dimension) continue;
      const Items& items = items_[k];
      const auto corners = static_cast<size_t>(itemKinds[k].corners);
      for (size_t i = 0; i < items.labels.size(); ++i) {
        const std::span<const int> cell(&items.corners[i * corners], corners);
        if constexpr (n == 2)
          simplices.push_back({cell[0], cell[1]});
        else
          cutCell(cell, simplices);
        labels.resize(simplices.size(), items.labels[i]);
        if (dimension == 2) sources_.resize(simplices.size(), {k, i});
      }
      changed.cut = changed.cut || (corners != n && !items.labels.empty());
    }
    return labels;
  }

  [[nodiscard]] size_t offset(MeshPart part, int index) const {
    const Section* section = &vertices_;
    auto item = static_cast<size_t>(index);
    if (part == MeshPart::triangle) section = &items_[sources_[item].first].section;
    if (part == MeshPart::triangle) item = sources_[item].second;
    if (part == MeshPart::edge) section = &items_[0].section;
    if (part == MeshPart::whole || section->begin == 0) return words_.lastEnd();
    return words_.offset(section->begin, item * size_t(section->width));
  }

  void readAll() {
    readHeader();
    while (readSection()) {
    }
    readNames();
  }

  void readHeader() {
    std::string_view found = words_.next();
    if (found != "MeshVersionFormatted")
      words_.failAt(found, "MeshVersionFormatted as the first word of a Medit file; files of other kinds: " +
                               otherMeshFiles());
    words_.number<int>("a version number");
    found = words_.next();
    if (found != "Dimension") words_.failAt(found, "Dimension");
    dimension_ = words_.number<int>("a dimension");
    if (dimension_ != 3 && (solid_ || dimension_ != 2))
      words_.fail(words_.lastEnd() - 1,
                  "Dimension " + std::to_string(dimension_) +
                      (solid_ ? ", expected 3: tetrahedra; a plane mesh becomes a body in space with extrude "
                                "or revolve"
                              : ", expected 2 or 3"));
  }

  // Lines after the End of the format (mesh/read.h).
  void readNames() {
    while (const auto name = words_.nextName()) {
      if (name->of == "label") labelNames_[std::string(name->name)] = name->number;
      if (name->of == "region") regionNames_[std::string(name->name)] = name->number;
    }
  }

  /// Whether there are triangles or more, after which a file may end without End, as FreeFEM reads it.
  [[nodiscard]] bool hasElements() const {
    return std::any_of(itemKinds.begin(), itemKinds.end(), [&](const ItemKind& kind) {
      return kind.dimension > 1 && !items_[size_t(&kind - itemKinds.data())].labels.empty();
    });
  }

  // Returns whether another section may follow.
  bool readSection() {
    const size_t before = words_.lastEnd();
    const std::string_view keyword = words_.next();
    if (keyword == "End") return false;
    if (keyword.empty() && hasElements()) {
      if (before == text_.text.size())
        words_.fail(before, "end of file within a line, expected a line break or End after the last number");
      words_.rewind();
      return false;
    }
    const auto* const kind = std::find_if(itemKinds.begin(), itemKinds.end(),
                                          [&](const ItemKind& each) { return each.keyword == keyword; });
    if (keyword == "Vertices") {
      readVertices();
    } else if (kind != itemKinds.end()) {
      readItems(*kind, items_[size_t(kind - itemKinds.begin())]);
    } else if (keyword == "Identifier" || keyword == "Geometry") {
      words_.skipString();
    } else if (keyword == "AngleOfCornerBound" || keyword == "MaximalAngleOfCorner") {
      words_.number<double>("an angle");
    } else {
      skipSection(keyword);
    }
    return true;
  }

  void skipSection(std::string_view keyword) {
    const auto* const section = std::find_if(std::begin(skippedSections), std::end(skippedSections),
                                             [&](const auto& s) { return s.keyword == keyword; });
    if (section == std::end(skippedSections))
      words_.failAt(keyword,
                    solid_ ? "Vertices, Triangles, Tetrahedra or End" : "Vertices, Edges, Triangles or End");
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
    places_.reserve(n);
    for (int i = 0; i < n; ++i) {
      const double x = words_.number<double>("a coordinate");
      const double y = words_.number<double>("a coordinate");
      const double z = dimension_ == 3 ? words_.number<double>("a coordinate") : 0;
      if (!solid_ && i > 0 && z != places_.front().z())
        failInSpace("vertex " + std::to_string(i + 1) + " at z = " + std::to_string(z) +
                    ", expected all vertices in the plane z = " + std::to_string(places_.front().z()));
      words_.number<int>("a label");
      places_.emplace_back(x, y, z);
    }
  }

  /// Complains about the last word of a mesh in space that is read for the plane.
  [[noreturn]] void failInSpace(const std::string& what) const {
    const std::string message = what + ", or dimension = 3 at the top of the scene for a body in space";
    if (text_.converted) throw InputError(text_.path + ": " + message);
    words_.fail(words_.lastEnd() - 1, message);
  }

  void readItems(const ItemKind& kind, Items& items) {
    const int n = begin(kind.keyword, items.section, kind.corners + 1);
    if (n > 0 && kind.dimension == 3 && !solid_)
      failInSpace(std::to_string(n) + " " + std::string(kind.keyword) +
                  ", expected triangles or quadrangles");
    items.corners.reserve(size_t(n) * size_t(kind.corners));
    items.labels.reserve(n);
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < kind.corners; ++k) items.corners.push_back(vertexNumber());
      items.labels.push_back(words_.number<int>("a label"));
    }
  }

  MeditText text_;
  MeditWords words_;
  int dimension_ = 2;
  bool solid_ = false;
  Section vertices_;
  std::vector<SpacePoint> places_;
  std::array<Items, itemKinds.size()> items_;
  std::vector<std::pair<size_t, size_t>> sources_;  // by triangle: the kind and the item that it comes from
  std::map<std::string, int> labelNames_, regionNames_;
};

}  // namespace

TriangleMesh parseMedit(const MeditText& text, const std::vector<std::string>& regions) {
  return Parser(text, false).parse<TriangleMesh>(regions);
}

TetrahedronMesh parseSpaceMedit(const MeditText& text, const std::vector<std::string>& regions) {
  return Parser(text, true).parse<TetrahedronMesh>(regions);
}

TriangleMesh readMedit(const std::string& path, const std::vector<std::string>& regions) {
  const std::string text = readWhole(path, "a Medit mesh");
  return parseMedit({path, text}, regions);
}

TetrahedronMesh readSpaceMedit(const std::string& path, const std::vector<std::string>& regions) {
  const std::string text = readWhole(path, "a Medit mesh");
  return parseSpaceMedit({path, text}, regions);
}

}  // namespace mortier
