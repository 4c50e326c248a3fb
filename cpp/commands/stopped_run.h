// `mortier run --restart DIR`: the stopped run that goes on.
#pragma once

#include <optional>
#include <string>

#include "commands/run.h"
#include "report/checkpoint.h"
#include "report/output_folder.h"
#include "scene/scene.h"

namespace mortier {

struct StoppedRun {
  std::string folder;  ///< its temporary folder
  FolderLock lock;
  Checkpoint checkpoint;
};

/// The latest stopped run whose result was to be `path`; none when the run was complete: its result has been
/// put in place.
/// \throws InputError when there is none that can go on.
std::optional<StoppedRun> findStoppedRun(const std::string& path);

/// Goes to the folder in which the run was begun, and asks for what it was asked for.
void askAgain(const RunIdentity& stored, RunCommand& command);

/// With the hashes of meshes and of files of temperatures.
RunIdentity identityOf(const SceneDescription& scene, const Model& model);

}  // namespace mortier
