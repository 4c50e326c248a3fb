#include "time/march.h"

#include <algorithm>
#include <chrono>

#include "solver/step.h"

namespace mortier {
namespace {

void addIncrement(const Iterate& iterate, const Model& model, State& state) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    BodyState& body = state.bodies[b];
    const BodyIterate& step = iterate.bodies[b];
    if (!model.bodies[b].material().linear()) {
      // What the elastic part leaves of the strain of the step.
      Matrix elastic;
      model.bodies[b].material().elasticStrain(step.stress - body.stress, elastic);
      body.viscoplasticStrain -= elastic;
      body.viscoplasticStrain.topRows<3>() += step.strain;
    }
    body.displacement += step.increment + step.small;
    body.stress = step.stress;
  }
  state.contactForce = iterate.contactForce;
}

void measure(const Model& model, const State& state, const Iterate& iterate,
             const std::vector<std::vector<char>>& before, StepReport& report) {
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const Vector& p = state.contactForce[k];
    for (Eigen::Index i = 0; i < p.size(); ++i) {
      report.active += iterate.active[k][i];
      report.joined += iterate.active[k][i] > before[k][i] ? 1 : 0;
      report.left += iterate.active[k][i] < before[k][i] ? 1 : 0;
    }
    report.penetration +=
        interface.interpenetration(state.bodies[interface.pair().nonmortar.body].displacement,
                                   state.bodies[interface.pair().mortar.body].displacement);
    report.maxPressure = std::max(report.maxPressure, interface.contactPressure(p).maxCoeff());
    report.contactForce += p.sum();
  }
  double area = 0;
  double flowing = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (int i = 0; i < body.points(); ++i) {
      area += body.weights()[i];
      if (body.material().flows(state.bodies[b].stress, i)) flowing += body.weights()[i];
    }
  }
  report.viscoplasticFraction = flowing / area;
}

void keepWorst(const Certificate& step, Certificate& worst) {
  worst.forceBalance = std::max(worst.forceBalance, step.forceBalance);
  worst.materialResidual = std::max(worst.materialResidual, step.materialResidual);
  worst.gapOnActive = std::max(worst.gapOnActive, step.gapOnActive);
  worst.sign = std::max(worst.sign, step.sign);
  worst.complementarity = std::max(worst.complementarity, step.complementarity);
}

}  // namespace

State initialState(const Model& model) {
  State state;
  for (const Body& body : model.bodies) {
    const int components = body.material().components();
    BodyState initial{Vector::Zero(body.dofs()), Matrix::Zero(components, body.points()),
                      Matrix::Zero(components, body.points())};
    body.prescribe(0, initial.displacement);
    state.bodies.push_back(std::move(initial));
  }
  for (const ContactInterface& interface : model.interfaces)
    state.contactForce.push_back(Vector::Zero(interface.rows()));
  return state;
}

RunReport march(const Model& model, State& state, const TimePlan& plan, const SolverOptions& options,
                const Observer& observer) {
  using Clock = std::chrono::steady_clock;
  RunReport run;
  const auto timed = [&](auto work) {
    const auto begin = Clock::now();
    work();
    run.solveSeconds += std::chrono::duration<double>(Clock::now() - begin).count();
  };

  std::unique_ptr<StepSolver> solver;
  timed([&] { solver = std::make_unique<StepSolver>(model, options); });
  observer(state, StepReport{});

  // In steady flow the last increments are a good guess; a hard step before makes them a bad one.
  constexpr int easyIterations = 2;
  constexpr int easySteps = 2;
  int easy = 0;
  Iterate last = solver->start(state);
  const double begin = state.time;
  for (int n = 1; n <= plan.steps; ++n) {
    StepReport report;
    Iterate iterate;
    std::vector<std::vector<char>> before;
    timed([&] {
      report.step = n;
      report.time = begin + (plan.end - begin) * n / plan.steps;
      report.timeStep = report.time - state.time;
      iterate = solver->start(state);
      before = iterate.active;
      if (easy >= easySteps)
        for (size_t b = 0; b < model.bodies.size(); ++b) {
          iterate.bodies[b].increment = last.bodies[b].increment;
          iterate.bodies[b].small = last.bodies[b].small;
          iterate.bodies[b].stress += last.bodies[b].stress;
        }
      const StepOutcome outcome = solver->solve(state, {report.time, report.timeStep, {}}, iterate);
      run.iterations += outcome.iterations;
      run.factorisations += outcome.factorisations;
      run.maxIterationsInAStep = std::max(run.maxIterationsInAStep, outcome.iterations);
      report.iterations = outcome.iterations;
      report.factorisations = outcome.factorisations;
      report.rung = outcome.rung;
      report.certificate = outcome.certificate;
      if (!outcome.converged) {
        report.status = run.status = Status::failed;
        run.reason =
            "step " + std::to_string(n) + " at t = " + std::to_string(report.time) + " s: " + outcome.reason;
        return;
      }
      easy = outcome.iterations <= easyIterations ? easy + 1 : 0;
      last = iterate;
      for (size_t b = 0; b < model.bodies.size(); ++b) last.bodies[b].stress -= state.bodies[b].stress;
      addIncrement(iterate, model, state);
      state.time = report.time;
      measure(model, state, iterate, before, report);
      keepWorst(report.certificate, run.worst);
      run.steps = n;
    });
    if (run.status != Status::converged) break;
    observer(state, report);
  }
  return run;
}

}  // namespace mortier
