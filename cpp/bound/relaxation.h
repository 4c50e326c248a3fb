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

#include "bound/composite_lanes.h"
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
  bool iterate(double part, int most);
  /// The least energy, by a direct solution for all modes at once. \returns whether it could be found
  bool minimise();
  /// Integral of (s^ - s) : E^-1 (s^ - s) by triangles, s^ the stress of the moments [J/m].
  [[nodiscard]] Vector energies() const;

 private:
  /// What units of Phi (over a length), dPhi/dx and dPhi/dy at a vertex do to a side: to the moments of its
  /// first and of its second end.
  using Modes = Eigen::Matrix<double, 4, 3>;
  /// What the modes of a triangle's sides and vertices do to its moments, and their numbers.
  struct TriangleModes {
    Eigen::Matrix<double, 12, Eigen::Dynamic, 0, 12, 12> effects;
    std::vector<int> numbers;
  };
  /// What a unit of the mean normal derivative does to the first end of a side; to the second the opposite.
  [[nodiscard]] Point normalMode(int side) const;
  [[nodiscard]] bool mayChange(int side) const;
  [[nodiscard]] TriangleModes modesOf(int triangle, const std::vector<int>& sideNumbers,
                                      const std::vector<int>& vertexNumbers,
                                      const std::vector<Matrix>& vertexModes) const;
  [[nodiscard]] double lengthAt(int vertex) const;
  [[nodiscard]] Modes seenBy(int triangle, int k, int vertex, double length) const;
  [[nodiscard]] CompositeTriangle elementOf(int triangle) const;
  [[nodiscard]] CompositeLanes elementsOf(const Batch& batch) const;
  /// Moments less those of the stress and of the load.
  [[nodiscard]] CompositeLanes::Twelve differencesOf(const Batch& batch,
                                                     const CompositeLanes& elements) const;
  [[nodiscard]] Moments differenceOf(int triangle, const CompositeTriangle& element) const;
  [[nodiscard]] Point alongOf(int side) const;
  [[nodiscard]] Modes modesOf(int side, int vertex, double length) const;
  /// Columns are the combinations that leave what is known of tractions as it is.
  [[nodiscard]] Matrix allowedModes(int vertex, double length) const;

  const TriangleMesh& mesh_;
  const Sides& sides_;
  const std::vector<Eigen::Matrix3d>& compliances_;
  const std::vector<Stress>& stress_;
  const std::vector<BodyLoad>& forces_;
  const std::vector<KnownTraction>& known_;
  SideMoments& moments_;
};

}  // namespace mortier
