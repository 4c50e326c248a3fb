// The labelled boundary of a body in space, and the common refinement of two of them.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <unsupported/Eigen/BVH>
#include <utility>
#include <vector>

#include "base/types.h"
#include "contact/boundary_surface.h"
#include "mesh/tetrahedron_mesh.h"

namespace mortier {

/// A vertex of a surface, as one of its smooth parts has it.
using PartVertex = std::pair<int, int>;  // vertex, part

/// Unit vectors along which a node never moves, as in planes of symmetry.
using FixedDirections = std::function<std::vector<SpacePoint>(int node)>;

struct ContactSurface {
  /// \throws InputError when the mesh does not have the label.
  ContactSurface(const TetrahedronMesh& mesh, const SpaceNodes& nodes, int label);

  int degree = 1;
  std::vector<std::array<int, 6>> triangles;      ///< nodes of the body: three vertices, then the middles
  std::vector<std::array<SpacePoint, 3>> places;  ///< of the vertices [m]
  std::vector<SpacePoint> normals;                ///< outward, of length one
  std::vector<int> parts;                         ///< by triangles: which turn smoothly into each other
  /// By triangles and vertices, of the curved surface that a part stands for (boundary_surface.h).
  std::vector<std::array<SurfaceNormal, 3>> vertexNormals;
  std::vector<std::array<double, 3>> curvatures;  ///< there, the mean of all directions, without sign [1/m]
  double area = 0;                                ///< [m^2]
  double extent = 0;                              ///< largest of the bounding box [m]
  bool planar = false;                            ///< whether all normals are one
  /// By triangles and vertices of a surface that has moved: the gradient of its place, which makes of the
  /// normal of the triangle as drawn its normal.
  std::vector<std::array<Eigen::Matrix3d, 3>> turns;

  /// Where displacements, by dofs of its mesh, have moved it [m]. Normals and the curved surface turn with
  /// the triangles; quadratic traces bend them. Extent and curvatures stay those as drawn.
  [[nodiscard]] ContactSurface moved(const Vector& u, const FixedDirections& fixed) const;
  /// Makes the normals of one surface the directions of contact, of this one or of the other.
  void faceAlongNormals(bool own);

  [[nodiscard]] int perTriangle() const { return degree == 1 ? 3 : 6; }
  /// All of them, each once, ascending.
  [[nodiscard]] std::vector<int> nodes() const;
  /// Of the curved surface at a point of a triangle, by its barycentric coordinates.
  [[nodiscard]] SpacePoint normalAt(int triangle, const Eigen::Vector3d& l) const;
  [[nodiscard]] double curvatureAt(int triangle, const Eigen::Vector3d& l) const;
  /// How far the curved surface is from a triangle at a point of it, by its barycentric coordinates [m]: the
  /// curve over each side that is perpendicular to the normals at its ends, a cubic, and of an arc to fourth
  /// order, continued into the triangle so that quadratic heights are exact.
  [[nodiscard]] SpacePoint offset(int triangle, const Eigen::Vector3d& l) const {
    SpacePoint sum = SpacePoint::Zero();
    for (int k = 0; k < 3; ++k) sum += l[k] * l[(k + 1) % 3] * sides_[triangle][k].at(l[k] - l[(k + 1) % 3]);
    return sum;
  }
  /// How far a point of the curved surface over l is along n from one that is `apart` from it: where its
  /// tangent plane meets the line through that. \param apart  from there to that of the triangle at l [m]
  [[nodiscard]] double distanceAlong(const SpacePoint& n, const SpacePoint& apart, int triangle,
                                     const Eigen::Vector3d& l) const;
  /// Expected error of that [m].
  [[nodiscard]] double offsetError(int triangle) const;

  /// Where vertices of both are in one place the surfaces are one there: the normal that is known better, or
  /// the mean of both.
  friend void shareNormals(ContactSurface& one, ContactSurface& other);

 private:
  struct Side {
    SpacePoint even{0, 0, 0}, odd{0, 0, 0}, fourth{0, 0, 0};  ///< [m]
    [[nodiscard]] SpacePoint at(double difference) const {
      return even + difference * (odd + difference * fourth);
    }
  };
  void findCurvatures();
  void findSides();
  [[nodiscard]] Side sideOver(int triangle, int k) const;
  std::vector<std::array<Side, 3>> sides_;
};

/// A nonmortar and a mortar triangle that face each other. A point of the first one, at its second and third
/// barycentric coordinates l, faces along a direction d
///   x2(l) = x1(l) + delta(l) d
/// on the plane of the other, at its barycentric coordinates mu(l). mu and delta are affine in l.
struct FacingTriangles {
  int nonmortar = 0, mortar = 0;
  Eigen::Matrix3d mu;     ///< times (l1, l2, 1)
  Eigen::Vector3d delta;  ///< at the mortar vertices [m]
  /// The part of the nonmortar triangle that faces the other, as a convex polygon of l.
  std::vector<Point> polygon;

  [[nodiscard]] Eigen::Vector3d at(const Point& l) const { return mu * Eigen::Vector3d(l.x(), l.y(), 1); }
};

/// Of the distance of two triangles that face each other [m].
struct DistanceError {
  double nearest = 0;  ///< least distance
  double error = 0;    ///< expected; 0 where both triangles are one
};

/// Calls visit(p0, e1, e2, area) of the triangles p0, p0 + e1, p0 + e2 that a convex polygon is cut into.
template <class Visit>
void forEachTriangle(const std::vector<Point>& polygon, const Visit& visit) {
  for (size_t last = 2; last < polygon.size(); ++last) {
    const Point& p0 = polygon[0];
    const Point e1 = polygon[last - 1] - p0;
    const Point e2 = polygon[last] - p0;
    if (const double area = cross(e1, e2) / 2; area > 0) visit(p0, e1, e2, area);
  }
}

/// Between d, along which triangles face each other, and the normal n ~ R1 n1 - R2 n2 of contact of the
/// curved surfaces at a point l of the nonmortar one: the square of the cosine. Surfaces that are g apart
/// along n, and g/cos along d, meet by a motion g n, whose part along d is g cos.
double squareOfCosine(const ContactSurface& nonmortar, const ContactSurface& mortar,
                      const FacingTriangles& facing, const SpacePoint& d, const Point& l);

double errorBetween(const ContactSurface& nonmortar, const ContactSurface& mortar,
                    const FacingTriangles& facing);

/// The largest error of those that are a tenth or more of how much farther apart the triangles are than the
/// nearest: others are not seen in contact whatever the approach of the bodies is.
double visibleError(const std::vector<DistanceError>& errors);

/// Calls visit with every pair of triangles that face each other within `reach` along the directions of the
/// nonmortar triangles. The polygons of a nonmortar triangle do not overlap where the mortar surface is
/// not folded, and cover exactly the part of it that is faced.
void forEachFacing(const ContactSurface& nonmortar, const ContactSurface& mortar,
                   const std::vector<SpacePoint>& directions, double reach,
                   const std::function<void(const FacingTriangles&)>& visit);

/// The same of one ray from a point: the triangle that it meets first, its barycentric coordinates there
/// and the distance; -1 for none.
struct RayHit {
  int triangle = -1;
  Eigen::Vector3d mu;
  double delta = 0;
};

/// Finds triangles of a surface in boxes.
class TriangleTree {
 public:
  explicit TriangleTree(const ContactSurface& surface);
  /// Triangles whose boxes' spheres reach within a radius of the line through a point, up to `reach` from
  /// that, ascending.
  void findAlong(const SpacePoint& from, const SpacePoint& direction, double radius, double reach,
                 std::vector<int>& found) const;
  [[nodiscard]] RayHit along(const SpacePoint& from, const SpacePoint& direction, double reach) const;
  /// The direction n ~ R1 n1 - R2 n2 from a point of the other surface with normal n1 and curvature 1/R1.
  /// \param curved  n1 and n2 are those of the curved surfaces, not of triangles
  [[nodiscard]] SpacePoint contactDirection(const SpacePoint& place, const SpacePoint& n1, double curvature1,
                                            double reach, bool curved) const;

 private:
  const ContactSurface& surface_;
  std::vector<Eigen::AlignedBox3d> boxes_;
  Eigen::KdBVH<double, 3, int> tree_;
};

struct VertexFacts {
  SpacePoint place, normal;
  double curvature = 0;
  std::set<PartVertex> neighbours;
  bool faces = false;
  std::vector<std::pair<int, double>> rows;  ///< to which its hat function goes, with which part
};

using VertexTable = std::map<PartVertex, VertexFacts>;

/// Neighbours are those along edges.
VertexTable verticesOf(const ContactSurface& surface);

/// Gives the hat functions without a row to neighbours that have one.
void shareFunctions(VertexTable& vertices);

/// The common refinement of two surfaces. A nonmortar triangle faces the mortar surface along n ~ R1 n1 -
/// R2 n2, n1, n2 the outward normals and R1, R2 the radii of curvature of both surfaces, as in the plane
/// (directions.h): a plane triangle along its own normal, a curved one that faces a plane along the normal of
/// the plane, on which alone the distance depends.
struct SurfaceRefinement {
  /// The tree is that of the mortar surface; all must outlive it.
  /// \param continuous  directions change continuously with the places: those of the curved surfaces
  SurfaceRefinement(const ContactSurface& nonmortar, const ContactSurface& mortar, const TriangleTree& tree,
                    bool continuous = false);

  /// Along which a vertex of the nonmortar surface faces the other.
  [[nodiscard]] SpacePoint directionAt(const VertexFacts& vertex) const;

  double reach = 0;                    ///< [m]
  std::vector<SpacePoint> directions;  ///< by nonmortar triangles
  std::vector<FacingTriangles> facing;
  VertexTable vertices;  ///< of the nonmortar surface

 private:
  const TriangleTree& tree_;
  std::optional<SpacePoint> plane_;  ///< the direction of all, towards a plane
};

}  // namespace mortier
