#pragma once

#include <string>
#include <vector>

#include "mesh/read.h"

namespace mortier {

/// `mortier mesh FAMILY`: a labelled mesh of a simple shape (mesh/generate.h), options as given.
struct MeshCommand {
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

/// \throws InputError, OutputError
int makeMesh(const MeshCommand& command);

/// `mortier mesh convert`: any mesh that a scene can name as a Medit file, with the names of its labels.
struct ConvertCommand {
  MeshSource source;
  std::string file;
};

/// \throws InputError, OutputError
int convertMesh(const ConvertCommand& command);

/// `mortier mesh info`: counts, labels with their lengths, extents, worst triangle. \throws InputError
int meshInfo(const std::string& file);

}  // namespace mortier
