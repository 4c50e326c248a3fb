// Which libraries read scenes.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace mortier {

/// Name and version of each.
std::vector<std::pair<std::string, std::string>> sceneLibraries();

}  // namespace mortier
