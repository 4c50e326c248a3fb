// A body on its matched mesh, loaded by given contact pressures instead of the other bodies, and the stress
// in equilibrium with all of that.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "bound/checks.h"
#include "bound/lift.h"
#include "bound/matched_meshes.h"
#include "bound/side_tractions.h"
#include "solver/state.h"

namespace mortier {

/// How far data of one kind are from linear functions on sides, or constants on triangles.
struct Oscillation {
  double off = 0;
  double all = 0;
  void add(double weight, double deviation, double value) {
    off += weight * deviation * deviation;
    all += weight * value * value;
  }
  /// Of a function on a side.
  void addLinear(double length, const std::function<double(double)>& value) {
    const double first = value(0);
    const double last = value(1);
    for (const double s : {0.25, 0.5, 0.75}) {
      const double v = value(s);
      add(length, v - ((1 - s) * first + s * last), std::max({std::abs(v), std::abs(first), std::abs(last)}));
    }
  }
  void add(const Oscillation& other) {
    off += other.off;
    all += other.all;
  }
  [[nodiscard]] double relative() const { return all > 0 ? std::sqrt(off / all) : 0; }
};

/// What is prescribed of a body, by kinds: each has its own unit.
struct DataOscillation {
  Oscillation displacements, tractions, forces;
  void add(const DataOscillation& other) {
    displacements.add(other.displacements);
    tractions.add(other.tractions);
    forces.add(other.forces);
  }
  /// The worst of them.
  [[nodiscard]] double relative() const {
    return std::max({displacements.relative(), tractions.relative(), forces.relative()});
  }
};

/// The law of a body, linearised at its stresses. \param weight  time step times the scheme's diagonal
/// coefficient; 0 for elasticity [s]
Linearisation linearisedLaw(const Body& body, const Matrix& stress, double weight);

class LoadedBody {
 public:
  /// What it is given must outlive it. \param weight  of linearisedLaw(), by which its stress in equilibrium
  /// is made near
  LoadedBody(const Model& model, const State& state, const CutMesh& cut, int index, double weight = 0);

  [[nodiscard]] const TriangleMesh& mesh() const { return cut_.mesh; }
  /// Of each triangle, that of the body's own mesh of which it is a part.
  [[nodiscard]] const std::vector<int>& parents() const { return cut_.parents; }
  /// Rigid motions that its supports leave free (fem/rigid_modes.h).
  [[nodiscard]] const Matrix& modes() const { return modes_; }
  /// Nodal forces of loads and of the pressures so far [N/m].
  [[nodiscard]] const Vector& load() const { return load_; }
  [[nodiscard]] LiftedBody lifted() const { return {body_, parents(), sides_, moduli_, displacement_}; }
  [[nodiscard]] const DataOscillation& oscillation() const { return oscillation_; }
  /// Whether supports act along the normals or tangents of a curve: those of sides are not those of nodes.
  [[nodiscard]] bool hasCurvedSupport() const { return curvedSupport_; }

  /// A pressure on the side between two vertices, by its moments at the first and at the second [N/m].
  void press(const std::array<int, 2>& vertices, const Point& outward, const std::array<double, 2>& moments);
  /// Finds the stress in equilibrium. \returns false where the tangent cannot be factorised
  /// \throws Interrupted
  bool balance();

  [[nodiscard]] const Vector& energies() const { return energies_; }  ///< |s^ - s|^2 by triangles [J/m]
  [[nodiscard]] double norm() const;                                  ///< |s|^2 [J/m]
  /// Moments of the traction on this body at the side between two vertices, at the first and the second.
  [[nodiscard]] std::array<Point, 2> momentsBetween(const std::array<int, 2>& vertices) const;
  [[nodiscard]] Imbalance imbalance() const;

  // What a problem with other data needs of it.

  /// The same body and supports without loads; `near` (dofs) is the displacement to whose stress that in
  /// equilibrium shall be near.
  [[nodiscard]] LoadedBody unloaded(const Vector& near) const;
  /// A constant traction on a label [Pa].
  void pull(int label, const Point& traction);
  /// A constant body force on a triangle [N/m^3].
  void push(int triangle, const Point& force);
  [[nodiscard]] const Body& body() const { return body_; }
  /// Values of the tangent's pattern.
  [[nodiscard]] std::vector<double> tangent() const;
  /// (s11, s22, s12) by triangles of a displacement (dofs).
  [[nodiscard]] std::vector<Stress> stressOf(const Vector& displacement) const;
  /// (p, q, r) of the strain of a displacement (dofs) in a triangle.
  [[nodiscard]] Eigen::Vector3d strainIn(int triangle, const Vector& displacement) const;
  /// Nodal forces less those of a stress.
  [[nodiscard]] Vector leftOver(Vector forces, const std::vector<Stress>& stress) const;
  [[nodiscard]] const std::vector<Stress>& stress() const { return stress_; }  ///< s
  /// Of s^ in a triangle.
  [[nodiscard]] Moments momentsOf(int triangle) const {
    return mortier::momentsOf(sides_, moments_, triangle);
  }
  [[nodiscard]] CompositeTriangle elementOf(int triangle) const;
  [[nodiscard]] const Point& forceOn(int triangle) const { return forces_[triangle]; }

 private:
  void readForces(double t);
  void readBoundary(double t);
  [[nodiscard]] int sideBetween(const std::array<int, 2>& vertices) const;
  [[nodiscard]] bool holds(const Side& side, const Point& direction) const;
  [[nodiscard]] Point gradient(int t, int i) const;
  bool equilibrate(std::vector<Stress>& stress) const;
  void pin(std::vector<double>& values) const;

  const CutMesh& cut_;
  Body body_;
  Sides sides_;
  Vector displacement_;
  Vector load_;
  Matrix modes_;
  std::vector<Eigen::Matrix3d> moduli_, compliances_;
  std::vector<Stress> stress_;  ///< s, that of the finite elements
  std::vector<Point> forces_;
  std::vector<KnownTraction> known_;
  DataOscillation oscillation_;
  bool curvedSupport_ = false;
  bool flows_ = false;   ///< its tangents may differ by many orders: iterations would not see the stiff part
  bool coarse_ = false;  ///< the model is: solutions of whole bodies cost little
  SideMoments moments_;
  Vector energies_;
};

}  // namespace mortier
