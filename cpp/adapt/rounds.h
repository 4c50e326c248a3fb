// A scene solved in rounds, on meshes that are refined by the error of the round before and with steps to
// match, until the estimated error is what was asked for.
// With E the error of the meshes, corrected for unbounded stresses, over 0.75 of what is asked of it,
//
//   k = max(1, round(log E / log 3))   rounds are to come, each of which divides it by  min(E^(1/k), 8):
//
// equal reductions avoid a mesh that misses the aim by a little and is solved once more at nearly its size.
// Fewer and larger reductions take more unknowns, as coarse meshes do not show where the error will be.
// Where bodies flow a part of what is asked is that of the steps in time (0.2 of degree 1, 0.25 of degree 2);
// before the last round steps are as good as the meshes deserve. One round of refinement is made at least,
// which divides the error by 1/0.7: on the first meshes an estimate is not trusted, and no rate is known.
// Where stresses are unbounded the estimate is corrected (adapt/adapted_meshes.h).
//
// Where refinement aims at a quantity J, the parts of its error by triangles, products of an error of u and
// one of the adjoint, go with the mesh like squares of errors in the energy norm, and take their place: E is
// the root of the error of J over what is asked of it. A proved one is believed in the first round, too.
//
// Where bodies overlap and no contact presses, elements there are cut to half of their size, until it is
// found or `mostMissed` rounds have not found it.
//
// Where a bound is asked for and there is one, it has to be below what is asked for, too: what it is over the
// estimate, it is taken to be over that of the rounds to come.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapt/adapted_meshes.h"
#include "scene/resolve.h"
#include "time/mesh_error.h"

namespace mortier {

/// The error of the meshes over a run, by triangles: meshes are refined by it. One mesh serves all times, so
/// that of each triangle is the largest that it had at any time.
class ErrorHistory {
 public:
  /// \param error  of the states of the run
  ErrorHistory(const Model& model, CurrentMeshError& error) : model_(model), error_(error) {}
  /// A state of the run, in their order; the initial state (step 0) begins anew.
  void add(const StepReport& report);

  /// By bodies and triangles [J/m]: the shares, whose sum is the largest error of any state, squared. 0 where
  /// that is rounding.
  [[nodiscard]] std::vector<Vector> errors() const;
  /// The largest energy of the recovered stress of any state [J/m].
  [[nodiscard]] double energy() const { return energy_; }

 private:
  const Model& model_;
  CurrentMeshError& error_;
  std::vector<Vector> largest_;  ///< of each triangle
  double largestSum_ = 0;
  double energy_ = 0;
  double displacement_ = 0;  ///< largest [m]
};

/// The error of a quantity, and where it comes from.
struct AimedError {
  std::string obstacle;       ///< why nothing is known of it
  double value = 0;           ///< of the quantity
  double error = 0;           ///< of the value
  bool proved = false;        ///< or an estimate
  std::vector<Vector> parts;  ///< of the error, by bodies and triangles, nearly
};

/// Bodies that overlap where no contact holds them apart: meshes are too coarse there to find it.
struct MissedContact {
  std::array<std::string, 2> bodies{};
  std::array<SpacePoint, 2> places{};  ///< on their boundaries as drawn [m]
  bool all = false;                    ///< no contact presses anywhere: estimates mean nothing
};

/// What a round has found.
struct RoundResult {
  std::vector<Vector> errors;  ///< of the meshes, squared, by bodies and triangles [J/m]
  double energy = 0;           ///< that they are relative to [J/m]
  double time = 0;             ///< error of the steps, relative
  double seconds = 0;          ///< wall time of the round
  /// The proved one, relative, if there is one: called where the estimate is small enough; empty where a
  /// bound is not wanted.
  std::function<std::optional<double>()> bound = {};
  std::optional<AimedError> aim = {};  ///< where refinement aims at a quantity
  std::optional<MissedContact> missed = {};
};

class Rounds {
 public:
  explicit Rounds(ResolvedScene scene);

  /// The scene of the round to come.
  [[nodiscard]] ResolvedScene scene() const;
  enum class Verdict { goOn, reached, notReached };
  /// \param seconds  wall time of all so far. Where another round follows, its meshes are made.
  Verdict judge(const RoundResult& result, double seconds);
  /// Why the accuracy is not reached.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Of the last round, relative, corrected for unbounded stresses.
  [[nodiscard]] double meshError() const { return aims() ? corrected_ * corrected_ : corrected_; }
  /// Doubts about the estimate beside those of plan/estimate_doubts.h.
  [[nodiscard]] std::vector<std::string> doubts() const;

 private:
  Verdict stop(const std::string& reason);
  /// How many unknowns the accuracy takes, as errors have fallen; "" where that is not known.
  [[nodiscard]] std::string unknownsToCome() const;
  [[nodiscard]] bool aims() const { return !description_.accuracy.quantity.empty(); }
  Verdict judgeAim(RoundResult result, double seconds);
  /// Whether this is the first round that has found contact.
  [[nodiscard]] bool isFirst() const { return done_ - missed_ == 1; }
  Verdict goOn(const RoundResult& result, double ofMeshes, double seconds);
  [[nodiscard]] double timeShare() const;
  /// \param cost  what a round on the present meshes takes [s]
  bool refine(const RoundResult& result, double aim, double cost, double seconds);

  SceneDescription description_;
  AdaptedMeshes meshes_;
  double timeTolerance_ = 0;                                 ///< of the round to come; 0: as the scene says
  double aim_ = 0;                                           ///< error that the meshes are to have in it
  double meshError_ = 0;                                     ///< as estimated in the last round, relative
  double lowest_ = std::numeric_limits<double>::infinity();  ///< of the rounds before
  double corrected_ = 0;                                     ///< corrected for unbounded stresses
  double least_;        ///< part of what is asked for that the estimate has to be below
  double bounded_ = 0;  ///< estimate when there last was a bound, which was too large
  int done_ = 0;
  int missed_ = 0;  ///< rounds in which no contact pressed, although bodies overlap
  int shortfalls_ = 0;
  std::vector<std::pair<int, double>> sizes_;  ///< unknowns and errors of the rounds that had contact
  std::string reason_;
};

}  // namespace mortier
