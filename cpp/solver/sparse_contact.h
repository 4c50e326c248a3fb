// All bodies and their contact in one sparse matrix: for lines so long that matrices over all contact
// conditions are too large. For a set A of closed conditions and a right-hand side F,
//   K d + C' p = F,   s = s0 - C d,   s_A = 0,   p = 0 off A.
// Rows of C may be long (those of mortar contact fall off by a quarter from node to node), those of B = T C,
// T the mass of the row functions, are not. With w = C d as a further unknown and p = T' q,
//   K d + B' q = F,   B d - T w = 0,   w_A = s0_A,   (T' q)_i = 0 off A:
// a penalty on the second equation leaves a matrix of d and w that is positive definite,
//   H = K + sum_i rho_i E_i' E_i,   E = [B  -T],   rows and columns of w_A left out,
// with small fronts however long the line; its pattern does not depend on A. Multipliers make q exact
// (Hestenes and Powell 1969), and by the residuals of the true equations also what rounding leaves in d.
#pragma once

#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "linear/condensing_solver.h"
#include "solver/complementarity.h"
#include "solver/condensed_body.h"

namespace mortier {

class SparseContact {
 public:
  /// \param firstRow  of each interface among the conditions, and their number at the end. No interface has
  /// friction. The threads must outlive this.
  SparseContact(const Model& model, const std::vector<CondensedBody>& bodies,
                const std::vector<int>& firstRow, LinearEngine engine, Threads& threads);

  /// Takes the tangents of the bodies.
  void take(const std::vector<CondensedBody>& bodies);
  [[nodiscard]] bool taken() const { return !K_.empty(); }
  /// Factors of H for a set of closed conditions, unless they are there. \returns false where it is singular.
  bool factorise(const std::vector<char>& active);
  /// Uses CHOLMOD or UMFPACK from now on.
  void useSuiteSparse();

  struct Solution {
    Vector motion;           ///< d without the rigid motions that the springs resist, by equations
    Vector rigid;            ///< these
    Vector change;           ///< dp, of closed conditions and of those that are not: p = 0 there
    double forceNoise = 0;   ///< the last correction of it
    double motionNoise = 0;  ///< and of C d
  };
  /// On the set that was factorised. \param force  F - C' p0. \param anchors  where the springs on rigid
  /// motions pull to. \param exact  to rounding, or only so far that signs are known.
  [[nodiscard]] Solution solve(const Vector& force, const Vector& p0, const Vector& slack,
                               const Vector& anchors, bool exact) const;

  /// C: conditions x equations of all bodies.
  [[nodiscard]] const Eigen::SparseMatrix<double, Eigen::RowMajor>& C() const { return C_; }
  /// Compliance that each condition has by the nodes that it acts on, without their neighbours.
  [[nodiscard]] const Vector& compliance() const { return compliance_; }
  /// First equation of each body, and their number at the end.
  [[nodiscard]] const std::vector<int>& firstEquation() const { return first_; }

  // A body that contact alone holds gets a weak spring on as many contact dofs as it has rigid motions: the
  // proximal term of contact_sets.h.

  /// Motion of the springs under the rigid motions z of the bodies: springs x rigid motions, invertible.
  [[nodiscard]] const Matrix& springMotions() const { return springMotions_; }
  /// Their stiffness over that of the dofs they are on [-].
  void setSprings(double weight);
  /// The softest dof that carries a spring, as a stiffness.
  [[nodiscard]] double stiffnessAtSprings() const;

  [[nodiscard]] bool symmetric() const { return pattern_.symmetric; }
  [[nodiscard]] int factorisations() const { return factorisations_; }

 private:
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  void findRows(const Model& model, const std::vector<CondensedBody>& bodies,
                const std::vector<int>& firstRow);
  void findSprings(const Model& model, const std::vector<CondensedBody>& bodies);
  void findPattern();
  [[nodiscard]] int entry(int row, int column) const;
  template <class Visit>
  void forEachTangentEntry(Visit visit) const;
  template <class Visit>
  void forEachPair(Visit visit) const;
  [[nodiscard]] Vector stiffnessTimes(const Vector& d) const;

  LinearEngine engine_;
  Threads& threads_;
  std::vector<int> first_{0};
  std::vector<const SparsePattern*> patterns_;  ///< of the bodies
  Rows C_;
  Rows T_;
  Rows E_;  ///< conditions x (equations, then w)
  std::vector<int> springs_;
  Matrix springMotions_;
  Matrix motions_;        ///< rigid motions by the equations of all bodies: their rounding is kept out of K d
  Matrix motionsInRows_;  ///< B times them
  Eigen::PartialPivLU<Matrix> toMotions_;
  SparsePattern pattern_;                      ///< of H
  std::vector<int> tangentEntry_;              ///< place of each in H, in the order of forEachTangentEntry
  std::vector<int> pairEntry_;                 ///< of the products in E' E, in the order of forEachPair
  std::vector<const std::vector<double>*> K_;  ///< tangents of the bodies
  Vector diagonal_;                            ///< of K
  Vector compliance_;
  Vector penalty_;  ///< rho
  double springWeight_ = 0;
  std::vector<double> values_;  ///< of H
  std::vector<char> active_;    ///< as factorised; none where empty
  std::unique_ptr<CondensingSolver> solver_;
  int factorisations_ = 0;
};

/// The contact problem of a linearised step with the equations of all bodies, none condensed,
///   K d + C' dp = force,   s = slack - C d >= 0,   p = p0 + dp >= 0,   p s = 0.
/// \param problem  its W is not used. Ends like solveContact (complementarity.h), by the same pivoting.
/// \param motion  becomes d without the rigid motions of the solution.
ContactSolution solveSparse(SparseContact& matrix, const ContactProblem& problem, const Vector& force,
                            const Vector& slack, const Vector& p0, const Vector& balance,
                            std::vector<char> active, Vector& motion);

}  // namespace mortier
