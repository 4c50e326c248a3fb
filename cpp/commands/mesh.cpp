// `mortier mesh`: makes labelled meshes of the shapes of scenes, converts and describes meshes.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "base/digits.h"
#include "base/error.h"
#include "base/printable.h"
#include "commands/command_line.h"
#include "mesh/boundary_line.h"
#include "mesh/box_of.h"
#include "mesh/read.h"
#include "mesh/regions.h"
#include "mesh/simplices.h"
#include "scene/readers.h"

namespace mortier {

namespace {

struct Family {
  const char *name, *what, *cells, *labels;
};
constexpr std::array<Family, 6> families{
    {{"rectangle", "rectangle, each cell cut by one diagonal", "cells along x and y",
      "1 bottom, 2 right, 3 top, 4 left"},
     {"crisscross", "rectangle, each cell cut by both diagonals", "cells along x and y",
      "1 bottom, 2 right, 3 top, 4 left"},
     {"quadrilateral", "convex quadrilateral, e.g. Cook's membrane", "cells along the first and second side",
      "1, 2, 3, 4: side k from corner k to the next"},
     {"annulus", "ring or a sector of it, radii in geometric progression", "cells around (in all) and across",
      "1 inner circle, 2 outer circle, 3 and 4 first and last side of a sector"},
     {"halfdisc", "lower half of a disc, fine around its lowest point",
      "cells on half the width of the fine core",
      "1 arc within 45 degrees of the lowest point, 2 flat side, 3 rest of the arc"},
     {"quarterdisc", "right half of that, the section of a sphere",
      "cells on half the width of the fine core",
      "1 arc within 45 degrees of the lowest point, 2 flat side, 3 rest of the arc, 4 vertical side"}}};

/// A mesh to make.
struct MeshOptions {
  const Family* family = nullptr;
  std::map<std::string, Keys> values;  ///< as given, by keys of [body.mesh]
  std::string file;
};

/// The keys of shapes that are options of their families.
struct FamilyOption {
  const char *key, *type, *help;
  int values = 1;
};
constexpr std::array<FamilyOption, 12> familyOptions{
    {{"lower", "X,Y", "lower left corner [m] (default 0,0)"},
     {"upper", "X,Y", "upper right corner [m] (default 1,1)"},
     {"focus", "X,Y", "point towards which cells shrink"},
     {"grading", "R[,RY]", "size of the farthest cells over the nearest (default 1)"},
     {"corners", "X,Y", "four corners, counterclockwise", 4},
     {"centre", "X,Y", "centre [m] (default 0,0)"},
     {"inner", "FLOAT", "inner radius [m] (default 1)"},
     {"outer", "FLOAT", "outer radius [m] (default 2)"},
     {"span", "TEXT", "quarter, half or full (default), from the x axis"},
     {"lowest", "X,Y", "lowest point [m] (default 0,0)"},
     {"radius", "FLOAT", "radius [m] (default 1)"},
     {"core", "FLOAT", "half width of the core [m] (default 0.1)"}}};

/// The word of the key `shape`.
std::string shapeOf(const std::string& family) {
  return family == "crisscross" ? "rectangle" : family;
}

/// "6" as a number, "0,-1" as an array, other texts as strings. \param parts  one such text, or several
Node valueOf(const Keys& parts, const std::string& where) {
  Node value;
  value.where = where;
  if (parts.size() != 1) {
    value.kind = Node::Kind::array;
    for (const std::string& part : parts) value.elements.push_back(valueOf(split(part, ','), where));
    return value;
  }
  value.text = parts.front();
  const char* const last = value.text.data() + value.text.size();
  const auto [stop, status] = std::from_chars(value.text.data(), last, value.value);
  value.kind = status == std::errc() && stop == last ? Node::Kind::number : Node::Kind::string;
  return value;
}

/// By the table of a scene that has the options as its keys.
TriangleMesh make(const MeshOptions& command) {
  const std::string family = command.family->name;
  Node table;
  table.where = "mortier mesh " + family;
  const auto add = [&](const std::string& key, const Keys& texts) {
    const std::string where = "--" + key + " " + printable(joined(texts, " "));
    table.members.push_back(valueOf(texts.size() != 1 ? texts : split(texts.front(), ','), where));
    table.members.back().key = key;
  };
  add("shape", {shapeOf(family)});
  if (family == "crisscross") add("cut", {"both"});
  for (const auto& [key, texts] : command.values) add(key, texts);
  return shapeMesh(readShape(TableReader(table, "body.mesh", "")));
}

template <class Mesh>
std::string sizeOf(const Mesh& mesh) {
  return counted(mesh.vertices.size(), "vertex") + ", " + counted(elementsOf(mesh).size(), elementWord<Mesh>);
}

/// ", name" of a label that has one.
std::string named(const std::map<std::string, int>& names, int label) {
  for (const auto& [name, number] : names)
    if (number == label) return ", " + printable(name);
  return "";
}

int makeMesh(const MeshOptions& command) {
  const TriangleMesh mesh = make(command);
  writeMedit(mesh, command.file);
  std::printf("%s: %s; labels %s\n", command.file.c_str(), sizeOf(mesh).c_str(), command.family->labels);
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

/// A line for each label of which the whole mesh has no side.
template <class Mesh>
void printLabelsWithin(const Mesh& mesh) {
  const std::set<int> known = knownNumbers(mesh.boundaryLabels, mesh.sharedLabels);
  for (const auto& [name, label] : mesh.labelNames)
    if (!known.contains(label) && !mesh.sharedLabels.contains(label))
      std::printf(
          "label %-5d not on the boundary, %s: sides of single regions (convert --region, region in a "
          "scene)\n",
          label, printable(name).c_str());
}

int convertMesh(const MeshSource& source, const std::string& file) {
  return withMesh(source, [&](const auto& mesh) {
    writeMedit(mesh, file);
    std::printf("%s: %s\n", file.c_str(), sizeOf(mesh).c_str());
    printLabelsWithin(mesh);
    return exitDone;
  });
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

/// An area, or a volume.
double contentOf(const TriangleMesh& mesh, int t) {
  return doubleArea(mesh, t) / 2;
}
double contentOf(const TetrahedronMesh& mesh, int t) {
  return volume(mesh, mesh.tetrahedra[t]);
}
double contentOf(const TriangleMesh& mesh, const std::array<int, 2>& edge) {
  return (mesh.vertices[edge[1]] - mesh.vertices[edge[0]]).norm();
}
double contentOf(const TetrahedronMesh& mesh, const std::array<int, 3>& triangle) {
  const SpacePoint& a = mesh.vertices[triangle[0]];
  return (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).norm() / 2;
}

template <class Mesh>
int describeMesh(const std::string& file, const Mesh& mesh) {
  constexpr bool inSpace = ofTetrahedra<Mesh>;
  const auto box = boxOf(mesh.vertices);
  const double size = box.diagonal().norm();
  double content = 0;
  double worst = 0;
  int worstElement = 0;
  for (int t = 0; t < static_cast<int>(elementsOf(mesh).size()); ++t) {
    content += contentOf(mesh, t);
    if (const double ratio = aspectRatio(mesh, t); ratio > worst) {
      worst = ratio;
      worstElement = t;
    }
  }
  std::printf("%s\nvertices   %zu\n%-10s %zu\n%-10s %.9g\nextents    %s\n", file.c_str(),
              mesh.vertices.size(), elementsWord<Mesh>, elementsOf(mesh).size(), inSpace ? "volume" : "area",
              content, extentsOf(box, size).c_str());
  std::printf("worst aspect ratio %.3g (%s %d; 1 is %s)\n", worst, elementWord<Mesh>, worstElement + 1,
              inSpace ? "regular" : "equilateral");

  struct Side {
    size_t count = 0;
    double content = 0;
    std::decay_t<decltype(box)> around;
  };
  std::map<int, Side> sides;
  for (size_t i = 0; i < labelledSides(mesh).size(); ++i) {
    const auto& vertices = labelledSides(mesh)[i];
    Side& side = sides[mesh.boundaryLabels[i]];
    ++side.count;
    side.content += contentOf(mesh, vertices);
    for (const int v : vertices) side.around.extend(mesh.vertices[v]);
  }
  for (const auto& [label, side] : sides)
    std::printf("label %-5d %s, %s %.9g%s: %s\n", label, counted(side.count, sideWord<Mesh>).c_str(),
                inSpace ? "area" : "length", side.content, named(mesh.labelNames, label).c_str(),
                extentsOf(side.around, size).c_str());
  printLabelsWithin(mesh);
  std::map<int, int> regions;
  for (const int region : mesh.regions) ++regions[region];
  for (const auto& [region, count] : regions)
    std::printf("region %-4d %s%s\n", region, counted(count, elementWord<Mesh>).c_str(),
                named(mesh.regionNames, region).c_str());
  return exitDone;
}

int meshInfo(const std::string& file) {
  return withMesh({file}, [&](const auto& mesh) { return describeMesh(file, mesh); });
}

}  // namespace

Command addMesh(CLI::App& app) {
  const auto command = std::make_shared<MeshOptions>();
  CLI::App& mesh = *app.add_subcommand("mesh", "make a mesh, or describe one");
  mesh.require_subcommand(1);

  for (const Family& each : families) {
    CLI::App* family = mesh.add_subcommand(each.name, each.what);
    const auto add = [&](const std::string& key, const char* type, const char* help, int values = 1) {
      const auto keep = [command, key](const Keys& texts) { command->values[key] = texts; };
      return family->add_option_function<Keys>("--" + key, keep, help)->type_name(type)->expected(values);
    };
    add("cells", "N[,N2]", each.cells)->required();
    if (each.name != std::string("crisscross"))
      add("cut", "TEXT",
          "diagonals of the cells: rising, falling, both (default rising, both of rings and discs)");
    for (const auto& [key, type, help, values] : familyOptions)
      if (isOneOf(shapeOf(each.name), keyAt("body.mesh", key).besideWords))
        add(key, type, help, values)->required(values > 1);
    family->add_option("FILE", command->file, "Medit .mesh file to write")->required();
    family->footer(std::string("Boundary labels: ") + each.labels + ".");
    family->callback([command, &each] { command->family = &each; });
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
