// An assumed volumetric strain (B-bar, Hughes 1980), of triangles and of linear tetrahedra.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/two_part_vector.h"
#include "base/types.h"
#include "mesh/element_nodes.h"
#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

// The change of volume theta that the material gets is the L2 projection A theta of that of the displacements
// onto polynomials of one degree less, patch by patch of elements. Degree 1: constants on about four
// triangles, or sixteen tetrahedra; degree 2, in the plane alone: linear functions on about two. Only the
// strain p = theta/sqrt(d), theta of the plane or of space and d its dimension, is replaced, by p + (A theta
// - theta)/sqrt(d): in the plane nothing moves across it, and the circumference of a ring is strained as
// before. Displacements and equilibrium remain those of a convex minimisation; A reproduces constants and is
// symmetric in L2, so uniform stresses stay exact.
//
// Stability (Stenberg 1984): the nodes within a patch control polynomials without mean, and those within the
// common line or surface of two patches the jump of the means. Surfaces of eight tetrahedra often have none.

/// The patch of each element, from 0. Elements of a patch are of one region and connected by sides. They
/// follow from the mesh's topology alone, not from lengths: a scale or a rotation changes no patch.
std::vector<int> volumePatches(const TriangleMesh& mesh, int degree);
/// \pre degree 1
std::vector<int> volumePatches(const TetrahedronMesh& mesh);

class VolumePatches {
 public:
  /// \param patchOf  of each triangle; other arguments as in Body
  VolumePatches(const std::vector<int>& patchOf, const ElementNodes& nodes, const std::vector<Point>& places,
                const std::vector<double>& weights, const std::vector<double>& gradients,
                const std::vector<double>& hoops);
  /// \param patchOf  of each tetrahedron; other arguments as those of Body. \pre degree 1
  VolumePatches(const std::vector<int>& patchOf, const SpaceNodes& nodes, const std::vector<double>& weights,
                const std::vector<double>& gradients);

  [[nodiscard]] int count() const { return static_cast<int>(nodesFrom_.size()) - 1; }
  [[nodiscard]] const std::vector<int>& patchOf() const { return patchOf_; }
  /// Triangles or tetrahedra.
  [[nodiscard]] std::span<const int> elements(int patch) const {
    return part(elements_, elementsFrom_, patch);
  }
  [[nodiscard]] std::span<const int> triangles(int patch) const { return elements(patch); }
  /// Ascending.
  [[nodiscard]] std::span<const int> nodes(int patch) const { return part(nodes_, nodesFrom_, patch); }

  /// Of each node of an element its place in nodes() of the patch.
  [[nodiscard]] const int* local(int element) const {
    return &local_[static_cast<size_t>(ofElement_) * element];
  }

  // A theta / sqrt(d) at a point is the sum over the terms k of basis(point)[k] times the product of
  // row(patch, k) with the displacements of the nodes of the patch, component by component.

  [[nodiscard]] int terms() const { return terms_; }
  [[nodiscard]] const double* basis(int point) const { return &basis_[static_cast<size_t>(terms_) * point]; }
  [[nodiscard]] const double* row(int patch, int term) const {
    return &rows_[dimension_ *
                  (static_cast<size_t>(terms_) * nodesFrom_[patch] + term * nodes(patch).size())];
  }
  /// What a row sums to in x: the product with a uniform motion along x; 0 but about an axis. In y it is 0.
  [[nodiscard]] double uniform(int patch, int term) const {
    return uniform_.empty() ? 0 : uniform_[static_cast<size_t>(terms_) * patch + term];
  }

  /// The products of the rows of a patch with a displacement (dofs), in twice the working precision or in it.
  [[nodiscard]] std::array<DoubleDouble, 3> products(int patch, const TwoPartVector& u) const;
  [[nodiscard]] std::array<double, 3> products(int patch, const Vector& d) const;

  /// f += the nodal forces (dofs) of sums over the points of a patch, weight times stress p times basis, by
  /// patches and terms.
  void addForces(const std::vector<double>& sums, Vector& f) const;

  /// A theta for values at the points.
  [[nodiscard]] Vector averaged(const Vector& theta, const std::vector<double>& weights) const;

 private:
  struct Elements;
  VolumePatches(const std::vector<int>& patchOf, const Elements& elements);
  static std::span<const int> part(const std::vector<int>& all, const std::vector<int>& from, int patch) {
    return {all.data() + from[patch], all.data() + from[patch + 1]};
  }
  void findPatches(const std::vector<int>& nodes);
  template <class Value, class At, class Difference, class Times>
  [[nodiscard]] std::array<Value, 3> productsOf(int patch, At at, Difference difference, Times times) const;

  std::vector<int> patchOf_;
  std::vector<int> elementsFrom_, elements_;
  std::vector<int> nodesFrom_, nodes_;
  std::vector<int> local_;
  int dimension_ = 2;
  int ofElement_ = 3;          ///< nodes
  int points_ = 1;             ///< of an element
  int terms_ = 1;              ///< of the polynomials
  std::vector<double> basis_;  ///< orthonormal in L2 of the patch: terms at each point
  std::vector<double> rows_;
  std::vector<double> uniform_;
};

/// products() with one displacement, found once for points that lie near each other. It must live on.
template <class Displacement>
class PatchProducts {
 public:
  PatchProducts(const VolumePatches* patches, const Displacement& u) : patches_(patches), u_(u) {
    known_.fill(-1);
  }
  const auto& operator()(int patch) {
    const int at = patch % kept;
    if (known_[at] != patch) {
      known_[at] = patch;
      values_[at] = patches_->products(patch, u_);
    }
    return values_[at];
  }

 private:
  static constexpr int kept = 128;
  using Products = decltype(std::declval<VolumePatches>().products(0, std::declval<const Displacement&>()));
  const VolumePatches* patches_;
  const Displacement& u_;
  std::array<int, kept> known_;
  std::array<Products, kept> values_;
};

/// What averaging adds to the tangent of a patch. With the strains B of its elements without those that are
/// averaged, the rows m of the patch and its polynomials f at the points it is sum w (B' D e m' f + m f e' D
/// B + m f e' D e f m'), e the unit of p. With R of the first and the last term and C of the second this is R
/// m' + m C', polynomial by polynomial. It is kept in memory of need() numbers.
class PatchTangent {
 public:
  [[nodiscard]] static size_t need(const VolumePatches& patches, int patch, int dimension) {
    return 3 * static_cast<size_t>(patches.terms() * dimension) * patches.nodes(patch).size();
  }
  PatchTangent(const VolumePatches& patches, int patch, int dimension, double* memory)
      : terms_(patches.terms()), size_(dimension * patches.nodes(patch).size()), m_(memory) {}

  [[nodiscard]] size_t size() const { return size_; }
  /// m, and nothing else.
  void start(const VolumePatches& patches, int patch);
  // Of the first and of the second term.
  [[nodiscard]] double* first(int term) { return m_ + (terms_ + term) * size_; }
  [[nodiscard]] double* second(int term) { return m_ + (2 * terms_ + term) * size_; }
  /// Adds the last term. \param inner  sum w f e' D e f', its lower triangle
  void addInner(const Eigen::Matrix3d& inner);
  /// Calls turn(d numbers) for what m, R and C have at a node of the patch.
  template <class Turn>
  void turnNode(size_t first, Turn turn) {
    for (int k = 0; k < 3 * terms_; ++k) turn(m_ + k * size_ + first);
  }
  [[nodiscard]] double operator()(size_t i, size_t j) const {
    const double* R = m_ + terms_ * size_;
    const double* C = R + terms_ * size_;
    double sum = 0;
    for (int k = 0; k < terms_; ++k)
      sum += R[k * size_ + i] * m_[k * size_ + j] + m_[k * size_ + i] * C[k * size_ + j];
    return sum;
  }

 private:
  int terms_;
  size_t size_;
  double* m_;
};

}  // namespace mortier
