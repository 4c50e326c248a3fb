// Random runs with steps chosen by their error, and how far they are off: driven by tractions, supports,
// distances or temperatures, of every law, with and without friction, on a few triangles.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "material/anisotropy.h"
#include "material/norton.h"
#include "material/overstress.h"
#include "material/own_material.h"
#include "material/rate_law.h"
#include "material/viscoelastic.h"
#include "theory/scenes.h"
#include "time/breaks.h"
#include "time/error_norms.h"

namespace mortier::timeerrors {

using namespace scenes;

enum class Drive { traction, support, distance, temperature };
constexpr const char* drives[] = {"traction", "support", "distance", "temperature"};
constexpr const char* shapes[] = {"ramp",  "cubic",  "hold", "waves", "chirp",    "spike",
                                  "table", "reload", "jump", "kinks", "constant", "cycles"};
constexpr int cycles = 11;  // not among those of all drives
constexpr const char* laws[] = {"perzyna", "hardening", "norton",      "solid",      "Maxwell",
                                "power",   "own",       "own, strain", "orthotropic"};
constexpr const char* places[] = {"", " on half", " in waves", " times x t", " that moves"};

/// A datum f(t) on [0, 1], of size 1.
struct Shape {
  std::function<double(double)> value;
  std::vector<double> table = {};  ///< its times, where it is one
};

struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  double in(double low, double high) {
    // The distributions of the library differ from one to the other.
    return low + (high - low) * (static_cast<double>(engine() >> 1) / 0x1p31);
  }
  double power(double low, double high) { return std::exp(in(std::log(low), std::log(high))); }
  int below(int n) { return std::min(n - 1, static_cast<int>(in(0, n))); }
  std::mt19937 engine;
};

inline Shape shapeOf(int kind, Random& random) {
  constexpr double pi = std::numbers::pi;
  const double a = random.in(0.15, 0.85);
  const double b = random.in(0, 1);
  switch (kind) {
    case 0:
      return {[](double t) { return t; }};
    case 1:
      return {[b](double t) { return b * t + (1 - b) * t * t * t; }};
    case 2:
      return {[a](double t) { return std::min(t / a, 1.0); }};
    case 3: {
      const int n = 1 + random.below(6);
      return {[=](double t) { return 0.5 * t + 0.5 * std::sin(2 * pi * n * t) * b; }};
    }
    case 4: {
      const double n = random.in(3, 12);
      return {[=](double t) { return 0.5 * (1 - std::cos(2 * pi * n * t * t)); }};
    }
    case 5: {
      const double width = random.power(1e-4, 1e-2);
      return {[=](double t) { return 0.3 * t + 0.7 * std::exp(-std::pow((t - a) / width, 2)); }};
    }
    case 6: {
      Shape shape;
      std::vector<double> at{0};
      std::vector<double> of{0};
      const int n = 3 + random.below(8);
      for (int i = 1; i < n; ++i) at.push_back(random.in(0.02, 0.98));
      std::sort(at.begin(), at.end());
      for (int i = 1; i <= n; ++i) of.push_back(random.in(0, 1));
      at.push_back(1);
      shape.table = at;
      shape.value = [=](double t) {
        const auto next = std::upper_bound(at.begin() + 1, at.end() - 1, t) - at.begin();
        const double part = (t - at[next - 1]) / (at[next] - at[next - 1]);
        return of[next - 1] + part * (of[next] - of[next - 1]);
      };
      return shape;
    }
    case 7:  // to and fro: contact opens and closes again
      return {[=](double t) { return (0.4 + 0.6 * b) * std::sin(3 * pi * t) + 0.1 * t; }};
    case 8:
      return {[=](double t) { return t < a ? 0.2 + 0.3 * b : 1.0; }};
    case 9:
      return {[=](double t) { return std::abs(2 * std::fmod(3 * t + b, 1.0) - 1) * t; }};
    case cycles: {  // down and up again, ever faster; contact opens as soon as it has flowed
      const double rate = random.in(0, 9);
      return {[=](double t) { return 0.5 * (1 - std::cos(2 * pi * (1 + rate * t) * t)) - 0.2 * b * t; }};
    }
    default:
      return {[](double) { return 1.0; }};
  }
}

struct Case {
  std::string name;
  Drive drive = Drive::traction;
  int law = 0;
  bool rough = false;
  Scheme scheme = Scheme::sdirk2;
  double tolerance = 1e-3;
  Shape shape;
  double size = 1, stiffness = 100, viscosity = 1;
  int place = 0;   ///< of `places`
  int degree = 1;  ///< of both bodies
  Plane plane = Plane::stress;
  CouplingKind coupling = CouplingKind::mortar;
  Model model = {};
  TimePlan plan = {};
};

/// The sinh of the stress less what hardens with the strain.
template <bool strain>
struct OwnRate {
  static constexpr bool needsTotalStrain = strain;
  double rate = 0, spring = 0;
  template <class Number>
  Components<Number> rateOf(const Components<Number>& s, const Components<Number>& e) const {
    using std::sinh;
    const Number mean = (s.c11 + s.c22 + s.c33) / 3.0;
    const auto flow = [&](const Number& deviator, const Number& total) {
      if constexpr (strain)
        return Number(rate * sinh(deviator - spring * total));
      else
        return Number(rate * sinh(deviator));
    };
    return {flow(s.c11 - mean, e.c11), flow(s.c22 - mean, e.c22), flow(s.c12, e.c12),
            Number(rate * sinh(s.c33 - mean))};
  }
};

inline std::shared_ptr<const Material> materialOf(const Case& of, Random& random) {
  const Elasticity elasticity{of.stiffness, 0.3};
  const auto own = [&](std::shared_ptr<const RateLaw> law) {
    OwnLaw it;
    it.name = it.where = "own";
    it.law = std::move(law);
    return ownMaterial(elasticity, it, Plane::stress);
  };
  switch (of.law) {
    case 1:
    case 5: {
      Overstress law{.yieldStress = 1};
      law.setViscosity(of.viscosity);
      if (of.law == 5) {
        law.exponent = random.in(1.5, 4);
      } else {
        law.kinematicHardening = of.stiffness * random.power(1e-3, 0.3);
        if (random.below(2) == 0) std::swap(law.kinematicHardening, law.isotropicHardening);
      }
      return overstressMaterial(elasticity, law, of.plane);
    }
    case 2:
      return nortonMaterial(elasticity, {1, 1 / (3 * of.viscosity), std::floor(random.in(1, 5))}, of.plane);
    case 3:
    case 4: {
      Viscoelasticity law;
      law.relaxationTime = 3 * of.viscosity / of.stiffness;
      law.relaxedFraction = of.law == 3 ? random.in(0.05, 0.8) : 0;
      return viscoelasticMaterial(elasticity, law, of.plane);
    }
    case 6:
      return own(rateLaw(OwnRate<false>{1 / (3 * of.viscosity)}));
    case 7:
      return own(rateLaw(OwnRate<true>{1 / (3 * of.viscosity), of.stiffness * random.in(0.01, 0.3)}));
    case 8: {
      const double across = of.stiffness * random.in(0.3, 1);
      const Anisotropy wood = anisotropyOf(
          Orthotropy{{of.stiffness, across, across}, {0.3, 0.2, 0.2}, {0.35 * of.stiffness}}, of.plane);
      return anisotropicMaterial(wood, perzynaMaterial(stiffestOf(wood), {of.viscosity, 1}, of.plane));
    }
    default:
      return perzynaMaterial(elasticity, {of.viscosity, 1}, of.plane);
  }
}

/// \param recloses  bodies are moved to and fro, so that contact opens and closes again
/// \param part  of the data that acts
inline Case randomCase(unsigned seed, bool recloses = false, double part = 1) {
  Random random(seed * 7919 + 13);
  for (int i = 0; i < 5; ++i) (void)random.engine();
  Case of;
  of.drive = static_cast<Drive>(recloses ? 1 + seed % 2 : seed % 4);
  const int kind = recloses ? cycles : random.below(cycles);
  of.shape = shapeOf(kind, random);
  of.law = random.below(static_cast<int>(std::size(laws)));
  of.rough = random.below(4) == 0;
  of.scheme = random.below(3) == 0 ? Scheme::backwardEuler : Scheme::sdirk2;
  of.tolerance = of.scheme == Scheme::backwardEuler || of.rough ? 1e-2 : random.below(2) == 0 ? 1e-2 : 1e-3;
  of.coupling = couplings[random.below(2)];
  of.stiffness = random.power(10, 1e5);
  of.viscosity = random.power(0.1, 10);
  const bool own = of.law == 6 || of.law == 7;
  of.plane = !own && random.below(2) == 0 ? Plane::strain : Plane::stress;
  of.place = random.below(static_cast<int>(std::size(places)));
  of.degree = 1 + (random.below(4) == 0 ? 1 : 0);
  const auto material = materialOf(of, random);
  const double across = random.in(-0.5, 0.5);
  // Stresses of about the yield stress up to some times that, whatever drives.
  const double stress = random.power(0.8, 6);
  // What flows at that rate of strain has that overstress; less than that is elastic. sinh grows too fast
  // for more.
  const double strain = stress * std::max(1 / of.stiffness, own ? 0 : 1 / (3 * of.viscosity));
  of.size = part * (of.drive == Drive::traction      ? stress
                    : of.drive == Drive::temperature ? strain
                                                     : 2 * strain);
  const auto datum = [f = of.shape.value, size = of.size, place = of.place, across,
                      pressed = of.drive == Drive::traction](double x, double, double t) {
    const double where = place == 1   ? (x < 0.5 ? 1.0 : 0.2)
                         : place == 2 ? 1 + 0.8 * std::cos(40 * std::numbers::pi * x)
                         : place == 3 ? 0.3 + x * t
                         : place == 4 ? 0.2 + std::exp(-std::pow((x - t) / 0.2, 2))
                                      : 1 + across * x;
    return -size * where * (pressed ? 0.05 + std::max(0.0, f(t)) : f(t));
  };
  Conditions upper{{{left, 0, constant(0)}}, {}, {}};
  InterfaceOptions options;
  if (of.rough) options.friction.coefficient = random.in(0.1, 0.6);
  if (of.drive == Drive::traction)
    upper.tractions.push_back({top, 1, datum});
  else
    upper.displacements.push_back({top, 1, of.drive == Drive::support ? Function(datum) : constant(0)});
  if (of.drive == Drive::distance) options.gap = datum;
  if (of.drive == Drive::temperature)
    upper.temperature = [=](double x, double y, double t) { return -datum(x, y, t); };
  const TriangleMesh above = square(0, of.coupling == CouplingKind::mortar ? 1 : 2);
  if (upper.temperature) {
    const auto points = static_cast<Eigen::Index>(above.triangles.size()) * (of.degree == 1 ? 1 : 3);
    upper.expansion = Matrix::Zero(material->components(), points);
    upper.expansion.row(0).setConstant(std::numbers::sqrt2);  // of e11 = e22 = 1 per kelvin
    if (of.plane == Plane::strain) upper.expansion.row(3).setConstant(1);
  }
  Body first("upper", above, material, upper, of.degree);
  Body second("lower", square(-1, of.coupling == CouplingKind::mortar ? 2 : 3), material,
              {{{left, 0, constant(0)}, {bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}},
              of.degree);
  of.model = contactModel(std::move(first), std::move(second), of.coupling, upperBody, options);
  of.plan = {.end = 1, .steps = 0, .scheme = of.scheme, .tolerance = of.tolerance, .maxSteps = 30000};
  // Places whose courses are independent (scene/load_courses.h).
  for (int i = 0; i <= (of.place < 3 ? 0 : of.place == 3 ? 1 : 8); ++i) {
    const auto at = [=, x = of.place == 3 ? i : i / 8.0](double t) { return datum(x, 0, t); };
    of.plan.data.push_back(of.shape.table.empty() ? resolve(at, 0, 1, 100000)
                                                  : tableCourse(at, of.shape.table, 0, 1));
    std::vector<double>& breaks = of.plan.breaks;
    breaks.insert(breaks.end(), of.plan.data.back().breaks.begin(), of.plan.data.back().breaks.end());
  }
  std::sort(of.plan.breaks.begin(), of.plan.breaks.end());
  of.plan.breaks.erase(std::unique(of.plan.breaks.begin(), of.plan.breaks.end()), of.plan.breaks.end());
  of.name = std::string(drives[static_cast<int>(of.drive)]) + places[of.place] + ", " + shapes[kind] + ", " +
            laws[of.law] + (of.plane == Plane::strain ? ", strain" : "") +
            (of.degree == 2 ? ", degree 2" : "") + (of.rough ? ", rough" : "") +
            (of.scheme == Scheme::sdirk2 ? ", sdirk2" : ", Euler") + ", " + nameOf(of.coupling) + ", E " +
            std::to_string(of.stiffness) + ", viscosity " + std::to_string(of.viscosity);
  return of;
}

struct Outcome {
  RunReport run;
  double stress = 0, displacement = 0;  ///< largest error of any step over the tolerance
  double friction = 0;                  ///< of the energy that friction dissipates
  double at = 0;                        ///< time of the larger one
  /// Largest size of the run.
  ErrorNorms scale;
};

/// The run, and its error beside one of fine steps that end where those of the run do.
inline Outcome outcomeOf(const Case& of, int fine, const TimePlan& plan) {
  Outcome result;
  std::vector<State> states;
  State state = initialState(of.model);
  result.run = march(of.model, state, plan, {}, [&](const State& now, const StepReport& report) {
    if (report.step == 0) states.clear();
    states.push_back(now);
  });
  const ErrorMeasure measure(of.model);
  State exact = states.front();
  MarchMemory memory;
  // One run from interval to interval: what is there at t = 0 acts in the first step alone.
  const auto goOn = [&](State& from, double end, int steps) {
    const int before = std::min(1, memory.run.steps);
    memory.run.steps = before;
    memory.begin = from.time - before * (end - from.time) / steps;
    (void)march(of.model, from, memory, {.end = end, .steps = steps + before, .scheme = Scheme::sdirk2}, {},
                [&](const State& now, const StepReport&) {
                  result.scale = larger(result.scale, measure.sizeOf(now));
                });
  };
  std::vector<ErrorNorms> errors;
  for (const State& at : states) {
    if (at.time > exact.time) {
      const double part = at.time - exact.time;
      const int steps = std::max(part < 1e-9 ? 1 : 4, static_cast<int>(std::ceil(fine * part)));
      goOn(exact, at.time, steps);
    }
    std::vector<Response> off;
    for (size_t b = 0; b < at.bodies.size(); ++b)
      off.push_back({at.bodies[b].displacement - exact.bodies[b].displacement,
                     at.bodies[b].stress - exact.bodies[b].stress});
    errors.push_back(measure.sizeOf(off));
    errors.back().friction = std::abs(at.frictionWork - exact.frictionWork);
  }
  for (size_t i = 0; i < errors.size(); ++i) {
    const double s = errors[i].stress / result.scale.stress / of.tolerance;
    const double u = errors[i].displacement / result.scale.displacement / of.tolerance;
    if (std::max(s, u) > std::max(result.stress, result.displacement)) result.at = states[i].time;
    result.stress = std::max(result.stress, s);
    result.displacement = std::max(result.displacement, u);
    if (of.rough)
      result.friction = std::max(result.friction, errors[i].friction / result.scale.friction / of.tolerance);
  }
  return result;
}

}  // namespace mortier::timeerrors
