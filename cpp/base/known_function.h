// A datum of which more is known than its values at points: what its formula does on whole pieces of lines.
// It is found again in a Function by Function::target.
#pragma once

#include <functional>
#include <string>

#include "base/taylor.h"
#include "base/types.h"

namespace mortier {

struct KnownFunction {
  /// With x, y and t along a piece of a line.
  using Along = std::function<Taylor(const Taylor& x, const Taylor& y, const Taylor& t)>;

  Function value;
  std::function<Along()> along;  ///< reads the formula; empty where there is none
  bool constant = false;         ///< depends on none of x, y, t
  bool inTime = true;            ///< may depend on t

  double operator()(double x, double y, double t) const { return value(x, y, t); }
};

}  // namespace mortier
