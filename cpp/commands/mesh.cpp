#include "commands/mesh.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>

#include "base/counted.h"
#include "base/error.h"
#include "base/printable.h"
#include "commands/exit_code.h"
#include "mesh/boundary_line.h"
#include "mesh/generate.h"
#include "mesh/medit.h"

namespace mortier {

namespace {

/// "6,4" as two numbers; "6" as 6 and 6 where `single` is allowed.
template <class Number>
std::pair<Number, Number> parsePair(const std::string& option, const std::string& text, bool single) {
  const auto one = [&](size_t begin, size_t end) {
    Number value{};
    const char* last = text.data() + end;
    const auto [stop, status] = std::from_chars(text.data() + begin, last, value);
    if (status != std::errc() || stop != last) {
      throw InputError(option + " " + text + ": expected " + (single ? "N or NX,NY" : "X,Y") + ", e.g. " +
                       (single ? "6 or 6,4" : "0,-1"));
    }
    return value;
  };
  const size_t comma = text.find(',');
  if (comma == std::string::npos && single) {
    const Number value = one(0, text.size());
    return {value, value};
  }
  const size_t end = std::min(comma, text.size());
  return {one(0, end), one(std::min(end + 1, text.size()), text.size())};
}

Point parsePoint(const std::string& option, const std::string& text) {
  const auto [x, y] = parsePair<double>(option, text, false);
  return {x, y};
}

/// One of a few words.
template <class Value>
Value parseWord(const std::string& option, const std::string& text,
                const std::vector<std::pair<std::string, Value>>& words) {
  std::string known;
  for (const auto& [word, value] : words) {
    if (word == text) {
      return value;
    }
    known += (known.empty() ? "" : ", ") + word;
  }
  throw InputError(option + " " + text + ": expected one of " + known);
}

std::string sizeOf(const TriangleMesh& mesh) {
  return counted(mesh.vertices.size(), "vertex") + ", " + counted(mesh.triangles.size(), "triangle");
}

/// ", name" of a label that has one.
std::string named(const std::map<std::string, int>& names, int label) {
  for (const auto& [name, number] : names)
    if (number == label) return ", " + printable(name);
  return "";
}

struct Made {
  TriangleMesh mesh;
  std::string labels;
};

Made make(const MeshCommand& command) {
  const auto [cells1, cells2] = parsePair<int>("--cells", command.cells, true);
  const bool curved = command.family == "annulus" || command.family.ends_with("disc");
  const std::string word = !command.cut.empty() ? command.cut : curved ? "both" : "rising";
  const Cut cut = parseWord<Cut>("--cut", word,
                                 {{"rising", Cut::rising}, {"falling", Cut::falling}, {"both", Cut::both}});
  if (command.family == "quadrilateral") {
    Quadrilateral shape{{}, cells1, cells2};
    for (size_t k = 0; k < 4; ++k) {
      shape.corners[k] = parsePoint("--corners", command.corners.at(k));
    }
    return {quadrilateralMesh(shape, cut), "1, 2, 3, 4: side k from corner k to the next"};
  }
  if (command.family == "annulus") {
    const int quarters = parseWord<int>("--span", command.span, {{"quarter", 1}, {"half", 2}, {"full", 4}});
    return {annulusMesh({parsePoint("--centre", command.centre), command.inner, command.outer, quarters,
                         cells1, cells2},
                        cut),
            quarters == 4 ? "1 inner circle, 2 outer circle"
                          : "1 inner circle, 2 outer circle, 3 first side, 4 last side"};
  }
  if (command.family.ends_with("disc")) {
    const bool quarter = command.family == "quarterdisc";
    return {halfDiscMesh(
                {parsePoint("--lowest", command.lowest), command.radius, command.core, cells1, quarter}, cut),
            std::string("1 arc near the lowest point, 2 flat side, 3 rest of the arc") +
                (quarter ? ", 4 vertical side" : "")};
  }
  Rectangle shape{parsePoint("--lower", command.lower), parsePoint("--upper", command.upper), cells1, cells2};
  if (!command.focus.empty()) {
    shape.focus = parsePoint("--focus", command.focus);
  }
  const auto [x, y] = parsePair<double>("--grading", command.grading, true);
  shape.grading = {x, y};
  if (command.focus.empty() && shape.grading != Point(1, 1)) {
    throw InputError("--grading " + command.grading + ": expected with --focus X,Y");
  }
  return {command.family == "crisscross" ? crissCrossMesh(shape) : rectangleMesh(shape, cut),
          "1 bottom, 2 right, 3 top, 4 left"};
}

}  // namespace

int makeMesh(const MeshCommand& command) {
  const auto [mesh, labels] = make(command);
  writeMedit(mesh, command.file);
  std::printf("%s: %s; labels %s\n", command.file.c_str(), sizeOf(mesh).c_str(), labels.c_str());
  return exitDone;
}

int convertMesh(const ConvertCommand& command) {
  const TriangleMesh mesh = readMesh(command.source);
  writeMedit(mesh, command.file);
  std::printf("%s: %s\n", command.file.c_str(), sizeOf(mesh).c_str());
  return exitDone;
}

int meshInfo(const std::string& file) {
  // 1. Read; the reader validates.
  const TriangleMesh mesh = readMesh({file});

  // 2. Extents and area.
  Point lower = mesh.vertices.front();
  Point upper = lower;
  for (const Point& p : mesh.vertices) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  double area = 0;
  double worst = 0;
  int worstTriangle = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    area += doubleArea(mesh, t) / 2;
    if (const double ratio = aspectRatio(mesh, t); ratio > worst) {
      worst = ratio;
      worstTriangle = t;
    }
  }

  // 3. Labels.
  std::map<int, std::pair<int, double>> boundary;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    const auto [a, b] = mesh.boundaryEdges[e];
    auto& [edges, length] = boundary[mesh.boundaryLabels[e]];
    ++edges;
    length += (mesh.vertices[b] - mesh.vertices[a]).norm();
  }
  std::map<int, int> regions;
  for (const int region : mesh.regions) {
    ++regions[region];
  }

  // 4. Tell.
  std::printf(
      "%s\nvertices   %zu\ntriangles  %zu\narea       %.9g\nextents    x %.9g .. %.9g, y %.9g .. %.9g\n",
      file.c_str(), mesh.vertices.size(), mesh.triangles.size(), area, lower[0], upper[0], lower[1],
      upper[1]);
  std::printf("worst aspect ratio %.3g (triangle %d; 1 is equilateral)\n", worst, worstTriangle + 1);
  for (const auto& [label, what] : boundary) {
    std::printf("label %-5d %s, length %.9g%s\n", label, counted(what.first, "edge").c_str(), what.second,
                named(mesh.labelNames, label).c_str());
  }
  for (const auto& [region, count] : regions) {
    std::printf("region %-4d %s%s\n", region, counted(count, "triangle").c_str(),
                named(mesh.regionNames, region).c_str());
  }
  return exitDone;
}

}  // namespace mortier
