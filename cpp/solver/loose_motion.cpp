// Rigid motions that contact does not hold.

#include <cmath>

#include "base/dense_templates.h"
#include "base/error.h"
#include "fem/rigid_modes.h"
#include "solver/contact_sets.h"
#include "solver/free_rotation.h"
#include "solver/friction_sets.h"
#include "solver/step_system.h"

namespace mortier {
namespace {

/// A body that moves by less than this part of a motion has none in it.
constexpr double negligibleMotion = 1e-6;

}  // namespace

void StepSystem::joinMotions() {
  Eigen::Index ties = 0;
  for (const Tie& tie : model_.ties) ties += tie.rows();
  Matrix G = Matrix::Zero(conditions() + ties, firstMotion_.back());
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const ContactDofs& dofs = bodies_[b].contact();
    G.middleCols(firstMotion_[b], dofs.R.cols()) = dofs.C * dofs.R;
  }
  ties_.setMotions(std::move(G), ties);
  contact_.G = ties_.contactMotions();
}

void StepSystem::requireHeld() {
  contact_.proximal = options_.proximalWeight;
  joinMotions();
  if (contact_.G.cols() == 0) return;
  const Matrix free = rigidMotionsOn(std::vector<char>(conditions(), 1), contact_.G).free;
  if (free.cols() > 0)
    throw UnheldBodyError("nothing holds " + describeRigid(ties_.wholeMotion(free.col(0))) +
                          "; a support or a contact would");
}

std::string StepSystem::looseMotion(const State& state0, const Iterate& solution) const {
  if (contact_.G.cols() == 0) return "";
  constexpr double touching = 1e-14;
  const std::vector<Vector> u = displacements(state0, solution);
  std::vector<char> closed(conditions(), 1);
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactPair& pair = model_.interfaces[k].pair();
    Vector gap = model_.interfaces[k].gap(u[pair.nonmortar.body], u[pair.mortar.body], state0.time);
    if (!solution.distanceChange.empty()) gap -= solution.distanceChange[k];
    if (model_.interfaces[k].yields()) gap -= model_.interfaces[k].yielded(solution.contactForce[k]);
    const double size = model_.bodies[pair.nonmortar.body].extent();
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      if (solution.active[k][i] == 0 && gap[i] < -touching * size) closed[firstRow_[k] + i] = 0;
  }
  const SlidingConditions sliding = slidingConditions(solution);
  for (const int condition : sliding.conditions) closed[condition] = 0;
  const Matrix loose = rigidMotionsOn(closed, sliding.G).free;
  Eigen::Index which = 0;
  const auto turns = [&](const Vector& z) {
    const Vector all = ties_.wholeMotion(z);
    for (size_t b = 0; b < bodies_.size(); ++b)
      if (const Vector part = motionOf(all, b); part.norm() > negligibleMotion)
        if (!turnsInItself(model_, static_cast<int>(b), bodies_[b].contact().motions * part)) return false;
    return true;
  };
  while (which < loose.cols() && turns(loose.col(which))) ++which;
  if (which == loose.cols()) return "";
  const Vector z = loose.col(which);
  // Where some nodes would go on to slip and others back, those stick in the end, whichever way it goes.
  double onwards = 0;
  double back = 0;
  for (size_t k = 0; k < sliding.conditions.size(); ++k) {
    const double way = sliding.signs[k] * sliding.G.row(sliding.conditions[k]).dot(z);
    onwards = std::max(onwards, way);
    back = std::max(back, -way);
  }
  if (std::min(onwards, back) > negligibleMotion * std::max(onwards, back)) return "";
  bool untouched = true;
  const Vector all = ties_.wholeMotion(z);
  for (size_t b = 0; b < bodies_.size(); ++b)
    untouched = untouched && (motionOf(all, b).norm() <= negligibleMotion || !!u[b].isZero(0));
  return untouched ? "" : describeRigid(all);
}

StepSystem::SlidingConditions StepSystem::slidingConditions(const Iterate& solution) const {
  const Vector p = joined(solution.contactForce);
  const FrictionSets sets = joinedSets(solution);
  const auto& [node, law, components] = contact_.along;
  SlidingConditions sliding;
  sliding.G = components == 1 ? contact_.G : AlignedProblem(contact_, law, sets).problem().G;
  for (size_t k = 0; k < node.size(); ++k) {
    const bool bears = p[node[k]] > 0 || law.limit[static_cast<Eigen::Index>(k)] > 0;
    if (bears && sets.slip[k] == 0) continue;
    for (int c = 0; c < (bears ? 1 : components); ++c) {
      sliding.conditions.push_back(rows() + components * static_cast<int>(k) + c);
      sliding.signs.push_back(bears ? sets.slip[k] : 0);
    }
  }
  return sliding;
}

std::string StepSystem::describeRigid(const Vector& z) const {
  std::string text;
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const Vector part = motionOf(z, b);
    if (!(part.norm() > negligibleMotion * z.norm())) continue;
    if (!text.empty()) text += ", ";
    text += "body " + model_.bodies[b].name() + ": " + bodies_[b].contact().describe(model_.bodies[b], part);
  }
  return text;
}

namespace {

constexpr double same = 1e-6;  // of a radius, or of a motion

/// By dofs, of an angle of one.
Vector rotationAbout(const Point& centre, const Body& body) {
  const std::vector<Point>& places = body.elementNodes().places;
  Vector u(2 * static_cast<Eigen::Index>(places.size()));
  for (size_t v = 0; v < places.size(); ++v) {
    const Point from = places[v] - centre;
    u.segment<2>(2 * static_cast<Eigen::Index>(v)) << -from.y(), from.x();
  }
  return u;
}

/// |x|^2 - 2 c . x = const in the mean of squares.
Point centreOf(const std::vector<Point>& points) {
  Matrix equations(points.size(), 3);
  Vector squares(points.size());
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    const Point x = points[i] - points[0];
    equations.row(i) << 2 * x.x(), 2 * x.y(), 1;
    squares[i] = x.squaredNorm();
  }
  const Vector found = equations.colPivHouseholderQr().solve(squares);
  return points[0] + Point(found[0], found[1]);
}

}  // namespace

std::optional<Point> centreOfRoller(const Model& model, int body) {
  const Body& of = model.bodies[body];
  std::optional<Point> centre;
  for (const ContactInterface& interface : model.interfaces) {
    const ContactPair& pair = interface.pair();
    if (pair.nonmortar.body != body && pair.mortar.body != body) continue;
    if (interface.hasFriction() || of.axisymmetric() || of.dimension() == 3) return std::nullopt;
    std::vector<Point> points;
    for (const int node : pair.nonmortar.body == body ? interface.nonmortarNodes() : interface.mortarNodes())
      points.push_back(of.elementNodes().places[node]);
    if (points.size() < 4) return std::nullopt;
    if (!centre) centre = centreOf(points);
    const double radius = (points[0] - *centre).norm();
    if (!(radius < of.extent() / same)) return std::nullopt;
    for (const Point& x : points)
      if (!(std::abs((x - *centre).norm() - radius) <= same * std::min(radius, of.extent())))
        return std::nullopt;
  }
  return centre;
}

std::optional<Point> freeRotation(const Model& model, int body) {
  const std::optional<Point> centre = centreOfRoller(model, body);
  if (!centre) return std::nullopt;
  const Body& of = model.bodies[body];
  const Matrix modes = rigidModes(of);
  const Vector turn = rotationAbout(*centre, of);
  if (modes.cols() == 0 ||
      (turn - modes * modes.colPivHouseholderQr().solve(turn)).norm() > same * turn.norm())
    return std::nullopt;
  return centre;
}

bool turnsInItself(const Model& model, int body, const Vector& motion) {
  const std::optional<Point> centre = centreOfRoller(model, body);
  if (!centre) return false;
  const Vector turn = rotationAbout(*centre, model.bodies[body]);
  constexpr double nearly = 0.3;  // closed nodes of a polygon lie beside the points where the circle touches
  return (motion - turn * (turn.dot(motion) / turn.squaredNorm())).norm() <= nearly * motion.norm();
}

}  // namespace mortier
