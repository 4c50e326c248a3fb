// The ranks of `mortier`: one. Under mpirun a run becomes mortier-mpi, which is linked with MPI: that alone
// takes longer to start than many a scene takes to be solved.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/ranks.h"

namespace mortier {

namespace {

bool underMpirun() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* size = std::getenv(name); size != nullptr && std::atoi(size) > 1) return true;
  return false;
}

}  // namespace

void startRanks(int& argc, char**& argv) {
  if (argc < 2 || std::string(argv[1]) != "run" || !underMpirun()) return;
  std::error_code ignored;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::string shared = (self.parent_path() / "mortier-mpi").string();
  execv(shared.c_str(), argv);
  throw InputError("mpirun: several processes, but no " + shared +
                   ", expected a mortier that was built where MPI and METIS are");
}

}  // namespace mortier
