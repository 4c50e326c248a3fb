// Two blocks that are pressed, held, drawn apart and pressed again; contact ends at t = 7/3 and comes back at
// 11/3.
#pragma once

#include <array>
#include <cmath>

#include "theory/scenes.h"

namespace mortier::scenes {

/// s(1); s(2) = s(4) = 1, gap(3) = 0.04 (uniaxial, eps_vp(2) = 0.02 in each block).
constexpr double exactAfterRamp = 1.074044777;

/// Down by 0.06 in [0, 1], held, up by 0.06 in [2, 3], down again.
inline double pathOfTheTop(double t) {
  return -0.06 * (t <= 1 ? t : t <= 2 ? 1 : t <= 3 ? 3 - t : t - 3);
}

inline Model pressedBlocks(
    CouplingKind coupling, const Function& path = [](double, double, double t) { return pathOfTheTop(t); }) {
  const auto material = perzynaMaterial({100, 0.3}, {1, 1, Projection::frobenius});
  Body upper("upper", square(0, 5), material, {{{left, 0, constant(0)}, {top, 1, path}}, {}, {}});
  Body lower("lower", square(-1, 7), material, {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return contactModel(std::move(upper), std::move(lower), coupling, upperBody);
}

/// What is known of the exact solution, collected during a run.
struct OpenClose {
  explicit OpenClose(const Model& which) : model(&which) {}

  const Model* model;
  std::array<Range, 5> stress;  ///< -s22 at t = 0, 1, .., 4 [Pa]
  Range gapAt3;                 ///< opening at t = 3 [m]
  double lastBefore = 0;        ///< last time with contact before it opens [s]
  double firstAfter = 0;        ///< first time with contact after that [s]

  Observer observer() {
    return [this](const State& now, const StepReport& report) {
      if (report.step == 0) *this = OpenClose(*model);
      const double force = now.contactForce[0].sum();
      if (force > 0 && now.time < 3) lastBefore = now.time;
      if (force > 0 && now.time > 3 && firstAfter == 0) firstAfter = now.time;
      if (now.time != std::round(now.time)) return;
      const auto second = static_cast<size_t>(now.time);
      for (const BodyState& body : now.bodies)
        for (Eigen::Index i = 0; i < body.stress.cols(); ++i)
          stress[second].add(-toCartesian(body.stress.col(i))[1]);
      if (second == 3)
        for (const double g :
             model->interfaces[0].gap(now.bodies[0].displacement, now.bodies[1].displacement))
          gapAt3.add(-g);
    };
  }
};

}  // namespace mortier::scenes
