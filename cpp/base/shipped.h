// What comes with the program: scripts and methods in folders of their own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mortier {

/// The folder `name` that comes with the program and holds `file`: in one of `starts`, the program's folder
/// or any folder above them, there also under share/mortier; else in the sources that the program was built
/// from.
std::optional<std::filesystem::path> shippedFolder(const std::string& name, const std::string& file,
                                                   const std::vector<std::filesystem::path>& starts = {});

/// The Python that runs its scripts.
std::string pythonProgram();

}  // namespace mortier
