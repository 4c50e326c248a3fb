#include "linear/distributed_engine.h"

namespace mortier {

DistributedEngine*& DistributedEngine::place() {
  static DistributedEngine* engine = nullptr;
  return engine;
}

}  // namespace mortier
