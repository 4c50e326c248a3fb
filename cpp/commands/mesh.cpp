// `mortier mesh`: makes labelled meshes of simple shapes (mesh/generate.h), converts and describes meshes.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "base/digits.h"
#include "base/error.h"
#include "base/printable.h"
#include "commands/command_line.h"
#include "mesh/boundary_line.h"
#include "mesh/box_of.h"
#include "mesh/generate.h"
#include "mesh/read.h"

namespace mortier {

namespace {

/// A mesh to make, options as given.
struct MeshOptions {
  std::string family;  ///< rectangle, crisscross, quadrilateral, annulus, halfdisc, quarterdisc
  std::string file;
  std::string cells = "1";    ///< N or N1,N2
  std::string cut;            ///< rising, falling, both; empty: that of the family
  std::string lower = "0,0";  ///< corners of a rectangle [m]
  std::string upper = "1,1";
  std::string focus;  ///< X,Y; none: equal cells
  std::string grading = "1";
  std::vector<std::string> corners;  ///< of a quadrilateral
  std::string centre = "0,0";        ///< of an annulus
  double inner = 1;
  double outer = 2;
  std::string span = "full";   ///< quarter, half, full
  std::string lowest = "0,0";  ///< of a half disc
  double radius = 1;
  double core = 0.1;
};

/// "6,4" as two numbers; "6" as 6 and 6 where `single` is allowed.
template <class Number>
std::pair<Number, Number> parsePair(const std::string& option, const std::string& text, bool single) {
  const auto one = [&](size_t begin, size_t end) {
    Number value{};
    const char* last = text.data() + end;
    const auto [stop, status] = std::from_chars(text.data() + begin, last, value);
    if (status != std::errc() || stop != last)
      throw InputError(option + " " + text + ": expected " + (single ? "N or NX,NY" : "X,Y") + ", e.g. " +
                       (single ? "6 or 6,4" : "0,-1"));
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
    if (word == text) return value;
    known += (known.empty() ? "" : ", ") + word;
  }
  throw InputError(option + " " + text + ": expected one of " + known);
}

std::string sizeOf(const TriangleMesh& mesh) {
  return counted(mesh.vertices.size(), "vertex") + ", " + counted(mesh.triangles.size(), "triangle");
}

std::string sizeOf(const TetrahedronMesh& mesh) {
  return counted(mesh.vertices.size(), "vertex") + ", " + counted(mesh.tetrahedra.size(), "tetrahedron");
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

Made make(const MeshOptions& command) {
  const auto [cells1, cells2] = parsePair<int>("--cells", command.cells, true);
  const bool curved = command.family == "annulus" || command.family.ends_with("disc");
  const std::string word = !command.cut.empty() ? command.cut : curved ? "both" : "rising";
  const Cut cut = parseWord<Cut>("--cut", word,
                                 {{"rising", Cut::rising}, {"falling", Cut::falling}, {"both", Cut::both}});
  if (command.family == "quadrilateral") {
    Quadrilateral shape{{}, cells1, cells2};
    for (size_t k = 0; k < 4; ++k) shape.corners[k] = parsePoint("--corners", command.corners.at(k));
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
  if (!command.focus.empty()) shape.focus = parsePoint("--focus", command.focus);
  const auto [x, y] = parsePair<double>("--grading", command.grading, true);
  shape.grading = {x, y};
  if (command.focus.empty() && shape.grading != Point(1, 1))
    throw InputError("--grading " + command.grading + ": expected with --focus X,Y");
  return {command.family == "crisscross" ? crissCrossMesh(shape) : rectangleMesh(shape, cut),
          "1 bottom, 2 right, 3 top, 4 left"};
}

int makeMesh(const MeshOptions& command) {
  const auto [mesh, labels] = make(command);
  writeMedit(mesh, command.file);
  std::printf("%s: %s; labels %s\n", command.file.c_str(), sizeOf(mesh).c_str(), labels.c_str());
  return exitDone;
}

/// Calls use(mesh) with the triangles of a file or, where it has tetrahedra, with these. \throws InputError
template <class Use>
int withMesh(const MeshSource& source, const Use& use) {
  std::optional<TetrahedronMesh> space;
  try {
    return use(readMesh(source));
  } catch (const InputError& inPlane) {
    const auto says = [](const InputError& error, const char* words) {
      return std::string(error.what()).find(words) != std::string::npos;
    };
    try {
      space = readSpaceMesh(source);
    } catch (const InputError& inSpace) {
      if (says(inPlane, "dimension = 3") && !says(inSpace, "no tetrahedra")) throw;
    }
    if (!space) throw;
  }
  return use(*space);
}

int convertMesh(const MeshSource& source, const std::string& file) {
  return withMesh(source, [&](const auto& mesh) {
    writeMedit(mesh, file);
    std::printf("%s: %s\n", file.c_str(), sizeOf(mesh).c_str());
    return exitDone;
  });
}

void printRegions(const std::vector<int>& regions, const std::map<std::string, int>& names,
                  const char* element) {
  std::map<int, int> counts;
  for (const int region : regions) ++counts[region];
  for (const auto& [region, count] : counts)
    std::printf("region %-4d %s%s\n", region, counted(count, element).c_str(), named(names, region).c_str());
}

/// "x 0 .. 2, y 1", a coordinate that does not vary alone.
template <int components>
std::string extentsOf(const Eigen::AlignedBox<double, components>& box, double size) {
  constexpr double rounding = 1e-12;  // of the mesh
  std::string text;
  for (int c = 0; c < components; ++c) {
    const auto digitsOf = [&](double value) {
      return digits(std::abs(value) <= rounding * size ? 0 : value, 9);
    };
    text += std::string(c == 0 ? "" : ", ") + "xyz"[c] + " " + digitsOf(box.min()[c]);
    if (box.sizes()[c] > rounding * size) text += " .. " + digitsOf(box.max()[c]);
  }
  return text;
}

int describeMesh(const std::string& file, const TetrahedronMesh& mesh) {
  const auto box = boxOf(mesh.vertices);
  const double size = box.diagonal().norm();
  double volume = 0;
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    const auto side = [&, from = a](int to) { return SpacePoint(mesh.vertices[to] - mesh.vertices[from]); };
    volume += side(b).cross(side(c)).dot(side(d)) / 6;
  }
  std::printf("%s\nvertices   %zu\ntetrahedra %zu\nvolume     %.9g\nextents    %s\n", file.c_str(),
              mesh.vertices.size(), mesh.tetrahedra.size(), volume, extentsOf(box, size).c_str());
  for (const int label : boundaryLabels(mesh)) {
    double area = 0;
    Eigen::AlignedBox<double, 3> around;
    const auto triangles = trianglesOn(mesh, label);
    for (const auto& triangle : triangles) {
      const auto& [a, b, c] = triangle;
      area += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm() / 2;
      for (const int vertex : triangle) around.extend(mesh.vertices[vertex]);
    }
    std::printf("label %-5d %s, area %.9g%s: %s\n", label, counted(triangles.size(), "triangle").c_str(),
                area, named(mesh.labelNames, label).c_str(), extentsOf(around, size).c_str());
  }
  printRegions(mesh.regions, mesh.regionNames, "tetrahedron");
  return exitDone;
}

int describeMesh(const std::string& file, const TriangleMesh& mesh) {
  const auto box = boxOf(mesh.vertices);
  const double size = box.diagonal().norm();
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
  std::printf("%s\nvertices   %zu\ntriangles  %zu\narea       %.9g\nextents    %s\n", file.c_str(),
              mesh.vertices.size(), mesh.triangles.size(), area, extentsOf(box, size).c_str());
  std::printf("worst aspect ratio %.3g (triangle %d; 1 is equilateral)\n", worst, worstTriangle + 1);

  struct Side {
    size_t edges = 0;
    double length = 0;
    Eigen::AlignedBox<double, 2> around;
  };
  std::map<int, Side> sides;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    const auto [a, b] = mesh.boundaryEdges[e];
    Side& side = sides[mesh.boundaryLabels[e]];
    ++side.edges;
    side.length += (mesh.vertices[b] - mesh.vertices[a]).norm();
    side.around.extend(mesh.vertices[a]).extend(mesh.vertices[b]);
  }
  for (const auto& [label, side] : sides)
    std::printf("label %-5d %s, length %.9g%s: %s\n", label, counted(side.edges, "edge").c_str(), side.length,
                named(mesh.labelNames, label).c_str(), extentsOf(side.around, size).c_str());
  printRegions(mesh.regions, mesh.regionNames, "triangle");
  return exitDone;
}

int meshInfo(const std::string& file) {
  return withMesh({file}, [&](const auto& mesh) { return describeMesh(file, mesh); });
}

/// A family's subcommand with what all of them have.
CLI::App* addFamily(CLI::App& mesh, MeshOptions& command, const std::string& name, const std::string& what,
                    const std::string& cellsHelp, const std::string& labels) {
  CLI::App* family = mesh.add_subcommand(name, what);
  family->add_option("--cells", command.cells, cellsHelp)->required()->type_name("N[,N2]");
  if (name != "crisscross")
    family->add_option("--cut", command.cut,
                       std::string("diagonals of the cells: rising, falling, both (default ") +
                           (name == "annulus" || name.ends_with("disc") ? "both)" : "rising)"));
  family->add_option("FILE", command.file, "Medit .mesh file to write")->required();
  family->footer("Boundary labels: " + labels + ".");
  family->callback([&command, name] { command.family = name; });
  return family;
}

}  // namespace

Command addMesh(CLI::App& app) {
  const auto command = std::make_shared<MeshOptions>();
  CLI::App& mesh = *app.add_subcommand("mesh", "make a mesh, or describe one");
  mesh.require_subcommand(1);

  const std::string sides = "1 bottom, 2 right, 3 top, 4 left";
  for (const auto& [name, what] : {std::pair("rectangle", "rectangle, each cell cut by one diagonal"),
                                   std::pair("crisscross", "rectangle, each cell cut by both diagonals")}) {
    CLI::App* each = addFamily(mesh, *command, name, what, "cells along x and y", sides);
    each->add_option("--lower", command->lower, "lower left corner [m] (default 0,0)")->type_name("X,Y");
    each->add_option("--upper", command->upper, "upper right corner [m] (default 1,1)")->type_name("X,Y");
    each->add_option("--focus", command->focus, "point towards which cells shrink")->type_name("X,Y");
    each->add_option("--grading", command->grading, "size of the farthest cells over the nearest (default 1)")
        ->type_name("R[,RY]");
  }
  CLI::App* quadrilateral =
      addFamily(mesh, *command, "quadrilateral", "convex quadrilateral, e.g. Cook's membrane",
                "cells along the first and second side", "1, 2, 3, 4: side k from corner k to the next");
  quadrilateral->add_option("--corners", command->corners, "four corners, counterclockwise")
      ->required()
      ->expected(4)
      ->type_name("X,Y");
  CLI::App* annulus =
      addFamily(mesh, *command, "annulus", "ring or a sector of it, radii in geometric progression",
                "cells around (in all) and across",
                "1 inner circle, 2 outer circle, 3 and 4 first and last side of a sector");
  annulus->add_option("--centre", command->centre, "centre [m] (default 0,0)")->type_name("X,Y");
  annulus->add_option("--inner", command->inner, "inner radius [m] (default 1)");
  annulus->add_option("--outer", command->outer, "outer radius [m] (default 2)");
  annulus->add_option("--span", command->span, "quarter, half or full (default), from the x axis");
  for (const auto& [name, what, more] :
       {std::tuple("halfdisc", "lower half of a disc, fine around its lowest point", ""),
        std::tuple("quarterdisc", "right half of that, the section of a sphere", ", 4 vertical side")}) {
    CLI::App* disc = addFamily(
        mesh, *command, name, what, "cells on half the width of the fine core",
        std::string("1 arc within 45 degrees of the lowest point, 2 flat side, 3 rest of the arc") + more);
    disc->add_option("--lowest", command->lowest, "lowest point [m] (default 0,0)")->type_name("X,Y");
    disc->add_option("--radius", command->radius, "radius [m] (default 1)");
    disc->add_option("--core", command->core, "half width of the core [m] (default 0.1)");
  }

  const auto file = std::make_shared<std::string>();
  CLI::App* info = mesh.add_subcommand("info", "counts, labels, extents, worst triangle");
  info->add_option("FILE", *file, "mesh or geometry of any kind that is read")->required();

  const auto source = std::make_shared<MeshSource>();
  CLI::App* convert =
      mesh.add_subcommand("convert", "any mesh or geometry that a scene can name, as a Medit .mesh file");
  convert->add_option("FROM", source->path, "mesh or geometry of any kind that is read (docs/scene.md)")
      ->required();
  convert->add_option("TO", *file, "Medit .mesh file to write")->required();
  convert->add_option("--region", source->regions, "regions to keep, by name or number");
  convert->add_option("--size", source->size, "longest edge of a geometry that is meshed [m]")
      ->check(CLI::PositiveNumber);
  return {&mesh, [=] {
            return info->parsed()      ? meshInfo(*file)
                   : convert->parsed() ? convertMesh(*source, *file)
                                       : makeMesh(*command);
          }};
}

}  // namespace mortier
