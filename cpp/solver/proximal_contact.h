// The contact problem of complementarity.h where W is regular, on one active set after the other, with dense
// factors of W.
#pragma once

#include <Eigen/LU>
#include <vector>

#include "solver/contact_sets.h"
#include "solver/dense_factor.h"

namespace mortier {

// Solves with those rows and columns of a matrix W that belong to a set A, while A changes. W_BB is
// factorised for a base set B. For an A that differs from B by the added conditions J and the removed ones R,
//   [W_BB  W_BJ  E_R] [x_B]   [f_B]
//   [W_JB  W_JJ   0 ] [x_J] = [f_J],
//   [E_R'   0     0 ] [ y ]   [ 0 ]
// so that each change of A costs one solve with W_BB, and not a factorisation (Gill, Murray, Saunders and
// Wright 1990). Where A has moved far from B, it becomes the new base.

class ActiveFactor {
 public:
  /// \param W  square; must outlive this, as `work`. Symmetric matrices are taken to be positive definite.
  /// \param work  floating-point operations are added here.
  ActiveFactor(const Matrix& W, bool symmetric, double& work);

  /// Goes over to a set. \returns false where W_AA is singular but for rounding.
  bool take(const std::vector<char>& active);
  /// The same with factors of W_AA itself.
  bool refactor(const std::vector<char>& active);
  /// Whether the factors are those of W_AA itself.
  [[nodiscard]] bool fresh() const { return border_.empty(); }
  /// Rows of `right` in A become W_AA^-1 times them, the others zero.
  void solve(Matrix& right);

 private:
  bool factoriseBase();
  void solveBase(Matrix& x);
  void insert(const std::vector<int>& conditions);
  void remove(int place);
  [[nodiscard]] Vector rowOfBorder(int condition) const;

  const Matrix& W_;
  bool symmetric_;
  double unit_;                 ///< size of W: E_R and y are scaled by it
  std::vector<int> base_;       ///< B
  std::vector<int> placeOf_;    ///< of each condition in B, -1 for none
  DenseFactor factor_;          ///< of W_BB
  std::vector<int> border_;     ///< J and R
  std::vector<char> bordered_;  ///< whether a condition is among them
  Matrix rows_;                 ///< by columns: W_JB, E_R'
  Matrix solved_;               ///< W_BB^-1 [W_BJ E_R]
  Matrix schur_;                ///< of the border
  Eigen::PartialPivLU<Matrix> schurFactor_;
  double& work_;
};

/// Operations done for a contact problem, and how many are allowed.
struct Work {
  explicit Work(const ContactProblem& problem);
  double factorisation = 0;
  double limit = 0;
  double done = 0;
};

class ProximalContact final : public ContactSets {
 public:
  /// \param idle  conditions that stay inactive. All that is given by reference must outlive this.
  ProximalContact(const ContactProblem& problem, const std::vector<char>& idle, const Vector& slack,
                  const Vector& p0, const Vector& balance, Work& work);

  /// Begins anew with another slack.
  void restart(const Vector& slack);
  bool refactor(const std::vector<char>& active) override;
  [[nodiscard]] bool fresh() const override { return factor_.fresh(); }
  [[nodiscard]] bool capped() const override { return work_.done > work_.limit || ContactSets::capped(); }

 private:
  bool take(const std::vector<char>& active) override;
  void solveTaken(ContactSolution& solution) override;
  void growTaken(int condition, Growth& growth) override;
  [[nodiscard]] Noise noise(const ContactSolution& solution) const override;
  [[nodiscard]] Vector compliance(const Vector& p);
  Vector solve(const Vector& h, Vector& f);

  Work& work_;
  ActiveFactor factor_;
  double stiffness_ = 0;  ///< of all nodes together against rigid motions
  RigidMotions motions_;
  Matrix forces_;  ///< W_AA^-1 G_A held
  Eigen::PartialPivLU<Matrix> stiffnessFactor_;
};

}  // namespace mortier
