// Two bodies in contact that follows them: what holds in the plane and in space.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "theory/scenes.h"
#include "time/measure.h"
#include "time/quantity.h"

namespace mortier::scenes {

inline Model following(Body upper, Body lower, const Rows& coupling, int nonmortarBody, double friction,
                       double stiffness) {
  InterfaceOptions options;
  options.follows = true;
  options.friction = {friction, 0};
  options.stiffness = stiffness;
  coupling.set(options, 0.01);
  return contactModel(std::move(upper), std::move(lower), coupling, nonmortarBody, options);
}

/// The supports' work is the change of the elastic energy and friction's, each with its own rows at both ends
/// of a step.
inline void expectEnergyKept(const Model& model, int steps) {
  const auto energyOf = [&](const State& state) {
    double sum = 0;
    for (size_t b = 0; b < state.bodies.size(); ++b) {
      Matrix strain;
      model.bodies[b].material().elasticStrain(state.bodies[b].stress, strain);
      for (int i = 0; i < model.bodies[b].points(); ++i)
        sum += model.bodies[b].weights()[i] / 2 * state.bodies[b].stress.col(i).dot(strain.col(i));
    }
    return sum;
  };
  State state = initialState(model);
  State before = state;
  double worst = 0;
  double largest = 0;
  const RunReport report = march(model, state, {.end = 1, .steps = steps, .quantities = externalWorks()}, {},
                                 [&](const State& now, const StepReport& step) {
                                   if (step.step == 0) return;
                                   const double lost = workSince(before, now) -
                                                       (energyOf(now) - energyOf(before)) -
                                                       (now.frictionWork - before.frictionWork);
                                   largest = std::max(largest, energyOf(now));
                                   worst = std::max(worst, std::abs(lost));
                                   before = now;
                                 });
  ASSERT_EQ(report.status, Status::converged) << report.reason;
  std::cout << "balance off by " << worst / largest << " of the largest energy\n";
  EXPECT_LE(worst, 2e-9 * largest);
  EXPECT_GT(state.frictionWork, 0.01 * largest);
}

/// Rows of a state are those of its displacements alone: a run resumes from state and memory to the last bit.
/// \param again  the same model, made anew
inline void expectResumed(const Model& model, const Model& again, int steps, int after) {
  const TimePlan plan{.end = 1, .steps = steps};
  State whole = initialState(model);
  State state;
  MarchMemory memory;
  MarchMemory kept;
  march(model, whole, memory, plan, {}, [&](const State& now, const StepReport& report) {
    if (report.step != after) return;
    state = now;
    kept = memory;
  });
  ASSERT_EQ(march(again, state, kept, plan, {}, [](const State&, const StepReport&) {}).status,
            Status::converged);
  EXPECT_EQ(state.frictionWork, whole.frictionWork);
  for (size_t b = 0; b < whole.bodies.size(); ++b) {
    EXPECT_EQ(state.bodies[b].displacement, whole.bodies[b].displacement);
    EXPECT_EQ(state.bodies[b].stress, whole.bodies[b].stress);
  }
  EXPECT_EQ(state.contactForce[0], whole.contactForce[0]);
}

}  // namespace mortier::scenes
