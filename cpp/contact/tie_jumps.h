// What a tie is put together of.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "contact/surface.h"
#include "contact/tie.h"

namespace mortier {

/// Of the mortar side at a point.
struct Opposite {
  int element = 0;  ///< behind it
  NodeValues values;
};

/// Of the displacements, by nodes and without a direction: rows of a scalar jump.
struct Tie::Jumps {
  std::function<SpacePoint(int)> placeOf;  ///< of a nonmortar node [m]
  const RigidTrace* offset = nullptr;
  double sign = 1;  ///< of its motion

  std::map<PartVertex, int> rowOf;          ///< by nonmortar nodes and smooth parts
  std::array<Triplets, 3> sides;            ///< nonmortar, mortar, the third body
  Triplets functions;                       ///< rows x points: row functions times weights
  std::map<int, double> lengths;            ///< int chi, by rows
  std::map<int, std::set<int>> neighbours;  ///< rows on one element
  // Of the points.
  std::array<Triplets, 3> traces;
  std::vector<std::array<int, 2>> elements;
  std::vector<double> weights, sizes;

  int row(int node, int part) {
    return rowOf.try_emplace({node, part}, static_cast<int>(rowOf.size())).first->second;
  }
  void addTo(std::array<Triplets, 3>& to, int row, double weight, const NodeValues& own,
             const NodeValues& across) const {
    SpacePoint x = SpacePoint::Zero();
    for (const auto& [node, value] : own) {
      to[0].emplace_back(row, node, weight * value);
      x += value * placeOf(node);
    }
    for (const auto& [node, value] : across) to[1].emplace_back(row, node, -weight * value);
    if (offset == nullptr) return;
    for (const auto& [node, value] : offset->at(x)) to[2].emplace_back(row, node, -sign * weight * value);
  }
  void add(int row, double weight, const NodeValues& own, const NodeValues& across) {
    addTo(sides, row, weight, own, across);
    lengths[row] += weight;
  }
  /// At the point that was added last.
  void addAtPoint(int row, double weight, const NodeValues& own, const NodeValues& across) {
    add(row, weight, own, across);
    functions.emplace_back(row, static_cast<int>(elements.size()) - 1, weight);
  }
  void addPoint(const NodeValues& own, const Opposite& opposite, int element, double weight, double size) {
    addTo(traces, static_cast<int>(elements.size()), 1, own, opposite.values);
    elements.push_back({element, opposite.element});
    weights.push_back(weight);
    sizes.push_back(size);
  }
  void join(const std::vector<int>& rows) {
    for (const int row : rows) neighbours[row].insert(rows.begin(), rows.end());
  }
};

}  // namespace mortier
