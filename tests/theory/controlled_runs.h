// Runs whose steps are chosen by their error.
#pragma once

#include <iostream>
#include <string>

#include "time/march.h"

namespace mortier::scenes {

inline TimePlan controlled(double end, double tolerance, Scheme scheme = Scheme::sdirk2) {
  return {.end = end, .steps = 0, .scheme = scheme, .tolerance = tolerance};
}

inline RunReport runWith(
    const Model& model, State& state, const TimePlan& plan,
    const Observer& observer = [](const State&, const StepReport&) {}) {
  return march(model, state, plan, {}, observer);
}

inline int count(const RunReport& run, const char* method) {
  const auto found = run.rungs.find(method);
  return found == run.rungs.end() ? 0 : found->second;
}

inline void print(const std::string& what, const RunReport& run) {
  std::cout << what << ": " << run.steps << " steps, " << run.rejected << " rejected, " << run.guarded
            << " guarded, " << count(run, "continuation") << " with continuation, " << count(run, "cut")
            << " cut, " << run.iterations << " linear solves (pilot " << run.pilotIterations << ")";
}

}  // namespace mortier::scenes
