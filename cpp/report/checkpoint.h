// Checkpoints: all data that a run needs to resume as if it had not stopped, in one binary file. A file is
// written as a whole or not at all, the one before it is kept, and a checksum detects damage.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "report/accuracy.h"
#include "report/result_files.h"
#include "time/march.h"

namespace mortier {

/// What the run was asked for. It resumes only with the same scene, settings and files.
struct RunIdentity {
  std::string workingFolder;          ///< in which paths were meant
  std::string scene;                  ///< path, as given
  std::string text;                   ///< of the scene
  std::vector<std::string> settings;  ///< --set, as given
  std::vector<std::string> files;     ///< meshes and nodal temperatures: "the mesh PATH"
  std::vector<uint64_t> fileHashes;
};

struct Checkpoint {
  RunIdentity identity;
  FilesSoFar empty;  ///< before the first step
  FilesSoFar files;
  StepReport last;
  State state;
  MarchMemory memory;
  AccuracyMemory accuracy;
};

/// FNV-1a of all that a mesh holds.
uint64_t hashOf(const TriangleMesh& mesh);
uint64_t hashOf(const TetrahedronMesh& mesh);

/// Makes `checkpoint` the latest in `folder` and keeps the one before it. \throws OutputError
void writeCheckpoint(const std::string& folder, const Checkpoint& checkpoint);

/// The latest checkpoint in `folder` that is sound, and whose files are there. \throws InputError
Checkpoint readCheckpoint(const std::string& folder);

/// \throws InputError `folder` holds a checkpoint of another scene: what differs.
void requireSame(const RunIdentity& stored, const RunIdentity& given, const std::string& folder);

/// \param quantities  how many there are
/// \throws InputError  the state or the memory is not one of this model: what is wrong with it.
void requireFits(const Checkpoint& checkpoint, const Model& model, const std::string& folder,
                 size_t quantities = 0);

}  // namespace mortier
