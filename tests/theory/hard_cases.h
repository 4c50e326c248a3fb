// Cases that stall, cycle or diverge in other codes: tests/theory/hard_cases_test.cpp asserts them,
// bench/hard_cases.cpp prints one row for each.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "theory/compression.h"

namespace mortier::hardcases {

// What every converged case must meet, in every step: what convergence demands whichever method found the
// step, and twice what is found of residuals that it does not look at.
constexpr double forceBalanceLimit = 1e-11;
constexpr double materialResidualLimit = 1e-10;
constexpr double complementarityLimit = 1e-15;
constexpr double gapOnActiveLimit = 1e-15;

struct HardCase {
  std::string name;
  std::function<Model()> model;
  TimePlan plan;
  bool slow = false;  ///< in the benchmark only
};

/// What the steps cost that took a method.
struct RungCost {
  int steps = 0;
  int iterations = 0;  ///< linear solves, those of the methods tried before included
  int most = 0;        ///< in one step

  void add(const RungCost& other) {
    steps += other.steps;
    iterations += other.iterations;
    most = std::max(most, other.most);
  }
};
using RungCosts = std::map<SolutionMethod, RungCost>;

struct HardResult {
  State state;
  RunReport report;
  RungCosts costs;
  double seconds = 0;

  /// The last resort of any step.
  [[nodiscard]] SolutionMethod method() const {
    return costs.empty() ? SolutionMethod::newton : costs.rbegin()->first;
  }
  [[nodiscard]] bool meetsLimits() const {
    return report.status == Status::converged && report.worst.forceBalance <= forceBalanceLimit &&
           report.worst.complementarity <= complementarityLimit &&
           report.worst.gapOnActive <= gapOnActiveLimit &&
           report.worst.materialResidual <= materialResidualLimit;
  }
};

inline HardResult solve(const Model& model, const TimePlan& plan) {
  const auto begin = std::chrono::steady_clock::now();
  HardResult result{initialState(model), {}, {}, 0};
  result.report = march(model, result.state, plan, {}, [&](const State&, const StepReport& report) {
    if (report.step > 0) result.costs[report.method].add({1, report.iterations, report.iterations});
  });
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

/// A few nonmortar segments on many: the nodes between see nothing of the contact.
inline void addCoarseNonmortar(std::vector<HardCase>& cases) {
  for (const auto& [coarse, fine] : {std::pair{4, 97}, std::pair{6, 101}, std::pair{1, 50}})
    for (const CouplingKind coupling : couplings)
      for (const int steps : {1, 5, 10, 20, 100}) {
        Compression scene;
        scene.upperCells = {coarse, coarse};
        scene.lowerCells = {fine, fine};
        scene.coupling = coupling;
        const std::string name = std::string("coarse nonmortar, ") + nameOf(coupling) + " " +
                                 std::to_string(coarse) + ":" + std::to_string(fine) + ", N ";
        cases.push_back({name + std::to_string(steps),
                         [scene] { return scene.model(); },
                         {.end = 1, .steps = steps},
                         true});
        scene.lowerCells.y = 12;
        cases.push_back({name + std::to_string(steps) + ", lower 12 cells high",
                         [scene] { return scene.model(); },
                         {.end = 1, .steps = steps},
                         steps == 100});
      }
}

inline void addData(std::vector<HardCase>& cases) {
  const auto add = [&](const std::string& what, Compression scene) {
    for (const CouplingKind coupling : couplings)
      for (const Projection projection : projections)
        for (const int steps : {10, 13}) {  // landing on first yield, missing it
          scene.coupling = coupling;
          scene.upperLaw.projection = projection;
          scene.lowerLaw.projection = projection;
          cases.push_back({"data, " + what + ", " + nameOf(coupling) + ", " + nameOf(projection) + ", N " +
                               std::to_string(steps),
                           [scene] { return scene.model(); },
                           {.end = 1, .steps = steps}});
        }
  };
  for (int decade = -6; decade <= 14; decade += 2) {
    Compression scene;
    const double stiffness = std::pow(10, decade);  // theta e for k = 0.1
    const double viscosity = 0.1 * scenes::noteElasticity.moduli()[0] / (2 * stiffness);
    scene.upperLaw.viscosity = scene.lowerLaw.viscosity = viscosity;
    add("theta e 1e" + std::to_string(decade), scene);
  }
  for (const double poisson : {-0.9, 0.0, 0.499}) {
    Compression scene;
    scene.upper.poisson = scene.lower.poisson = poisson;
    add("nu " + number(poisson), scene);
  }
  for (const double contrast : {1e6, 1e-6}) {
    Compression scene;
    scene.upper.young *= contrast;
    add("upper stiffer by " + number(contrast), scene);
  }
  for (const int decade : {12, 14}) {
    Compression scene;
    scene.upper.young = scene.lower.young = std::pow(10, decade) * 20 * 10 * (1 - 0.3);
    add("theta e 1e" + std::to_string(decade) + " by the modulus", scene);
  }
  for (const double contrast : {1e9, 1e-9}) {
    Compression scene;
    scene.upperLaw.viscosity *= contrast;
    add("upper more viscous by " + number(contrast), scene);
  }
  Compression lowerViscous;
  lowerViscous.lowerLaw.viscosity *= 1e9;
  add("lower more viscous by 1e+09", lowerViscous);
  Compression upperElastic;
  upperElastic.upperLaw.viscosity = 0;
  add("upper elastic", upperElastic);
  Compression lowerElastic;
  lowerElastic.lowerLaw.viscosity = 0;
  add("lower elastic", lowerElastic);
  Compression upperSoft;
  upperSoft.upperLaw.yieldStress = 0.01;
  add("upper yields at 1e-3 of the load", upperSoft);
  for (const double yieldStress : {1e-4, 1e-8, 1e-11}) {
    Compression flowing;
    flowing.upperLaw.yieldStress = flowing.lowerLaw.yieldStress = yieldStress;
    add("yield stress " + number(yieldStress), flowing);
  }
  Compression lowerSoft;
  lowerSoft.lowerLaw.yieldStress = 0.01;
  add("lower yields at 1e-3 of the load", lowerSoft);
}

inline void addGeometry(std::vector<HardCase>& cases) {
  const auto add = [&](const std::string& what, Compression scene, int steps) {
    for (const CouplingKind coupling : couplings)
      for (const int nonmortar : {scenes::upperBody, scenes::lowerBody}) {
        const auto addLaw = [&](const std::string& law, double viscosity, Projection projection) {
          scene.coupling = coupling;
          scene.nonmortar = nonmortar;
          scene.upperLaw = scene.lowerLaw = {viscosity, 1, projection};
          cases.push_back({"geometry, " + what + ", " + nameOf(coupling) + ", nonmortar " +
                               (nonmortar == scenes::upperBody ? "upper, " : "lower, ") + law,
                           [scene] { return scene.model(); },
                           {.end = 1, .steps = steps}});
        };
        addLaw("elastic", 0, Projection::elasticity);
        for (const Projection projection : projections) addLaw(nameOf(projection), 10, projection);
      }
  };
  Compression fine;
  fine.upperCells = {1, 1};
  fine.lowerCells = {100, 10};
  add("meshes 1:100", fine, 5);
  std::swap(fine.upperCells, fine.lowerCells);
  add("meshes 100:1", fine, 5);
  Compression nested;
  nested.upperCells = {6, 6};
  nested.lowerCells = {12, 12};
  add("nested", nested, 10);
  Compression nonNested;
  add("not nested", nonNested, 10);
  for (const double fraction : {1.0, 0.9, 0.5, 1e-1, 1e-2, 1e-3, 1e-6, 1e-9}) {
    Compression scene;
    scene.lowerCells = {7, 7};
    scene.lowerShift = 1 - fraction;
    add("overlap " + number(fraction), scene, 10);
  }
  Compression close;
  close.lowerCells = {6, 6};
  add("matching", close, 10);
  close.nodeShift = 1e-13;
  add("nodes 1e-13 apart", close, 10);
  Compression slivers;
  slivers.lowerCells = {7, 7};
  slivers.firstRowHeight = 1e-4;
  add("slivers of aspect 1e4", slivers, 10);
}

/// A block on a wider one, loaded on the left two fifths of its top: the right of the contact opens.
inline Model eccentric(Projection projection, bool heldByContactOnly) {
  using namespace scenes;
  const auto material = perzynaMaterial(noteElasticity, noteLaw(projection));
  const Function load = [](double x, double, double t) { return x < 0.36 ? -10 * t : 0; };
  TriangleMesh above = crissCrossMesh({{0, 0}, {1, 1}, 10, 10});
  TriangleMesh below = crissCrossMesh({{-1, -1}, {2, 0}, 24, 8});
  // Rollers on the contact line itself leave the rotation to the contact.
  Body upper("upper", std::move(above), material,
             {{{heldByContactOnly ? bottom : left, 0, constant(0)}}, {{top, 1, load}}, {}});
  Body lower("lower", std::move(below), material,
             {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody);
}

inline void addEccentric(std::vector<HardCase>& cases) {
  for (const bool alone : {false, true})
    for (const Projection projection : projections)
      for (const int steps : {20, 50})
        cases.push_back({std::string("eccentric, ") + (alone ? "rotation held by contact" : "rollers") +
                             ", " + nameOf(projection) + ", N " + std::to_string(steps),
                         [=] { return eccentric(projection, alone); },
                         {.end = 1, .steps = steps}});
}

inline bool has(const std::string& name, const char* part) {
  return name.find(part) != std::string::npos;
}

/// One of the full-height meshes that takes only a second or two.
inline bool isQuick(const std::string& name) {
  return has(name, "interpolation 1:50, N 20");
}

/// Cases that take seconds.
inline bool isSlow(const std::string& name) {
  return has(name, "eccentric, rollers, elasticity, N 50");
}

inline std::vector<HardCase> hardCases() {
  std::vector<HardCase> cases;
  addCoarseNonmortar(cases);
  addData(cases);
  addGeometry(cases);
  addEccentric(cases);
  for (HardCase& hard : cases) {
    hard.slow = (hard.slow && !isQuick(hard.name)) || isSlow(hard.name);
  }
  return cases;
}

}  // namespace mortier::hardcases
