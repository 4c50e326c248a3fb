// The error of the meshes over a run, by triangles: what meshes are refined by. One mesh serves all times, so
// that of each triangle is the largest that it had at any time.
#pragma once

#include <vector>

#include "time/space_error.h"

namespace mortier {

class ErrorHistory {
 public:
  /// \param error  of the states that are told of
  ErrorHistory(const Model& model, CurrentSpaceError& error) : model_(model), error_(error) {}
  /// A state of the run, in their order; the initial state (step 0) begins anew.
  void add(const StepReport& report);

  /// By bodies and triangles [J/m]: the shares, whose sum is the largest error of any state, squared. 0 where
  /// that is nothing but rounding.
  [[nodiscard]] std::vector<Vector> errors() const;
  /// The largest energy of the recovered stress of any state [J/m].
  [[nodiscard]] double energy() const { return energy_; }

 private:
  const Model& model_;
  CurrentSpaceError& error_;
  std::vector<Vector> largest_;  ///< of each triangle
  double largestSum_ = 0;
  double energy_ = 0;
  double displacement_ = 0;  ///< largest [m]
};

}  // namespace mortier
