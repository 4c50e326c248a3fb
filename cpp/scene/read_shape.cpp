#include <algorithm>
#include <numbers>

#include "scene/readers.h"

namespace mortier {
namespace {

/// N or [N, M], such as "cells" and "grading" are.
Point pairOf(const TableReader& table, const std::string& key, bool whole) {
  if (!table.has(key)) return {1, 1};
  const Node& node = *table.find(key);
  const Point pair = node.isNumeric()            ? Point(node.value, node.value)
                     : node.elements.size() == 2 ? table.point(key)
                                                 : Point(0, 0);
  constexpr double most = 1e8;
  const auto good = [&](double x) { return x >= 1 && x <= most && (!whole || x == std::floor(x)); };
  if (!good(pair.x()) || !good(pair.y()))
    table.reject(key, whole ? "N or [N, M], integers >= 1" : "R or [RX, RY], numbers >= 1");
  return pair;
}

std::array<Point, 4> cornersOf(const TableReader& table) {
  constexpr const char* expected = "four corners [[x, y], ...], counterclockwise";
  const std::vector<Point> points = readPoints(table, "corners", expected);
  std::array<Point, 4> corners;
  if (points.size() != corners.size()) table.reject("corners", expected);
  std::copy(points.begin(), points.end(), corners.begin());
  return corners;
}

/// \param known  keys of every shape
void requireKeysOf(const TableReader& table, Keys known) {
  const std::string word = table.string("shape");
  for (const std::string& key : keysOf("body.mesh"))
    if (isOneOf(word, keyAt("body.mesh", key).besideWords)) known.push_back(key);
  for (const Node& member : table.table().members)
    if (!isOneOf(member.key, known))
      table.reject(member.key, "of a mesh of shape " + word + " " + joined({known.begin() + 1, known.end()}));
}

const Keys solids{"cuboid", "cylinder", "ball"};

}  // namespace

bool isSolidShape(const std::string& word) {
  return isOneOf(word, solids);
}

const Keys& sweepKeys() {
  static const Keys keys{"extrude", "revolve", "layers"};
  return keys;
}

std::optional<Sweep> readSweep(const TableReader& table) {
  requireOfDimension(table, sweepKeys(), {});
  const bool extrudes = table.has("extrude");
  if (!extrudes && !table.has("revolve")) {
    table.rejectIfGiven({"layers"}, "it beside extrude or revolve");
    return {};
  }
  if (extrudes) table.rejectIfGiven({"revolve"}, "extrude or revolve, not both");
  Sweep sweep;
  if (extrudes) {
    sweep.length = table.number("extrude");
  } else {
    const std::optional<Expression> angle = table.datum("revolve");
    sweep.angle = angle->constant ? angle->value(0, 0, 0) : 0;
    constexpr double rounding = 1e-6;
    if (!(sweep.angle > 0) || sweep.angle > 2 * std::numbers::pi + rounding)
      table.reject("revolve", "an angle above 0, at most 2 pi");
  }
  sweep.layers = table.integer("layers");
  constexpr int most = 10000;
  if (sweep.layers > most) table.reject("layers", "at most " + std::to_string(most));
  return sweep;
}

SpaceShape readSpaceShape(const TableReader& table) {
  constexpr double most = 1e4;
  const std::string shape = table.string("shape");
  if (!isSolidShape(shape))
    table.reject("shape",
                 joined(solids) + ", a plane shape beside extrude or revolve, or a file, with dimension = 3");
  requireKeysOf(table, {"shape", "cells"});
  const size_t different = shape == "cuboid" ? 3 : shape == "cylinder" ? 2 : 1;
  const std::string expected = different == 3   ? "N or [NX, NY, NZ], integers >= 1"
                               : different == 2 ? "N or [N along a radius, M along z], integers >= 1"
                                                : "N along a radius, an integer >= 1";
  const Node& node = table.require("cells", expected);
  const std::vector<double> counts =
      node.isNumeric() ? std::vector<double>(different, node.value) : table.numbers("cells");
  if (counts.size() != different || !std::all_of(counts.begin(), counts.end(), [](double count) {
        return count >= 1 && count <= most && count == std::floor(count);
      }))
    table.reject("cells", expected);
  const auto cells = [&](size_t i) { return static_cast<int>(counts[std::min(i, different - 1)]); };
  if (different == 3)
    return Cuboid{table.spacePoint("lower", SpacePoint(0, 0, 0)),
                  table.spacePoint("upper", SpacePoint(1, 1, 1)),
                  {cells(0), cells(1), cells(2)}};
  RoundBody body;
  body.ball = shape == "ball";
  body.centre = table.spacePoint("centre", SpacePoint(0, 0, 0));
  body.radius = table.number("radius");
  if (!body.ball) body.height = table.number("height");
  body.cells = {cells(0), cells(1)};
  const Keys halves{"x", "y", "z", "-x", "-y", "-z"};
  for (const std::string& half : table.strings("keep")) {
    const auto at = std::find(halves.begin(), halves.end(), half) - halves.begin();
    if (at == 6 || (at % 3 == 2 && !body.ball) || body.keep[at % 3] != 0)
      table.reject("keep", std::string("halves such as [\"x\", \"-y\"], each axis once") +
                               (body.ball ? "" : ", of a cylinder x and y only"));
    body.keep[at % 3] = at < 3 ? 1 : -1;
  }
  return body;
}

std::vector<Point> readPoints(const TableReader& table, const std::string& key, const std::string& expected) {
  const Node& node = table.require(key, expected);
  if (!node.isArray()) table.reject(key, expected);
  std::vector<Point> points;
  for (const Node& element : node.elements) {
    const std::vector<Node>& x = element.elements;
    const bool finite = x.size() == 2 && x[0].isNumeric() && x[1].isNumeric() && std::isfinite(x[0].value) &&
                        std::isfinite(x[1].value);
    if (!finite) table.reject(key, expected);
    points.emplace_back(x[0].value, x[1].value);
  }
  return points;
}

MeshShape readShape(const TableReader& table) {
  enum Family { rectangle, quadrilateral, annulus, halfDisc, quarterDisc, inSpace };
  const auto family = table.choice<Family>("shape");
  if (family >= inSpace) table.reject("shape", "a plane one, or dimension = 3 at the top of the scene");
  Keys known{"shape", "cells", "cut"};
  if (table.table().inSpace) known.insert(known.end(), sweepKeys().begin(), sweepKeys().end());
  requireKeysOf(table, known);
  static_cast<void>(table.require("cells", "N or [N, M], integers >= 1"));
  const Point cells = pairOf(table, "cells", true);
  const auto cells1 = static_cast<int>(cells.x());
  const auto cells2 = static_cast<int>(cells.y());
  MeshShape shape;
  shape.cut = table.choice<Cut>("cut", family < annulus ? Cut::rising : Cut::both);
  if (family == rectangle) {
    Rectangle of{table.point("lower", Point(0, 0)), table.point("upper", Point(1, 1)), cells1, cells2};
    if (table.has("focus")) of.focus = table.point("focus");
    if (!of.focus) table.rejectIfGiven({"grading"}, "it beside focus");
    of.grading = pairOf(table, "grading", false);
    shape.of = of;
  } else if (family == quadrilateral) {
    shape.of = Quadrilateral{cornersOf(table), cells1, cells2};
  } else if (family == annulus) {
    shape.of = Annulus{table.point("centre", Point(0, 0)),
                       table.number("inner"),
                       table.number("outer"),
                       1 << table.choice<int>("span"),  // quarters
                       cells1,
                       cells2};
  } else {
    if (cells1 != cells2) table.reject("cells", "N, on half the width of the core");
    shape.of = HalfDisc{table.point("lowest", Point(0, 0)), table.number("radius"), table.number("core"),
                        cells1, family == quarterDisc};
  }
  return shape;
}

}  // namespace mortier
