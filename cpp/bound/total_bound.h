// A guaranteed bound of what steps and meshes together do to a run of bodies that flow, against the solution
// that is continuous in time and space. With u^ in K, (s^, p^) in S at the ends of all steps and linear in
// between, any rate G(t) of flow, s~ = E (eps(u^) - eps^_p) and r = s~ - s^
//
//   |s^ - sigma| <= Y = sqrt(2 A) + R,    lambda (integral of ||G(t) - eps_p'||^2) <= A + R Y,
//   A = |r(0)|^2/2 + integral of D(s^; t),    R = integral of |r'|
//
// where contact is closed and open as in the run; and with weights (error_course.h), in which contact forces
// grow, whatever contact does, unless gaps become smaller (docs/bounds.md has the proofs).
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bound/admissible.h"
#include "bound/flow_bound.h"
#include "bound/flowing_body.h"

namespace mortier {

/// The sums of a run so far.
struct TotalBoundMemory {
  std::string obstacle;  ///< why there is no bound
  std::string moved;     ///< why contact is not closed and open as in the run
  std::string closes;    ///< why there is no bound whatever contact does
  ErrorCourse fixed, any;
  std::vector<char> contact;   ///< of the pieces of contact lines: Touch
  std::vector<Matrix> stress;  ///< s~ by bodies
  EarlierContact earlier;      ///< by which u^ and p^ of the last step were made
};

struct TotalBound {
  std::string obstacle;  ///< why there is none
  std::string moved;     ///< why there is none of the two where contact is closed and open as in the run
  std::string closes;    ///< why there is none whatever contact does
  struct Errors {
    double strain = 0;  ///< ||eps_p,h - eps_p|| [m]
    double stress = 0;  ///< |s - sigma| [sqrt(J/m)]
  };
  Errors fixed, any;
  double lifted = 0;      ///< ||eps^_p - eps_p,h||, which is in both [m]
  double strainNorm = 0;  ///< ||eps_p,h|| [m]
  double stressNorm = 0;  ///< |s| [sqrt(J/m)]
  double data = 0;        ///< how far data are from linear within steps (flow_bound.h)
};

/// Sums up a run, step by step.
class TotalBoundRecord {
 public:
  /// \param state  the first one, or that which a stopped run has reached
  /// \param memory  of an earlier part of the run, which ended in the state; kept up to date
  TotalBoundRecord(const Model& model, const State& state, TotalBoundMemory& memory);
  /// Finds what the state at the end of a step adds, without changing the memory. \throws Interrupted
  void look(const State& state, int step);
  /// Adds it. \param obstacle  why there is no bound of the steps
  void add(const std::string& obstacle);
  /// \param steps  the bound of the steps alone, at the same state
  [[nodiscard]] TotalBound atEnd(const State& state, const FlowBound& steps) const;

 private:
  /// Of both ends of a piece of a contact line.
  struct Contact {
    std::array<double, 2> pressure{};  ///< p^ [Pa]
    std::array<double, 2> gap{};       ///< G of u^ [m]
    double length = 0;                 ///< [m]
  };
  /// All that is known of a time.
  struct Moment {
    State state;
    std::vector<RunFields> bodies;
    std::vector<Contact> contact;
    std::vector<Vector> pressures = {};  ///< coefficients of p^
    bool rest = false;                   ///< nothing acts, and nothing has been
  };

  [[nodiscard]] bool atRest(const State& state) const;
  [[nodiscard]] Moment rest(const State& state, TotalBoundMemory& memory) const;
  Moment begin(const State& state, TotalBoundMemory& memory) const;
  Moment step(const State& state, int number, TotalBoundMemory& memory) const;
  void goOn();
  [[nodiscard]] std::vector<Contact> contactOf(const Admissible& pair) const;
  [[nodiscard]] double growthTo(const std::vector<Contact>& contact, int number,
                                TotalBoundMemory& memory) const;
  void classify(const std::vector<Contact>& contact, int number, TotalBoundMemory& memory) const;
  [[nodiscard]] bool closes(const std::vector<Contact>& contact) const;
  [[nodiscard]] bool pressesAnew(const std::vector<Contact>& contact) const;

  const Model& model_;
  TotalBoundMemory& memory_;
  State first_;
  std::vector<FlowingBody> bodies_;
  double extent_ = 0;                                           ///< the largest coordinate [m]
  double viscosity_ = std::numeric_limits<double>::infinity();  ///< lambda, the least [Pa s]
  std::optional<Moment> now_;
  TotalBoundMemory nextMemory_;
  std::optional<Moment> next_;
};

}  // namespace mortier
