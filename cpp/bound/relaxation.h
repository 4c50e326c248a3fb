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
// Conjugate gradients lower the energy of the difference (AirySystem); every iterate is in equilibrium, so
// they may stop at any time.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/sparse.h"
#include "bound/side_tractions.h"
#include "linear/condensing_solver.h"

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

// The energy of what Airy functions add to a stress,
//
//   E(x) = E(0) - 2 b'x + x'K x,
//
// x their modes: value and gradient at each vertex, the mean normal derivative at each side. With
// K = D + L + L', D the blocks of vertices and the diagonal of sides, vertices before sides, conjugate
// gradients preconditioned by symmetric Gauss-Seidel, (D + L) D^-1 (D + L'), work with
//
//   (D + L)^-1 K (D + L')^-1 p = t + (D + L)^-1 (p - D t),      t = (D + L')^-1 p,
//
// which reads K once an iteration (Eisenstat, SIAM J. Sci. Stat. Comput. 2 (1981)). E falls in each. Modes of
// thin triangles hang together so stiffly that sweeps over them one by one are slow: they are one block of D,
// the last, which is factorised.

class AirySystem {
 public:
  /// \param thin  triangles whose modes are one block
  AirySystem(const TriangleMesh& mesh, const Sides& sides, const std::vector<int>& thin);

  /// Adds a triangle: \param K, b  by its modes, those of sides with the normals of `sides`; rows and columns
  /// of modes that are not allowed are 0. \param energy  of E(0)
  void add(const std::array<int, 3>& triangle, const std::array<int, 3>& sidesOf, const MomentMatrix& K,
           const AiryModes& b, double energy);

  /// \pre all triangles have been added \returns whether the block could be factorised
  bool factorise();
  /// Lowers E until what more iterations could take, as their gains fade, is no more than a part of it.
  /// \returns whether it is after `most` of them \throws Interrupted
  bool solve(double part, int most);
  [[nodiscard]] int iterations() const { return iterations_; }
  [[nodiscard]] Eigen::Vector3d atVertex(int vertex) const { return x_.segment<3>(stride * vertex); }
  [[nodiscard]] double atSide(int side) const { return x_[firstSide_ + side]; }

 private:
  /// Modes of vertices are held with a 0 behind them, and what multiplies them, too.
  static constexpr int stride = 4;
  using Block = Eigen::Matrix<double, stride, 3>;
  /// The coupling of a side: with its two ends, the lower number first, and the vertices opposite; of these
  /// ends with each other; with sides of greater number.
  struct Coupling {
    std::array<int, 4> vertices, others;
    Block ends = Block::Zero();
    Eigen::Matrix4d withVertices = Eigen::Matrix4d::Zero();  ///< columns
    Eigen::Vector4d withOthers = Eigen::Vector4d::Zero();
    double own = 0;
  };
  void addToSweeps(const std::array<int, 3>& triangle, const std::array<int, 3>& sidesOf,
                   const MomentMatrix& K);
  static auto at(Vector& f, int vertex) { return f.segment<stride>(stride * vertex); }
  void solveBlock(Vector& f) const;
  void forward(Vector& f) const;   ///< f becomes (D + L)^-1 f
  void backward(Vector& f) const;  ///< f becomes (D + L')^-1 f
  void multiplyDiagonal(const Vector& f, Vector& result) const;
  void invertDiagonal();

  int vertices_, firstSide_;
  std::vector<Coupling> sides_;
  std::vector<int> sidesFrom_;  ///< the sides of which a vertex is the lower end: those from here on
  std::vector<Block> diagonal_, inverse_;
  std::vector<char> joined_;  ///< by modes, whether they are in the block; empty where none is
  std::vector<int> inBlock_;  ///< modes of its equations: those that are allowed
  using Entry = Eigen::Triplet<double>;
  std::vector<Entry> ofBlock_;         ///< to be assembled
  std::vector<Entry> toBlock_;         ///< rows are modes of the block, columns others
  Eigen::SparseMatrix<double> block_;  ///< its lower triangle
  std::unique_ptr<CondensingSolver> blockSolver_;
  Vector b_, x_;
  double energy_ = 0;
  int iterations_ = 0;
};

}  // namespace mortier
