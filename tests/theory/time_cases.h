// Loads of many kinds on the note's compression test, and what is true of them: for tests/theory and bench.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "theory/scenes.h"
#include "time/breaks.h"

namespace mortier::timecases {

constexpr double rounding = 1e-9;
enum class Size { small, note };

struct Load {
  const char* name;
  std::function<double(double)> value;  ///< traction on the top [Pa], t in [0, 1]
  int waves = 1;
};

inline std::vector<Load> loads() {
  constexpr double pi = std::numbers::pi;
  const auto waves = [](double mean, double size, int n) {
    return [=](double t) { return -(mean - size * std::cos(2 * pi * n * t)); };
  };
  return {{"ramp", [](double t) { return -10 * t; }},
          {"ramp and hold", [](double t) { return t < 0.5 ? -20 * t : -10; }},
          {"1 - exp", [](double t) { return -10 * (1 - std::exp(-5 * t)); }},
          {"t^4", [](double t) { return -10 * t * t * t * t; }},
          {"sine", [](double t) { return -10 * std::sin(pi * t); }},
          {"square wave", [](double t) { return t * 3.3 - std::floor(t * 3.3) < 0.5 ? -0.5 : -8.0; }, 4},
          {"saw", [](double t) { return -20 * std::abs(t * 2.5 - std::floor(t * 2.5 + 0.5)); }, 3},
          {"3 waves", waves(5, 4.9, 3), 3},
          {"8 low waves", waves(1.04, 0.96, 8), 8},
          {"20 waves", waves(5, 4.9, 20), 20},
          {"at t = 0", [](double t) { return -5 * (1 + t); }},
          {"onto yield", [](double t) { return t < 0.5    ? -16 * t
                                               : t < 0.75 ? -8 + 28 * (t - 0.5)
                                                          : -1; }}};
}

struct Case {
  std::string name;
  Load load;
  CouplingKind coupling = CouplingKind::mortar;
  Scheme scheme = Scheme::sdirk2;
  double young = 3e11;
  Size size = Size::small;
  std::vector<double> tolerances;
  Projection projection = Projection::elasticity;

  [[nodiscard]] std::shared_ptr<const Material> material() const {
    return perzynaMaterial({young, 0.3}, scenes::noteLaw(projection));
  }
  [[nodiscard]] Model model() const {
    const bool mortar = coupling == CouplingKind::mortar;
    const int upper = size == Size::note ? 6 : mortar ? 1 : 2;
    const int lower = size == Size::note ? 16 : mortar ? 2 : 3;
    const auto on = [f = load.value](double, double, double t) { return f(t); };
    Body above("upper", scenes::square(0, upper), material(),
               {{{scenes::left, 0, scenes::constant(0)}}, {{scenes::top, 1, on}}, {}});
    Body below("lower", scenes::square(-1, lower), material(),
               {{{scenes::left, 0, scenes::constant(0)}, {scenes::bottom, 1, scenes::constant(0)}}, {}, {}});
    return scenes::contactModel(std::move(above), std::move(below), coupling, scenes::upperBody);
  }
  [[nodiscard]] TimePlan plan(Scheme with, double tolerance) const {
    TimePlan plan{.end = 1, .steps = 0, .scheme = with, .tolerance = tolerance, .maxSteps = 20000};
    plan.data = {resolve(load.value, 0, 1)};
    plan.breaks = plan.data[0].breaks;
    return plan;
  }
  /// Jumps and kinks, and the end.
  [[nodiscard]] std::vector<double> stops() const {
    std::vector<double> stops = resolve(load.value, 0, 1).breaks;
    stops.push_back(1);
    return stops;
  }
};

inline std::vector<Case> cases(Size size) {
  std::vector<Case> cases;
  for (const Load& load : loads())
    for (const double young : {3e11, 3e2})
      for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation})
        for (const Scheme scheme : {Scheme::sdirk2, Scheme::backwardEuler}) {
          Case each{"", load, coupling, scheme, young, size, {1e-2, 1e-3}};
          if (scheme == Scheme::sdirk2) each.tolerances = {1e-2, 1e-3, 1e-4, 1e-5};
          each.name = std::string(load.name) + (young > 1e6 ? ", hard, " : ", soft, ") +
                      scenes::nameOf(coupling) + (scheme == Scheme::sdirk2 ? ", sdirk2" : ", Euler");
          cases.push_back(std::move(each));
        }
  return cases;
}

/// States over time, linear in the history: displacement and stress of all bodies.
class Truth {
 public:
  struct BodyNorms {
    double displacement = 0, stress = 0;
  };

  explicit Truth(const Case& which) : case_(which), model_(which.model()) {
    if (which.coupling == CouplingKind::mortar)
      integrate();
    else
      march();
    for (const BodyNorms& n : norms_) {
      displacement_ = std::max(displacement_, n.displacement);
      stress_ = std::max(stress_, n.stress);
    }
  }

  /// The larger relative error of displacement and stress.
  [[nodiscard]] double error(const State& state) const {
    const State exact = at(state.time);
    State difference = state;
    for (size_t b = 0; b < state.bodies.size(); ++b) {
      difference.bodies[b].displacement -= exact.bodies[b].displacement;
      difference.bodies[b].stress -= exact.bodies[b].stress;
    }
    const BodyNorms n = normsOf(difference);
    return std::max(n.displacement / displacement_, n.stress / stress_);
  }

 private:
  [[nodiscard]] BodyNorms normsOf(const State& state) const {
    BodyNorms n;
    for (size_t b = 0; b < state.bodies.size(); ++b) {
      const Body& body = model_.bodies[b];
      Matrix strain;
      body.material().elasticStrain(state.bodies[b].stress, strain);
      for (int i = 0; i < body.points(); ++i) {
        n.stress += body.weights()[i] * strain.col(i).dot(state.bodies[b].stress.col(i));
        for (const int v : body.mesh().triangles[i])
          n.displacement +=
              body.weights()[i] / 3 * state.bodies[b].displacement.segment<2>(2 * v).squaredNorm();
      }
    }
    return {std::sqrt(n.displacement), std::sqrt(n.stress)};
  }

  void keep(State state) {
    norms_.push_back(normsOf(state));
    states_.push_back(std::move(state));
  }

  /// Stress (0, f(t), 0); the flow is an integral.
  void integrate() {
    constexpr int parts = 40000;
    const auto material = case_.material();
    uniform_ = true;
    const auto rate = [&](double t) {
      Matrix s = fromCartesian(Eigen::Vector3d(0, case_.load.value(t), 0));
      Matrix g;
      material->viscoplasticRate(s, g);
      return Vector(g.col(0));
    };
    double from = 0;
    Vector flow = Vector::Zero(3);
    times_.push_back(0);
    flows_.push_back(flow);
    for (const double to : case_.stops()) {
      const int n = std::max(1, static_cast<int>(parts * (to - from)));
      const double h = (to - from) / n;
      Vector g0 = rate(std::nextafter(from, 2.0));
      for (int i = 1; i <= n; ++i) {
        const double t = i == n ? to : from + h * i;
        const Vector middle = rate(t - h / 2);
        const Vector g1 = rate(t - h * 1e-9);
        flow += h / 6 * (g0 + 4 * middle + g1);
        g0 = g1;
        times_.push_back(t);
        flows_.push_back(flow);
      }
      from = to;
    }
    for (size_t i = 0; i < times_.size(); i += 20) norms_.push_back(normsOf(at(times_[i])));
  }

  [[nodiscard]] size_t intervalAt(double t) const {
    const auto next = std::lower_bound(times_.begin() + 1, times_.end() - 1, t);
    return static_cast<size_t>(next - times_.begin()) - 1;
  }

  [[nodiscard]] State at(double t) const {
    const size_t i = intervalAt(t);
    const double h = times_[i + 1] - times_[i];
    const double part = h > 0 ? (t - times_[i]) / h : 1;
    if (!uniform_) return t == times_[i + 1] ? states_[i + 1] : after(i, t);
    const Vector flow = (1 - part) * flows_[i] + part * flows_[i + 1];
    const Matrix stress = fromCartesian(Eigen::Vector3d(0, case_.load.value(t), 0));
    Matrix elastic;
    case_.material()->elasticStrain(stress, elastic);
    const Vector strain = elastic.col(0) + flow;
    const double e11 = (strain[0] + strain[1]) / std::numbers::sqrt2;
    const double e22 = (strain[0] - strain[1]) / std::numbers::sqrt2;
    State state;
    state.time = t;
    for (const Body& body : model_.bodies) {
      Vector u(body.dofs());
      for (int v = 0; v < body.nodes(); ++v)
        u.segment<2>(2 * v) << e11 * body.mesh().vertices[v].x(), e22 * (body.mesh().vertices[v].y() + 1);
      state.bodies.push_back({u, stress.replicate(1, body.points()), {}});
    }
    return state;
  }

  /// One step from the last state before.
  [[nodiscard]] State after(size_t i, double t) const {
    State state = states_[i];
    if (t > state.time)
      (void)mortier::march(model_, state, {.end = t, .steps = 1, .scheme = Scheme::sdirk2}, {},
                           [](const State&, const StepReport&) {});
    return state;
  }

  void march() {
    constexpr double tolerance = 5e-7;
    State state = initialState(model_);
    TimePlan plan = case_.plan(Scheme::sdirk2, tolerance);
    plan.maxSteps = 1000000;
    const RunReport run =
        mortier::march(model_, state, plan, {}, [&](const State& now, const StepReport& report) {
          if (report.step == 0) {  // the run begins, or begins again
            times_.clear();
            states_.clear();
            norms_.clear();
          }
          times_.push_back(now.time);
          keep(now);
        });
    if (run.status != Status::converged) std::printf("reference: %s\n", run.reason.c_str());
  }

  Case case_;
  Model model_;
  bool uniform_ = false;
  std::vector<double> times_;
  std::vector<Vector> flows_;
  std::vector<State> states_;
  std::vector<BodyNorms> norms_;
  double displacement_ = 0;
  double stress_ = 0;
};

struct Outcome {
  int steps = 0, rejected = 0, solves = 0;
  double error = 0;     ///< largest of any step
  double estimate = 0;  ///< largest of any step, as the run says
  bool told = false;    ///< the run says that it could not meet the tolerance
  bool left = false;    ///< ended early: its error is larger than was asked, `error` at least
  std::string reason;
};

/// \param most  error at which the run is left
inline Outcome runOf(const Case& which, const Truth& truth, const TimePlan& plan, double most = INFINITY) {
  struct Left {};
  const Model model = which.model();
  State state = initialState(model);
  Outcome result;
  MarchMemory memory;
  try {
    (void)march(model, state, memory, plan, {}, [&](const State& now, const StepReport& report) {
      result.error = report.step == 0 ? 0 : std::max(result.error, truth.error(now));
      if (result.error > most) throw Left{};
    });
  } catch (const Left&) {
    result.left = true;
  }
  const RunReport& run = memory.run;
  result.steps = run.steps;
  result.rejected = run.rejected;
  result.solves = run.iterations;
  result.estimate = run.timeError;
  result.told = run.status != Status::converged || (plan.tolerance > 0 && run.timeError > plan.tolerance);
  result.reason = run.reason;
  if (run.status != Status::converged) result.error = std::max(result.error, 1.0);
  return result;
}

inline Outcome controlledRun(const Case& which, const Truth& truth, double tolerance) {
  return runOf(which, truth, which.plan(which.scheme, tolerance));
}

/// Linear solves of the cheapest run with equal steps that is as accurate, but for 7 % of the steps; 0 where
/// none takes fewer than `most`, a linear solve for each stage being the least that a step takes. `known` is
/// kept from call to call.
inline int bestOfEqual(const Case& which, const Truth& truth, double error, int most,
                       std::map<int, Outcome>& known) {
  constexpr double ratio = 1.15;
  const auto stages = static_cast<int>(tableau(which.scheme).stages.size());
  int best = 0;
  for (double next = 1; next * stages < (best > 0 ? best : most); next = std::max(next + 1, next * ratio)) {
    const int steps = static_cast<int>(next);
    const auto found = known.find(steps);
    if (found == known.end() || (found->second.left && found->second.error <= error))
      known[steps] = runOf(which, truth, {.end = 1, .steps = steps, .scheme = which.scheme}, error);
    const Outcome& run = known[steps];
    if (run.reason.empty() && !run.left && run.error <= error && run.solves < (best > 0 ? best : most))
      best = run.solves;
  }
  return best;
}

}  // namespace mortier::timecases
