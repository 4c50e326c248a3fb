// The flow of Perzyna's law as the gradient of a convex function, where it is one:
//
//   G = grad phi,  phi = dist^2(., B)/(4 lambda) = lambda |G|^2,   G(s) = r(s)/(2 lambda),  r(s) = s - P_B s.
//
// D(s; t) = phi(s) - phi(t) - G(t) : (s - t) is what phi has at s beyond its tangent at t.
#pragma once

#include <string>
#include <vector>

#include "solver/model.h"

namespace mortier {

/// The least lambda of a body's laws; infinite where nothing flows [Pa s].
double leastViscosity(const Body& body);

class FlowPotential {
 public:
  /// The flow of which body has no potential; empty where all have.
  static std::string obstacleOf(const Model& model);

  /// \param parents  of each triangle, that of the body whose law it has; the first ones are the body's own
  FlowPotential(const Body& body, const std::vector<int>& parents);

  /// 1/(2 lambda) by triangles, 0 where nothing flows [1/(Pa s)]
  [[nodiscard]] const Vector& fluidity() const { return fluidity_; }
  /// So many triangles from one on, that rates() handles at once.
  [[nodiscard]] int together(int first) const;
  /// G of stresses at the triangles from one on (components x triangles), no more than together() [1/s].
  Matrix rates(int first, const Matrix& stress);

  /// Means over the same triangles, of stresses s that are linear in each of the three parts of a triangle,
  /// by their values at the vertices of the parts (9 columns a triangle), with G at t: no less than that of
  /// D(s; t), by its values at the vertices of small triangles, as it is convex in s,
  Vector excessAbove(int first, const Matrix& s, const Matrix& t, const Matrix& rates) {
    return means(true, first, s, t, rates);
  }
  /// and no more than that of (m/2) |s - t|^2 - D(s; t), m = 1/(2 lambda), convex too, by those at centroids.
  Vector squareBeyond(int first, const Matrix& s, const Matrix& t, const Matrix& rates) {
    return means(false, first, s, t, rates);
  }

 private:
  Vector means(bool atVertices, int first, const Matrix& s, const Matrix& t, const Matrix& rates);

  const Material& material_;
  const std::vector<int>& parents_;
  Matrix stress_, rate_;  ///< by points of the body
  Vector fluidity_;
};

/// What is made of D(s; t) at stresses s near one t, with the fluidity m = 1/(2 lambda): both free of
/// cancellation.
struct FlowExcess {
  const PointVector& t;
  const PointVector& rate;  ///< G(t)
  double fluidity = 0;

  /// D(s; t), convex in s, G its rate. It is (m/2) (|dr|^2 - 2 r(t) : dP) with d = s - t, r(s) - r(t) = dr,
  /// P_B s - P_B t = d - dr = dP.
  [[nodiscard]] double above(const PointVector& s, const PointVector& rate) const;
  /// (m/2) |s - t|^2 - D(s; t), convex too: (m/2) (|dP|^2 + 2 r(s) : dP).
  [[nodiscard]] double below(const PointVector& s, const PointVector& rate) const;
};

}  // namespace mortier
