// Finds the bound of steps and meshes together (total_bound.h) while a run goes on.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bound/admissible.h"
#include "bound/flow_bound.h"
#include "bound/run_misfit.h"
#include "bound/total_bound.h"

namespace mortier {

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
  std::vector<RunBody> bodies_;
  double extent_ = 0;                                           ///< the largest coordinate [m]
  double viscosity_ = std::numeric_limits<double>::infinity();  ///< lambda, the least [Pa s]
  std::optional<Moment> now_;
  TotalBoundMemory nextMemory_;
  std::optional<Moment> next_;
};

}  // namespace mortier
