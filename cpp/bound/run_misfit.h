// What a step of a run adds to the bound of steps and meshes together (total_bound.h), of one body: between
// the ends of the step s^ is linear in time, and s~ = E (eps(u^) - eps^_p), whose strain eps^_p flows at the
// rate G(t) that the law has for u^: that of the finite elements where the lift moves nothing.
#pragma once

#include <vector>

#include "bound/error_course.h"
#include "bound/loaded_body.h"
#include "bound/part_stress.h"

namespace mortier {

/// Of a body on its matched mesh at a time.
struct RunFields {
  Matrix stress;        ///< s~, components x triangles [Pa]
  Matrix balanced;      ///< s^ at the vertices of the parts, components x 9 triangles [Pa]
  Vector displacement;  ///< u^ [m]
};

struct RunMisfit {
  std::vector<double> flow;  ///< integrals of D(s^; t)/rho over step and body, by weights [J/m]
  double change = 0;         ///< |r1 - r0|^2, r = s~ - s^ [J/m]
};

/// Of a state, beside a body of its own mesh.
class RunBody {
 public:
  explicit RunBody(const Body& own);

  /// s^ and u^ of a state. \param weight  as that of `loaded` [s]
  [[nodiscard]] RunFields fields(const BodyState& state, const LoadedBody& loaded, const Vector& lifted,
                                 double weight) const;
  /// The fields at the start: s~ is the stress of the state, less what the lift takes from it.
  [[nodiscard]] RunFields start(const BodyState& state, const LoadedBody& loaded, const Vector& lifted) const;
  /// The same at rest, where all is zero.
  [[nodiscard]] RunFields rest(const CutMesh& cut) const;
  /// Those at the end of a step; adds what the step does.
  /// \param before,state  of the run at both ends  \param weight  as that of `loaded` [s]
  /// \param weights  those of the integrals
  RunFields step(const RunFields& fields, const BodyState& before, const BodyState& state,
                 const LoadedBody& loaded, const Vector& lifted, double timeStep, double weight,
                 const std::vector<StepWeights>& weights, RunMisfit& misfit) const;

  /// |s~ - s^|^2 [J/m]
  [[nodiscard]] double misfit(const RunFields& fields, const LoadedBody& loaded) const;
  /// |s - s^|^2 [J/m] and ||eps^_p - eps_p||^2 [m^2], s and eps_p those of the state.
  [[nodiscard]] std::array<double, 2> distance(const RunFields& fields, const BodyState& state,
                                               const LoadedBody& loaded) const;

 private:
  const Body& own_;
  std::vector<PointMatrix> compliances_, moduli_;  ///< E^-1 and E by triangles of the body
};

}  // namespace mortier
