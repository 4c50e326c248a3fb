// The tetrahedra of a body in space: what a Body is made of there (fem/body.h).
//
// Stress and strain are vectors of six components (material/deviatoric.h).
#pragma once

#include <optional>
#include <vector>

#include "base/two_part_vector.h"
#include "base/types.h"
#include "fem/volume_patches.h"
#include "material/material.h"
#include "mesh/tetrahedron_mesh.h"

namespace mortier {

/// Places of the quadrature points of all tetrahedra, one after the other [m].
std::vector<SpacePoint> placesOfPoints(const TetrahedronMesh& mesh, int degree);

class SpaceElements {
 public:
  /// \param averaged  whether the material gets an averaged volumetric strain; with degree 1 alone
  SpaceElements(TetrahedronMesh mesh, int degree, bool averaged);

  [[nodiscard]] const TetrahedronMesh& mesh() const { return mesh_; }
  [[nodiscard]] const SpaceNodes& nodes() const { return nodes_; }
  [[nodiscard]] int pointsOfElement() const { return nodes_.degree == 1 ? 1 : 4; }
  /// Of the quadrature points, tetrahedron by tetrahedron [m^3].
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
  /// Of all shape functions of an element but the first, over sqrt2, by points [1/m].
  [[nodiscard]] const std::vector<double>& gradients() const { return gradients_; }
  [[nodiscard]] SpacePoint placeOf(int point) const;  ///< [m]
  [[nodiscard]] double largestGradient() const { return largestGradient_; }
  /// Where the volumetric strain is averaged; null elsewhere.
  [[nodiscard]] const VolumePatches* patches() const { return patches_ ? &*patches_ : nullptr; }

  // As those of Body.

  void strain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const;
  void addStressOf(const Vector& d, const Linearisation& law, Matrix& stress, int begin, int end) const;

 private:
  void averageStrain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const;

  TetrahedronMesh mesh_;
  SpaceNodes nodes_;
  std::vector<double> weights_;
  std::vector<double> gradients_;  ///< of all shape functions of an element but the first, over sqrt2
  double largestGradient_ = 0;
  std::optional<VolumePatches> patches_;
};

}  // namespace mortier
