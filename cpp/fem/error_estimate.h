// How far the stress of a body is from the exact one, estimated from itself (Zienkiewicz and Zhu, Int. J.
// Numer. Methods Engrg. 33, 1992): stresses of triangles are best at their quadrature points, so a polynomial
// of the degree of the displacements, fitted to those around a vertex, is a better stress there. The estimate
// is the difference of the stress from the continuous field of these values. It has the error of the mesh,
// not that of the steps in time.
#pragma once

#include <array>
#include <vector>

#include "base/parallel.h"
#include "fem/body.h"

namespace mortier {

struct ErrorEstimate {
  Vector error;       ///< per element, integral of e : E^-1 e [J/m], e the estimated error of the stress
  double energy = 0;  ///< integral of s : E^-1 s of the recovered stress [J/m]
  /// In the energy norm; 0 without stress [-].
  [[nodiscard]] double relative() const;
};

/// Of a body in space (space_estimate.cpp). \param stress  components x points [Pa]
ErrorEstimate estimateInSpace(const Body& body, const Matrix& stress, Threads& threads);

/// ErrorEstimator::recovered of a body in space.
Matrix recoveredInSpace(const Body& body, const Matrix& stress, Threads& threads);

/// Estimates for one body, which must outlive it. Regions of the mesh are recovered one by one: stresses jump
/// between materials.
class ErrorEstimator {
 public:
  explicit ErrorEstimator(const Body& body, Threads& threads = Threads::none());
  /// \param stress  components x points [Pa].
  [[nodiscard]] ErrorEstimate operator()(const Matrix& stress, Threads& threads = Threads::none()) const;
  /// The recovered stress at the nodes of all elements, one after the other: components x (elements times
  /// nodes of each) [Pa].
  [[nodiscard]] Matrix recovered(const Matrix& stress, Threads& threads = Threads::none()) const;

 private:
  template <class Element>
  void recover(Threads& threads);
  template <class Element>
  [[nodiscard]] ErrorEstimate estimate(const Matrix& stress, Threads& threads) const;

  template <class Element>
  [[nodiscard]] Matrix recoveredStress(const Matrix& stress, Threads& threads) const;

  /// Of a fit, at a distance from its vertex over its size.
  struct Value {
    int fit = 0;
    Point at;
  };
  const Body& body_;
  std::vector<int> recoveredAt_;  ///< of each node of each triangle, among the recovered stresses
  /// Of quadratic displacements: each is the mean of two, at a middle of what the vertices beside it say. Of
  /// linear ones the recovered stresses are the first coefficients of the fits.
  std::vector<std::array<Value, 2>> values_;
  std::vector<size_t> first_{0};  ///< point of each fit
  std::vector<int> points_;       ///< of the stress
  std::vector<double> weights_;   ///< of each point in the coefficients of its fit
};

}  // namespace mortier
