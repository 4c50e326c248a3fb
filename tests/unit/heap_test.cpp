#include "base/heap.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <memory>

namespace mortier {
namespace {

/// Pages that are mapped while so many bytes are taken, written and freed.
long pagesMappedFor(size_t bytes) {
  const auto mapped = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
  };
  const long before = mapped();
  const auto memory = std::make_unique_for_overwrite<volatile char[]>(bytes);
  for (size_t i = 0; i < bytes; i += 4096) memory[i] = 1;
  return mapped() - before;
}

TEST(Heap, freedMemoryIsNotMappedAnew) {
  constexpr size_t bytes = size_t{100} << 20;
  keepHeap();
  pagesMappedFor(bytes);
  EXPECT_LT(pagesMappedFor(bytes), 100);
}

}  // namespace
}  // namespace mortier
