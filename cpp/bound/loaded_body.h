// A body on its matched mesh, loaded by given contact pressures instead of the other bodies, and the stress
// in equilibrium with all of that.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bound/checks.h"
#include "bound/composite_triangle.h"
#include "bound/matched_meshes.h"
#include "bound/side_datum.h"
#include "bound/side_tractions.h"
#include "solver/state.h"

namespace mortier {

// The data of a body at a time, on its matched mesh: linear tractions on sides, constant forces and initial
// stresses on triangles, by which stresses and displacements are made, and bounds of what they leave. In each
// triangle there are
//
//   a stress s_D that carries the tractions and forces that are left, without tractions on other sides,
//   a displacement w, zero on other sides, the remainder of prescribed displacements and gaps,
//
// so that s^ + s_D and u^ + w are admissible for the data as given (docs/bounds.md has the proofs).

struct BodyData {
  /// What moves beside linear functions on a side: integral of w over it [m^2].
  struct Moved {
    int label = 0;
    Point integral{0, 0};
    double error = 0;  ///< of it
  };

  std::string obstacle;              ///< data that are not bounded
  std::string beyond;                ///< the first that is not linear, or constant; empty where all are
  std::vector<BodyLoad> forces;      ///< by triangles
  std::vector<KnownTraction> known;  ///< by sides
  Vector load;                       ///< nodal forces of these (dofs) [N/m]
  Vector carried;                    ///< |s_D| by triangles, at most [sqrt(J/m)]
  Vector strained;                   ///< |E eps(w) + what initial stresses vary by|, the same
  std::vector<Stress> meanCarried;   ///< integrals of what is known of these stresses [N]
  std::vector<Stress> meanStrained;
  std::vector<Moved> moved;
  double error = 0;  ///< of moments of tractions and forces, at most [N/m]
  bool curvedSupport = false;

  [[nodiscard]] bool linear() const { return beyond.empty(); }
};

/// A body on its matched mesh, its law linearised.
struct MatchedBody {
  const Body& own;  ///< on its own mesh
  const CutMesh& cut;
  Body body;  ///< on the matched mesh
  Sides sides;
  Vector displacement;                       ///< u_h
  std::vector<Eigen::Matrix3d> moduli;       ///< by triangles, on (p, q, r) of strains [Pa]
  std::vector<Eigen::Matrix3d> compliances;  ///< on (s11, s22, s12)
};

BodyData readData(const MatchedBody& place, double t);

/// The elasticity of a body.
Linearisation elasticLaw(const Body& body);

class LoadedBody {
 public:
  /// What it is given must outlive it.
  LoadedBody(const Model& model, const State& state, const CutMesh& cut, int index);

  [[nodiscard]] const MatchedBody& place() const { return place_; }
  [[nodiscard]] const TriangleMesh& mesh() const { return place_.cut.mesh; }
  /// Of each triangle, that of the body's own mesh of which it is a part.
  [[nodiscard]] const std::vector<int>& parents() const { return place_.cut.parents; }
  /// Rigid motions that its supports leave free (fem/rigid_modes.h).
  [[nodiscard]] const Matrix& modes() const { return modes_; }
  /// Nodal forces of loads and of the pressures so far [N/m].
  [[nodiscard]] const Vector& load() const { return data_.load; }
  /// What linear data leave. Supports along the normals or tangents of a curve (`curvedSupport`) are not
  /// those of nodes.
  [[nodiscard]] const BodyData& data() const { return data_; }
  /// Adds a displacement on a side between two vertices (unresolved_data.h), or returns its energy norm only.
  void move(const std::array<int, 2>& vertices, const Point& along, const SideDatum& datum);
  [[nodiscard]] double movedEnergy(const std::array<int, 2>& vertices, const Point& along,
                                   const SideDatum& datum) const;

  /// A pressure on the side between two vertices, by its moments at the first and at the second [N/m].
  void press(const std::array<int, 2>& vertices, const Point& outward, const std::array<double, 2>& moments);
  /// Finds the stress in equilibrium. \returns false where the tangent cannot be factorised
  /// \throws Interrupted
  bool balance();

  [[nodiscard]] const Vector& energies() const { return energies_; }  ///< |s^ - s|^2 by triangles [J/m]
  [[nodiscard]] double norm() const;                                  ///< |s|^2 [J/m]
  /// Moments of the traction on this body at the side between two vertices, at the first and the second; what
  /// is pressed in the directions in which supports hold the side: they take the rest.
  [[nodiscard]] std::array<Point, 2> asPressed(const std::array<int, 2>& vertices) const;
  /// Whether no support holds the side between two vertices.
  [[nodiscard]] bool isFree(const std::array<int, 2>& vertices) const {
    return data_.known[sideBetween(vertices)].count == 2;
  }
  [[nodiscard]] Imbalance imbalance() const;

  // What a problem with other data needs of it.

  /// The same body and supports without loads; `near` (dofs) is the displacement to whose stress that in
  /// equilibrium shall be near.
  [[nodiscard]] LoadedBody unloaded(const Vector& near) const;
  /// A constant traction on a label [Pa].
  void pull(int label, const Point& traction);
  /// A constant body force on a triangle [N/m^3].
  void push(int triangle, const Point& force);
  [[nodiscard]] const Body& body() const { return place_.body; }
  /// Values of the tangent's pattern.
  [[nodiscard]] std::vector<double> tangent() const;
  /// (s11, s22, s12) by triangles of a displacement (dofs).
  [[nodiscard]] std::vector<Stress> stressOf(const Vector& displacement) const;
  /// Nodal forces less those of a stress.
  [[nodiscard]] Vector leftOver(Vector forces, const std::vector<Stress>& stress) const;
  [[nodiscard]] const std::vector<Stress>& stress() const { return stress_; }  ///< s
  /// Of s^ in a triangle.
  [[nodiscard]] Moments momentsOf(int triangle) const {
    return mortier::momentsOf(place_.sides, moments_, triangle);
  }
  [[nodiscard]] CompositeTriangle elementOf(int triangle) const;
  [[nodiscard]] const BodyLoad& forceOn(int triangle) const { return data_.forces[triangle]; }

 private:
  [[nodiscard]] int sideBetween(const std::array<int, 2>& vertices) const;
  bool equilibrate(std::vector<Stress>& stress) const;
  void pin(std::vector<double>& values) const;

  MatchedBody place_;
  Matrix modes_;
  std::vector<Stress> stress_;  ///< s, that of the finite elements
  BodyData data_;
  SideMoments moments_;
  Vector energies_;
};

}  // namespace mortier
