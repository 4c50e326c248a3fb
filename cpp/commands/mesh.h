#pragma once

#include <string>

namespace mortier {

/// `mortier mesh rectangle|crisscross`: a labelled mesh of a rectangle.
struct MeshCommand {
  std::string cells = "1";    ///< N or NX,NY
  std::string lower = "0,0";  ///< lower left corner [m]
  std::string upper = "1,1";  ///< upper right corner [m]
  std::string file;
  bool crissCross = false;
};

/// \throws InputError, OutputError
int makeMesh(const MeshCommand& command);

/// `mortier mesh info`: counts, labels with their lengths, extents, worst triangle. \throws InputError
int meshInfo(const std::string& file);

}  // namespace mortier
