// A folder that a test fills as a run does.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "report/manifest.h"

namespace mortier {

namespace fs = std::filesystem;

inline std::string contentOf(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

class Folder : public testing::Test {
 protected:
  Folder() : path(testing::TempDir() + "report_test_" + std::to_string(getpid())) {
    fs::create_directories(path);
  }
  ~Folder() override { fs::remove_all(path); }

  void put(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(path + "/" + name).parent_path());
    std::ofstream(path + "/" + name) << text;
  }
  /// Writes files into a folder as a run does.
  using Texts = std::map<std::string, std::string>;
  static Manifest fill(const std::string& folder, const Texts& texts) {
    Manifest manifest;
    for (const auto& [name, text] : texts)
      manifest.files[name] = (OutputFile(folder + "/" + name) << text).close();
    return manifest;
  }
  /// A result that was complete.
  void result(const std::string& name, const Texts& texts) const {
    fs::create_directories(path + "/" + name);
    writeManifest(path + "/" + name, fill(path + "/" + name, texts));
  }
  /// Names in the folder, so that nothing temporary is left behind.
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(path)) {
      found.insert(entry.path().filename().string());
    }
    return found;
  }

  std::string path;
};

using Output = Folder;

}  // namespace mortier
