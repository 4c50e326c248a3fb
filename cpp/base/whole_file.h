// A file as a whole: written so that it is there as a whole or not at all, and read from a regular file of a
// size that memory can hold.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace mortier {

/// Writes `text` to `path`, in place of what stands there: beside it, then renamed. Pipes and devices are
/// written as they are. \param durable  also brings it to the disk before it gets its name, so that a loss of
/// power spares the old one; without it SIGINT, SIGTERM and SIGHUP end the writing, and nothing is left.
/// \throws OutputError, Interrupted
void writeWhole(const std::string& path, std::string_view text, bool durable = false);

/// Of files that people write or that hold meshes: some 5e7 triangles, beyond what is solved here.
constexpr uint64_t mostBytes = uint64_t{4} << 30;

/// The bytes of a file. \param expected  for messages: a Medit mesh
/// \param pipes  whether it may be a pipe or a device as well
/// \throws InputError  it is no file, it is larger than `most`, or it cannot be read
std::string readWhole(const std::string& path, const std::string& expected, uint64_t most = mostBytes,
                      bool pipes = false);

}  // namespace mortier
