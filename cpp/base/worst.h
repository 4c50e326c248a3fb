// The worst of residuals.
#pragma once

#include <cmath>

#include "base/types.h"

namespace mortier {

/// The largest of some values >= 0; 0 where there are none. A NaN is worse than any number and stays.
class Worst {
 public:
  void add(double value) {
    if (!std::isnan(value_) && !(value <= value_)) value_ = value;
  }
  /// The largest |entry|.
  void add(const Vector& entries) {
    if (entries.size() > 0) add(entries.cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
  }
  [[nodiscard]] double value() const { return value_; }

 private:
  double value_ = 0;
};

/// The worse of two.
inline double worse(double a, double b) {
  Worst worst;
  worst.add(a);
  worst.add(b);
  return worst.value();
}

}  // namespace mortier
