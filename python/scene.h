// A scene as it was when it was read: file, settings and meshes.
#pragma once

#include <string>
#include <vector>

#include "scene/resolve.h"

namespace mortier::python {

struct Scene {
  ResolvedScene resolved;
  /// \throws InputError
  Scene(const std::string& path, const std::vector<std::string>& settings)
      : resolved(resolveScene(readScene(path, settings))) {}
};

}  // namespace mortier::python
