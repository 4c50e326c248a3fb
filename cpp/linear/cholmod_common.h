// CHOLMOD's workspace as an RAII object, for the sources of this folder only.
#pragma once

#include <cholmod.h>

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

}  // namespace mortier
