// How large the data of a scene are in the course of a run, for comparisons with stiffness and strength.
#pragma once

#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "scene/scene.h"
#include "solver/model.h"

namespace mortier {

/// A scene and the meshes of its bodies; nullptr where one cannot be read.
struct MeshedScene {
  const SceneDescription& scene;
  std::vector<const TriangleMesh*> meshes;
  std::vector<const TetrahedronMesh*> spaceMeshes = {};  ///< in space, in place of `meshes`
};

MeshedScene meshedScene(const SceneDescription& scene, const Model& model);

/// A condition of a body with the points at which it is tried.
struct SampledDatum {
  enum class Kind { displacement, traction, force, temperature, distance };
  Kind kind = Kind::traction;
  size_t body = 0;
  const Expression* value = nullptr;
  std::vector<SpacePoint> points;
  double size = 0;  ///< extent of the body [m]; of a temperature 1 over the largest expansion [K]

  [[nodiscard]] double at(const SpacePoint& point, double t) const;
  /// Largest |value| over the points at a time.
  [[nodiscard]] double largest(double t) const;
  /// The same over the run: at its ends where the value is linear in time, else at the trial times.
  [[nodiscard]] double largestIn(const TimePlan& plan) const;
  /// Largest |value(t) - value(s)| over the points.
  [[nodiscard]] double change(double s, double t) const;
  /// Stress that a unit of the value causes, by order of magnitude: 1 of tractions, the extent of body
  /// forces, Young's modulus over the extent of displacements and distances, and times the thermal strain.
  [[nodiscard]] double stressOfUnit(const SceneDescription& scene) const;
};

/// Of all bodies whose mesh is known.
std::vector<SampledDatum> sampledData(const MeshedScene& input);

/// Times from 0 to the end, evenly; among them times that no period of an expression meets.
std::vector<double> trialTimes(const TimePlan& plan);

/// Whether the value differs at any of the times.
bool changesInTime(const SampledDatum& datum, const TimePlan& plan);

/// The stress that the data of the scene cause at a time, by order of magnitude [Pa]; of distances their
/// change counts.
double nominalStress(const SceneDescription& scene, const std::vector<SampledDatum>& data, double t);
/// The largest of the run.
double nominalStress(const SceneDescription& scene, const std::vector<SampledDatum>& data);

/// The datum whose change from one time to another causes the largest stress: the scene's words with file
/// and line, and its largest value at both times. Empty where none changes.
std::string drivingDatum(const MeshedScene& input, double from, double to);

// The steps in time of a run that is to reach an accuracy: equal ones would leave an error that no mesh takes
// away, so where bodies flow or slip a part of what is asked (0.2 of it, 0.3 at degree 2) is their tolerance.

bool hasFriction(const SceneDescription& scene);

/// Whether a material of the scene can flow, or a contact has friction.
bool stepsMatter(const SceneDescription& scene);

/// Tolerance of the steps of a run, of its last round where it has several; 0: equal steps.
double stepTolerance(const SceneDescription& scene);

}  // namespace mortier
