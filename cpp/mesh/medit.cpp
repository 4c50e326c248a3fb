#include "mesh/medit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/whole_file.h"

namespace mortier {
namespace {

constexpr std::uintmax_t maxBytes = std::uintmax_t(4)
                                    << 30;  // some 5e7 triangles: beyond what is solved here

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

constexpr std::array<std::string_view, 5> foreignElements{"Quadrilaterals", "Tetrahedra", "Hexahedra",
                                                          "Prisms", "Pyramids"};

bool isBlank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

// Text of the file as it may stand in a message of one line.
std::string quote(std::string_view word) {
  constexpr size_t longest = 40;
  std::string out(word.substr(0, longest));
  for (char& c : out) {
    if (c < ' ' || c > '~') c = '?';
  }
  return word.size() > longest ? out + "..." : out;
}

std::string readAll(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(path + ": not a file, expected a Medit mesh");
  }
  const auto size = std::filesystem::file_size(path, error);
  if (error || size > maxBytes) throw InputError(path + ": file size, expected 4 GiB at most");
  std::ifstream file(path, std::ios::binary);
  std::string text(size, '\0');
  if (!file.read(text.data(), std::streamsize(size))) {
    throw InputError(path + ": cannot be read, expected a Medit mesh");
  }
  return text;
}

// Reads the text word by word. Lines are counted only when a message needs one.
class Parser {
 public:
  Parser(const std::string& path, std::string_view text) : path_(path), text_(text) { mesh_.name = path; }

  TriangleMesh parse() {
    readHeader();
    while (readSection()) {
    }
    validate(mesh_, [this](MeshPart part, int index) { return place(offset(part, index)); });
    return std::move(mesh_);
  }

 private:
  struct Section {
    size_t begin = 0;  // offset of the first item; 0 when the file has no such section
    int width = 0;     // numbers of an item
  };

  std::string place(size_t at) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at), '\n');
    return path_ + ":" + std::to_string(line);
  }

  [[noreturn]] void fail(size_t at, const std::string& what) const {
    throw InputError(place(at) + ": " + what);
  }

  size_t offset(MeshPart part, int index) const {
    const Section& section = part == MeshPart::vertex     ? vertices_
                             : part == MeshPart::triangle ? triangles_
                             : part == MeshPart::edge     ? edges_
                                                          : Section();
    if (section.begin == 0) return lastEnd_;
    Parser again(path_, text_);
    again.at_ = section.begin;
    for (std::int64_t i = 0; i < std::int64_t(index) * section.width; ++i) again.word();
    again.skipBlanks();
    return again.at_;
  }

  void skipBlanks() {
    while (at_ < text_.size()) {
      if (text_[at_] == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (isBlank(text_[at_])) {
        ++at_;
      } else {
        return;
      }
    }
  }

  // The next word; empty at the end of the file.
  std::string_view word() {
    skipBlanks();
    const size_t begin = at_;
    while (at_ < text_.size() && !isBlank(text_[at_])) ++at_;
    if (at_ > begin) lastEnd_ = at_;
    return text_.substr(begin, at_ - begin);
  }

  template <class Number>
  Number number(const char* what) {
    skipBlanks();
    const size_t begin = at_;
    if (at_ < text_.size() && text_[at_] == '+') ++at_;  // which from_chars does not know
    Number value{};
    const char* const last = text_.data() + text_.size();
    const auto [end, error] = std::from_chars(text_.data() + at_, last, value);
    if (error == std::errc() && (end == last || isBlank(*end))) {
      at_ = lastEnd_ = size_t(end - text_.data());
      return value;
    }
    at_ = begin;
    failAt(word(), what);
  }

  // Complains about the word just read.
  [[noreturn]] void failAt(std::string_view found, const std::string& expected) const {
    if (found.empty()) fail(lastEnd_, "end of file, expected " + expected);
    fail(lastEnd_ - found.size(), "'" + quote(found) + "', expected " + expected);
  }

  void readHeader() {
    std::string_view found = word();
    if (found != "MeshVersionFormatted") failAt(found, "MeshVersionFormatted as the first word");
    number<int>("a version number");
    found = word();
    if (found != "Dimension") failAt(found, "Dimension");
    const int dimension = number<int>("a dimension");
    if (dimension != 2) fail(lastEnd_ - 1, "Dimension " + std::to_string(dimension) + ", expected 2");
  }

  // Returns whether another section may follow.
  bool readSection() {
    const std::string_view keyword = word();
    if (keyword == "End") return false;
    if (keyword == "Vertices") {
      readVertices();
    } else if (keyword == "Triangles") {
      readTriangles();
    } else if (keyword == "Edges") {
      readEdges();
    } else if (keyword == "Identifier" || keyword == "Geometry") {
      skipString();
    } else if (keyword == "AngleOfCornerBound" || keyword == "MaximalAngleOfCorner") {
      number<double>("an angle");
    } else if (std::count(foreignElements.begin(), foreignElements.end(), keyword)) {
      const int n = count(keyword, 1);
      if (n > 0) fail(lastEnd_, std::to_string(n) + " " + std::string(keyword) + ", expected triangles only");
    } else {
      skipSection(keyword);
    }
    return true;
  }

  void skipSection(std::string_view keyword) {
    const auto* const section = std::find_if(std::begin(skippedSections), std::end(skippedSections),
                                             [&](const auto& s) { return s.keyword == keyword; });
    if (section == std::end(skippedSections)) failAt(keyword, "Vertices, Edges, Triangles or End");
    const std::int64_t values = std::int64_t(count(keyword, section->width)) * section->width;
    for (std::int64_t i = 0; i < values; ++i) number<double>("a number");
  }

  // FreeFEM's savemesh writes two strings into the head of its files.
  void skipString() {
    skipBlanks();
    if (at_ == text_.size() || text_[at_] != '"') failAt(word(), "a string in double quotes");
    const size_t close = text_.find('"', at_ + 1);
    if (close == std::string_view::npos) fail(at_, "string without end, expected closing double quotes");
    at_ = lastEnd_ = close + 1;
  }

  // The number of items that follow. The file must have room for them: a blank and a digit for each number.
  int count(std::string_view keyword, int width) {
    const auto n = number<std::int64_t>("a count");
    const auto room = std::int64_t(text_.size() - at_) / (2 * width);
    if (n >= 0 && n <= room && n <= std::numeric_limits<int>::max() / width) return int(n);
    fail(lastEnd_ - 1, std::string(keyword) + " " + std::to_string(n) + ", expected a count from 0 to " +
                           std::to_string(room) + ": more do not fit into the file");
  }

  int begin(std::string_view keyword, Section& section, int width) {
    if (section.begin != 0) failAt(keyword, "this section once");
    const int n = count(keyword, width);
    section = {at_, width};
    return n;
  }

  // From 1 in the file, from 0 in memory. The upper bound is checked by validate: Vertices may come last.
  int vertexNumber() {
    const int v = number<int>("a vertex number");
    if (v < 1) fail(lastEnd_ - 1, "vertex " + std::to_string(v) + ", expected a vertex number from 1");
    return v - 1;
  }

  void readVertices() {
    const int n = begin("Vertices", vertices_, 3);
    mesh_.vertices.reserve(n);
    for (int i = 0; i < n; ++i) {
      const double x = number<double>("a coordinate");
      const double y = number<double>("a coordinate");
      number<int>("a label");
      mesh_.vertices.emplace_back(x, y);
    }
  }

  void readTriangles() {
    const int n = begin("Triangles", triangles_, 4);
    mesh_.triangles.reserve(n);
    mesh_.regions.reserve(n);
    for (int i = 0; i < n; ++i) {
      const int a = vertexNumber(), b = vertexNumber(), c = vertexNumber();
      mesh_.triangles.push_back({a, b, c});
      mesh_.regions.push_back(number<int>("a label"));
    }
  }

  void readEdges() {
    const int n = begin("Edges", edges_, 3);
    mesh_.boundaryEdges.reserve(n);
    mesh_.boundaryLabels.reserve(n);
    for (int i = 0; i < n; ++i) {
      const int a = vertexNumber(), b = vertexNumber();
      mesh_.boundaryEdges.push_back({a, b});
      mesh_.boundaryLabels.push_back(number<int>("a label"));
    }
  }

  const std::string& path_;
  std::string_view text_;
  size_t at_ = 0;
  size_t lastEnd_ = 0;  // end of the last word read
  Section vertices_, triangles_, edges_;
  TriangleMesh mesh_;
};

template <class Number>
void append(std::string& out, Number value, char after) {
  char digits[32];
  out.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  out += after;
}

}  // namespace

TriangleMesh readMedit(const std::string& path) {
  const std::string text = readAll(path);
  return Parser(path, text).parse();
}

void writeMedit(const TriangleMesh& mesh, const std::string& path) {
  std::string out = "MeshVersionFormatted 2\nDimension 2\n\nVertices\n";
  append(out, mesh.vertices.size(), '\n');
  for (const Point& p : mesh.vertices) {
    append(out, p.x(), ' ');
    append(out, p.y(), ' ');
    out += "0\n";
  }
  out += "\nEdges\n";
  append(out, mesh.boundaryEdges.size(), '\n');
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    for (int v : mesh.boundaryEdges[e]) append(out, v + 1, ' ');
    append(out, mesh.boundaryLabels[e], '\n');
  }
  out += "\nTriangles\n";
  append(out, mesh.triangles.size(), '\n');
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int v : mesh.triangles[t]) append(out, v + 1, ' ');
    append(out, mesh.regions[t], '\n');
  }
  out += "\nEnd\n";

  writeWhole(path, out);
}

}  // namespace mortier
