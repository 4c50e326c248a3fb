// The parts of a scene that are read one by one (scene.cpp). Whatever is wrong is an InputError with one line
// `file:line: subject: key = value, expected ...`.
#pragma once

#include "mesh/shape.h"
#include "mesh/space_shapes.h"
#include "scene/scene.h"
#include "scene/table_reader.h"

namespace mortier {

/// Sets `path=value` in the document, before it is validated. Where the path meets an array of tables its
/// next component is the name of an element (or the label, in body.boundary), or its index from 0, or is left
/// out, which means every element:
///   time.steps=20   contact.variant=interpolation   body.upper.mesh=a.mesh
///   body.material.projection=frobenius
void applyOverride(Node& document, const std::string& setting);

/// The units that a scene says.
Units readUnits(const Node& scene);
/// Makes numbers of the scene's units of all numbers with a unit, young = "210 GPa". What has no unit that is
/// known, or one of another dimension, is refused, and any unit in a scene that says none.
void convertMeasures(Node& scene, const Units& units);

/// [time]: equal steps, or steps chosen by their error.
TimePlan readTime(const Node& node);

/// [[body]]: mesh, materials, regions, forces and boundary conditions. `scenePath` is the file that names the
/// mesh; `index` names a body that has no name yet.
BodyDescription readBody(const Node& node, const std::string& scenePath, size_t index);
/// `mesh = { shape = "rectangle", ... }`
MeshShape readShape(const TableReader& table);
/// The same in space.
SpaceShape readSpaceShape(const TableReader& table);
/// Whether a word of `shape` is one in space.
bool isSolidShape(const std::string& word);
/// What makes a body in space of a plane mesh; none where no key asks for it.
std::optional<Sweep> readSweep(const TableReader& table);
const Keys& sweepKeys();

/// Its mesh. \param owner  of the key `mesh`
void readMeshSource(const TableReader& owner, const std::string& scenePath, BodyDescription& body);
/// [[tool]]; the plane of the scene is known.
BodyDescription readTool(const Node& node, const SceneDescription& scene, size_t index);
/// [[x, y], ...] \throws InputError that says what was expected
std::vector<Point> readPoints(const TableReader& table, const std::string& key, const std::string& expected);

/// Elasticity, and the law by which it flows; a key that belongs to another law is refused.
MaterialDescription readMaterial(const Node& node, const std::string& path, const std::string& subject);
/// Plasticity has no rate at a given stress: a scene whose steps need one is refused.
void requireRates(const BodyDescription& body, const SceneDescription& scene);
/// Isotropic by young and poisson, orthotropic by nine constants, general by its matrix, and the axes it is
/// turned by; the coefficients of thermal expansion.
void readElasticity(const TableReader& table, MaterialDescription& material);
/// Refuses a law that asks for isotropic elasticity beside another.
void requireTakesElasticity(const TableReader& table, const MaterialDescription& material);
/// law = "expression": rate11, rate22, rate12, rate33 in s11, s22, s12, s33, e11, e22, e12, e33 and what
/// `parameters` names, numbers and expressions.
OwnLaw readExpressionLaw(const TableReader& table);
/// A law that a program has registered (scene/registered_laws.h).
OwnLaw readRegisteredLaw(const TableReader& table);

/// Refuses keys of space in the plane, and those of the plane in space.
void requireOfDimension(const TableReader& table, const Keys& ofSpace, const Keys& ofPlane);
/// Refuses what is not known in space.
void requireKnownInSpace(const TableReader& root, const SceneDescription& scene);

/// `body` of a table: one that the scene has.
std::string nameOfBody(const TableReader& table, const SceneDescription& scene);
/// [[contact]]; `scene` holds the bodies and the contacts that were read before.
ContactDescription readContact(const Node& node, const SceneDescription& scene);
/// [[quantity]]; the bodies of the scene are there.
QuantityDescription readQuantity(const Node& node, const SceneDescription& scene);

}  // namespace mortier
