// The law of one time step followed along its central path, for steps in which Newton's method finds no way:
// with x = P_B s / sigma_Y scaled by a^(1/2) (yield_domain.h) and the flow as a cone variable y = (y_0, y'),
//   E^-1 (s - s0) + flow(y) = B du - shift,   s = sigma_Y a^(-1/2) (x - b y'),   |x| <= 1,  |y'| <= y_0,
//   x o y = (y_0 + x.y', y' + y_0 x) = (mu, 0).
// For mu = 0 this is the law itself: y' = -m x, where m >= 0 and m (1 - |x|) = 0. For mu > 0 a point is never
// quite elastic and never quite on the yield surface, and mu falls to zero in some twenty iterations however
// stiff the law (primal-dual method with the direction of Alizadeh, Haeberly and Overton 1998, predictor and
// corrector of Mehrotra 1992). What is small is carried, never a difference: 1 - |x|^2 and y' + y_0 x.
#pragma once

#include <optional>

#include "material/material.h"

namespace mortier {

/// Some points of a body on their central path. Fields hold all points of the body.
class InteriorPath {
 public:
  virtual ~InteriorPath() = default;
  /// The strain (elastic and viscoplastic) that an overstress of one yield stress makes in the step [-].
  [[nodiscard]] virtual double flowAtTwiceYield() const = 0;
  /// Starts without stress, at the place of the central path where the flow is this large [-].
  virtual void begin(double flow) = 0;

  /// Sum of x o y over all points: mu times their number on the path, y as a strain [-].
  [[nodiscard]] virtual double complementarity() const = 0;
  [[nodiscard]] virtual int points() const = 0;

  /// Linearises at the iterate, whose strain (minus shift) is given: predictor and moduli of the stress. Aims
  /// at mu = `target`; `correct` takes in what was neglected by the last direction.
  virtual void linearise(const Matrix& strain, double target, bool correct, Linearisation& result) = 0;
  /// The direction in which a change of strain takes the points. \returns the largest step along it at which
  /// all of them stay inside their cones [-].
  virtual double direct(const Matrix& strainChange) = 0;
  /// Goes `step` along the last direction; `stress` follows.
  virtual void advance(double step, Matrix& stress) = 0;
};

/// A law with such a path, on three directions in which it is diagonal.
struct ConeLaw {
  Eigen::Array3d e;        ///< eigenvalues of the elasticity tensor [Pa]
  Eigen::Array3d a;        ///< of the yield function [-]
  Eigen::Array3d b;        ///< a over the weights of the projection's norm [-]
  double yieldStress = 0;  ///< sigma_Y [Pa]
  double theta = 0;        ///< weight/(2 lambda) [1/Pa]
  std::optional<double> bulk =
      {};  ///< where the directions are k, q, r of plane strain, that of the pressure [Pa]
};

std::unique_ptr<InteriorPath> conePath(const ConeLaw& law, const Matrix& stress0, std::vector<int> points);

/// For laws without a central path: their points take Newton's step. They limit no step; points() is 0.
std::unique_ptr<InteriorPath> newtonPath(const Material& material, const PathStart& start,
                                         std::vector<int> points);

}  // namespace mortier
