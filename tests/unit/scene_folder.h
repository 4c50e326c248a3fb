// What tests that read scenes share: a folder of their own, and two blocks in contact.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "mesh/read.h"
#include "scene/build.h"

namespace mortier {

/// The end of a scene of two blocks, for two seconds; the number of steps is to follow.
constexpr const char* contactOfTwoBlocks = R"toml([contact]
nonmortar = { body = "upper", label = 1 }
mortar = { body = "lower", label = 3 }
[time]
end = 2
)toml";

/// A folder for a scene and its meshes, removed after each test.
class SceneFolder : public testing::Test {
 protected:
  explicit SceneFolder(const std::string& name)
      : folder(testing::TempDir() + name + "_" + std::to_string(getpid())) {
    std::filesystem::create_directories(folder);
  }
  ~SceneFolder() override { std::filesystem::remove_all(folder); }

  void write(const std::string& text) const { std::ofstream(path(), std::ios::binary) << text; }
  [[nodiscard]] std::string path() const { return folder + "/scene.toml"; }

  static Model modelOf(const SceneDescription& scene) {
    ResolvedScene resolved = resolveScene(scene);
    return buildModel(resolved);
  }

  std::string folder;
};

}  // namespace mortier
