// From a resolved scene to what is solved: conditions checked against the meshes, bodies and interfaces made.
#pragma once

#include <functional>

#include "fem/body.h"
#include "mesh/simplices.h"
#include "scene/resolve.h"
#include "time/march.h"

namespace mortier {

/// The meshes of the scene become those of the model. What is doubtful but legal, the linter names.
/// \throws InputError with one line that names the scene's file and line (or the mesh's): data that are not
/// finite somewhere, corners with two displacements, bodies that do not face each other.
Model buildModel(ResolvedScene& scene);

/// What a resolved scene asks for. \throws InputError with file and line: a label without supports has no
/// reaction, one that is no side of contact no contact force, and a point outside of its body no
/// displacement.
std::vector<Quantity> buildQuantities(const SceneDescription& scene, const Model& model);

/// How far initial stresses are from equilibrium with what acts at t = 0.
/// \returns what a user may not have meant: by how much the initial stresses of `state` change at t = 0
/// (time/initial_balance.h); empty where they are in equilibrium. \throws InputError, UnheldBodyError
std::string findInitialEquilibrium(const SceneDescription& scene, const Model& model, State state);

/// In words, with what it does: distances that are not larger than what polygons are off the curves behind
/// them. Empty where there is nothing to say.
std::string doubtOfPolygons(const ContactInterface& interface, const std::string& length);

// Parts of a model. \throws InputError

/// Centres of a few hundred elements: enough to find an expression that has no value.
template <class Mesh>
auto centresOf(const Mesh& mesh) {
  std::decay_t<decltype(mesh.vertices)> places;
  const auto& elements = elementsOf(mesh);
  for (size_t e = 0; e < elements.size(); e += 1 + elements.size() / 500) {
    auto& centre = places.emplace_back(mesh.vertices[elements[e][0]]);
    for (size_t k = 1; k < elements[e].size(); ++k) centre += mesh.vertices[elements[e][k]];
    centre /= static_cast<double>(elements[e].size());
  }
  return places;
}

/// \param plane  none in space \param angles  of its axes at all of its points, one where they are the same
std::shared_ptr<const Material> buildMaterial(const MaterialDescription& description, Plane plane,
                                              const std::vector<double>& angles = {0});
/// By what angle the axes of a material are turned at each of the places [rad]; one where it is everywhere
/// the same. \throws InputError
template <class Place>
std::vector<double> anglesOf(const MaterialDescription& description, const std::vector<Place>& places) {
  if (!description.anisotropy || !description.anisotropy->angle || places.empty()) return {0};
  const Expression& angle = *description.anisotropy->angle;
  return valuesAt(angle, angle.constant ? std::vector<Place>{places.front()} : places);
}
/// One material, or as many as regions ask for. \param regions  by elements \param points  of the whole body
std::shared_ptr<const Material> materialOfRegions(
    const BodyDescription& body, const std::vector<int>& regions, size_t points,
    const std::function<std::shared_ptr<const Material>(const MaterialDescription&)>& make);
/// In the plane or in space. Data are tried at `times` [s].
template <class Mesh>
Body buildBody(const BodyDescription& body, Mesh mesh, const SceneDescription& scene,
               const std::vector<double>& times);
/// What a temperature of 1 strains at `places`, the stress points of the mesh, times the nodal values where
/// the body has a file of them: components x places. \throws InputError where the temperature is not finite.
template <class Mesh, class Place>
Matrix expansionOf(const BodyDescription& body, const Mesh& mesh, Plane plane,
                   const std::vector<Place>& places, const std::vector<double>& times);
/// Adds the interface to the model, which has its bodies.
void addContact(const SceneDescription& scene, const ContactDescription& contact, Model& model);

}  // namespace mortier
