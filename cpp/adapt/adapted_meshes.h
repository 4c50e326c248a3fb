// Meshes that are refined together, each triangle to the size at which the estimate of the whole meets an
// aim: with the errors eta_T of the triangles (in the energy norm), p the degree and A_T the areas,
//
//   r_T = c eta_T^(-1/(p+1)),  1/8 <= r_T <= 1,     sum of eta_T^2 r_T^(2p) = aim^2,
//
// A_T r_T^2 is the area that a triangle should have; the mean of its logarithm over the triangles of a vertex
// is a field by which triangles are cut until they are small enough. Two things are done beside that:
//   - the triangles that make half of the error (Doerfler 1996) are cut in any case;
//   - where the error of the triangles of a vertex has fallen from one round to the next like area^s with
//     s < 1.1, the stress is unbounded there: they are cut repeatedly,
//     until they are to be a hundredth of the aim.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"
#include "mesh/refine.h"

namespace mortier {

class AdaptedMeshes {
 public:
  AdaptedMeshes(const std::vector<TriangleMesh>& meshes, int degree);

  [[nodiscard]] const TriangleMesh& mesh(size_t body) const { return bodies_[body].mesh; }
  /// Boundaries whose curves are not known, and vertices that could not be put onto theirs:
  /// what the estimate cannot see.
  [[nodiscard]] const std::vector<std::string>& polygons(size_t body) const { return bodies_[body].polygons; }
  [[nodiscard]] int offCurve() const { return offCurve_; }

  /// How the errors eta_T^2 [J/m] by bodies and triangles have fallen since the last call, at each vertex.
  void learn(const std::vector<Vector>& errors);
  /// The error of unbounded stresses that estimates leave out, as far as rates are known. At a vertex where
  /// the error goes like area^s, a mesh of half the size reduces it by 1 - 4^-s, which is what the recovered
  /// stress shows: the whole is 1/(1 - 4^-s) times as large [J/m].
  [[nodiscard]] double unresolved() const;
  /// \param errors  eta_T^2 [J/m] by bodies and triangles  \param aim  what the root of their sum shall
  /// become
  void refine(const std::vector<Vector>& errors, double aim);
  /// Cuts every triangle in two.
  void refineAll();
  /// Gives each of two lines that face each other a vertex where the other one has a corner.
  void faceCorners(size_t body, int label, size_t otherBody, int otherLabel);
  /// Cuts the triangles of the first line until none of its edges is longer than twice those that it faces.
  void faceSizes(size_t body, int label, size_t otherBody, int otherLabel);

 private:
  struct Adapted {
    TriangleMesh mesh;
    CurvedEdges curves;
    std::vector<std::string> polygons;
    // By vertices, of the triangles around them:
    std::vector<double> error;  ///< eta^2 in the last round [J/m]
    std::vector<double> area;   ///< [m^2]
    std::vector<double> rate;   ///< s; infinite where it is not known
  };
  void learnRates(Adapted& body, const Vector& error, double rounding) const;
  /// \returns the triangle of which each new one is a part
  std::vector<int> cut(Adapted& body, const std::vector<char>& marked,
                       std::vector<double>* byVertex = nullptr);
  void cutToSize(Adapted& body, const Vector& reduction, std::vector<char> marked);
  void cutAtSingularities(Adapted& body, double allowed);

  int degree_;
  std::vector<Adapted> bodies_;
  int offCurve_ = 0;
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
