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
// Gauss-Seidel sweeps over sides and vertices in their order lower the energy of the difference; every
// iterate is in equilibrium, so the sweeps may stop at any time. Energy matrices only say where to go, and
// are held in single precision.
#pragma once

#include <vector>

#include "bound/side_tractions.h"

namespace mortier {

class Relaxation {
 public:
  /// \param compliances  by triangles (composite_triangle.h)  \param stress  to which the result shall be
  /// near
  /// \param moments  in equilibrium; changed by the sweeps
  Relaxation(const TriangleMesh& mesh, const Sides& sides, const std::vector<Eigen::Matrix3d>& compliances,
             const std::vector<Stress>& stress, const std::vector<Point>& forces,
             const std::vector<KnownTraction>& known, SideMoments& moments);

  /// Sweeps, and a direct solution where these are slow, or it costs little. \throws Interrupted
  void relax();
  /// \returns what it took from the energy [J/m]
  double sweep();
  /// The least energy, by a direct solution for all modes at once, after which no sweep follows: a few times
  /// a factorisation of the body, for where sweeps are slow, on triangles that are thin or of many sizes.
  /// \returns whether it could be found
  bool minimise();
  /// Integral of (s^ - s) : E^-1 (s^ - s) by triangles, s^ the stress of the moments [J/m].
  [[nodiscard]] Vector energies() const;

 private:
  /// What units of Phi (over a length), dPhi/dx and dPhi/dy at a vertex do to a side: to the moments of its
  /// first and of its second end.
  using Modes = Eigen::Matrix<double, 4, 3>;
  /// The same to the two sides of a triangle at the vertex, as it sees them; places are those of its moments.
  struct Effect {
    int triangle = 0;
    std::array<int, 2> places{};
    std::array<Modes, 2> modes;
  };
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
  /// Moments less those of the stress and of the load.
  [[nodiscard]] Moments differenceOf(int triangle, const CompositeTriangle& element) const;
  template <int columns>
  void change(int triangle, int place, const Eigen::Matrix<double, columns, 1>& by);
  /// Both return what they took from the energy, times scale_.
  double relaxSide(int side);
  double relaxVertex(int vertex);
  [[nodiscard]] Point alongOf(int side) const;
  [[nodiscard]] Modes modesOf(int side, int vertex, double length) const;
  /// Columns are the combinations that leave what is known of tractions as it is.
  [[nodiscard]] Matrix allowedModes(int vertex, double length) const;

  const TriangleMesh& mesh_;
  const Sides& sides_;
  const std::vector<Eigen::Matrix3d>& compliances_;
  const std::vector<Stress>& stress_;
  const std::vector<Point>& forces_;
  const std::vector<KnownTraction>& known_;
  SideMoments& moments_;
  double scale_ = 1;  ///< of the energies [Pa]
  std::vector<Eigen::Matrix<float, 12, 12>> energies_;
  std::vector<Moments> gradient_;  ///< of half the energy by the moments
  std::vector<Effect> effects_;    ///< of the vertex at hand
};

}  // namespace mortier
