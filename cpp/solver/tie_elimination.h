// Ties (contact/tie.h) are equations: their forces and the rigid motions that they hold are eliminated before
// contact is solved. With dp the change of the contact forces, l that of the tie forces and z = N y + H h the
// rigid motions, N those that no tie resists and H the others,
//
//   s = s0 + W_cc dp + W_ct l - G_c z          (contact)
//   0 = t0 + W_tc dp + W_tt l - G_t H h        (ties)
//   G_c' dp + G_t' l = r                       (balance)
//
// The second equation and H' times the third determine (l, h) by dp,
//
//   A (l, h) = -(t0, H' r) - B dp,   A = [W_tt  -G_t H; -(G_t H)'  0],   B = [W_tc; -(G_c H)'],
//
// and what remains is a contact problem (complementarity.h) for dp and y.
#pragma once

#include <Eigen/QR>
#include <optional>

#include "solver/complementarity.h"
#include "solver/dense_factor.h"

namespace mortier {

class TieElimination {
 public:
  /// \param G  motion of all constraints, those of contact and then those of ties, by rigid motions
  void setMotions(Matrix G, Eigen::Index ties);
  /// N' of the motions of contact: conditions x motions that no tie resists.
  [[nodiscard]] Matrix contactMotions() const;
  /// The compliance of all constraints. \returns that of contact with the ties held
  Matrix take(Matrix W, bool symmetric);
  /// Whether there is a compliance of all constraints.
  [[nodiscard]] bool taken() const { return taken_; }

  /// Slacks of all constraints, and the balance by all rigid motions.
  struct Whole {
    Vector slack, balance;
  };
  /// What remains of them for the contact problem.
  [[nodiscard]] Whole reduced(const Whole& whole) const;
  /// The solution of that, completed by the tie forces and by the rigid motions.
  [[nodiscard]] ContactSolution completed(ContactSolution solution, const Whole& whole) const;
  /// A motion that no tie resists, by all rigid motions.
  [[nodiscard]] Vector wholeMotion(const Vector& y) const { return ties_ == 0 ? y : Vector(free_ * y); }

  [[nodiscard]] Eigen::Index ties() const { return ties_; }
  [[nodiscard]] const Matrix& G() const { return G_; }

 private:
  /// (l, h) for a right-hand side of A.
  [[nodiscard]] Matrix solve(const Matrix& right) const;
  [[nodiscard]] Matrix lower(const Whole& whole) const;

  Eigen::Index ties_ = 0;
  Matrix G_;                ///< of all constraints
  Matrix held_, free_;      ///< H, N
  Matrix heldTies_;         ///< G_t H
  Matrix across_;           ///< [W_ct  -G_c H]
  Matrix solved_;           ///< A^-1 B
  DenseFactor compliance_;  ///< of W_tt
  Matrix carried_;          ///< W_tt^-1 G_t H
  DenseFactor stiffness_;   ///< of (G_t H)' W_tt^-1 G_t H
  /// Of A, where ties depend on each other.
  std::optional<Eigen::CompleteOrthogonalDecomposition<Matrix>> dependent_;
  double unit_ = 1;  ///< by which compliances are scaled there
  bool taken_ = false;
};

}  // namespace mortier
