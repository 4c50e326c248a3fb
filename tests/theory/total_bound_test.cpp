// The guaranteed bound of what steps and meshes do together to bodies that flow: against an exact solution,
// and against finer meshes and shorter steps.
#include "bound/total_bound.h"

#include <gtest/gtest.h>

#include <iostream>

#include "material/plane_strain.h"
#include "theory/scenes.h"

namespace mortier {
namespace {

using namespace scenes;

struct Bounded {
  State state;
  TotalBound bound;
};

Bounded boundedRun(const Model& model, const TimePlan& plan) {
  Bounded result{initialState(model), {}};
  FlowBoundMemory flowMemory;
  TotalBoundMemory memory;
  FlowBoundRecord flow(model, {true, plan.controlled()}, result.state, flowMemory);
  TotalBoundRecord record(model, result.state, memory);
  const RunReport report =
      march(model, result.state, plan, {}, [&](const State& state, const StepReport& step) {
        record.look(state, step.step);
        flow.add(state, step);
        record.add(flowMemory.obstacle);
      });
  EXPECT_EQ(report.status, Status::converged);
  result.bound = record.atEnd(result.state, flow.atEnd(result.state));
  return result;
}

/// ||eps_p - other||, of uniform others.
double strainBetween(const Model& model, const State& state, const Vector& other) {
  double sum = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b)
    for (int i = 0; i < model.bodies[b].points(); ++i)
      sum += model.bodies[b].weights()[i] * (state.bodies[b].viscoplasticStrain.col(i) - other).squaredNorm();
  return std::sqrt(sum);
}

/// The viscoplastic strain of a stress -10 t e_y e_y, by Simpson's rule.
Vector flownUnder10(const Material& material) {
  Vector exact = Vector::Zero(3);
  constexpr int parts = 20000;
  const auto rate = [&](double t) {
    Matrix g;
    material.viscoplasticRate(fromCartesian({0, -10 * t, 0}), g);
    return Vector(g.col(0));
  };
  for (int i = 0; i < parts; ++i) {
    const double h = 0.9 / parts;
    const double t = 0.1 + i * h;
    exact += h / 6 * (rate(t) + 4 * rate(t + h / 2) + rate(t + h));
  }
  return exact;
}

// ---- an exact solution: the note's test, where the stress is -10 t e_y e_y
TEST(TotalBound, isAboveAndNearTheErrorOfTheNotesTest) {
  for (const double young : {3e11, 1e4, 10.0})
    for (const CouplingKind coupling : couplings)
      for (const auto& [upper, lower] : {std::array{6, 16}, std::array{16, 6}})
        for (const int steps : {5, 10, 20, 100}) {
          const auto material = perzynaMaterial({young, 0.3}, noteLaw(Projection::frobenius));
          const Model model = compression(upper, lower, material, coupling, upperBody);
          const auto [state, bound] = boundedRun(model, {.end = 1, .steps = steps});
          const double error = strainBetween(model, state, flownUnder10(*material));
          std::cout << nameOf(coupling) << " " << upper << ":" << lower << ", E = " << young << ", " << steps
                    << " steps: error " << 100 * error / bound.strainNorm << " %, bound over it "
                    << bound.fixed.strain / error << ", lifted " << bound.lifted / error
                    << ", whatever contact does " << bound.any.strain / error << " stress "
                    << bound.fixed.stress / bound.stressNorm << " " << bound.obstacle << " " << bound.moved
                    << " " << bound.closes << "\n";
        }
}

}  // namespace
}  // namespace mortier
