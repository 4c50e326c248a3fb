#pragma once

namespace mortier {

#ifdef MORTIER_VERSION  // the build knows
constexpr const char* version = MORTIER_VERSION;
#else
constexpr const char* version = "0.1.0";
#endif

}  // namespace mortier
