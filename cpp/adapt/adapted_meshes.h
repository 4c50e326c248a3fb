// Meshes that are refined together, each triangle to the size at which the estimate of the whole meets an
// aim: with the errors eta_T of the triangles (in the energy norm), p the degree and A_T the areas,
//
//   r_T = c eta_T^(-1/(p+1)),  1/8 <= r_T <= 1,     sum of eta_T^2 r_T^(2p) = aim^2,
//
// A_T r_T^2 is the area that a triangle should have; the mean of its logarithm over the triangles of a vertex
// is a field by which triangles are cut until they are small enough. Two things are done beside that:
//   - the triangles that make half of the error (Doerfler 1996) are cut in any case;
//   - where the error of the triangles of a vertex has fallen from one round to the next like area^s with
//     s < 1.1, the stress is unbounded there: they are cut again and again,
//     until they are to be a hundredth of the aim.
#pragma once

#include <string>
#include <vector>

#include "adapt/curves.h"
#include "base/types.h"

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
  /// What estimates do not see of unbounded stresses, as far as rates are known. At a vertex where the error
  /// goes like area^s, a mesh of half the size takes 1 - 4^-s of it away, and that is what a field recovered
  /// from this mesh tells: in all it is 1/(1 - 4^-s) times as large [J/m].
  [[nodiscard]] double unseen() const;
  /// \param errors  eta_T^2 [J/m] by bodies and triangles  \param aim  what the root of their sum shall
  /// become
  void refine(const std::vector<Vector>& errors, double aim);
  /// Cuts every triangle in two.
  void refineAll();
  /// Gives each of two lines that face each other a vertex where the other one has a corner
  /// (adapt/facing_corners.h).
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

}  // namespace mortier
