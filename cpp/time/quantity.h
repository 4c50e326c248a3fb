// Numbers that a user asks for, of every state of a run: forces of supports and of contact, displacements,
// energies and work, largest values.
//
// The forces that supports exert are the residual of equilibrium at the nodes that they hold,
//   r = sum |T| B' s + C' p - F.
// At a node with two prescribed motions r is split along their directions, so each label and each point has
// the forces of its own supports and those of all add up to all of r.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/units.h"
#include "mesh/line_part.h"
#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

struct Quantity {
  enum class Kind {
    reaction,
    contactForce,
    displacement,
    storedEnergy,      ///< integral of s : E^-1 s / 2 over the body
    dissipatedEnergy,  ///< integral of s : G over the body and the time since the run began
    work,              ///< of all forces on the body since then, those of contact included
    externalWork,      ///< of its loads and supports
    thermalWork,       ///< of its thermal strain: minus the integral of s : its rate
    largestPressure,   ///< of the contact pressure, 0 where there is none
    contactLength,     ///< of the part of Gamma_C where nodes press
    contactArea,       ///< the same in space
    largestMises,
    frictionWork,  ///< dissipated along the label since the run began
    meanPressure   ///< of the contact pressure over a part of a side
  };
  /// Moments about axes; the plane has momentZ, counterclockwise. The rotation is of rigid bodies.
  enum class Component { x, y, z, momentX, momentY, momentZ, rotationX, rotationY, rotationZ };

  std::string name;
  Kind kind = Kind::reaction;
  int body = 0;
  int label = 0;  ///< of the supports, or of a side of contact
  Component component = Component::x;
  SpacePoint about{0, 0, 0};  ///< of the moment; z = 0 in the plane [m]
  std::vector<std::pair<int, double>> mean =
      {};  ///< of a displacement: nodes and their weights, which sum to one
  /// In place of the label: of a displacement, or of a reaction that of a held vertex [m]
  std::optional<SpacePoint> point = {};
  std::optional<LinePart> part = {};  ///< of a mean pressure
  std::vector<Vector> shares = {};    ///< of contact forces in it (time/mean_pressure.h)
  bool whole = false;                 ///< of all of a rigid body, in place of a label

  /// N/m, N (a moment per metre of depth), m, J/m or Pa, in space N, N m, m, m^2, J or Pa, or what they are
  /// in other units.
  [[nodiscard]] std::string unit(const Units& units = {}) const;
};

/// Whether a kind is of one label of a body.
bool ofLabel(Quantity::Kind kind);
/// Whether a quantity has a component.
bool hasComponent(Quantity::Kind kind);
/// Whether it is one of forces about an axis.
bool isMoment(Quantity::Component component);
/// Whether the work done on bodies must be counted for it.
bool needsWork(const Quantity& quantity);
/// The first condition that holds a label of a body or, where one is given, a point; -1 for none.
int firstSupport(const Body& body, int label, const std::optional<SpacePoint>& point);

/// The value of each, in the units above. Forces act on the body.
std::vector<double> evaluate(const std::vector<Quantity>& quantities, const Model& model, const State& state);

/// Where a largest value is, as meshed [m]; none for other quantities, and where there is no contact.
/// z = 0 in the plane.
std::optional<SpacePoint> placeOf(const Quantity& quantity, const Model& model, const State& state);

/// How far the largest pressure may be off, estimated: the largest difference of it, as the mass matrix of C
/// has it, from the force of its node over the length of the row function, and from the normal stress that
/// the triangles at the node have in the mean; 0 where there is no contact [Pa].
double largestPressureError(const Quantity& quantity, const Model& model, const State& state);

/// The displacement at a point of a mesh as a mean of those of nodes; empty where the point is outside.
std::vector<std::pair<int, double>> meanAt(const TriangleMesh& mesh, const ElementNodes& nodes,
                                           const Point& point);

/// The mean displacement of a label in the same way: the integral over its length, or over the surface that
/// it is as it turns about the axis x = 0.
std::vector<std::pair<int, double>> meanOn(const TriangleMesh& mesh, const ElementNodes& nodes, int label,
                                           bool axisymmetric = false);
/// The same of a body in space.
std::vector<std::pair<int, double>> meanAt(const TetrahedronMesh& mesh, const SpaceNodes& nodes,
                                           const SpacePoint& point);
std::vector<std::pair<int, double>> meanOn(const TetrahedronMesh& mesh, const SpaceNodes& nodes, int label);

}  // namespace mortier
