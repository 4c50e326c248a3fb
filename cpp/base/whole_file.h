// A file that is there as a whole or not at all: written beside its place, then renamed.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace mortier {

/// Writes `text` to `path`, in place of what stands there. Pipes and devices are written as they are.
/// \param durable  also brings it to the disk before it gets its name, so that a loss of power spares the old
/// one.
/// \throws OutputError
inline void writeWhole(const std::string& path, std::string_view text, bool durable = false) {
  namespace fs = std::filesystem;
  std::error_code error;
  const bool direct = fs::exists(path, error) && !fs::is_regular_file(path, error);
  const std::string beside = direct ? path : path + ".tmp-" + std::to_string(getpid());
  std::FILE* file = std::fopen(beside.c_str(), "wb");
  bool sound = file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size() &&
               std::fflush(file) == 0 && (!durable || fsync(fileno(file)) == 0);
  int reason = errno;
  if (file != nullptr && std::fclose(file) != 0 && sound) {
    reason = errno;
    sound = false;
  }
  if (sound && !direct && std::rename(beside.c_str(), path.c_str()) != 0) {
    reason = errno;
    sound = false;
  }
  if (sound) return;
  if (!direct) fs::remove(beside, error);
  throw OutputError(path + ": cannot be written: " + std::strerror(reason));
}

}  // namespace mortier
