// A line of elements as contact sees it: places, abscissae, and the displacement trace on it.
//
// An element runs between two vertices. Its trace is linear, or quadratic with a node in the middle: then the
// element is straight, or bent through the place of that node (isoparametric), and its abscissa runs with the
// parameter. Nodes are counted along the line, the vertices first, then the middles.
#pragma once

#include <vector>

#include "contact/segments.h"
#include "mesh/edge_element.h"

namespace mortier {

struct ElementLine {
  std::vector<int> nodes;     ///< vertex numbers along the line; first and last agree where it is closed
  std::vector<Point> points;  ///< [m]
  std::vector<int> middles;   ///< node numbers, one an element; empty where the trace is linear
  std::vector<Point> middlePoints;  ///< their places; those of straight elements halfway [m]
  Trace s;                          ///< abscissae of the vertices, strictly ascending [m]

  [[nodiscard]] int elements() const { return static_cast<int>(nodes.size()) - 1; }
  [[nodiscard]] int degree() const { return middles.empty() ? 1 : 2; }
  [[nodiscard]] int traceNodes() const { return static_cast<int>(nodes.size() + middles.size()); }
  /// The number in its mesh of a node of the line.
  [[nodiscard]] int number(int node) const {
    const auto vertices = static_cast<int>(nodes.size());
    return node < vertices ? nodes[node] : middles[node - vertices];
  }
  [[nodiscard]] EdgeNodes nodesOf(int element) const {
    if (middles.empty()) return EdgeNodes{{element, element + 1}};
    return EdgeNodes{{element, element + 1, static_cast<int>(nodes.size()) + element}};
  }
  /// Part of the element at an abscissa.
  [[nodiscard]] double partAt(int element, double abscissa) const {
    return (abscissa - s[element]) / (s[element + 1] - s[element]);
  }
  [[nodiscard]] bool bent(int element) const {
    return !middles.empty() && middlePoints[element] != (points[element] + points[element + 1]) / 2;
  }
  /// The place at a part xi of an element.
  [[nodiscard]] Point at(int element, double xi) const {
    const Point chord = (1 - xi) * points[element] + xi * points[element + 1];
    return bent(element) ? Point(chord + 4 * xi * (1 - xi) * bow(element)) : chord;
  }
  /// dx/dxi
  [[nodiscard]] Point tangentAt(int element, double xi) const {
    const Point chord = points[element + 1] - points[element];
    return bent(element) ? Point(chord + 4 * (1 - 2 * xi) * bow(element)) : chord;
  }

 private:
  [[nodiscard]] Point bow(int element) const {
    return middlePoints[element] - (points[element] + points[element + 1]) / 2;
  }
};

}  // namespace mortier
