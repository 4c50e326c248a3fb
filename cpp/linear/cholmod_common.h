// CHOLMOD's workspace as an RAII object and its view of a matrix, for the sources of this folder only.
#pragma once

#include <cholmod.h>

#include <mutex>
#include <vector>

namespace mortier {

class CholmodCommon {
 public:
  CholmodCommon() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.error_handler = nullptr;
  }
  CholmodCommon(const CholmodCommon&) = delete;
  CholmodCommon& operator=(const CholmodCommon&) = delete;
  ~CholmodCommon() { cholmod_finish(&common_); }

  cholmod_common* operator&() { return &common_; }  // NOLINT(google-runtime-operator)
  cholmod_common* operator->() { return &common_; }

 private:
  cholmod_common common_{};
};

/// METIS draws from the random numbers of the process, and traps its signals: one call at a time, so that
/// runs in several threads have the orderings that each would have alone.
inline std::mutex metisInUse;

/// The pattern of the lower triangle of a symmetric matrix by columns.
inline cholmod_sparse lowerTriangle(std::vector<int>& columnStart, std::vector<int>& rows) {
  cholmod_sparse A{};
  A.nrow = A.ncol = columnStart.size() - 1;
  A.nzmax = rows.size();
  A.p = columnStart.data();
  A.i = rows.data();
  A.stype = -1;
  A.itype = CHOLMOD_INT;
  A.xtype = CHOLMOD_PATTERN;
  A.dtype = CHOLMOD_DOUBLE;
  A.sorted = 1;
  A.packed = 1;
  return A;
}

}  // namespace mortier
