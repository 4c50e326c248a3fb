// The processes of `mortier`: one. Linked with MPI it would start more slowly than many a scene is solved.
#include <cstdlib>

#include "base/error.h"
#include "linear/distributed_engine.h"

namespace mortier {

void startProcesses(int& /*argc*/, char**& /*argv*/) {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* size = std::getenv(name); size != nullptr && std::atoi(size) > 1)
      throw InputError("mpirun: mortier runs in one process, expected mortier-mpi (docs/scaling.md)");
}

void endProcesses() {}

}  // namespace mortier
