// Everything that reads what others wrote, for any bytes: the first one says which reader gets the rest. An
// InputError is what a reader owes to bytes that make no sense; anything else that is thrown, and every
// crash, is a fault.
//   s scene   m Medit mesh   g mesh for Gmsh, in a process of its own   e expression   t table in time
//   o --set
//   c checkpoint   p message
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "base/archive.h"
#include "base/error.h"
#include "base/printable.h"
#include "mesh/read.h"
#include "report/checkpoint.h"
#include "report/checkpoint_members.h"
#include "scene/expression.h"
#include "scene/scene.h"

namespace mortier {

/// Bytes as a file without a place.
class File {
 public:
  explicit File(const std::string& bytes) : file_(memfd_create("bytes", 0)) {
    if (file_ < 0 || write(file_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      std::abort();
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { close(file_); }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

inline const char* soundScene() {
  return "[[body]]\nname = \"a\"\nmesh = \"/proc/self/exe\"\nmaterial = { young = 1, poisson = 0 }\n"
         "boundary = [ { label = 4, ux = 0, uy = 0 } ]\n[time]\nend = 1\nsteps = 4\n";
}

inline void readBytes(char reader, const std::string& bytes) {
  switch (reader) {
    case 's':
      readScene(File(bytes).path());
      break;
    case 'm':
      readMedit(File(bytes).path());
      break;
    case 'g':
      readGmsh({File(bytes).path()});
      break;
    case 'e':
      parseExpression(bytes, "here").value(0.5, -1, 2);
      break;
    case 't':
      readScene(File(soundScene()).path(), {"body.a.force.x=" + bytes});
      break;
    case 'o':
      readScene(File(soundScene()).path(), {bytes});
      break;
    case 'c': {
      Checkpoint checkpoint;
      ArchiveReader archive(bytes);
      archive(checkpoint);
      requireFits(checkpoint, Model(), "out");
      break;
    }
    case 'p':
      if (printable(bytes).size() > 2000 || printable(printable(bytes)) != printable(bytes)) std::abort();
      break;
    default:
      break;
  }
}

/// \returns whether it was refused. A message is one line that can be shown.
inline bool isRefused(const std::string& bytes) {
  try {
    if (!bytes.empty()) readBytes(bytes[0], bytes.substr(1));
    return false;
  } catch (const InputError& error) {
    if (*error.what() == '\0') std::abort();
    return true;
  }
}

}  // namespace mortier
