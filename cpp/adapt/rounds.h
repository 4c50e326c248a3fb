// A scene solved again and again, on meshes that are refined by the error of the round before and with steps
// to match, until the estimated error is what was asked for.
// With E the error of the meshes, with what its estimate does not see, over 0.75 of what is asked of it,
//
//   k = max(1, round(log E / log 4))   rounds are to come, each of which divides it by  min(E^(1/k), 8):
//
// equal reaches avoid the dear case, a mesh that misses by a little and is solved again at the same size.
// Where bodies flow a part of what is asked is that of the steps in time (0.2 of degree 1, 0.25 of degree 2);
// before the last round steps are as good as the meshes deserve. One round of refinement is made at least,
// which is to halve the error: on the first meshes an estimate is not trusted, and no rate is known. Where
// stresses are unbounded what it does not see is added before it is believed (adapt/adapted_meshes.h).
//
// Where refinement aims at a quantity J, the parts of its error by triangles, products of an error of u and
// one of the adjoint, go with the mesh like squares of errors in the energy norm, and take their place: E is
// the root of the error of J over what is asked of it. A proved one is believed in the first round, too.
//
// Where a bound is asked for and there is one, it has to be below what is asked for, too: what it is over the
// estimate, it is taken to be over that of the rounds to come.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "adapt/adapted_meshes.h"
#include "scene/resolve.h"

namespace mortier {

/// The error of a quantity, and where it comes from.
struct AimedError {
  std::string obstacle;       ///< why nothing is known of it
  double value = 0;           ///< of the quantity
  double error = 0;           ///< of the value
  bool proved = false;        ///< or an estimate
  std::vector<Vector> parts;  ///< of the error, by bodies and triangles, nearly
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
};

class Rounds {
 public:
  explicit Rounds(ResolvedScene scene);

  /// The scene of the round to come.
  [[nodiscard]] ResolvedScene scene() const;
  enum class Verdict { goOn, reached, notReached };
  /// \param seconds  wall time of all so far. Where it goes on, the meshes of the next round are made.
  Verdict judge(const RoundResult& result, double seconds);
  /// Why the accuracy is not reached.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Of the last round, relative, with what the estimate does not see of unbounded stresses.
  [[nodiscard]] double meshError() const { return aims() ? trusted_ * trusted_ : trusted_; }
  /// Doubts about the estimate beside those of plan/estimate_doubts.h.
  [[nodiscard]] std::vector<std::string> doubts() const;

 private:
  Verdict stop(const std::string& reason);
  [[nodiscard]] bool aims() const { return !description_.accuracy.quantity.empty(); }
  Verdict judgeAim(RoundResult result, double seconds);
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
  double trusted_ = 0;                                       ///< with what that does not see
  double least_;        ///< part of what is asked for that the estimate has to be below
  double bounded_ = 0;  ///< estimate when there last was a bound, which was too large
  int done_ = 0;
  int shortfalls_ = 0;
  std::string reason_;
};

}  // namespace mortier
