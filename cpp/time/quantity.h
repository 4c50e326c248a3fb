// Numbers that a user asks for, of every state of a run: forces of supports and of contact, displacements.
//
// The forces that supports exert are what is left of equilibrium at the nodes that they hold,
//   r = sum |T| B' s + C' p - F.
// At a node with two prescribed motions r is split along their directions, so each label and each point has
// the forces of its own supports and those of all add up to all of r.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

struct Quantity {
  enum class Kind { reaction, contactForce, displacement };
  enum class Component { x, y, moment };

  std::string name;
  Kind kind = Kind::reaction;
  int body = 0;
  int label = 0;                       ///< of the supports, or of a side of contact
  Component component = Component::x;  ///< moment of forces only, counterclockwise
  Point about{0, 0};                   ///< of the moment [m]
  std::vector<std::pair<int, double>> mean =
      {};                           ///< of a displacement: nodes and their weights, which sum to one
  std::optional<Point> point = {};  ///< of a reaction: that of a held vertex, in place of the label [m]

  /// N/m, N (a moment per metre of depth) or m.
  [[nodiscard]] std::string unit() const;
};

/// The first condition that holds a label of a body or, where one is given, a point; -1 for none.
int firstSupport(const Body& body, int label, const std::optional<Point>& point);

/// The value of each, in the units above. Forces act on the body.
std::vector<double> evaluate(const std::vector<Quantity>& quantities, const Model& model, const State& state);

/// The displacement at a point of a mesh as a mean of those of nodes; empty where the point is outside.
std::vector<std::pair<int, double>> meanAt(const TriangleMesh& mesh, const Point& point);

/// The mean displacement of a label in the same way: the integral over its length.
std::vector<std::pair<int, double>> meanOn(const TriangleMesh& mesh, int label);

}  // namespace mortier
