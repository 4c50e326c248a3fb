#include "scene/versions.h"

#define TOML_HEADER_ONLY 0
#include <toml++/impl/version.h>

namespace mortier {

std::vector<std::pair<std::string, std::string>> sceneLibraries() {
  return {{"toml++", std::to_string(TOML_LIB_MAJOR) + "." + std::to_string(TOML_LIB_MINOR) + "." +
                         std::to_string(TOML_LIB_PATCH)}};
}

}  // namespace mortier
