// A guaranteed bound of the error in time of bodies that flow, on the meshes as they are. Of the law
//
//   eps' = E^-1 sigma' + G(sigma),   G = grad phi,  phi convex,   |G(s) - G(t)| <= |s - t|/(2 lambda),
//
// backward Euler's stresses s_n, linear between the steps, and their flow G(s_n) are
//
//   |s - sigma|^2/2 <= A,    ||eps_p,h - eps_p||^2 <= T_f A/lambda     (energy norm; norm in L^2)
//   A = sum over steps and points of  |T| k |d|^2 (1 - (1 - x)^3)/(12 lambda),    d = s_n - s_(n-1),
//   x = 2 lambda (G(s_n) - G(s_(n-1))) : d / |d|^2,  0 <= x <= 1,
//
// from the exact ones where contact is closed and open as in the run, T_f the time since the first flow. What
// contact does elsewhere costs a factor that is known, unless gaps close (docs/bounds.md has the proofs).
#pragma once

#include <exception>
#include <new>
#include <string>
#include <vector>

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// What goes wrong inside a bound is the reason why there is none: the result of the run stays.
inline std::string reasonOf(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ? "there is no memory for it" : error.what();
}

/// Why schemes have none but backward Euler.
constexpr const char* otherScheme = "steps are not those of backward Euler";

/// The sums of a run so far.
struct FlowBoundMemory {
  std::string obstacle;  ///< why there is no bound
  std::string moved;     ///< why contact is not closed and open as it was at the first flow
  double begin = 0;      ///< up to here nothing flows [s]
  double misfit = 0;     ///< A [J/m]
  double opening = 0;    ///< what contact that opens adds to it [J/m]
  double growth = 1;     ///< by which contact forces have grown at most; infinite where gaps become smaller
  double load = 0, loadOff = 0;      ///< largest nodal force, and how far any is from linear in a step [N/m]
  double motion = 0, motionOff = 0;  ///< the same of prescribed displacements [m]
};

struct FlowBound {
  std::string obstacle;   ///< why there is none
  double strain = 0;      ///< ||eps_p,h - eps_p|| where contact is closed and open as in the run [m]
  double stress = 0;      ///< |s - sigma|, the same [sqrt(J/m)]
  std::string moved;      ///< why contact is not always so in the run: then only what follows is a bound
  double factor = 1;      ///< of both, whatever contact does; infinite where there is no such bound
  double strainNorm = 0;  ///< ||eps_p,h|| [m]
  double stressNorm = 0;  ///< |s| [sqrt(J/m)]
  double data = 0;        ///< how far loads and supports are from linear in a step: rounding [-]
};

/// How the steps are made.
struct Steps {
  bool backwardEuler = true;
  bool chosen = false;  ///< by their error: none is cut
};

/// Sums up a run, step by step.
class FlowBoundRecord {
 public:
  /// Whether any body flows.
  static bool applies(const Model& model);
  /// \param memory  of an earlier part of the run, which ended in the state; kept up to date
  FlowBoundRecord(const Model& model, Steps steps, const State& state, FlowBoundMemory& memory);
  /// The state at the end of a step; that of step 0 begins anew.
  void add(const State& state, const StepReport& report);
  [[nodiscard]] FlowBound atEnd(const State& state) const;

 private:
  void addStep(const State& state, const StepReport& report);
  void begin(const State& state);
  void keep(const State& state);
  [[nodiscard]] double misfitTo(const State& state) const;
  void addContact(const State& state);
  void addData(double t);
  [[nodiscard]] std::string curvedIn(double t0, double t1) const;

  const Model& model_;
  Steps steps_;
  FlowBoundMemory& memory_;
  State before_;                     ///< without displacements
  std::vector<double> viscosities_;  ///< lambda, the least of each body [Pa s]
  double rounding_ = 0;              ///< a gap that coordinates leave [m]
};

}  // namespace mortier
