// manifest.json: the record of what a run wrote into its result, by name, with sizes and checksums. It is
// written last, as a whole: a folder with a manifest is a complete result. What it does not list, or what
// differs, is not the program's.
#pragma once

#include <concepts>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/checksum.h"

namespace mortier {

struct FileRecord {
  uint64_t bytes = 0;
  uint64_t checksum = 0;  ///< FNV-1a
};

struct Manifest {
  bool failed = false;  ///< the run stopped at a step that cannot be solved
  std::map<std::string, FileRecord> files;
};

constexpr const char* manifestName = "manifest.json";
constexpr const char* checkpointName = "checkpoint";
constexpr const char* previousCheckpointName = "checkpoint.previous";
/// Ends the name of a file's copy that is kept while another result is tried.
constexpr const char* keptSuffix = ".kept";

/// \throws OutputError
void writeManifest(const std::string& folder, const Manifest& manifest);

/// The manifest of a folder; none where there is none that this program wrote. \throws OutputError  it cannot
/// be read.
std::optional<Manifest> readManifest(const std::string& folder);

/// Whether the first `bytes` of a file are those of its record. A longer one does not match if it is to be
/// `whole`.
/// \throws OutputError, std::filesystem::filesystem_error  it cannot be read.
bool matches(const std::string& path, const FileRecord& record, bool whole = true);

/// Whether all of its files are as they were written.
bool isSound(const std::string& folder, const Manifest& manifest);

/// \throws std::filesystem::filesystem_error  nobody can say.
inline bool hasCheckpoint(const std::string& folder) {
  return std::filesystem::is_regular_file(folder + "/" + checkpointName) ||
         std::filesystem::is_regular_file(folder + "/" + previousCheckpointName);
}

/// Names that a run gives to its files; those that no result keeps are the lock, checkpoints, files under
/// way and copies.
bool isResultName(const std::string& name);
bool isWorkName(const std::string& name);

// A text or binary file that is either complete or an error: buffered, every write checked, no number that is
// not finite.

class OutputFile {
 public:
  /// \throws OutputError when the file cannot be created.
  explicit OutputFile(std::string path);
  /// Goes on after what `keep` records of a file that is there. \throws OutputError
  OutputFile(std::string path, const FileRecord& keep);

  OutputFile& operator<<(std::string_view text);
  OutputFile& operator<<(char c) { return *this << std::string_view(&c, 1); }
  /// The shortest decimal that reads back the same. \throws OutputError when it is not finite.
  OutputFile& operator<<(double value);
  OutputFile& operator<<(std::integral auto value) {
    return *this << std::string_view(std::to_string(value));
  }

  /// Brings everything to the disk. \returns what is written so far. \throws OutputError
  FileRecord sync();
  /// \returns what was written. \throws OutputError when anything could not be (a full disk shows here).
  FileRecord close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void require(bool done) const;
  void put(std::string_view text);
  void flush();

  std::string path_;
  std::string buffer_;  ///< not yet written
  uint64_t written_ = 0;
  Checksum sum_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace mortier
