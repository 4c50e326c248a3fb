// The error of the meshes in a state: that of the stress of each body (fem/error_estimate.h), and what
// contact leaves between its nodes. Recovery is blind to the latter: a soft body pressed by a wrong pressure
// has smooth stresses. With e the error, p and g the pressure and the gap, h at the meshes,
//
//   a(e, e) = (bodies) + <p - p_h, g - g_h>,       <p - p_h, g - g_h> <= <p_h - p, g_h>,
//
// so all that is left is the gap under pressure, and penetration without. Both are stresses of about E* g/h:
//
//   integral of E* g^2/h where p_h > 0, of E* (g_+)^2/h elsewhere,       1/E* = 1/E1 + 1/E2,
//
// h the edge of the nonmortar triangle, to whose error they are added; so is the jump of ties, in place of
// the gap; 1/(k h) of a layer of stiffness k is added to 1/E*. Where bodies have flowed, the gap closes under
// less stress: E* is then that of strain over stress, and the energy that of elasticity, K^2/E* in place of
// E*. In space the points of the common refinement take the place of the line. Data that the meshes do not
// resolve come on top (data_error.cpp; in the plane), and what the edges of the mortar side do not resolve of
// pressure and friction: to their body these are tractions (pressure_error.cpp).
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/adaptive_quadrature.h"
#include "fem/error_estimate.h"
#include "mesh/simplices.h"
#include "solver/model.h"
#include "solver/state.h"
#include "solver/step_system.h"

namespace mortier {

/// Estimates for a model, which must outlive it.
class MeshErrorEstimator {
 public:
  explicit MeshErrorEstimator(const Model& model, Threads& threads = Threads::none());
  /// By bodies.
  [[nodiscard]] std::vector<ErrorEstimate> operator()(const State& state,
                                                      Threads& threads = Threads::none()) const;
  /// The energy norm, squared, of the stresses of a body that the rounding of displacements makes: strains of
  /// `displacement` [m] times epsilon over the size of a triangle [J/m].
  [[nodiscard]] double roundingOf(size_t body, double displacement, Threads& threads) const;
  /// The products, in place of squares, of the errors of a state and those of another field, by bodies and
  /// elements. \param own  the estimates of the state. \param other  of which displacements leave gaps
  [[nodiscard]] std::vector<Vector> products(const State& state, const std::vector<ErrorEstimate>& own,
                                             const std::vector<Response>& other, Threads& threads) const;
  [[nodiscard]] const ErrorEstimator& ofBody(size_t body) const { return bodies_[body]; }

 private:
  void addSides(int body, int label);
  [[nodiscard]] int elementBehind(int body, int label, const std::array<int, 2>& edge) const;
  void addGaps(size_t interface, const State& state, std::vector<ErrorEstimate>& estimates) const;
  /// What ties leave of the jump between their rows.
  void addTies(const State& state, std::vector<ErrorEstimate>& estimates) const;
  /// The same of surfaces (surface_error.cpp).
  void addSurfaceGaps(size_t interface, const State& state, std::vector<ErrorEstimate>& estimates) const;
  /// 1/E, and strain over stress [1/Pa].
  struct Compliance {
    double elastic = 0;
    double all = 0;
    Compliance operator+(const Compliance& other) const { return {elastic + other.elastic, all + other.all}; }
  };
  [[nodiscard]] Compliance complianceOf(const State& state, int body, int triangle) const;

  // What data that are not resolved add (data_error.cpp).
  /// A given distance on a nonmortar edge: |w| |w'| of what is between the nodes [m^2], and the most.
  struct GivenGap {
    std::array<int, 2> edge;
    double square = 0;
    double most = 0;
  };
  void readData();
  void addData(const State& state, std::vector<ErrorEstimate>& estimates) const;
  [[nodiscard]] static bool hasVaryingData(const Body& body);
  /// An energy per depth [J/m] of the triangle behind a boundary edge.
  void addAtEdge(size_t b, size_t edge, double energy, bool needsTotalStrain, const State& state,
                 Vector& error) const;
  /// What the edges of a line do not resolve of tractions. \param tractions  by boundary edges [Pa]
  void addTractions(size_t b, const std::vector<std::pair<size_t, ResolvedEdge>>& tractions,
                    const State& state, Vector& error) const;
  void addEdgeData(size_t b, const State& state, Vector& error) const;
  void addTriangleData(size_t b, double t, bool steady, Vector& error) const;
  [[nodiscard]] std::vector<GivenGap> givenGaps(size_t k, double t) const;
  void addGivenGaps(size_t k, const State& state, std::vector<ErrorEstimate>& estimates) const;
  void addPressures(size_t k, const State& state, std::vector<ErrorEstimate>& estimates) const;

  const Model& model_;
  std::vector<ErrorEstimator> bodies_;
  std::map<std::array<int, 2>, ElementsBehind>
      behind_;                       ///< by body and label: of contact, and where data vary
  std::vector<Vector> compliances_;  ///< 1/E by points [1/Pa]
  std::vector<Vector> steadyData_;   ///< of each body, by triangles; empty where all are resolved
  std::vector<std::vector<GivenGap>> givenGaps_;  ///< of each interface; of those that do not move
};

/// The error of the state that a run is at: estimated when it is first asked for, once for all that ask.
class CurrentMeshError {
 public:
  using Estimates = std::shared_ptr<const std::vector<ErrorEstimate>>;

  /// \param model  must outlive it.
  /// \param threads  at most, that work on estimates
  explicit CurrentMeshError(const Model& model, int threads = 1) : model_(model), threads_(threads) {}
  /// \param state  must not change before it is the next one's turn.
  void moveTo(const State& state);
  [[nodiscard]] const State& state() const { return *state_; }
  /// By bodies.
  [[nodiscard]] Estimates estimates();
  /// The energy norm, squared, of what rounding makes of the stresses of a body (MeshErrorEstimator).
  [[nodiscard]] double roundingOf(size_t body, double displacement);
  /// MeshErrorEstimator::products
  [[nodiscard]] std::vector<Vector> products(const std::vector<Response>& other);
  /// ErrorEstimator::recovered of a body.
  [[nodiscard]] Matrix recovered(size_t body);

 private:
  [[nodiscard]] const MeshErrorEstimator& estimator(Threads& threads);

  const Model& model_;
  int threads_;
  std::optional<MeshErrorEstimator> estimator_;  ///< from the first estimate on
  const State* state_ = nullptr;
  Estimates estimates_;  ///< null before they are asked for
};

}  // namespace mortier
