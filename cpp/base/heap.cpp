#include "base/heap.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace mortier {

void keepHeap() {
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
  constexpr int block = 1 << 29;  // bytes
  mallopt(M_MMAP_THRESHOLD, block);
  mallopt(M_TRIM_THRESHOLD, -1);
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY) return;
  int overcommit = 0;
  constexpr int none = 2;  // memory counts before it is written
  if (std::ifstream("/proc/sys/vm/overcommit_memory") >> overcommit && overcommit == none) return;
  // The heap grows to half of the machine's memory, of which nothing is used before it is written.
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto memory = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * page;
  std::vector<void*> blocks;
  for (std::size_t size = block; size <= memory / 2; size += block) {
    void* const next = std::malloc(block - 64);  // less than what is mapped on its own
    if (next == nullptr) break;
    blocks.push_back(next);
    const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(next) + page - 1) / page * page;
    madvise(reinterpret_cast<void*>(begin), block - 2 * page, MADV_HUGEPAGE);  // a hint
  }
  for (void* each : blocks) std::free(each);
#endif
}

}  // namespace mortier
