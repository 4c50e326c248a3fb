// A scene as it was when it was read: file, settings and meshes.
#pragma once

#include <string>
#include <vector>

#include "scene/resolve.h"

namespace mortier::python {

struct Scene {
  std::string path;
  std::vector<std::string> settings;  ///< key=value
  std::string text;                   ///< of the file
  ResolvedScene resolved;
  /// \throws InputError
  Scene(std::string path, std::vector<std::string> settings);
};

}  // namespace mortier::python
