// What contact sees of a body: the equations that its conditions act on, its columns of C there, and the
// rigid motions that its supports leave free.
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "solver/model.h"

namespace mortier {

struct ContactDofs {
  /// \param firstRow  of each interface among the conditions across contact, and their number at the end.
  /// Those along the line come after all of them, for each interface with friction as many.
  /// \throws UnheldBodyError where a motion does not move the contact dofs.
  ContactDofs(const Model& model, int body, const std::vector<int>& firstRow);

  /// Takes the rows of interfaces that have followed the bodies.
  void takeRows(const Model& model, int body, const std::vector<int>& firstRow);

  std::vector<int> equations;     ///< of the contact dofs; all of a line that may touch anywhere
  Eigen::SparseMatrix<double> C;  ///< contact conditions x contact dofs
  Matrix motions;                 ///< rigid motions, by dofs
  Matrix R;                       ///< the same on the contact dofs, orthonormal there

  /// Whether no condition acts on the body.
  [[nodiscard]] bool none() const { return equations.empty(); }
  /// The rigid motion with these coefficients, in words. Collective.
  [[nodiscard]] std::string describe(const Model& model, int body, const Vector& z) const;
  /// Work of nodal forces (dofs) on the rigid motions: what only contact can balance. Stresses do none.
  /// Forces that balance each other but for rounding give zero.
  /// \param load  complete at all nodes
  [[nodiscard]] Vector rigidForce(const Model& model, int body, const Vector& load) const;

 private:
  void findEquations(const Model& model, int body, const std::vector<int>& firstRow);
  void findMotions(const Model& model, int body);

  Matrix basis_;             ///< of the motions by those of rigidModes()
  std::vector<int> column_;  ///< of C, by equations of the body; -1: none
};

}  // namespace mortier
