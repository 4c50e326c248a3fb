// Tractions on all sides of a mesh, linear on each, equal and opposite for the two triangles of a side and in
// equilibrium with the loads of every triangle: what turns finite element stresses into a stress that is in
// equilibrium at every point (Ladeveze and Leguillon 1983). At each vertex i the moments
//
//   b_(E,i) = integral over side E of t phi_i
//
// are taken nearest to the mean tractions of the two triangles under
//
//   sum over the sides E of K at i of  (+-) b_(E,i) = integral over K of s grad phi_i - f phi_i
//
// for every triangle K at i: that is possible because finite element stresses s are in equilibrium with hat
// functions. Sums over the vertices of K give the balance of its forces, with their places that of moments.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "bound/composite_triangle.h"
#include "fem/body.h"

namespace mortier {

struct Side {
  std::array<int, 2> vertices{};  ///< tractions are those of the triangle on the left of first to second
  std::array<int, 2> triangles{-1, -1};  ///< on the left and on the right; -1 for none
  int boundary = -1;                     ///< TriangleMesh::boundaryEdges that it is, or -1
};

/// |K| grad phi of corner i of a triangle K, phi its hat function.
Point hatGradient(const TriangleMesh& mesh, int triangle, int i);
/// (p, q, r) of the symmetric part of v (x) g.
Eigen::Vector3d symmetricPart(const Point& v, const Point& g);
/// (p, q, r) of the strain of a displacement (dofs) in a triangle.
Eigen::Vector3d strainIn(const TriangleMesh& mesh, int triangle, const Vector& displacement);
/// Takes from nodal forces (dofs) those of a stress in a triangle [N/m].
void takeForces(const TriangleMesh& mesh, int triangle, const Stress& stress, Vector& forces);

/// The sides of a mesh, and the way from triangles and vertices to them.
class Sides {
 public:
  explicit Sides(const TriangleMesh& mesh);

  [[nodiscard]] const std::vector<Side>& all() const { return sides_; }
  [[nodiscard]] int count() const { return static_cast<int>(sides_.size()); }
  /// Side k of a triangle (0-1, 1-2, 2-0), and whether the triangle is on its left.
  [[nodiscard]] int of(int triangle, int k) const { return ofTriangle_[3 * triangle + k] >> 1; }
  [[nodiscard]] bool left(int triangle, int k) const { return (ofTriangle_[3 * triangle + k] & 1) == 0; }
  /// Sides at a vertex, and triangles.
  [[nodiscard]] std::span<const int> sidesAt(int vertex) const {
    return rangeOf(sideStart_, sidesAt_, vertex);
  }
  [[nodiscard]] std::span<const int> trianglesAt(int vertex) const {
    return rangeOf(triangleStart_, trianglesAt_, vertex);
  }

 private:
  static std::span<const int> rangeOf(const std::vector<int>& start, const std::vector<int>& all,
                                      int vertex) {
    return {all.data() + start[vertex], all.data() + start[vertex + 1]};
  }
  std::vector<Side> sides_;
  std::vector<int> ofTriangle_;  ///< 2 side + (0 on the left, 1 on the right)
  std::vector<int> sideStart_, sidesAt_, triangleStart_, trianglesAt_;
};

/// What is known of the tractions of a side of the boundary: their components along `known`, as moments.
struct KnownTraction {
  int count = 0;                                           ///< of directions: 2 where nothing holds the side
  std::array<Point, 2> known;                              ///< unit vectors
  std::array<Point, 2> moments{Point(0, 0), Point(0, 0)};  ///< by ends, all of it [N/m]
};

/// Moments of the tractions by sides and ends [N/m], of the triangle on the left.
using SideMoments = std::vector<std::array<Point, 2>>;

/// \param stress  (s11, s22, s12) by triangles, in equilibrium with hat functions [Pa]
/// \param forces  by triangles
/// \param known  by sides; those inside are not read
SideMoments balancedMoments(const TriangleMesh& mesh, const Sides& sides, const std::vector<Stress>& stress,
                            const std::vector<BodyLoad>& forces, const std::vector<KnownTraction>& known);

/// Of a body load on a triangle (CompositeTriangle).
Eigen::Matrix<double, 2, 3> nodalForces(const TriangleMesh& mesh, int triangle, const BodyLoad& load);

/// The moments of the sides of a triangle, with its signs.
Moments momentsOf(const Sides& sides, const SideMoments& moments, int triangle);

}  // namespace mortier
