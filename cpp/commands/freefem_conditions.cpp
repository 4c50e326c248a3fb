// Supports and loads in FreeFEM's language.
#include <algorithm>

#include "commands/freefem.h"
#include "fem/element.h"
#include "mesh/boundary_line.h"
#include "scene/document.h"

namespace mortier {

namespace {

using Kind = ConditionDescription::Kind;

/// In the plane.
bool isRoller(const ConditionDescription& condition) {
  return condition.kind == Kind::displacement && !condition.point &&
         (condition.component == alongNormal || condition.component == alongTangent);
}

/// Whether a force or a moment moves a tool.
bool isPushed(const BodyDescription& body) {
  return body.isTool() && std::any_of(body.conditions.begin(), body.conditions.end(),
                                      [](const auto& c) { return c.kind == Kind::traction; });
}

/// The call that adds its equations.
std::string pushedTool(const BodyDescription& tool, int number) {
  std::string text = "freeTool(" + std::to_string(number) + ", " + shortest(tool.reference->x()) + ", " +
                     shortest(tool.reference->y());
  for (const ConditionDescription& c : tool.conditions)
    text += (c.kind == Kind::traction ? ", 1, " : ", 0, ") + freefemExpression(c.value);
  return text + "); ";
}

/// A body whose boundary (its labels) moves as a rigid one is free of stress, and moves so inside. Of a tool
/// that forces move what is held beside pushedTool().
std::string rigidMotion(const BodyDescription& tool, const std::vector<int>& labels, bool axisymmetric) {
  if (isPushed(tool) && !axisymmetric) return "";
  std::string on = "+ on(";
  for (const int label : labels) on += std::to_string(label) + ", ";
  if (isPushed(tool)) return on + "u1 = 0) ";
  const auto value = [&](int c) { return freefemExpression(tool.conditions[c].value); };
  const auto arm = [&](const char* x, double at) {
    return "*(" + std::string(x) + " - (" + shortest(at) + "))";
  };
  return on + "u1 = (" + value(0) + ") - (" + value(2) + ")" + arm("y", tool.reference->y()) + ", u2 = (" +
         value(1) + ") + (" + value(2) + ")" + arm("x", tool.reference->x()) + ") ";
}

}  // namespace

/// Loads by the rules that mortier takes (docs/theory.md) where these integrate them, with quadratic
/// displacements by FreeFEM's own of degree 5; others, which mortier resolves, by those of degree 9 on
/// edges and triangles. A macro must not be empty.
std::string freefemConditions(const SceneDescription& scene, const Model& model, size_t b) {
  const BodyDescription& body = scene.bodies[b];
  const bool space = scene.inSpace();
  const bool axisymmetric = scene.plane == Plane::axisymmetric;
  const std::string own = axisymmetric ? "*2*pi*x" : "";  // beside FreeFEM's rules
  const bool linear = scene.degree == 1 && !space;
  const std::string n = std::to_string(b + 1);
  std::string supports;
  std::string loads;
  if (body.isTool()) supports += rigidMotion(body, boundaryLabels(model.bodies[b].mesh()), axisymmetric);
  for (const ConditionDescription& c : body.conditions) {
    const std::string value = freefemExpression(c.value);
    const std::string label = std::to_string(c.label);
    const std::string component = std::to_string(c.component + 1);
    if (c.point || (!space && isRoller(c))) continue;
    if (c.kind == Kind::displacement) {
      supports += "+ on(" + label + ", u" + component + " = " + value + ") ";
      continue;
    }
    const bool simpson = linear && c.value.value.degree <= LinearTriangle::edgeExact;
    const bool rough = !space && c.value.value.degree > QuadraticTriangle::edgeExact;
    const std::string direction = c.component != alongNormal ? "v" + component
                                  : space                    ? "(N.x*v1 + N.y*v2 + N.z*v3)"
                                                             : "(N.x*v1 + N.y*v2)";
    loads += simpson ? "+ simpson(" + n + ", " + label + ", (" + value + ")*" + direction + ") "
                     : (space ? "+ int2d(Body" : "+ int1d(Body") + n + ", " + label +
                           (rough ? ", qfe = qf5pE)((" : ")((") + value + ")*" + direction + own + ") ";
  }
  for (int c = 0; c < (space ? 3 : 2); ++c) {
    if (!body.force[c]) continue;
    const bool midpoints = linear && body.force[c]->value.degree <= LinearTriangle::loadExact;
    const bool rough = !space && body.force[c]->value.degree > QuadraticTriangle::loadExact;
    const std::string value = "(" + freefemExpression(*body.force[c]) + ")*v" + std::to_string(c + 1);
    loads += midpoints ? "+ midpoints(" + n + ", " + value + ") "
                       : (space ? "+ int3d(Body" : "+ int2d(Body") + n + (rough ? ", qft = qf9pT)(" : ")(") +
                             value + own + ") ";
  }
  const auto orZero = [&](const std::string& terms, const char* zero) {
    return terms.empty() ? (space ? "+ int3d(Body" : "+ int2d(Body") + n + ")(" + zero + ") " : terms;
  };
  return "macro supports" + n + ' ' + orZero(supports, "0.*u1*v1") + "//\nmacro loads" + n + ' ' +
         orZero(loads, "0.*v2") + "//\n";
}

std::string freefemSpecialSupports(const SceneDescription& scene) {
  std::string tools;
  std::string rollers;
  std::string points;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    if (isPushed(scene.bodies[b])) tools += pushedTool(scene.bodies[b], static_cast<int>(b) + 1);
    for (const ConditionDescription& c : scene.bodies[b].conditions) {
      const std::string body = "(" + std::to_string(b + 1) + ", ";
      const std::string value = ", " + freefemExpression(c.value) + ") ";
      if (isRoller(c))
        rollers += "roller" + body + std::to_string(c.label) + ", " +
                   (c.component == alongNormal ? "normal" : "tangent") + value;
      if (c.point && !scene.bodies[b].isTool())
        points += "heldPoint" + body + shortest(c.point->x()) + ", " + shortest(c.point->y()) + ", " +
                  std::to_string(c.component + 1) + value;
    }
  }
  return freefemMacro("freeTools", tools, "body, x, y, (1: a force, value) along x, y, about them") +
         freefemMacro("rollers", rollers, "body, label, direction, displacement") +
         freefemMacro("heldPoints", points, "body, x, y, component, displacement");
}

}  // namespace mortier
