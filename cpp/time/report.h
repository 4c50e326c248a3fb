// What is reported of a whole run.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "solver/outcome.h"

namespace mortier {

/// The largest value of a run, and when it came first.
struct Peak {
  double value = 0;
  double time = 0;  ///< [s]
  void raise(double other, double when) {
    if (!(other > value)) return;
    value = other;
    time = when;
  }
};

/// The values of a quantity over a run, the initial state included, and when the extremes came first.
struct QuantityRange {
  double start = 0;
  double smallest = 0;
  double smallestTime = 0;  ///< [s]
  double largest = 0;
  double largestTime = 0;

  static QuantityRange from(double value, double time) { return {value, value, time, value, time}; }
  void add(double value, double time) {
    if (value < smallest) {
      smallest = value;
      smallestTime = time;
    }
    if (value > largest) {
      largest = value;
      largestTime = time;
    }
  }
};

/// Limits of small strains and rotations; the log and mortier check name larger ones.
constexpr double smallStrain = 0.05;
constexpr double smallRotation = 5 * M_PI / 180;

/// Of what a StepReport says of the state at its end.
struct Peaks {
  Peak vonMises, pressure, contactForce, displacement, motion, energy;
  Peak sliding;           ///< over the edges beside the node (contact/sliding.h)
  Peak strain, rotation;  ///< of bodies that contact follows [-, rad]
};

/// A step of which several solutions were found.
struct SeveralSolutions {
  int step = 0;
  double time = 0;                     ///< at its end [s]
  std::vector<ListedSolution> listed;  ///< the first one was taken
};

/// Where the boundaries of two bodies, as moved, cross each other (time/overlap_check.h).
struct BodyOverlap {
  double area = 0;                      ///< of the region; in space of the surface in the other body [m^2]
  double depth = 0;                     ///< largest distance to the other boundary there [m]
  SpacePoint place{0, 0, 0};            ///< of it [m]
  std::array<SpacePoint, 2> drawn{};    ///< the points of both boundaries as drawn [m]
  double time = 0;                      ///< [s]
  std::array<std::string, 2> bodies{};  ///< the one whose boundary is in the other first
  std::array<int, 2> labels{};          ///< there; 0 where it has none
  bool explained = true;
  /// Not explained, but less than a quarter of an element, no deeper than meshes would leave it if a row
  /// pressed there, or beside small sliding contact that presses: it does not end a step.
  bool shallow = false;
  std::string words;  ///< one line where it is not explained

  [[nodiscard]] bool refused() const { return !explained && !shallow; }
  /// "bodies a and b overlap by 0.1 at (0, 0)"
  [[nodiscard]] std::string text(int dimension) const;
};

struct RunReport {
  Status status = Status::converged;
  std::string reason;               ///< one line when the status is not converged
  std::string shortfall;            ///< why a complete run does not meet its tolerance; empty where it does
  std::optional<StuckPlace> stuck;  ///< of the step that failed, where that can be said
  int steps = 0;                    ///< completed
  int iterations = 0;
  int maxIterationsInAStep = 0;
  int factorisations = 0;
  int pilotIterations = 0;    ///< part of `iterations` that went into scales of the error
  int rejected = 0;           ///< attempts
  double timeError = 0;       ///< estimate of the largest error in time of any step, relative
  int guarded = 0;            ///< steps done again as two half steps of backward Euler
  double solveSeconds = 0;    ///< wall time of the march without its observer
  SpecialConditions special;  ///< of contact
  Certificate worst;          ///< the largest residuals of any step
  Peaks peaks;
  std::vector<QuantityRange> quantities;  ///< of the plan
  std::map<std::string, int> rungs;       ///< how many steps took which (StepReport::method)
  int ambiguousSteps = 0;                 ///< StepSolutions::ambiguous
  std::vector<SeveralSolutions> several;  ///< where they are looked for
  BodyOverlap overlap;                    ///< the deepest of any step; of the step that failed by one
};

}  // namespace mortier
