#include "report/output_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <set>

#include "base/error.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

bool isResult(const fs::path& folder) {
  return fs::exists(folder / "summary.json");
}

/// Anything but an old result could be something that the user wants to keep.
void requireReplaceable(const fs::path& folder) {
  if (fs::exists(folder) && (!fs::is_directory(folder) || (!fs::is_empty(folder) && !isResult(folder)))) {
    throw InputError(folder.string() +
                     ": exists and is no result of mortier (no summary.json in it), "
                     "expected a new or empty folder, or a result to replace");
  }
}

bool isOurs(const fs::path& file) {
  static const std::set<std::string> names{"fields.pvd", "contact.csv", "history.csv", "summary.json"};
  return names.count(file.filename().string()) != 0 || file.extension() == ".vtu";
}

void replace(const fs::path& from, const fs::path& target) {
  try {
    if (!fs::exists(target)) {
      fs::rename(from, target);
      return;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(target)) {
      if (!isOurs(entry.path())) {
        fs::rename(entry.path(), from / entry.path().filename());
      }
    }
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) != 0) {
      fs::remove_all(target);  // a file system that cannot exchange two folders in one step
      fs::rename(from, target);
    }
    fs::remove_all(from);
  } catch (const fs::filesystem_error& error) {
    throw OutputError(target.string() + ": cannot be replaced: " + error.code().message());
  }
}

}  // namespace

OutputFolder::OutputFolder(std::string path) : path_(std::move(path)) {
  while (path_.size() > 1 && path_.back() == '/') {
    path_.pop_back();
  }
  try {
    requireReplaceable(path_);
    requireReplaceable(path_ + ".failed");
    const fs::path target = fs::absolute(path_).lexically_normal();
    if (target.has_parent_path()) {
      fs::create_directories(target.parent_path());
    }
    temporary_ = target.string() + ".tmp-" + std::to_string(getpid());
    fs::remove_all(temporary_);
    fs::create_directory(temporary_);
  } catch (const fs::filesystem_error& error) {
    throw OutputError(path_ + ": cannot be made: " + error.code().message());
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
}

void OutputFolder::commit() {
  replace(temporary_, path_);
  std::error_code ignored;
  if (const fs::path failed = path_ + ".failed"; isResult(failed)) {
    fs::remove_all(failed, ignored);
  }
}

std::string OutputFolder::commitAsFailed() {
  std::string failed = path_ + ".failed";
  replace(temporary_, failed);
  return failed;
}

}  // namespace mortier
