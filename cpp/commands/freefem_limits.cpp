#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "commands/freefem.h"
#include "contact/directions.h"
#include "contact/smooth_part.h"
#include "contact/surface.h"
#include "scene/document.h"
#include "scene/resolve.h"

namespace mortier {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& expected) {
  throw InputError(what + ", expected " + expected + " (all that the FreeFEM method knows)");
}

/// \throws InputError for the first thing in the scene that the FreeFEM method does not know.
void requireKnown(const SceneDescription& scene, bool stepsGiven) {
  if (scene.goesOn()) refuse((scene.start.empty() ? scene.path : scene.startWhere) + ": start", "none");
  if (scene.contacts.empty()) refuse(scene.path + ": no contact interface", "one at least");
  if (scene.time.scheme != Scheme::backwardEuler)
    refuse(scene.path + ": scheme = " + word(scene.time.scheme), "backward-euler");
  if (scene.time.controlled() && !stepsGiven)
    refuse(scene.path + ": tolerance = " + shortest(scene.time.tolerance),
           "equal steps, or those of a run (--steps-of)");
  forEachPair(scene, [](const ContactDescription& pair) {
    if (pair.nonmortar().body == pair.mortar().body)
      refuse(pair.where + ": two sides of one body", "two bodies");
  });
  for (const BodyDescription& body : scene.bodies) {
    for (const ConditionDescription& c : body.conditions)
      if (body.isTool() && c.turns() && isFollowed(scene, body.name) &&
          (c.kind == ConditionDescription::Kind::traction ||
           !(c.value.constant && c.value.value(0, 0, 0) == 0)))
        refuse(c.where + ": tool " + body.name + ": a tool that turns beside sliding = \"finite\"",
               "no rotation");
    for (const ConditionDescription& c : body.conditions)
      if (c.point && c.kind == ConditionDescription::Kind::traction && !body.isTool())
        refuse(c.where + ": body " + body.name + ": a force at a point", "none");
    const bool stressed = std::any_of(body.initialStress.begin(), body.initialStress.end(),
                                      [](const auto& component) { return component.has_value(); });
    if (stressed || !body.regions.empty())
      refuse(body.where + ": body " + body.name + ": regions or initial stress", "neither");
    if (const auto* own = body.material.as<OwnLaw>()) {
      if (!own->texts) refuse(own->where, "a law of mortier's own or \"expression\"");
      if (body.temperature) refuse(body.temperature->where + ": temperature", "none beside such a law");
      if (scene.plane == Plane::axisymmetric)
        refuse(own->where + " beside plane = \"axisymmetric\"", "\"stress\" or \"strain\"");
    }
    const MaterialDescription& material = body.material;
    if (material.anisotropy && material.flows())
      refuse(material.anisotropy->where, "\"isotropic\" beside flow");
    if (material.anisotropy && body.temperature)
      refuse(body.temperature->where + ": temperature", "none beside elasticity that is not isotropic");
  }
}

/// Whether the elements stand for one circle, or for nothing that is known.
bool isOneCurve(const SmoothPart& part) {
  const Arc& first = part.arcs.front();
  return std::all_of(part.arcs.begin(), part.arcs.end(), [&](const Arc& arc) {
    return !arc.curve.known() && arc.known == first.known && (!arc.known || arc.curvature == first.curvature);
  });
}

/// \throws InputError where quadratic triangles have curved sides: FreeFEM's are straight.
void requireStraightSides(const SceneDescription& scene, const Model& model) {
  constexpr double rounding = 1e-12;
  if (scene.degree != 2) return;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const TriangleMesh& mesh = model.bodies[b].mesh();
    for (size_t e = 0; e < mesh.edgeMiddles.size(); ++e) {
      const auto& [from, to] = mesh.boundaryEdges[e];
      const Point side = mesh.vertices[to] - mesh.vertices[from];
      const Point off = mesh.edgeMiddles[e] - mesh.vertices[from] - side / 2;
      if (off.allFinite() && off.norm() > rounding * side.norm())
        refuse(scene.bodies[b].meshWhere + ": body " + scene.bodies[b].name + ": a mesh with curved sides",
               "straight ones beside degree = 2");
    }
  }
}

/// Whether contact is at a corner or an end of a line, along the normal of the other one.
bool isAtCorner(const SmoothPart& part, const BoundaryLine& across) {
  const ContactDirections directions = contactDirections(part, MortarLine(across));
  const std::vector<double>& share = directions.mortarShare;
  return !directions.corners.empty() ||
         (part.straight && std::any_of(share.begin(), share.end(), [](double each) { return each > 0; }));
}

/// \throws InputError where a line of contact has corners that count, is closed on the nonmortar side or is
/// made of several curves.
void requireSmooth(const SceneDescription& scene, const Model& model) {
  std::vector<const TriangleMesh*> meshes;
  for (const Body& body : model.bodies) meshes.push_back(&body.mesh());
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactPair& pair = model.interfaces[k].pair();
    const auto partsOf = [&](const ContactSide& side, Kinks kinks) {
      return smoothParts(boundaryLine(model.bodies[side.body].mesh(), side.label), kinks);
    };
    const std::vector<SmoothPart> parts = partsOf(pair.nonmortar, Kinks::none);
    const std::vector<SmoothPart> across = partsOf(pair.mortar, Kinks::ofStraightElements);
    const auto straight = [](const SmoothPart& part) { return part.straight; };
    // Contact acts along the normals of the nonmortar line alone, whatever corners the other one has.
    const ContactDescription& contact = scene.contacts[k];
    const bool oneNormal = contact.sliding == SlidingKind::finite
                               ? stiffnessRatio(scene, contact.nonmortar(), contact.mortar(), meshes) >= 1
                               : parts.front().straight;
    const bool cornersCount =
        parts.size() > 1 ||
        (across.size() > 1 && !(oneNormal && std::all_of(across.begin(), across.end(), straight)));
    if (cornersCount || parts.front().closed)
      refuse(contact.where + ": contact: a line with corners, or a closed one on the nonmortar side",
             "lines without corners, an open one on the nonmortar side");
    if (!isOneCurve(parts.front()) || !std::all_of(across.begin(), across.end(), isOneCurve))
      refuse(scene.contacts[k].where + ": contact: a line of several curves",
             "one circle, one straight line, or a polygon");
    const ContactSide& mortar = pair.mortar;
    if (isAtCorner(parts.front(), boundaryLine(model.bodies[mortar.body].mesh(), mortar.label)))
      refuse(contact.where + ": contact: a corner or an end of a line that touches the other one",
             "sides along each other");
  }
}

}  // namespace

void requireFreefemKnows(const SceneDescription& scene, const Model& model, bool stepsGiven) {
  requireKnown(scene, stepsGiven);
  if (scene.inSpace()) return requireFreefemKnowsSpace(scene, model);
  requireSmooth(scene, model);
  requireStraightSides(scene, model);
}

namespace {

using Kind = ConditionDescription::Kind;

/// Whether the surface is of planes that meet at more than 40 degrees: the method takes distances as meshed,
/// and has other corners.
bool hasPlaneParts(const ContactSurface& surface) {
  constexpr double rounding = 1e-9;
  std::map<std::array<int, 2>, SpacePoint> normals;  // by edges
  for (size_t t = 0; t < surface.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const SpacePoint& own = surface.normals[t];
      if ((surface.vertexNormals[t][k].n - own).norm() > rounding) return false;
      const auto [low, high] = std::minmax(surface.triangles[t][k], surface.triangles[t][(k + 1) % 3]);
      const auto [across, isNew] = normals.try_emplace({low, high}, own);
      if (!isNew && (across->second - own).norm() > rounding && across->second.dot(own) > std::cos(sharpTurn))
        return false;
    }
  return true;
}

}  // namespace

void requireFreefemKnowsSpace(const SceneDescription& scene, const Model& model) {
  const auto refuse = [](const std::string& what, const std::string& expected) {
    throw InputError(what + ", expected " + expected + " (all that the FreeFEM method knows in space)");
  };
  if (scene.degree != 1) refuse(scene.path + ": degree = 2", "1");
  for (const BodyDescription& body : scene.bodies) {
    if (body.isTool()) refuse(body.where + ": tool " + body.name, "bodies that strain");
    if (body.material.flows() && body.material.as<Viscoplasticity>() == nullptr)
      refuse(body.where + ": body " + body.name + ": material: law", "\"elastic\" or \"perzyna\"");
    if (body.temperature) refuse(body.temperature->where + ": temperature", "none");
    if (body.material.anisotropy) refuse(body.material.anisotropy->where, "\"isotropic\"");
    for (const ConditionDescription& c : body.conditions) {
      if (c.pointInSpace) refuse(c.where + ": body " + body.name + ": a support at a point", "labels");
      if (c.kind == Kind::displacement && c.component == alongNormal)
        refuse(c.where + ": body " + body.name + ": un", "ux, uy or uz");
    }
  }
  for (size_t k = 0; k < scene.contacts.size(); ++k) {
    if (scene.contacts[k].gap) refuse(scene.contacts[k].where + ": contact: gap", "distances as meshed");
    if (scene.contacts[k].friction.any()) refuse(scene.contacts[k].where + ": contact: friction", "none");
    if (scene.contacts[k].sliding == SlidingKind::finite)
      refuse(scene.contacts[k].where + ": contact: sliding = \"finite\"", "refuse or allow");
    if (scene.contacts[k].initial == InitialGap::close)
      refuse(scene.contacts[k].where + ": contact: initial = \"close\"", "distances as meshed");
    const ContactPair& pair = model.interfaces[k].pair();
    for (const ContactSide* side : {&pair.nonmortar, &pair.mortar}) {
      const Body& body = model.bodies[side->body];
      if (!hasPlaneParts(ContactSurface(body.space()->mesh(), body.space()->nodes(), side->label)))
        refuse(scene.contacts[k].where + ": contact: a curved surface of body " + body.name(), "plane ones");
    }
  }
}

}  // namespace mortier
