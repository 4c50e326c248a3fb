// How accurate the stresses of a run are, by their own estimate (time/space_error.h).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bound/energy_bound.h"
#include "bound/flow_bound.h"
#include "bound/total_bound.h"
#include "report/manifest.h"
#include "report/run_facts.h"
#include "time/march.h"
#include "time/quantity_error.h"
#include "time/space_error.h"

namespace mortier {

/// Estimated errors of the stress, relative, in the energy norm [-]. They are those of the meshes; what the
/// steps in time add is not in them. Errors at the level of rounding are 0.
struct Accuracy {
  double all = 0;              ///< of the last state, over its own stress
  std::vector<double> bodies;  ///< the same of each body
  std::string worstBody;       ///< the body of the triangle with the largest error, and its centre [m]
  SpacePoint worst{0, 0, 0};
  double largest = 0;      ///< of any step at which it was estimated, over the largest stress of the run
  double largestTime = 0;  ///< [s]
  double time = 0;         ///< of the last state [s]
  std::optional<EnergyBound> bound = {};       ///< of the last state, where it is asked for
  std::optional<FlowBound> flow = {};          ///< of the steps up to it, where bodies flow
  std::optional<TotalBound> total = {};        ///< of steps and meshes together, where bodies flow
  std::optional<EnergyBound> step = {};        ///< of the meshes in the last step, where bodies flow
  std::vector<QuantityError> quantities = {};  ///< of the meshes; empty where the run is not complete
};

/// What a run came to.
struct Solved {
  State state;      ///< the last one that was reached
  StepReport last;  ///< of the step that led to it
  RunReport report;
  Accuracy accuracy;
  std::map<std::string, FileRecord> files = {};  ///< what was written
};

/// How a quantity changed from the round before that of the result to it.
struct RoundChange {
  double size = 0;  ///< absolute
  /// Whether a largest value has grown in two rounds, hardly less in the last one: at a place where stresses
  /// are unbounded it has no limit.
  bool grows = false;
};

/// None where the result is that of the first round, or there are none.
std::optional<RoundChange> changeInRounds(const RunFacts& facts, size_t quantity);

/// Of a quantity, because of the meshes: what refinement last changed where there are rounds.
QuantityError errorOf(const RunFacts& facts, const Accuracy& accuracy, size_t quantity);

/// The estimates of a run so far.
struct AccuracyMemory {
  double energy = 0;  ///< elastic energy when it was estimated last [J/m]
  double error = 0;   ///< largest integral of e : E^-1 e [J/m]
  double time = 0;    ///< and when [s]
  FlowBoundMemory flow;
  TotalBoundMemory total;
};

/// Estimates the last state, those that are kept, and on the way those at which the elastic energy has
/// doubled: so a run that ends unloaded has an estimate of its loaded states too.
class AccuracyRecord {
 public:
  /// \param memory  of an earlier part of the run; kept up to date.
  /// \param error  of the states of the run
  AccuracyRecord(const Model& model, CurrentSpaceError& error, AccuracyMemory& memory)
      : model_(model), error_(error), memory_(memory) {}
  /// Whether add() needs the state.
  [[nodiscard]] bool asks(const StepReport& report, bool kept) const;
  void add(const StepReport& report, bool kept);
  /// \param quantities  their errors; 0 where the error of the stress is at the level of rounding
  Accuracy atEnd(const Peaks& peaks, std::vector<QuantityError> quantities = {});

 private:
  const Model& model_;
  CurrentSpaceError& error_;
  AccuracyMemory& memory_;
};

}  // namespace mortier
