// An assumed volumetric strain (B-bar, Hughes 1980): the change of volume theta that the material sees is the
// L2 projection of that of the displacements onto polynomials of one degree less, patch by patch of
// triangles. Degree 1: constants on about four triangles; degree 2: linear functions on about two. Only the
// strain p = (e11 + e22)/sqrt2 is replaced, by p + (A theta - theta)/sqrt2, so nothing moves across the plane
// and the circumference of a ring is strained as before. Displacements and equilibrium remain those of a
// convex minimisation; A reproduces constants and is symmetric in L2, so uniform stresses stay exact.
//
// Stability (Stenberg 1984): the nodes within a patch control polynomials without mean, and those on the
// common line of two patches the jump of the means.
#pragma once

#include <vector>

#include "base/types.h"
#include "mesh/element_nodes.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

/// The patch of each triangle, from 0. Triangles of a patch are of one region and connected by sides. They
/// follow from the mesh's topology alone, not from lengths: a scale or a rotation changes no patch.
std::vector<int> volumePatches(const TriangleMesh& mesh, int degree);

class VolumePatches {
 public:
  /// \param patchOf  of each triangle; other arguments as in Body
  VolumePatches(const std::vector<int>& patchOf, const ElementNodes& nodes, const std::vector<Point>& places,
                const std::vector<double>& weights, const std::vector<double>& gradients,
                const std::vector<double>& hoops);

  [[nodiscard]] int count() const { return static_cast<int>(nodesFrom_.size()) - 1; }
  [[nodiscard]] const std::vector<int>& patchOf() const { return patchOf_; }
  struct Range {
    const int* first;
    const int* last;
    [[nodiscard]] const int* begin() const { return first; }
    [[nodiscard]] const int* end() const { return last; }
    [[nodiscard]] size_t size() const { return last - first; }
  };
  [[nodiscard]] Range triangles(int patch) const { return range(triangles_, trianglesFrom_, patch); }
  /// Ascending.
  [[nodiscard]] Range nodes(int patch) const { return range(nodes_, nodesFrom_, patch); }

  /// Of each node of a triangle its place in nodes() of the patch.
  [[nodiscard]] const int* local(int triangle) const {
    return &local_[static_cast<size_t>(ofTriangle_) * triangle];
  }

  // A theta / sqrt2 at a point is the sum over the terms k of basis(point)[k] times the product of
  // row(patch, k) with the displacements of the nodes of the patch, x and y.

  [[nodiscard]] int terms() const { return terms_; }
  [[nodiscard]] const double* basis(int point) const { return &basis_[static_cast<size_t>(terms_) * point]; }
  [[nodiscard]] const double* row(int patch, int term) const {
    return &rows_[2 * (static_cast<size_t>(terms_) * nodesFrom_[patch] + term * nodes(patch).size())];
  }
  /// What a row sums to in x: the product with a uniform motion along x; 0 in the plane. In y it is 0.
  [[nodiscard]] double uniform(int patch, int term) const {
    return uniform_.empty() ? 0 : uniform_[static_cast<size_t>(terms_) * patch + term];
  }

  /// A theta for values at the points.
  [[nodiscard]] Vector averaged(const Vector& theta, const std::vector<double>& weights) const;

 private:
  static Range range(const std::vector<int>& all, const std::vector<int>& from, int patch) {
    return {all.data() + from[patch], all.data() + from[patch + 1]};
  }
  void findPatches(const ElementNodes& nodes);

  std::vector<int> patchOf_;
  std::vector<int> trianglesFrom_, triangles_;
  std::vector<int> nodesFrom_, nodes_;
  std::vector<int> local_;
  int ofTriangle_ = 3;         ///< nodes
  int points_ = 1;             ///< of a triangle
  int terms_ = 1;              ///< of the polynomials
  std::vector<double> basis_;  ///< orthonormal in L2 of the patch: terms at each point
  std::vector<double> rows_;
  std::vector<double> uniform_;
};

}  // namespace mortier
