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

#include "material/norton.h"
#include "material/overstress.h"
#include "material/viscoelastic.h"
#include "theory/scenes.h"
#include "time/breaks.h"
#include "time/error_norms.h"

namespace mortier::timeerrors {

using namespace scenes;

enum class Drive { traction, support, distance, temperature };
constexpr const char* drives[] = {"traction", "support", "distance", "temperature"};
constexpr const char* shapes[] = {"ramp",  "cubic",  "hold", "waves", "chirp",   "spike",
                                  "table", "reload", "jump", "kinks", "constant"};
constexpr const char* laws[] = {"perzyna", "hardening", "norton", "solid"};

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
  int place = 0;  ///< where a traction acts: everywhere, on half of the edge, in waves
  CouplingKind coupling = CouplingKind::mortar;
  Model model = {};
  TimePlan plan = {};
};

inline std::shared_ptr<const Material> materialOf(const Case& of, Random& random) {
  const Elasticity elasticity{of.stiffness, 0.3};
  switch (of.law) {
    case 1: {
      Overstress law{.yieldStress = 1, .kinematicHardening = of.stiffness * random.power(1e-3, 0.3)};
      if (random.below(2) == 0) std::swap(law.kinematicHardening, law.isotropicHardening);
      law.setViscosity(of.viscosity);
      return overstressMaterial(elasticity, law, Plane::stress);
    }
    case 2:
      return nortonMaterial(elasticity, {1, 1 / (3 * of.viscosity), std::floor(random.in(1, 5))},
                            Plane::stress);
    case 3: {
      Viscoelasticity law;
      law.relaxationTime = 3 * of.viscosity / of.stiffness;
      law.relaxedFraction = random.in(0, 0.8);
      return viscoelasticMaterial(elasticity, law, Plane::stress);
    }
    default:
      return perzynaMaterial(elasticity, {of.viscosity, 1, Projection::frobenius});
  }
}

inline Case randomCase(unsigned seed) {
  Random random(seed * 7919 + 13);
  for (int i = 0; i < 5; ++i) (void)random.engine();
  Case of;
  of.drive = static_cast<Drive>(seed % 4);
  const int kind = random.below(static_cast<int>(std::size(shapes)));
  of.shape = shapeOf(kind, random);
  of.law = random.below(static_cast<int>(std::size(laws)));
  of.rough = random.below(4) == 0;
  of.scheme = random.below(3) == 0 ? Scheme::backwardEuler : Scheme::sdirk2;
  of.tolerance = of.scheme == Scheme::backwardEuler || of.rough ? 1e-2 : random.below(2) == 0 ? 1e-2 : 1e-3;
  of.coupling = couplings[random.below(2)];
  of.stiffness = random.power(10, 1e5);
  of.viscosity = random.power(0.1, 10);
  of.place = of.drive == Drive::traction ? random.below(4) : 0;
  const auto material = materialOf(of, random);
  const double across = random.in(-0.5, 0.5);
  // Stresses of about the yield stress up to some times that, whatever drives.
  const double stress = random.power(0.8, 6);
  // What flows at that rate of strain has that overstress; less than that is elastic.
  const double strain = std::max(stress / of.stiffness, stress / (3 * of.viscosity));
  const auto f = of.shape.value;
  Conditions upper{{{left, 0, constant(0)}}, {}, {}};
  InterfaceOptions options;
  if (of.rough) options.friction.coefficient = random.in(0.1, 0.6);
  std::function<double(double)> datum;
  switch (of.drive) {
    case Drive::traction: {
      of.size = stress;
      const int place = of.place;
      const double size = of.size;
      upper.tractions.push_back({top, 1, [=](double x, double, double t) {
                                   const double where = place == 1 ? (x < 0.5 ? 1.0 : 0.2)
                                                        : place == 2
                                                            ? 1 + 0.8 * std::cos(40 * std::numbers::pi * x)
                                                        : place == 3 ? 0.3 + x * t
                                                                     : 1.0;
                                   return -size * where * (0.05 + std::max(0.0, f(t)));
                                 }});
      datum = [=](double t) { return -size * (place == 3 ? 0.3 + t : 1.0) * (0.05 + std::max(0.0, f(t))); };
      break;
    }
    case Drive::support: {
      const double size = 2 * strain;
      upper.displacements.push_back(
          {top, 1, [=](double x, double, double t) { return -size * (1 + across * x) * f(t); }});
      datum = [=](double t) { return -size * f(t); };
      break;
    }
    case Drive::distance: {
      const double size = 2 * strain;
      upper.displacements.push_back({top, 1, constant(0)});
      options.gapInTime = [=](const Point& x, double t) { return -size * (1 + across * x.x()) * f(t); };
      options.gap = [g = options.gapInTime](const Point& x) { return g(x, 0); };
      datum = [=](double t) { return size * f(t); };
      break;
    }
    case Drive::temperature: {
      const double size = strain;
      upper.displacements.push_back({top, 1, constant(0)});
      upper.temperature = [=](double x, double, double t) { return size * (1 + across * x) * f(t); };
      datum = [=](double t) { return size * f(t); };
      break;
    }
  }
  const TriangleMesh above = square(0, of.coupling == CouplingKind::mortar ? 1 : 2);
  if (upper.temperature) {
    const auto points = static_cast<Eigen::Index>(above.triangles.size());
    upper.expansion = Matrix::Zero(3, points);
    upper.expansion.row(0).setConstant(std::numbers::sqrt2);  // of e11 = e22 = 1 per kelvin
  }
  Body first("upper", above, material, upper);
  Body second("lower", square(-1, of.coupling == CouplingKind::mortar ? 2 : 3), material,
              {{{left, 0, constant(0)}, {bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  of.model = contactModel(std::move(first), std::move(second), of.coupling, upperBody, options);
  of.plan = {.end = 1, .steps = 0, .scheme = of.scheme, .tolerance = of.tolerance, .maxSteps = 30000};
  of.plan.data = {of.shape.table.empty() ? resolve(datum, 0, 1, 100000)
                                         : tableCourse(datum, of.shape.table, 0, 1)};
  of.plan.breaks = of.plan.data[0].breaks;
  of.name = std::string(drives[seed % 4]) + ", " + shapes[kind] + ", " + laws[of.law] +
            (of.rough ? ", rough" : "") + (of.scheme == Scheme::sdirk2 ? ", sdirk2" : ", Euler") + ", " +
            nameOf(of.coupling) + ", E " + std::to_string(of.stiffness) + ", viscosity " +
            std::to_string(of.viscosity);
  return of;
}

struct Outcome {
  RunReport run;
  double stress = 0, displacement = 0;  ///< largest error of any step over the tolerance
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
  }
  for (size_t i = 0; i < errors.size(); ++i) {
    const double s = errors[i].stress / result.scale.stress / of.tolerance;
    const double u = errors[i].displacement / result.scale.displacement / of.tolerance;
    if (std::max(s, u) > std::max(result.stress, result.displacement)) result.at = states[i].time;
    result.stress = std::max(result.stress, s);
    result.displacement = std::max(result.displacement, u);
  }
  return result;
}

}  // namespace mortier::timeerrors
