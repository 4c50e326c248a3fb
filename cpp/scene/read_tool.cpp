// [[tool]]: a rigid body by its outline and its motion.
#include <Eigen/Geometry>
#include <algorithm>

#include "base/error.h"
#include "mesh/box_of.h"
#include "scene/readers.h"

namespace mortier {
namespace {

std::vector<int> labelsOf(const TableReader& table, size_t sides) {
  std::vector<int> labels;
  for (size_t k = 0; k < sides; ++k) labels.push_back(static_cast<int>(k) + 1);
  if (!table.has("labels")) return labels;
  const std::vector<double> given = table.numbers("labels");
  const auto good = [](double x) { return x >= 0 && x <= 1e9 && x == std::floor(x); };
  if (given.size() != sides || !std::all_of(given.begin(), given.end(), good))
    table.reject("labels", "an integer >= 0 for each of the " + std::to_string(sides) + " sides");
  return {given.begin(), given.end()};
}

/// Beside one another: a side without length has no direction.
std::vector<Point> distinctPoints(const TableReader& table, size_t least, size_t most,
                                  const std::string& expected) {
  std::vector<Point> points = readPoints(table, "points", expected);
  const bool enough = points.size() >= least && points.size() <= most;
  if (!enough || std::adjacent_find(points.begin(), points.end()) != points.end())
    table.reject("points", expected);
  return points;
}

enum Family { line, disc, rectangle, polygon, spline, point };

Outline readOutline(const TableReader& table, bool axisymmetric) {
  constexpr size_t mostCorners = 1000;
  constexpr size_t mostPoints = 100;  // of a spline
  const auto family = table.choice<Family>("shape");
  table.requireBeside("shape", table.string("shape"));
  if (family == disc) {
    const Point centre = table.point("centre");
    const double radius = table.number("radius");
    if (axisymmetric && centre.x() != 0 && !(centre.x() >= radius))
      table.reject("centre", "one on the axis, or a circle beside it: x = 0 or x >= radius");
    return discOutline(centre, radius, axisymmetric);
  }
  if (family == line) {
    const std::vector<Point> ends =
        distinctPoints(table, 2, 2, "two points [[x, y], [x, y]], the tool to the left of the line");
    return lineOutline(ends[0], ends[1]);
  }
  if (family == rectangle) {
    const Point lower = table.point("lower");
    const Point upper = table.point("upper");
    if (!(lower.x() < upper.x() && lower.y() < upper.y()))
      table.reject("upper", "a point right of and above lower");
    return {{lower, {upper.x(), lower.y()}, upper, {lower.x(), upper.y()}}, {1, 2, 3, 4}};
  }
  if (family == polygon) {
    const std::vector<Point> corners = distinctPoints(
        table, 3, mostCorners, "3 to 1000 corners [[x, y], ...], counterclockwise, none twice in turn");
    return {corners, labelsOf(table, corners.size()), std::vector<EdgeCurve>(corners.size())};
  }
  const std::vector<Point> through = distinctPoints(
      table, 3, mostPoints, "3 to 100 points [[x, y], ...], the tool to the left, none twice in turn");
  if (through.size() == 3 && through.front() == through.back())
    table.reject("points", "four points at least of a closed spline, the last one the first");
  try {
    return splineOutline(through);
  } catch (const InputError& error) {
    table.reject("points", error.what());
  }
}

/// Of each motion: the keys of its displacement or angle, and of its force or moment.
using MotionKeys = std::vector<std::array<const char*, 2>>;
const MotionKeys inPlane{{"ux", "fx"}, {"uy", "fy"}, {"rotation", "moment"}};
const MotionKeys inSpace{{"ux", "fx"},
                         {"uy", "fy"},
                         {"uz", "fz"},
                         {"rotation_x", "moment_x"},
                         {"rotation_y", "moment_y"},
                         {"rotation_z", "moment_z"}};

void readMotion(const TableReader& table, bool axisymmetric, BodyDescription& tool) {
  using Kind = ConditionDescription::Kind;
  const bool space = table.table().inSpace;
  requireOfDimension(
      table, {"uz", "rotation_x", "rotation_y", "rotation_z", "fz", "moment_x", "moment_y", "moment_z"},
      {"rotation", "moment"});
  const MotionKeys& motions = space ? inSpace : inPlane;
  for (size_t c = 0; c < motions.size(); ++c) {
    const auto [displacement, force] = motions[c];
    for (const char* key : motions[c])
      if (axisymmetric && c != 1)
        table.rejectIfGiven({key}, "none beside plane = \"axisymmetric\": a ring moves along its axis alone");
    if (table.has(displacement)) table.rejectIfGiven({force}, std::string("either it or ") + displacement);
    const bool free = table.has(force);
    const char* key = free ? force : displacement;
    std::optional<Expression> value = free ? table.datum(key) : table.displacement(key);
    if (!value) value = constantExpression(0, table.message(tool.where, std::string(key) + " = 0"));
    if (value->value.degree > 0) table.reject(key, "a function of t alone: a tool moves as a whole");
    ConditionDescription condition{
        free ? Kind::traction : Kind::displacement,          0, "", static_cast<int>(c), *value,
        table.has(key) ? table.find(key)->where : tool.where};
    condition.whereItIs = !free && table.isHeld(key);
    if (space)
      condition.pointInSpace = *tool.reference;
    else
      condition.point = tool.reference->head<2>();
    tool.conditions.push_back(std::move(condition));
  }
}

}  // namespace

BodyDescription readTool(const Node& node, const SceneDescription& scene, size_t index) {
  const Node* name = node.find("name");
  const bool named = name != nullptr && name->isString();
  const TableReader table(node, "tool", "tool " + (named ? name->text : std::to_string(index)));
  BodyDescription tool;
  tool.where = node.where;
  tool.name = table.string("name");
  if (!isName(tool.name)) table.reject("name", "letters, digits, _ and -");
  const bool axisymmetric = scene.plane == Plane::axisymmetric;
  Point at(0, 0);
  if (table.has("mesh")) {
    for (const std::string& key : keysOf("tool"))
      if (key == "shape" || !keyAt("tool", key).besideWords.empty())
        table.rejectIfGiven({key}, "either mesh or a shape");
    readMeshSource(table, scene.path, tool);
    if (tool.mesh.shape && !scene.inSpace())
      table.reject("mesh", "a file, or shape and its keys in place of mesh");
  } else if (table.has("shape") && table.choice<Family>("shape") == point) {
    table.requireBeside("shape", "point");
    static_cast<void>(table.require("at", "the place of the point"));
    tool.point = true;
    tool.meshWhere = table.find("shape")->where;
    tool.mesh.path = table.string("shape");
  } else if (scene.inSpace()) {
    table.rejectIfGiven({"shape"}, "\"point\", or mesh in its place");
    static_cast<void>(table.require("mesh", "a file, or a shape of a body in space"));
  } else {
    static_cast<void>(
        table.require("shape", "\"line\", \"disc\", \"rectangle\", \"polygon\", \"spline\" or \"point\""));
    Outline outline = readOutline(table, axisymmetric);
    outline.name = "outline of " + tool.name;
    // Where the outline says nothing else: in the middle of its extents.
    at = table.has("centre") ? table.point("centre") : Point(boxOf(outline.points).center());
    tool.meshWhere = table.find("shape")->where;
    tool.mesh.path = table.string("shape");
    tool.mesh.shape = MeshShape{std::move(outline)};
  }
  tool.reference =
      scene.inSpace() ? table.spacePoint("at", SpacePoint(0, 0, 0)) : asSpacePoint(table.point("at", at));
  readMotion(table, axisymmetric, tool);
  return tool;
}

}  // namespace mortier
