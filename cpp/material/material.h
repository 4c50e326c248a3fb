// What a body asks of a material: the stress law of one time step, linearised. A material knows no mesh.
#pragma once

#include <array>
#include <atomic>
#include <memory>

#include "base/types.h"

namespace mortier {

/// The step that the law is asked for. Columns are points.
struct MaterialStep {
  double weight = 0;      ///< time step times the scheme's diagonal coefficient [s]
  const Matrix& stress0;  ///< components x points, at the start of the step [Pa]
  const Matrix& strain;   ///< components x points, total strain increment minus the scheme's shift [-]
  bool anticipate =
      false;  ///< judge yielding by the stress plus a part of what the strain still asks for: slower where
              ///< bodies flow, but it holds where triangles sit on the yield surface
};

/// The law linearised at an iterate s of the stress: the next iterate is predictor + H^-1 B d.
struct Linearisation {
  Matrix predictor;  ///< components x points: s + H^-1 r [Pa]
  /// The block of H^-1 that acts on the strains of the plane [Pa], column major: 9 x points, or, where the moduli are
  /// symmetric, 6 x points for the lower triangle. The caller sizes it.
  Matrix moduli;
  /// The row of H^-1 of a fourth stress component [Pa], which is its column too: 4 x points. Empty where there are three.
  Matrix beyond = {};
  /// Points at which the moduli are those of elasticity: the caller sets 0, linearise() adds its own, from any
  /// thread. Points of a law that does not count are taken to flow.
  int elastic = 0;
  void addElastic(int points) { std::atomic_ref(elastic).fetch_add(points, std::memory_order_relaxed); }
};

/// All 3 x 3 moduli of a point, column major.
inline std::array<double, 9> moduliAt(const Matrix& moduli, int point) {
  const double* D = &moduli(0, point);
  if (moduli.rows() == 6) return {D[0], D[1], D[2], D[1], D[3], D[4], D[2], D[4], D[5]};
  return {D[0], D[1], D[2], D[3], D[4], D[5], D[6], D[7], D[8]};
}

/// Stores the moduli of a point, their lower triangle where that is all that is kept.
inline void storeModuli(const Eigen::Matrix3d& D, Matrix& moduli, int point) {
  if (moduli.rows() == 6)
    moduli.col(point) << D(0, 0), D(1, 0), D(2, 0), D(1, 1), D(2, 1), D(2, 2);
  else
    moduli.col(point) = Eigen::Map<const Eigen::VectorXd>(D.data(), 9);
}

using PointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;  ///< by components

/// H^-1 of a point times a strain.
inline PointVector stressOf(const Linearisation& law, const Eigen::Ref<const Vector>& strain, int point) {
  const std::array<double, 9> D = moduliAt(law.moduli, point);
  PointVector stress(strain.size());
  stress.head<3>() = Eigen::Map<const Eigen::Matrix3d>(D.data()) * strain.head<3>();
  if (strain.size() > 3) {
    stress.head<3>() += law.beyond.col(point).head<3>() * strain[3];
    stress[3] = law.beyond.col(point).dot(strain);
  }
  return stress;
}

class InteriorPath;

class Material {
 public:
  virtual ~Material() = default;
  /// Number of stress components: those of the plane, and one beyond it (H^-1 is symmetric then).
  [[nodiscard]] virtual int components() const = 0;
  /// The stress beyond the plane that elasticity asks for beside p, q, r, without strain beyond it [Pa].
  [[nodiscard]] virtual double outOfPlane(const Eigen::Vector3d& /*stress*/, int /*point*/) const {
    return 0;
  }
  /// Whether the moduli are symmetric whatever the stress.
  [[nodiscard]] virtual bool symmetricTangent() const = 0;
  /// Whether the law is linear: its moduli depend on nothing.
  [[nodiscard]] virtual bool linear() const = 0;
  /// The stress that residuals are measured against [Pa]; 0 where the law has none.
  [[nodiscard]] virtual double stressScale() const = 0;
  /// Viscous over elastic compliance, theta e, for a step of `weight` [-].
  [[nodiscard]] virtual double stiffness(double weight) const = 0;

  /// With r = strain - [E^-1 (s - s0) + weight G(s)] and H = E^-1 + weight G'(s), fills the columns [begin,
  /// end). \returns the largest |H^-1 r| over them [Pa].
  virtual double linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                           int end) const = 0;
  /// The law regularised for the penalty-duality method (solver/penalty_duality.cpp). With penalties
  /// w = penalty weight/(2 lambda) [1/Pa] per point and D^-1 = E^-1 + w, the moduli become D and the predictor
  /// s + relaxation (t - s), where t is on the law at the strain + D^-1 (s - t). Columns [begin, end).
  /// \returns the largest |t - s| over them [Pa].
  virtual double regularise(const MaterialStep& step, const Matrix& stress, const Vector& penalty,
                            double relaxation, Linearisation& result, int begin, int end) const = 0;
  /// The penalties [-] that suit a stress: nothing where it is elastic, the mean stiffness of the flow where it flows.
  virtual void choosePenalty(const Matrix& stress, Vector& penalty) const = 0;
  /// The path along which a hard step is solved; nothing where the law is linear. `stress0` must outlive it.
  [[nodiscard]] virtual std::unique_ptr<InteriorPath> interiorPath(double weight,
                                                                   const Matrix& stress0) const = 0;
  /// Viscoplastic strain rate G(s) [1/s], components x points.
  virtual void viscoplasticRate(const Matrix& stress, Matrix& rate) const = 0;
  /// E^-1 s [-], components x points.
  virtual void elasticStrain(const Matrix& stress, Matrix& strain) const = 0;
  /// Whether the stress of a point is on or beyond yield.
  [[nodiscard]] virtual bool flows(const Matrix& stress, int point) const = 0;
};

}  // namespace mortier
