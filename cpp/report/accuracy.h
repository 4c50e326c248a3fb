// How accurate the stresses of a run are, by their own estimate (time/mesh_error.h).
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bound/energy_bound.h"
#include "report/manifest.h"
#include "solver/model.h"
#include "time/march.h"
#include "time/mesh_error.h"
#include "time/quantity.h"
#include "time/quantity_error.h"

namespace mortier {

// Facts of the scene that reports show and the model does not have, so that reports do not depend on scenes.

/// "a, b, c"; `none` where there is none.
inline std::string joined(const std::set<std::string>& words, const std::string& none = "") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? none : text;
}

/// The laws of a body in a line, each once: "Perzyna (frobenius), elastic".
inline std::string lawsOf(const Body& body) {
  if (body.rigid()) return "rigid";
  std::set<std::string> names;
  for (const LawDescription& law : body.material().laws()) names.insert(law.text());
  return joined(names);
}

/// Of the rounds on ever better meshes by which an accuracy is reached.
struct RoundFacts {
  size_t elements = 0;
  int unknowns = 0;
  int steps = 0;
  double mesh = 0;  ///< estimated errors, relative
  double time = 0;
  double seconds = 0;                   ///< wall time
  std::vector<double> quantities = {};  ///< their values at the end
};

struct RunFacts {
  std::string scene;      ///< path of the scene
  std::string sceneText;  ///< the file as it was read
  std::string title;
  Units units;                        ///< of all numbers
  std::string plane = "stress";       ///< "stress" or "strain"
  std::vector<std::string> settings;  ///< --set, as given
  std::vector<std::string> variants;  ///< per interface: the word of the coupling
  std::vector<std::string> ties;      ///< the same per tie
  std::vector<std::string>
      choices;             ///< per interface: why its nonmortar side is that; empty where the scene says it
  std::string contact;     ///< all variants, each once; "none" without an interface
  std::string nonmortar;   ///< names of the nonmortar bodies; "none" without an interface
  std::string projection;  ///< all projections, each once; "none" where every body is elastic
  std::string scheme;
  int plannedSteps = 0;
  double tolerance = 0;           ///< of a step; 0: equal steps
  std::string start;              ///< the result with whose last state the run begins; empty: none
  double startTime = 0;           ///< [s]
  std::set<std::string> asDrawn;  ///< bodies that begin at rest beside it
  int threads = 1;
  int processes = 0;  ///< that factorise the bodies together; 0: none but this one
  SolverOptions solver;
  double accuracy = 0;               ///< asked for, relative, in the energy norm; 0: none
  std::string aim;                   ///< the quantity of which it is asked for; empty: the stress
  bool reached = false;              ///< that
  std::vector<RoundFacts> rounds;    ///< none where no accuracy is asked for
  size_t best = 0;                   ///< the round of the result, from 0
  std::vector<Quantity> quantities;  ///< that the scene asks for
  std::vector<std::string>
      doubts;           ///< where the estimate of the accuracy is known to be wrong, and by how much
  std::string driving;  ///< what drives the step that failed (plan/loads.h)
  std::vector<std::pair<std::string, std::string>> versions;  ///< of mortier and its libraries
};

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
  std::vector<QuantityError> quantities = {};  ///< of the meshes; empty where the run is not complete
};

/// An error over the exact norm, by the norm that was found; none where it is not below 100 %.
std::optional<double> overExact(double error, double norm);

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
};

/// Estimates the last state, those that are kept, and on the way those at which the elastic energy has
/// doubled: so a run that ends unloaded has an estimate of its loaded states too.
class AccuracyRecord {
 public:
  /// \param memory  of an earlier part of the run; kept up to date.
  /// \param error  of the states of the run
  AccuracyRecord(const Model& model, CurrentMeshError& error, AccuracyMemory& memory)
      : model_(model), error_(error), memory_(memory) {}
  /// Whether add() needs the state.
  [[nodiscard]] bool needs(const StepReport& report, bool kept) const;
  void add(const StepReport& report, bool kept);
  /// \param quantities  their errors; 0 where the error of the stress is at the level of rounding
  /// \param of, values  the quantities
  Accuracy atEnd(const Peaks& peaks, std::vector<QuantityError> quantities = {},
                 const std::vector<Quantity>& of = {}, const std::vector<double>& values = {});

 private:
  const Model& model_;
  CurrentMeshError& error_;
  AccuracyMemory& memory_;
};

}  // namespace mortier
