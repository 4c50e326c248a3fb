#include "commands/stopped_run.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "base/checksum.h"
#include "base/error.h"

namespace mortier {

namespace fs = std::filesystem;

std::optional<StoppedRun> findStoppedRun(const std::string& path) {
  try {
    const ResultPlace place(path);
    const PlaceLock alone(place.parent().string());
    const LeftBehind left = clearUp(place);
    if (!left.stopped.empty()) {
      const std::string folder = left.stopped.front().string();
      FolderLock lock(folder);
      if (!lock.held()) throw OutputError(place.shown(folder) + ": cannot be locked");
      return StoppedRun{folder, std::move(lock), readCheckpoint(folder)};
    }
    if (left.placed == place.of(true))
      throw OutputError(place.shown(left.placed) + ": the run had stopped at a step that cannot be solved");
    if (!left.placed.empty()) return {};
  } catch (const fs::filesystem_error& error) {
    throw OutputError(path + ": " + error.code().message());
  }
  throw InputError(path + ": no stopped run, expected a folder " + path + ".tmp-... with a checkpoint in it");
}

void askAgain(const RunIdentity& stored, RunCommand& command) {
  std::error_code error;
  command.restart = fs::absolute(command.restart).string();
  fs::current_path(stored.workingFolder, error);
  if (error) {
    throw InputError(command.restart + ": begun in " + stored.workingFolder +
                     ", which is not there, expected SCENE.toml and its --set as well");
  }
  command.scene = stored.scene;
  command.settings = stored.settings;
}

RunIdentity identityOf(const SceneDescription& scene, const Model& model) {
  RunIdentity identity;
  identity.workingFolder = fs::current_path().string();
  identity.scene = scene.path;
  identity.settings = scene.settings;
  identity.text = scene.text;
  for (const Body& body : model.bodies) {
    identity.files.push_back("the mesh " + body.mesh().name);
    identity.fileHashes.push_back(hashOf(body.mesh()));
  }
  for (const BodyDescription& body : scene.bodies) {
    if (!body.temperature || body.temperature->file.empty()) continue;
    std::ifstream file(body.temperature->file, std::ios::binary);
    Checksum checksum;
    checksum.add(std::string(std::istreambuf_iterator<char>(file), {}));
    identity.files.push_back("the file " + body.temperature->file);
    identity.fileHashes.push_back(checksum.value);
  }
  return identity;
}

}  // namespace mortier
