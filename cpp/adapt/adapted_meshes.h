// Meshes that are refined together, each element to the size at which the estimate of the whole meets an
// aim: with the errors eta_T of the elements (in the energy norm), p the degree, d the dimension and A_T the
// areas or volumes,
//
//   r_T = c eta_T^(-2/(2p+d)),  1/8 <= r_T <= 1,     sum of eta_T^2 r_T^(2p) = aim^2,
//
// A_T r_T^d is the size that an element should have; log r_T is the mean over its vertices, at which it is
// that over the elements there, and elements are cut until they are small enough. Two things are done beside:
//   - the elements that make half of the error (Doerfler 1996) are cut in any case;
//   - where the error of the elements of a vertex has fallen from one round to the next like h^(2s + d - 2),
//     h^d their size, with s < 1.1, the stress is unbounded there, at a point of the plane or along an edge
//     in space: they are cut repeatedly, until they are to be a hundredth of the aim. In the plane that is
//     done six times a round at most, and only where the density of the error is at least 0.6 of that at the
//     vertices next to it: else the rate may show that data or contact were not resolved before.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "base/types.h"
#include "mesh/refine.h"

namespace mortier {

class AdaptedMeshes {
 public:
  AdaptedMeshes(const std::vector<TriangleMesh>& meshes, int degree);
  /// \param curves  of each
  AdaptedMeshes(const std::vector<TetrahedronMesh>& meshes, std::vector<CurvedFaces> curves, int degree);

  [[nodiscard]] const TriangleMesh& mesh(size_t body) const { return plane(body).mesh; }
  [[nodiscard]] const TetrahedronMesh& spaceMesh(size_t body) const {
    return std::get<InSpace>(bodies_[body]).mesh;
  }
  [[nodiscard]] bool inSpace() const { return dimension_ == 3; }
  /// Components of displacements of all bodies together.
  [[nodiscard]] int unknowns() const;
  /// Boundaries whose curves are not known, and vertices that could not be put onto theirs: what the estimate
  /// does not contain.
  [[nodiscard]] const std::vector<std::string>& polygons(size_t body) const { return polygons_[body]; }
  [[nodiscard]] std::vector<SpacePoint> offCurve(size_t body) const;

  /// How the errors eta_T^2 [J/m] by bodies and elements have fallen since the last call, at each vertex.
  void learn(const std::vector<Vector>& errors);
  /// The error of unbounded stresses that estimates leave out, as far as rates are known. At a point of the
  /// plane where it goes like area^s, a mesh of half the size reduces it by 1 - 4^-s, which is what the
  /// recovered stress shows: the whole is 1/(1 - 4^-s) times as large [J/m]. So it is along an edge in space,
  /// on which such a mesh has twice the vertices.
  [[nodiscard]] double unresolved() const;
  /// \param errors  eta_T^2 [J/m] by bodies and elements  \param aim  what the root of their sum shall
  /// become
  void refine(const std::vector<Vector>& errors, double aim);
  /// Cuts every element in two.
  void refineAll();
  /// Halves the size of the elements around the vertex that is nearest to a place.
  void halveAt(size_t body, const SpacePoint& place);
  // In the plane:
  /// Gives each of two lines that face each other a vertex where the other one has a corner.
  void faceCorners(size_t body, int label, size_t otherBody, int otherLabel);
  /// Cuts the triangles of the first line until none of its edges is longer than twice those that it faces.
  void faceSizes(size_t body, int label, size_t otherBody, int otherLabel);

 private:
  template <class Mesh, class Curves>
  struct Adapted {
    Mesh mesh;
    Curves curves;
    std::vector<int> offCurve = {};  ///< vertices
    // By vertices, of the elements around them:
    std::vector<double> error = {};  ///< eta^2 in the last round [J/m]
    std::vector<double> size = {};   ///< [m^2], [m^3]
    std::vector<char> isPeak = {};   ///< of the density of the error, nearly; in space every one
    std::vector<double> rate = {};   ///< s; infinite where it is not known
  };
  using InPlane = Adapted<TriangleMesh, CurvedEdges>;
  using InSpace = Adapted<TetrahedronMesh, CurvedFaces>;

  [[nodiscard]] const InPlane& plane(size_t body) const { return std::get<InPlane>(bodies_[body]); }
  template <class Body>
  void learnRates(Body& body, const Vector& error, double rounding) const;
  /// \returns the element of which each new one is a part
  template <class Body>
  std::vector<int> cut(Body& body, const std::vector<char>& marked);
  template <class Body>
  void cutToSize(Body& body, const Vector& reduction, std::vector<char> marked);
  template <class Body>
  void cutAtSingularities(Body& body, double allowed);

  int degree_;
  int dimension_;
  std::vector<std::variant<InPlane, InSpace>> bodies_;
  std::vector<std::vector<std::string>> polygons_;  ///< by bodies
};

/// The curves for which the boundary of a mesh stands, as far as they are known, so that a refined mesh tends
/// to the body and not to its first polygon: the mesh's own (TriangleMesh::edgeCurves, edgeMiddles), else the
/// arcs of circles that its nodes lie on (contact/smooth_part.h: four nodes at least, to 1e-6). What is
/// straight is known, too. Lines inside, where two regions meet, are fitted as well.
struct KnownCurves {
  CurvedEdges edges;  ///< without those of TriangleMesh::edgeCurves
  /// The lines of which no curve is known: their polygons are kept.
  std::vector<std::string> polygons;  ///< "label 3", "its boundary without a label", "its regions"
};

KnownCurves curvesBehind(const TriangleMesh& mesh);

/// The same in space: surfaces of the geometry, else those of contact/boundary_surface.h. Surfaces inside,
/// where two regions meet, keep their triangles.
CurvedFaces curvesBehind(const TetrahedronMesh& mesh);

/// Puts vertices of a mesh onto all surfaces of its geometry that meet there: CAD files have the curves
/// between them to a ten-millionth of the size.
void putOntoGeometry(TetrahedronMesh& mesh);

// Ends and corners of a contact line make stresses of the body that it faces unbounded or kinked. Where the
// other mesh has no vertex there, the estimate shows half of it on any mesh: one is added.

/// Ends of a labelled line, and vertices where it turns by more than `sharpTurn`. \throws InputError
std::vector<Point> cornersOf(const TriangleMesh& mesh, int label);

/// Cuts the edges of a labelled line that places face, where these are not next to a vertex (a tenth of the
/// edge) or farther away than the edge is long, and the triangles behind them. Curved edges stay as they are.
void cutFacing(TriangleMesh& mesh, const CurvedEdges& curves, int label, const std::vector<Point>& places);

/// Of the triangles of a mesh, those with an edge on a labelled line that is longer than twice an edge of the
/// line that it faces. \throws InputError
std::vector<char> longerThanFacing(const TriangleMesh& mesh, int label, const TriangleMesh& other,
                                   int otherLabel);

}  // namespace mortier
