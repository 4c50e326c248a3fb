#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace mortier {

/// Adds `mesh` with its families and `mesh info` to the program. \returns what does it, once the command line
/// is parsed.
std::function<int()> addMeshCommand(CLI::App& app);

}  // namespace mortier
