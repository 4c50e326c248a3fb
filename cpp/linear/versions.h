// Which libraries of linear algebra the program runs with.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace mortier {

/// Name and version of each; of those linked at run time as they report it.
std::vector<std::pair<std::string, std::string>> linearLibraries();

}  // namespace mortier
