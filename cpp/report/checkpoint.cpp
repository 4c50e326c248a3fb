#include "report/checkpoint.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "base/archive.h"
#include "base/checksum.h"
#include "base/error.h"
#include "base/sealed_file.h"
#include "base/whole_file.h"
#include "report/checkpoint_members.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

/// Names the layout (checkpoint_members.h) and what a scene means; it changes with any member.
constexpr const char* magic = "mortier checkpoint 17";

template <class... Lists>
uint64_t hashOfLists(const Lists&... lists) {
  Checksum sum;
  (sum.add({reinterpret_cast<const char*>(lists.data()), lists.size() * sizeof(lists[0])}), ...);
  return sum.value;
}

Checkpoint decode(const std::string& path) {
  const std::string content = readSealed(path, magic);
  ArchiveReader reader(content);
  Checkpoint checkpoint;
  reader(checkpoint);
  if (!reader.bytes.empty()) throw InputError("damaged");
  return checkpoint;
}

/// Those of a run: names in a checkpoint are data of others.
void requireNames(const FilesSoFar& files) {
  for (const KeptFields& kept : files.fields)
    for (const auto& [name, record] : kept.files)
      if (!isResultName(name)) throw InputError("it lists " + name + ", which no run writes");
}

/// \param whole  false: a file that has grown since
void requireFile(const std::string& folder, const std::string& name, const FileRecord& record, bool whole) {
  const std::string path = std::string(folder).append("/").append(name);
  if (matches(path, record, whole)) return;
  const bool isThere = fs::exists(path);
  const bool isShorter = isThere && fs::file_size(path) < record.bytes;
  throw InputError("its " + name +
                   (isShorter ? " is shorter than it was"
                    : isThere ? " is damaged"
                              : " is gone"));
}

}  // namespace

uint64_t hashOf(const TetrahedronMesh& mesh) {
  return hashOfLists(mesh.vertices, mesh.tetrahedra, mesh.regions, mesh.boundaryTriangles,
                     mesh.boundaryLabels, mesh.boundaryNormals);
}

uint64_t hashOf(const TriangleMesh& mesh) {
  return hashOfLists(mesh.vertices, mesh.triangles, mesh.regions, mesh.boundaryEdges, mesh.boundaryLabels);
}

void writeCheckpoint(const std::string& folder, const Checkpoint& checkpoint) {
  ArchiveWriter writer;
  writer(const_cast<Checkpoint&>(checkpoint));  // one list of members serves reading and writing
  const std::string path = folder + "/" + checkpointName;
  std::error_code none;
  fs::rename(path, folder + "/" + previousCheckpointName, none);
  writeWhole(path, sealed(magic, writer.bytes), true);
}

Checkpoint readCheckpoint(const std::string& folder) {
  std::string fault;
  for (const char* name : {checkpointName, previousCheckpointName}) {
    const std::string path = folder + "/" + name;
    if (!fs::is_regular_file(path)) continue;
    try {
      Checkpoint checkpoint = decode(path);
      requireNames(checkpoint.empty);
      requireNames(checkpoint.files);
      requireFile(folder, "history.csv", checkpoint.files.history, false);
      requireFile(folder, "contact.csv", checkpoint.files.contact, false);
      for (const KeptFields& kept : checkpoint.files.fields)
        for (const auto& [file, record] : kept.files) requireFile(folder, file, record, true);
      return checkpoint;
    } catch (const std::exception& error) {
      fault += (fault.empty() ? "" : "; ") + path + ": " + error.what();
    }
  }
  throw InputError((fault.empty() ? folder + ": no checkpoint" : fault) +
                   ", expected a checkpoint that this program wrote");
}

void requireSame(const RunIdentity& stored, const RunIdentity& given, const std::string& folder) {
  const auto reject = [&](const std::string& what) {
    throw InputError(given.scene + ": " + what + ", expected what the checkpoint in " + folder +
                     " was made with");
  };
  const auto listed = [](const std::vector<std::string>& settings) {
    std::string text;
    for (const std::string& each : settings) text += " " + each;
    return text.empty() ? " nothing" : text;
  };
  if (stored.text != given.text) {
    const auto [a, b] =
        std::mismatch(given.text.begin(), given.text.end(), stored.text.begin(), stored.text.end());
    reject("line " + std::to_string(1 + std::count(given.text.begin(), a, '\n')) + " has changed");
  }
  if (stored.settings != given.settings)
    reject("--set" + listed(given.settings) + " (was" + listed(stored.settings) + ")");
  for (size_t i = 0; i < given.fileHashes.size(); ++i)
    if (i >= stored.fileHashes.size() || stored.fileHashes[i] != given.fileHashes[i])
      reject(given.files[i] + " has changed");
}

}  // namespace mortier
