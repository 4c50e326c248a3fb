#include "time/march.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <sstream>

#include "solver/step.h"
#include "time/measure.h"

namespace mortier {
namespace {

/// State at the start of a step in, state at its end out.
class March {
 public:
  March(const Model& model, State& state, Scheme scheme, const SolverOptions& options)
      : model_(model), state_(state), scheme_(scheme), solver_(model, options) {}

  /// Goes to time t1 in one step, or in as many smaller ones as it takes; the state is left at the last that
  /// converged.
  void advance(double t1, StepReport& report) {
    constexpr int smallest = 256;  // smallest part of a step that is tried
    const double begin = state_.time;
    const std::vector<std::vector<char>> before = solver_.start(state_).active;
    int parts = 1;
    int done = 0;
    while (done < parts) {
      const double time = done + 1 == parts ? t1 : begin + (t1 - begin) * (done + 1) / parts;
      const StepOutcome outcome = step(time);
      report.iterations += outcome.iterations;
      report.factorisations += outcome.factorisations;
      if (outcome.converged) report.certificate = worse(report.certificate, outcome.certificate);
      if (outcome.rung != "newton" && report.rung == "newton") report.rung = outcome.rung;
      if (outcome.converged) {
        ++done;
        continue;
      }
      if (outcome.unheld || parts == smallest) {
        report.status = outcome.unheld ? Status::unheld : Status::failed;
        std::ostringstream reason;
        reason << "step " << report.step << " at t = " << time << " s: " << outcome.reason;
        report.reason = reason.str();
        return;
      }
      parts *= 2;
      done *= 2;
      report.rung = "cut";
    }
    for (size_t k = 0; k < before.size(); ++k)
      for (size_t i = 0; i < before[k].size(); ++i) {
        report.active += active_[k][i];
        report.joined += active_[k][i] > before[k][i] ? 1 : 0;
        report.left += active_[k][i] < before[k][i] ? 1 : 0;
      }
    measure(model_, state_, report);
  }

 private:
  // An explicit or second-order scheme may overshoot into the elastic domain, where nothing brings the stress
  // back. When the flow turns round between the stages in more than a small share of the bodies, the step is
  // redone with backward Euler, which cannot.
  StepOutcome step(double t1) {
    constexpr double turned = 0.05;
    Iterate iterate;
    StepOutcome outcome = stages(tableau(scheme_), t1, iterate);
    if (scheme_ == Scheme::sdirk2 && outcome.converged && turnedShare() > turned) {
      last_.reset();
      StepOutcome again = stages(tableau(Scheme::backwardEuler), t1, iterate);
      again.iterations += outcome.iterations;
      again.factorisations += outcome.factorisations;
      outcome = std::move(again);
      last_.reset();
    }
    if (outcome.converged) commit(iterate, t1);
    return outcome;
  }

  /// Solves all stages; `iterate` is left at the last one.
  StepOutcome stages(const Tableau& scheme, double t1, Iterate& iterate) {
    const double k = t1 - state_.time;
    rates_.clear();
    if (scheme.explicitFirst) rates_.push_back(ratesOf(solver_.start(state_)));
    StepOutcome total;
    std::vector<Iterate> solutions;
    for (size_t i = 0; i < scheme.stages.size(); ++i) {
      const Stage& stage = scheme.stages[i];
      StepData data{state_.time + stage.time * k, stage.diagonal * k, {}};
      if (stage.time == 1) data.time = t1;
      shift_.clear();
      for (size_t b = 0; b < model_.bodies.size() && !stage.before.empty(); ++b) {
        shift_.push_back(Matrix::Zero(3, model_.bodies[b].points()));
        for (size_t j = 0; j < stage.before.size(); ++j)
          shift_[b] += stage.before[j] * k * rates_[j][b].topRows<3>();
      }
      data.shift = shift_;
      iterate = guess(i, k, scheme.stages.size());
      StepOutcome outcome = solver_.solve(state_, data, iterate);
      outcome.iterations += total.iterations;
      outcome.factorisations += total.factorisations;
      outcome.certificate = worse(outcome.certificate, total.certificate);
      if (total.rung != "newton") outcome.rung = total.rung;
      total = std::move(outcome);
      if (!total.converged) {
        last_.reset();
        return total;
      }
      if (scheme.stages.size() > 1) rates_.push_back(ratesOf(iterate));
      solutions.push_back(iterate);
    }
    remember(std::move(solutions), k);
    return total;
  }

  /// In steady flow the last increments are a good guess; a hard step before, or another step size, makes
  /// them a bad one.
  [[nodiscard]] Iterate guess(size_t stage, double k, size_t stageCount) const {
    constexpr double sameStep = 1e-9;
    Iterate iterate = solver_.start(state_);
    if (!last_ || last_->increments.size() != stageCount || std::abs(last_->timeStep - k) > sameStep * k)
      return iterate;
    for (size_t b = 0; b < model_.bodies.size(); ++b) {
      const BodyIterate& last = last_->increments[stage].bodies[b];
      iterate.bodies[b].increment = last.increment;
      iterate.bodies[b].small = last.small;
      iterate.bodies[b].stress += last.stress;
    }
    return iterate;
  }

  void remember(std::vector<Iterate> solutions, double k) {
    for (Iterate& solution : solutions)
      for (size_t b = 0; b < model_.bodies.size(); ++b) solution.bodies[b].stress -= state_.bodies[b].stress;
    last_ = LastStep{std::move(solutions), k};
  }

  [[nodiscard]] std::vector<Matrix> ratesOf(const Iterate& iterate) const {
    std::vector<Matrix> rates(model_.bodies.size());
    for (size_t b = 0; b < model_.bodies.size(); ++b)
      model_.bodies[b].material().viscoplasticRate(iterate.bodies[b].stress, rates[b]);
    return rates;
  }

  /// Share of |G_1| in triangles where G_1 : G_2 <= 0.
  [[nodiscard]] double turnedShare() const {
    double all = 0;
    double against = 0;
    for (size_t b = 0; b < model_.bodies.size(); ++b)
      for (int i = 0; i < model_.bodies[b].points(); ++i) {
        const double flow = model_.bodies[b].weights()[i] * rates_[0][b].col(i).norm();
        all += flow;
        if (rates_[0][b].col(i).dot(rates_[1][b].col(i)) <= 0) against += flow;
      }
    return all > 0 ? against / all : 0;
  }

  void commit(const Iterate& iterate, double t1) {
    for (size_t b = 0; b < model_.bodies.size(); ++b) {
      BodyState& body = state_.bodies[b];
      const BodyIterate& step = iterate.bodies[b];
      if (!model_.bodies[b].material().linear()) {
        // What the elastic part leaves of the strain of the step.
        Matrix elastic;
        model_.bodies[b].material().elasticStrain(step.stress - body.stress, elastic);
        body.viscoplasticStrain -= elastic;
        body.viscoplasticStrain.topRows<3>() += step.strain;
        if (!shift_.empty()) body.viscoplasticStrain.topRows<3>() += shift_[b];
      }
      body.displacement += step.increment + step.small;
      body.stress = step.stress;
    }
    state_.contactForce = iterate.contactForce;
    state_.time = t1;
    active_ = iterate.active;
  }

  /// The last step, as increments per stage.
  struct LastStep {
    std::vector<Iterate> increments;
    double timeStep = 0;
  };

  const Model& model_;
  State& state_;
  Scheme scheme_;
  StepSolver solver_;
  std::vector<std::vector<Matrix>> rates_;  ///< G of the stages of this step, per body
  std::vector<Matrix> shift_;               ///< of the last stage
  std::vector<std::vector<char>> active_;
  std::optional<LastStep> last_;
};

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

  std::optional<March> bodies;
  timed([&] { bodies.emplace(model, state, plan.scheme, options); });
  observer(state, StepReport{});
  const double begin = state.time;
  for (int n = 1; n <= plan.steps; ++n) {
    StepReport report;
    report.step = n;
    report.time = begin + (plan.end - begin) * n / plan.steps;
    report.timeStep = report.time - state.time;
    timed([&] { bodies->advance(report.time, report); });
    run.iterations += report.iterations;
    run.factorisations += report.factorisations;
    run.maxIterationsInAStep = std::max(run.maxIterationsInAStep, report.iterations);
    if (report.status != Status::converged) {
      run.status = report.status;
      run.reason = report.reason;
      break;
    }
    run.steps = n;
    run.worst = worse(run.worst, report.certificate);
    observer(state, report);
  }
  return run;
}

}  // namespace mortier
