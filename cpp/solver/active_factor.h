// Solves with those rows and columns of a matrix W that belong to a set A, while A changes. W_BB is
// factorised for a base set B. For an A that differs from B by the added conditions J and the removed ones R,
//   [W_BB  W_BJ  E_R] [x_B]   [f_B]
//   [W_JB  W_JJ   0 ] [x_J] = [f_J],
//   [E_R'   0     0 ] [ y ]   [ 0 ]
// so that each change of A costs one solve with W_BB, and not a factorisation (Gill, Murray, Saunders and
// Wright 1990). Where A has moved far from B, it becomes the new base.
#pragma once

#include <Eigen/LU>
#include <vector>

#include "solver/dense_factor.h"

namespace mortier {

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

}  // namespace mortier
