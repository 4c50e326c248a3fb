// What a body adds to the bounds of flow, by integrals over the parts of composite triangles, in which s^ is
// linear: of squares exactly, of D(s^; t) from above (flow_potential.h). To that of a step (energy_bound.h),
// and to that of a run (total_bound.h), where between the ends of a step s^ is linear in time, and
// s~ = E (eps(u^) - eps^_p), whose strain eps^_p flows at the rate G(t) that the law has for u^: that of the
// finite elements where the lift moves nothing.
#pragma once

#include <vector>

#include "bound/error_course.h"
#include "bound/loaded_body.h"

namespace mortier {

using PointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;

struct FlowMisfit {
  double stress = 0;    ///< |s^ - s|^2 [J/m]
  double lift = 0;      ///< |a - s|^2 [J/m]
  double flow = 0;      ///< 2 k integral of D(s^; t) [J/m]
  double shift = 0;     ///< |k r - k G(s)|^2 [m^2]
  double norm = 0;      ///< |s|^2 [J/m]
  double strain = 0;    ///< |k G(s)|^2 [m^2]
  double fluidity = 0;  ///< 1/(2 lambda), the largest [1/(Pa s)]
};

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
class FlowingBody {
 public:
  explicit FlowingBody(const Body& own);

  /// Adds what a step does. \param weight  k [s]
  void addStep(const BodyState& state, const LoadedBody& loaded, const Vector& lifted, double weight,
               FlowMisfit& misfit) const;

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
