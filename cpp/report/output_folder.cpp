#include "report/output_folder.h"

#include <filesystem>
#include <utility>

#include "base/error.h"
#include "report/checkpoint_files.h"
#include "report/output_file.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

/// A new folder that is locked before it has the name by which others look for it.
std::pair<std::string, FolderLock> newFolder(const ResultPlace& place) {
  const fs::path fresh = place.unused(".mortier-");
  const fs::path temporary = place.unused(".tmp-");
  fs::create_directory(fresh);
  try {
    FolderLock lock(fresh.string(), temporary.filename().string());
    fs::rename(fresh, temporary);
    return {temporary.string(), std::move(lock)};
  } catch (const std::exception&) {
    std::error_code none;
    fs::remove(fresh / lockName, none);
    fs::remove(fresh, none);
    throw;
  }
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path) : place_(path) {
  try {
    place_.requireReplaceable();
    fs::create_directories(place_.parent());
    const PlaceLock alone(place_.parent().string());
    clearUp(place_);
    std::tie(temporary_, lock_) = newFolder(place_);
  } catch (const fs::filesystem_error& error) {
    throw OutputError(path + ": cannot be made: " + error.code().message());
  }
}

OutputFolder::OutputFolder(const std::string& path, std::string temporary, FolderLock lock)
    : place_(path), temporary_(std::move(temporary)), lock_(std::move(lock)) {
  place_.requireReplaceable();
}

OutputFolder::~OutputFolder() {
  try {
    if (fs::is_directory(temporary_) && !hasCheckpoint(temporary_) && !readManifest(temporary_))
      discard(place_, temporary_, place_.of(false));
  } catch (const std::exception&) {  // the next run tries again
  }
}

std::string OutputFolder::commit(const Manifest& manifest) {
  fs::path target;
  try {
    if (hasCheckpoint(temporary_))  // it goes when the result is on the disk
      for (const auto& [name, record] : manifest.files) OutputFile(temporary_ + "/" + name, record).sync();
    writeManifest(temporary_, manifest);
    {
      const PlaceLock alone(place_.parent().string());
      target = putInPlace(place_, temporary_);
    }
    finish(place_, target, fs::path(temporary_).filename().string());
    return place_.shown(target);
  } catch (const std::exception& error) {
    const auto* file = dynamic_cast<const fs::filesystem_error*>(&error);
    const std::string reason = file != nullptr ? file->code().message() : error.what();
    const std::string name = place_.shown(place_.of(manifest.failed));
    if (!target.empty())
      throw OutputError(name +
                        ": the result is in place, but not all of the old one could be cleared: " + reason);
    if (readManifest(temporary_))
      throw OutputError(name + ": cannot be replaced: " + reason + "; the result is in " +
                        place_.shown(temporary_) + ", and the next run for " +
                        place_.shown(place_.of(false)) + " puts it in place");
    throw OutputError(name + ": cannot be written: " + reason);
  }
}

}  // namespace mortier
