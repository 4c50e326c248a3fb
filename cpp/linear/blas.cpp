#include "linear/blas.h"

#include <cstdlib>
#include <string_view>

extern "C" {
// Of OpenBLAS, where it has threads, and kernels for many processors.
int blas_thread_shutdown_() __attribute__((weak));
void gotoblas_dynamic_init() __attribute__((weak));
void gotoblas_dynamic_quit() __attribute__((weak));
}

namespace mortier::dense {
namespace {

/// OpenBLAS takes a processor that is newer than itself for one without AVX, and is half as fast: it gets the
/// kernels for what the processor has. \returns whether it did
bool useVectorUnits() {
#ifdef __x86_64__
  constexpr const char* kernels = "OPENBLAS_CORETYPE";
  if (gotoblas_dynamic_init == nullptr || gotoblas_dynamic_quit == nullptr ||
      std::getenv(kernels) != nullptr || std::string_view(openblas_get_corename()) != "Prescott" ||
      !__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
    return false;
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  setenv(kernels, wide ? "SkylakeX" : "Haswell", 1);
  gotoblas_dynamic_quit();
  gotoblas_dynamic_init();
  unsetenv(kernels);
  return true;
#else
  return false;
#endif
}

/// When the program or the module is loaded: BLAS may not be at work.
[[maybe_unused]] const bool usesVectorUnits = useVectorUnits();

}  // namespace

void useOneThread() {
  openblas_set_num_threads(1);
}

void endThreadsOfBlas() {
  useOneThread();
  if (blas_thread_shutdown_ != nullptr) blas_thread_shutdown_();
}

}  // namespace mortier::dense
