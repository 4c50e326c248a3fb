#include "linear/versions.h"

#include <cblas.h>
#include <umfpack.h>

#include <Eigen/Core>

#include "linear/cholmod_common.h"

namespace mortier {

namespace {

template <class... Number>
std::string dotted(int first, Number... rest) {
  return std::to_string(first) + (... + ("." + std::to_string(rest)));
}

}  // namespace

std::vector<std::pair<std::string, std::string>> linearLibraries() {
  int cholmod[3];
  cholmod_version(cholmod);
  return {{"Eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"CHOLMOD", dotted(cholmod[0], cholmod[1], cholmod[2])},
          {"UMFPACK", dotted(UMFPACK_MAIN_VERSION, UMFPACK_SUB_VERSION, UMFPACK_SUBSUB_VERSION)},
          {"BLAS", openblas_get_config()}};
}

}  // namespace mortier
