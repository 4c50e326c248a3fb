#include "commands/mesh_options.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "commands/mesh.h"

namespace mortier {

namespace {

/// A family's subcommand with what all of them have.
CLI::App* addFamily(CLI::App& mesh, MeshCommand& command, const std::string& name, const std::string& what,
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

std::function<int()> addMeshCommand(CLI::App& app) {
  const auto command = std::make_shared<MeshCommand>();
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
  info->add_option("FILE", *file, "Medit .mesh file")->required();

  auto conversion = std::make_shared<ConvertCommand>();
  CLI::App* convert =
      mesh.add_subcommand("convert", "any mesh or geometry that a scene can name, as a Medit .mesh file");
  convert->add_option("FROM", conversion->source.path, "Medit .mesh file, or a file for Gmsh")->required();
  convert->add_option("TO", conversion->file, "Medit .mesh file to write")->required();
  convert->add_option("--region", conversion->source.regions, "regions to keep, by name or number");
  convert->add_option("--size", conversion->source.size, "longest edge of a geometry that is meshed [m]")
      ->check(CLI::PositiveNumber);
  return [=] {
    return info->parsed()      ? meshInfo(*file)
           : convert->parsed() ? convertMesh(*conversion)
                               : makeMesh(*command);
  };
}

}  // namespace mortier
