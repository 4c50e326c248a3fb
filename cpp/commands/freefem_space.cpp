// `mortier freefem`: bodies in space (freefem/space.idp).
#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "commands/freefem.h"
#include "contact/surface.h"
#include "scene/document.h"

namespace mortier {

namespace {

using Kind = ConditionDescription::Kind;

/// Whether every smooth part is plane: the method takes distances as meshed.
bool hasPlaneParts(const ContactSurface& surface) {
  constexpr double rounding = 1e-9;
  for (size_t t = 0; t < surface.triangles.size(); ++t)
    for (const SpacePoint& normal : surface.vertexNormals[t])
      if ((normal - surface.normals[t]).norm() > rounding) return false;
  return true;
}

}  // namespace

void requireFreefemKnowsSpace(const SceneDescription& scene, const Model& model) {
  const auto refuse = [](const std::string& what, const std::string& expected) {
    throw InputError(what + ", expected " + expected + " (all that the FreeFEM method knows in space)");
  };
  if (scene.degree != 1) refuse(scene.path + ": degree = 2", "1");
  for (const BodyDescription& body : scene.bodies) {
    if (body.material.flows() && body.material.as<Viscoplasticity>() == nullptr)
      refuse(body.where + ": body " + body.name + ": material: law", "\"elastic\" or \"perzyna\"");
    if (body.temperature) refuse(body.temperature->where + ": temperature", "none");
    if (body.material.anisotropy) refuse(body.material.anisotropy->where, "\"isotropic\"");
    for (const ConditionDescription& c : body.conditions) {
      if (c.pointInSpace) refuse(c.where + ": body " + body.name + ": a support at a point", "labels");
      if (c.kind == Kind::displacement && c.component == spaceNormal)
        refuse(c.where + ": body " + body.name + ": un", "ux, uy or uz");
    }
  }
  for (size_t k = 0; k < scene.contacts.size(); ++k) {
    if (scene.contacts[k].gap) refuse(scene.contacts[k].where + ": contact: gap", "distances as meshed");
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

std::string freefemSpaceConditions(const BodyDescription& body, int number) {
  const std::string n = std::to_string(number);
  std::ostringstream supports;
  std::ostringstream loads;
  for (const ConditionDescription& c : body.conditions) {
    const std::string value = freefemExpression(c.value);
    if (c.kind == Kind::displacement)
      supports << "+ on(" << c.label << ", u" << c.component + 1 << " = " << value << ") ";
    else
      loads << "+ int2d(Body" << n << ", " << c.label << ")((" << value << ")*"
            << (c.component == spaceNormal ? "(N.x*v1 + N.y*v2 + N.z*v3)"
                                           : "v" + std::to_string(c.component + 1))
            << ") ";
  }
  for (int c = 0; c < 3; ++c)
    if (body.force[c])
      loads << "+ int3d(Body" << n << ")((" << freefemExpression(*body.force[c]) << ")*v" << c + 1 << ") ";
  const auto orZero = [&](const std::ostringstream& terms, const char* zero) {
    return terms.str().empty() ? "+ int3d(Body" + n + ")(" + zero + ") " : terms.str();
  };
  return "macro supports" + n + ' ' + orZero(supports, "0.*u1*v1") + "//\nmacro loads" + n + ' ' +
         orZero(loads, "0.*v2") + "//\n";
}

}  // namespace mortier
