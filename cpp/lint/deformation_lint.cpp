// Strains and rotations that supports and tools alone show, against what the theory takes as small.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/digits.h"
#include "lint/lint.h"
#include "mesh/boundary_line.h"
#include "time/report.h"

namespace mortier {
namespace {

/// The first condition that shows the most.
struct Most {
  double value = 0;
  std::string where;
  void raise(double other, const std::string& at) {
    if (other > value) *this = {other, at};
  }
};

/// Of the trial times, the end among them.
std::vector<double> someTimes(const TimePlan& plan) {
  constexpr size_t each = 8;
  std::vector<double> times = trialTimes(plan);
  for (size_t i = 0; each * i < times.size(); ++i) times[i] = times[each * i];
  times.resize((times.size() + each - 1) / each);
  return times;
}

struct HeldMotion {
  double value = 0;
  const ConditionDescription* condition = nullptr;
};
using HeldMotions = std::map<int, HeldMotion>;  ///< by vertices

/// What is prescribed along both axes at a time.
std::array<HeldMotions, 2> heldMotions(const BodyDescription& body, const TriangleMesh& mesh, double t) {
  std::array<HeldMotions, 2> motions;
  for (const ConditionDescription& c : body.conditions) {
    if (c.kind != ConditionDescription::Kind::displacement || c.onAxis) continue;
    const auto hold = [&](int vertex, int axis) {
      const Point& x = mesh.vertices[vertex];
      motions[axis][vertex] = {c.value.value(x.x(), x.y(), t), &c};
    };
    if (c.point) {
      if (const int vertex = vertexAt(mesh, *c.point); vertex >= 0) hold(vertex, c.component);
      continue;
    }
    if (c.component > 1) continue;  // along normals and tangents
    for (const int vertex : verticesOn(mesh, c.label)) hold(vertex, c.component);
  }
  return motions;
}

/// Mean strain between neighbours of those held along an axis that lie on one line along it.
void raiseStrain(const HeldMotions& held, const TriangleMesh& mesh, int axis, Most& most) {
  constexpr double sameLine = 1e-6;
  const double width = sameLine * extent(mesh);
  std::vector<std::pair<std::array<double, 2>, const HeldMotion*>> sorted;  // line, and place on it
  for (const auto& [vertex, motion] : held) {
    const Point& x = mesh.vertices[vertex];
    sorted.push_back({{std::round(x[1 - axis] / width), x[axis]}, &motion});
  }
  std::sort(sorted.begin(), sorted.end());
  for (size_t i = 1; i < sorted.size(); ++i) {
    const auto& [place, motion] = sorted[i];
    const auto& [placeBefore, before] = sorted[i - 1];
    const double length = place[1] - placeBefore[1];
    if (place[0] != placeBefore[0] || !(length > width)) continue;
    most.raise(std::abs(motion->value - before->value) / length,
               (motion->value != 0 ? motion : before)->condition->where);
  }
}

/// Angles by which held sides along an axis turn.
void raiseTurn(const BodyDescription& body, const std::array<HeldMotions, 2>& held, const TriangleMesh& mesh,
               Most& most) {
  for (const ConditionDescription& c : body.conditions) {
    if (c.kind != ConditionDescription::Kind::displacement || c.point || c.onAxis || c.component > 1)
      continue;
    const HeldMotions& motions = held[c.component];
    for (const auto& [a, b] : sidesWith(mesh, c.label)) {
      const Point along = mesh.vertices[b] - mesh.vertices[a];
      constexpr double aligned = 1e-9;
      if (std::abs(along[c.component]) > aligned * along.norm()) continue;
      most.raise(std::abs(motions.at(b).value - motions.at(a).value) / along.norm(), c.where);
    }
  }
}

void addStrain(const Most& strain, const std::string& subject, Faults& faults) {
  if (strain.value > smallStrain)
    faults.add("large-strain", strain.where, subject + " by " + digits(100 * strain.value, 2) + " % or more");
}

void addRotation(const Most& turn, const std::string& subject, Faults& faults) {
  if (turn.value > smallRotation)
    faults.add("large-rotation", turn.where,
               subject + " by " + digits(turn.value * 180 / M_PI, 2) + " degrees");
}

/// Length over which a body takes the motion of one of its points along n: a line from there to where its
/// motion is prescribed along the line shortens by the part of the motion along it.
double lengthTo(const LintInput& input, const SideDescription& side, const Point& x, const Point& n) {
  const auto b = static_cast<size_t>(bodyIndex(input.scene, side.body));
  if (input.scene.bodies[b].isTool()) return 0;
  constexpr double along = 0.99;
  const std::array<HeldMotions, 2> held = heldMotions(input.scene.bodies[b], *input.meshes[b], 0);
  double length = std::numeric_limits<double>::infinity();
  for (const int axis : {0, 1})
    for (const auto& [vertex, motion] : held[axis]) {
      const Point to = input.meshes[b]->vertices[vertex] - x;
      const bool known = held[1 - axis].count(vertex) > 0 || std::abs(to[axis]) > along * to.norm();
      if (known && to.dot(n) != 0) length = std::min(length, to.squaredNorm() / std::abs(to.dot(n)));
    }
  return length;
}

/// The displacement along an axis that supports give a body at a time, the least and the largest [m]; none
/// where none does.
std::optional<std::array<double, 2>> movedTo(const LintInput& input, const SideDescription& side, int axis,
                                             double t) {
  const auto body = static_cast<size_t>(bodyIndex(input.scene, side.body));
  std::optional<std::array<double, 2>> range;
  for (const ConditionDescription& c : input.scene.bodies[body].conditions) {
    if (c.kind != ConditionDescription::Kind::displacement || c.component != axis || c.onAxis) continue;
    std::vector<Point> points;
    if (c.point) points.push_back(*c.point);
    for (const int v : c.point ? std::vector<int>() : verticesOn(*input.meshes[body], c.label))
      points.push_back(input.meshes[body]->vertices[v]);
    for (const Point& x : points) {
      const double u = c.value.value(x.x(), x.y(), t);
      if (!range) range = {u, u};
      range = {std::min((*range)[0], u), std::max((*range)[1], u)};
    }
  }
  return range;
}

}  // namespace

Point supportedMotion(const LintInput& input, const ContactDescription& contact, double t) {
  Point by(0, 0);
  for (const int axis : {0, 1}) {
    const auto first = movedTo(input, contact.nonmortar(), axis, t);
    const auto second = movedTo(input, contact.mortar(), axis, t);
    if (!first || !second) continue;
    const double least = (*first)[0] - (*second)[1];
    const double most = (*first)[1] - (*second)[0];
    by[axis] = least > 0 ? least : std::min(most, 0.0);
  }
  return by;
}

void lintApproach(const LintInput& input, const ContactDescription& contact, ContactInterface interface,
                  Faults& faults) {
  if (contact.gap) return;
  const auto nonmortar = static_cast<size_t>(bodyIndex(input.scene, contact.nonmortar().body));
  const Vector still = Vector::Zero(interface.C2().cols());
  Most strain{0, contact.where};
  for (const double t : someTimes(input.scene.time)) {
    const Point by = supportedMotion(input, contact, t);
    if (by.isZero(0)) continue;
    const Vector u = by.replicate(interface.C1().cols() / 2, 1);
    if (interface.follows()) interface.follow(u, still);
    Vector depth = interface.jump(u, still);
    if (contact.initial != InitialGap::close) depth -= interface.initialDistance();
    Eigen::Index row = 0;
    const double deepest = depth.maxCoeff(&row);
    if (!(deepest > 0)) continue;
    const Point& x = input.meshes[nonmortar]->vertices[interface.nonmortarNodes()[row]];
    const Point n = interface.normals()[row].head<2>();
    strain.raise(
        deepest / (lengthTo(input, contact.nonmortar(), x, n) + lengthTo(input, contact.mortar(), x, n)),
        contact.where);
  }
  addStrain(strain,
            "supports press bodies " + contact.nonmortar().body + " and " + contact.mortar().body +
                " into each other, which strains them",
            faults);
}

void lintDeformations(const LintInput& input, Faults& faults) {
  for (size_t b = 0; b < input.meshes.size(); ++b) {
    const BodyDescription& body = input.scene.bodies[b];
    if (input.meshes[b] == nullptr) continue;
    Most strain;
    Most turn;
    for (const double t : someTimes(input.scene.time)) {
      if (body.isTool()) {
        for (const ConditionDescription& c : body.conditions)
          if (c.kind == ConditionDescription::Kind::displacement && c.turns() &&
              !isFollowed(input.scene, body.name))  // else it turns by finite angles
            turn.raise(std::abs(c.value.value(0, 0, t)), c.where);
        continue;
      }
      const std::array<HeldMotions, 2> held = heldMotions(body, *input.meshes[b], t);
      for (const int axis : {0, 1}) raiseStrain(held[axis], *input.meshes[b], axis, strain);
      raiseTurn(body, held, *input.meshes[b], turn);
    }
    addStrain(strain, "supports strain body " + body.name, faults);
    addRotation(
        turn, (body.isTool() ? "tool " + body.name + " turns" : "supports turn a side of body " + body.name),
        faults);
  }
}

}  // namespace mortier
