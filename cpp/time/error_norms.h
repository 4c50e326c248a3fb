// The norms in which errors in time are measured: the stress in the energy norm, which is blind where
// equilibrium alone decides the stress, and the displacement in the mean; and what friction dissipates.
#pragma once

#include <vector>

#include "solver/model.h"
#include "solver/state.h"
#include "solver/step_system.h"
#include "time/memory.h"

namespace mortier {

ErrorNorms larger(const ErrorNorms& a, const ErrorNorms& b);

/// The largest part of its scale that any of them is; 1 where that is none.
double relative(const ErrorNorms& error, const ErrorNorms& scale);

/// sum += factor part
void addTo(std::vector<Matrix>& sum, double factor, const std::vector<Matrix>& part);
void addTo(SlipAndWork& sum, double factor, const SlipAndWork& part);

void addTo(std::vector<Response>& sum, const std::vector<Response>& part);

class ErrorMeasure {
 public:
  explicit ErrorMeasure(const Model& model);

  /// Of a state. Where everything is held no displacement is a scale: what the elastic strain makes of the
  /// extent is. Where bodies only move the stress is none: that of a tiny part of their motion is. Where next
  /// to nothing slips the dissipation is none: a small part of the energy is.
  [[nodiscard]] ErrorNorms sizeOf(const State& state) const;
  [[nodiscard]] ErrorNorms sizeOf(const std::vector<Response>& error) const;

 private:
  struct StressNorms {
    double energy = 0;  ///< square of the energy norm of a stress [J/m]
    double strain = 0;  ///< mean square of its elastic strain [-]
  };
  [[nodiscard]] StressNorms normsOf(const Matrix& stress, size_t body) const;
  [[nodiscard]] double meanSquare(const Vector& displacement, size_t body) const;

  const Model& model_;
  bool hasFriction_;
  double area_ = 0;    ///< of all bodies [m^2]
  double extent_ = 0;  ///< of the largest [m]
};

}  // namespace mortier
