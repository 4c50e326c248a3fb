// The interface of a body to its material: the stress law of one time step at its points, linearised. A
// material has no mesh and keeps no state. With the elasticity E and the viscoplastic rate G,
//   E^-1 (s - s0) + weight G(s, eps) = strain.
// Laws are written for one point (point_material.h); a body may have several (parts.h).
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "base/types.h"

namespace mortier {

/// The step that the law is asked for. Columns are points.
struct MaterialStep {
  double weight = 0;      ///< time step times the scheme's diagonal coefficient [s]
  const Matrix& stress0;  ///< components x points, at the start of the step [Pa]
  const Matrix& strain;   ///< components x points, total strain increment minus the scheme's shift [-]
  /// Judge yielding by the stress plus a part of the change that the strain still requires: Newton's method
  /// is slower where bodies flow, but converges where triangles are on the yield surface.
  bool anticipate = false;
  /// What `strain` is added to, to give the total strain eps; needed where the law depends on that [-].
  const Matrix* strain0 = nullptr;
};

/// Stress, and total strain where the law depends on that. Columns are points.
struct MaterialState {
  const Matrix& stress;
  const Matrix* strain = nullptr;
};

/// Where the path of a hard step begins: the members of MaterialStep.
struct PathStart {
  double weight = 0;
  const Matrix& stress0;
  const Matrix* strain0 = nullptr;
};

/// The law linearised at an iterate s of the stress: the next iterate is predictor + H^-1 B d.
struct Linearisation {
  Matrix predictor;  ///< components x points: s + H^-1 r [Pa]
  /// The block of H^-1 that acts on the strains of the plane [Pa], column major: 9 x points, or, where the
  /// moduli are symmetric, 6 x points for the lower triangle. In space those of six components: 36 or 21 x
  /// points.
  Matrix moduli;
  /// What a fourth stress component adds to H^-1 [Pa]: its row, and, where H^-1 is not symmetric, the first
  /// three of its column: 4 or 7 x points. Empty where there are three components. A fifth one adds the first
  /// three of its row, what is on the diagonal, and that of both: 9 x points. A seventh one in space adds its
  /// row: 7 x points.
  Matrix beyond = {};
  int elastic = 0;  ///< points at which the moduli are those of elasticity, as far as they were counted
};

/// What linearising a range of points returns beside the fields.
struct LawReport {
  double change = 0;  ///< the largest change of stress that the law requires [Pa]; NaN where any is
  int elastic = 0;    ///< points of the range if the moduli of all of them are those of elasticity, else 0
};

/// All 3 x 3 moduli of a point, column major.
inline std::array<double, 9> moduliAt(const Matrix& moduli, int point) {
  const double* D = &moduli(0, point);
  if (moduli.rows() == 6) return {D[0], D[1], D[2], D[1], D[3], D[4], D[2], D[4], D[5]};
  return {D[0], D[1], D[2], D[3], D[4], D[5], D[6], D[7], D[8]};
}

/// What the fourth component adds to them: its row and its column of H^-1, and where both meet [Pa].
struct BeyondModuli {
  std::array<double, 3> row, column;
  double corner = 0;
};
inline BeyondModuli beyondAt(const Matrix& beyond, int point) {
  const double* b = &beyond(0, point);
  const double* column = beyond.rows() == 7 ? b + 4 : b;
  return {{b[0], b[1], b[2]}, {column[0], column[1], column[2]}, b[3]};
}

/// H^-1 of a point in space.
inline Eigen::Matrix<double, 6, 6> spaceModuliAt(const Matrix& moduli, int point) {
  Eigen::Matrix<double, 6, 6> D;
  const double* entry = &moduli(0, point);
  const bool symmetric = moduli.rows() == 21;
  for (int j = 0; j < 6; ++j)
    for (int i = symmetric ? j : 0; i < 6; ++i) D(i, j) = *entry++;
  if (symmetric) D.triangularView<Eigen::StrictlyUpper>() = D.transpose();
  return D;
}

using PointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 7, 1>;  ///< by components

/// H^-1 of a point times a strain.
inline PointVector stressOf(const Linearisation& law, const Eigen::Ref<const Vector>& strain, int point) {
  PointVector stress(strain.size());
  if (strain.size() >= 6) {
    stress.head<6>() = spaceModuliAt(law.moduli, point) * strain.head<6>();
    if (strain.size() == 6) return stress;
    stress.head<6>() += law.beyond.col(point).head<6>() * strain[6];
    stress[6] = law.beyond.col(point).dot(strain);
    return stress;
  }
  const std::array<double, 9> D = moduliAt(law.moduli, point);
  stress.head<3>() = Eigen::Map<const Eigen::Matrix3d>(D.data()) * strain.head<3>();
  if (strain.size() > 3) {
    const auto beyond = law.beyond.col(point);
    const Eigen::Index column = beyond.size() == 7 ? 4 : 0;
    stress.head<3>() += beyond.segment<3>(column) * strain[3];
    stress[3] = beyond.head<4>().dot(strain.head<4>());
    if (strain.size() > 4) {
      stress.head<3>() += beyond.segment<3>(4) * strain[4];
      stress[3] += beyond[8] * strain[4];
      stress[4] = beyond.segment<3>(4).dot(strain.head<3>()) + beyond[8] * strain[3] + beyond[7] * strain[4];
    }
  }
  return stress;
}

/// What a law is, for log, summary and plan.
struct LawDescription {
  struct Parameter {
    std::string name;
    double value = 0;
    std::string unit;
  };
  std::string name;     ///< "elastic", "Perzyna"
  std::string variant;  ///< "frobenius"; may be empty
  std::vector<Parameter> parameters;
  bool flows = true;
  bool projects = false;  ///< it flows by (s - P s)/(2 viscosity), P a projection onto a convex set

  /// "Perzyna (frobenius)"
  [[nodiscard]] std::string text() const { return variant.empty() ? name : name + " (" + variant + ")"; }
};

class InteriorPath;

class Material {
 public:
  virtual ~Material() = default;
  /// One for each part of the body.
  [[nodiscard]] virtual std::vector<LawDescription> laws() const = 0;
  /// Number of stress components: those of the plane, one beyond it, and what a law remembers in the form of
  /// one: it does work on no strain of the body. In space six (fem/body_kernels.cpp).
  [[nodiscard]] virtual int components() const = 0;
  /// How many of them are those of the tensor.
  [[nodiscard]] virtual int tensorComponents() const { return components(); }
  /// The stress beyond the plane that elasticity has beside p, q, r, without strain beyond it [Pa].
  [[nodiscard]] virtual double outOfPlane(const Eigen::Vector3d& stress, int point) const = 0;
  /// Whether the moduli are symmetric whatever the stress.
  [[nodiscard]] virtual bool symmetricTangent() const = 0;
  /// Whether the law is linear: its moduli depend on nothing.
  [[nodiscard]] virtual bool linear() const = 0;
  /// Whether G depends on the total strain: then steps and states must have it.
  [[nodiscard]] virtual bool needsTotalStrain() const = 0;
  /// The stress that residuals are measured against [Pa]; 0 where the law has none.
  [[nodiscard]] virtual double stressScale() const = 0;
  /// Viscous over elastic compliance, theta e, for a step of `weight` [-].
  [[nodiscard]] virtual double stiffness(double weight) const = 0;
  /// Whether the stress of a point is on or beyond yield; where that depends on the total strain, which is
  /// not given, it may be.
  [[nodiscard]] virtual bool flows(const Matrix& stress, int point, const Matrix* strain = nullptr) const = 0;
  /// Whether it is linearised at the stress to which the strain leads (return mapping): Newton's method has
  /// no corner then at which it could turn in circles.
  [[nodiscard]] virtual bool usesReturnMapping() const { return linear(); }

  // Of the points [begin, end); what is filled is sized before.

  /// With r = strain - [E^-1 (s - s0) + weight G] and H = E^-1 + weight G', the predictor and the moduli.
  virtual LawReport linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result,
                              int begin, int end) const = 0;
  /// The law regularised for the penalty-duality method (solver/penalty_duality.cpp). With penalties
  /// w = penalty weight/(2 lambda) [1/Pa] per point and D^-1 = E^-1 + w, the moduli become D and the
  /// predictor s + relaxation (t - s), where t is on the law at the strain + D^-1 (s - t).
  virtual LawReport regularise(const MaterialStep& step, const Matrix& stress, const Vector& penalty,
                               double relaxation, Linearisation& result, int begin, int end) const = 0;
  virtual void choosePenalty(const Matrix& stress, Vector& penalty, int begin, int end) const = 0;
  virtual void viscoplasticRate(const MaterialState& state, Matrix& rate, int begin, int end) const = 0;
  virtual void elasticStrain(const Matrix& stress, Matrix& strain, int begin, int end) const = 0;
  /// The path along which `points` of a hard step are solved; what `start` refers to must outlive it.
  [[nodiscard]] virtual std::unique_ptr<InteriorPath> interiorPath(const PathStart& start,
                                                                   std::vector<int> points) const = 0;

  // Of all points.

  /// Room for the linearisation of so many points.
  [[nodiscard]] Linearisation room(int points) const;
  /// The penalties [-] that suit a stress: nothing where it is elastic, the mean stiffness of the flow where
  /// it flows.
  void choosePenalty(const Matrix& stress, Vector& penalty) const;
  /// Viscoplastic strain rate G [1/s], components x points, of stress and, where the law depends on it, total
  /// strain.
  void viscoplasticRate(const Matrix& stress, Matrix& rate, const Matrix* strain = nullptr) const;
  /// E^-1 s [-], components x points.
  void elasticStrain(const Matrix& stress, Matrix& strain) const;
  /// The path of all points; null where none has a central path. It keeps references to its arguments.
  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(double weight, const Matrix& stress0,
                                                           const Matrix* strain0 = nullptr) const;
};

}  // namespace mortier
