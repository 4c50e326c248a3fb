// Stresses in equilibrium at every point that are nearer to given ones: what may be added to tractions
// without disturbing their balance are those of Airy functions,
//
//   t = d/ds J grad Phi,   J = [0 1; -1 0],
//
// with Phi and grad Phi free at each vertex and the mean normal derivative at each side (Clough and Tocher's
// element). On a side from P to Q they change the moments by
//
//   b_P = J (mean - grad Phi(P)),   b_Q = J (grad Phi(Q) - mean),
//   mean = ((Phi(Q) - Phi(P))/L) tau + (mean normal derivative) n.
//
// Conjugate gradients lower the energy of the difference (airy_system.h); every iterate is in equilibrium, so
// they may stop at any time.
#pragma once

#include <vector>

#include "bound/side_tractions.h"

namespace mortier {

class Relaxation {
 public:
  /// \param compliances  by triangles (composite_triangle.h)  \param stress  to which the result shall be
  /// near
  /// \param moments  in equilibrium; changed
  Relaxation(const TriangleMesh& mesh, const Sides& sides, const std::vector<Eigen::Matrix3d>& compliances,
             const std::vector<Stress>& stress, const std::vector<BodyLoad>& forces,
             const std::vector<KnownTraction>& known, SideMoments& moments);

  /// Lowers the energy, by conjugate gradients or, where it costs little, to the least. \throws Interrupted
  void relax();
  /// By conjugate gradients, until more iterations would take no more than a part of it. \returns whether
  /// this is so after `most` of them
  bool iterate(double part, int most) { return solve(false, part, most); }
  /// The least energy, by a direct solution for all modes at once. \returns whether it could be found
  bool minimise() { return solve(true, 0, 1); }
  /// Integral of (s^ - s) : E^-1 (s^ - s) by triangles, s^ the stress of the moments [J/m].
  [[nodiscard]] Vector energies() const;

 private:
  bool solve(bool directly, double part, int most);
  [[nodiscard]] bool mayChange(int side) const;
  [[nodiscard]] CompositeTriangle elementOf(int triangle) const;
  /// Moments less those of the stress and of the load.
  [[nodiscard]] Moments differenceOf(int triangle, const CompositeTriangle& element) const;
  [[nodiscard]] Point alongOf(int side) const;
  /// Columns are the combinations of Phi and grad Phi that leave what is known of tractions as it is; or 0.
  [[nodiscard]] Eigen::Matrix3d allowedModes(int vertex) const;

  const TriangleMesh& mesh_;
  const Sides& sides_;
  const std::vector<Eigen::Matrix3d>& compliances_;
  const std::vector<Stress>& stress_;
  const std::vector<BodyLoad>& forces_;
  const std::vector<KnownTraction>& known_;
  SideMoments& moments_;
};

}  // namespace mortier
