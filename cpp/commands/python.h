#pragma once

#include <string>
#include <vector>

namespace mortier {

/// This process becomes the Python program `folder`/__main__.py that comes with mortier, with these words;
/// MORTIER in its environment is this program. Does not return. \throws OutputError when Python or the
/// program cannot be found
[[noreturn]] void becomePython(const std::string& folder, const std::vector<std::string>& words);

}  // namespace mortier
