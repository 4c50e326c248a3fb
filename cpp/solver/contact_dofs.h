// What contact sees of a body: the equations that its conditions act on, its columns of C there, and the
// rigid motions that its supports leave free.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "solver/model.h"

namespace mortier {

struct ContactDofs {
  /// \param firstRow  of each interface among the conditions across contact, and their number at the end.
  /// Those along the line come after all of them, for each interface with friction as many.
  /// \throws UnheldBodyError where a motion does not move the contact dofs.
  ContactDofs(const Model& model, int body, const std::vector<int>& firstRow);

  std::vector<int> equations;     ///< of the contact dofs
  Eigen::SparseMatrix<double> C;  ///< contact conditions x contact dofs
  Matrix motions;                 ///< rigid motions, by dofs
  Matrix R;                       ///< the same on the contact dofs, orthonormal there

  /// Whether no condition acts on the body.
  [[nodiscard]] bool none() const { return equations.empty(); }
  /// Work of nodal forces (dofs) on the rigid motions: what only contact can balance. Stresses do none.
  /// Forces that balance each other but for rounding give zero.
  [[nodiscard]] Vector rigidForce(const Vector& load) const;

 private:
  void findEquations(const Model& model, int body, const std::vector<int>& firstRow);
  void findMotions(const Body& body);
};

}  // namespace mortier
