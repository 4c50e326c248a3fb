// For libFuzzer (clang): fuzz_readers -max_len=4096 CORPUS tests/fuzz/corpus
#include "fuzz/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  mortier::isRefused(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
