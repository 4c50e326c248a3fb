#include "scene/read_shape.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"

namespace mortier {
namespace {

const Keys shapeWords{"rectangle", "quadrilateral", "annulus", "halfdisc", "quarterdisc"};
const Keys cutWords{"rising", "falling", "both"};  // as Cut
const Keys spanWords{"quarter", "half", "full"};

const std::map<std::string, Keys> keysOfShape{{"rectangle", {"lower", "upper", "focus", "grading"}},
                                              {"quadrilateral", {"corners"}},
                                              {"annulus", {"centre", "inner", "outer", "span"}},
                                              {"halfdisc", {"lowest", "radius", "core"}},
                                              {"quarterdisc", {"lowest", "radius", "core"}}};

/// N or [N, M], such as "cells" and "grading" are.
Point pairOf(const TableReader& table, const std::string& key, double fallback, bool whole) {
  const Node* node = table.find(key);
  if (node == nullptr) return {fallback, fallback};
  const Point pair = node->isNumeric() ? Point(node->value, node->value) : table.point(key);
  constexpr double most = 1e8;
  const auto good = [&](double x) { return x >= 1 && x <= most && (!whole || x == std::floor(x)); };
  if (!good(pair.x()) || !good(pair.y()))
    table.reject(key, whole ? "N or [N, M], integers >= 1" : "R or [RX, RY], numbers >= 1");
  return pair;
}

std::array<Point, 4> cornersOf(const TableReader& table) {
  constexpr const char* expected = "four corners [[x, y], ...], counterclockwise";
  const Node& node = table.require("corners", expected);
  std::array<Point, 4> corners;
  if (!node.isArray() || node.elements.size() != corners.size()) table.reject("corners", expected);
  for (size_t k = 0; k < corners.size(); ++k) {
    const std::vector<Node>& x = node.elements[k].elements;
    if (x.size() != 2 || !x[0].isNumeric() || !x[1].isNumeric()) table.reject("corners", expected);
    corners[k] = {x[0].value, x[1].value};
  }
  return corners;
}

}  // namespace

MeshShape readShape(const TableReader& table) {
  const std::string word = shapeWords[static_cast<size_t>(table.oneOf("shape", shapeWords))];
  for (const Node& member : table.table().members) {
    if (member.key == "shape" || member.key == "cells" || member.key == "cut") continue;
    const Keys& known = keysOfShape.at(word);
    if (std::find(known.begin(), known.end(), member.key) == known.end())
      table.reject(member.key, "of a mesh of shape " + word + " cells, cut, " + joined(known));
  }
  static_cast<void>(table.require("cells", "N or [N, M], integers >= 1"));
  const Point cells = pairOf(table, "cells", 1, true);
  const auto cells1 = static_cast<int>(cells.x());
  const auto cells2 = static_cast<int>(cells.y());
  MeshShape shape;
  const bool curved = word == "annulus" || word.ends_with("disc");
  shape.cut = static_cast<Cut>(table.oneOf("cut", cutWords, curved ? 2 : 0));
  const auto point = [&](const char* key, const Point& fallback) {
    return table.find(key) != nullptr ? table.point(key) : fallback;
  };
  if (word == "rectangle") {
    Rectangle rectangle{point("lower", {0, 0}), point("upper", {1, 1}), cells1, cells2};
    if (table.find("focus") != nullptr) rectangle.focus = table.point("focus");
    if (table.find("grading") != nullptr && !rectangle.focus) table.reject("grading", "it beside focus");
    rectangle.grading = pairOf(table, "grading", 1, false);
    shape.of = rectangle;
  } else if (word == "quadrilateral") {
    shape.of = Quadrilateral{cornersOf(table), cells1, cells2};
  } else if (word == "annulus") {
    constexpr std::array quarters{1, 2, 4};
    shape.of = Annulus{point("centre", {0, 0}),
                       table.number("inner", above(0), 1),
                       table.number("outer", above(0), 2),
                       quarters[static_cast<size_t>(table.oneOf("span", spanWords, 2))],
                       cells1,
                       cells2};
  } else {
    if (cells1 != cells2) table.reject("cells", "N, on half the width of the core");
    shape.of = HalfDisc{point("lowest", {0, 0}), table.number("radius", above(0), 1),
                        table.number("core", above(0), 0.1), cells1, word == "quarterdisc"};
  }
  return shape;
}

}  // namespace mortier
