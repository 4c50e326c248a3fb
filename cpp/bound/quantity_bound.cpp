#include "bound/quantity_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bound/pressures.h"
#include "material/stress.h"

namespace mortier {
namespace {

/// Vertices of contact lines: motions there and glue make a dense system (GluedBodies).
constexpr size_t mostFacing = 1000;

/// Integral of two linear functions over a piece.
double integral(double length, const std::array<double, 2>& a, const std::array<double, 2>& b) {
  const std::array<double, 2> moments = momentsOfLinear(a, length);
  return moments[0] * b[0] + moments[1] * b[1];
}

/// Integral of s : eps(z) + div s . z over a triangle, s of these moments.
double workOf(const Moments& m, const std::array<int, 3>& v, const Vector& z) {
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    for (int end = 0; end < 2; ++end)
      sum += m.segment<2>(4 * k + 2 * end).dot(z.segment<2>(2 * v[(k + end) % 3]));
  return sum;
}

/// What rounding leaves of a force in any triangle, at least of the moments of its sides [N/m].
double leftOf(const LoadedBody& body) {
  const auto [worst, largest] = body.imbalance();
  return std::max(worst, std::numeric_limits<double>::epsilon() * largest) + body.data().error;
}

class Enclosing {
 public:
  explicit Enclosing(const Admissible& pair)
      : pair_(pair), facing_(pair.lifting.facing), glued_(pair.bodies, pair.lifting.facing) {
    Q_ = pair.lifting.gap;
    for (size_t b = 0; b < pair.bodies.size(); ++b) {
      const LoadedBody& body = pair.bodies[b];
      unbalanced_ = std::max(unbalanced_, leftOf(body));
      triangles_ += static_cast<double>(body.mesh().triangles.size());
      moved_ = std::max(moved_, pair.lifting.displacements[b].lpNorm<Eigen::Infinity>());
      std::vector<Stress> lifted = body.stressOf(pair.lifting.displacements[b] - body.place().displacement);
      products_.emplace_back();
      sizes_.emplace_back();
      misfits_.emplace_back(Vector::Zero(static_cast<Eigen::Index>(lifted.size())));
      for (int t = 0; t < static_cast<int>(lifted.size()); ++t) {
        lifted[t] += body.stress()[t];
        const CompositeTriangle element = body.elementOf(t);
        const BodyLoad& f = body.forceOn(t);
        const Moments d = body.momentsOf(t) - element.momentsOf(lifted[t]) - element.momentsOfLoad(f);
        const Moments load = element.loadProduct(f);
        products_[b].emplace_back(element.energy() * d + load);
        sizes_[b].emplace_back(roundingOfSums *
                               (element.energy().cwiseAbs() * d.cwiseAbs() + load.cwiseAbs()));
        const double square = element.energyOf(d, f);
        const double data = body.data().carried[t] + body.data().strained[t];
        misfits_[b][t] = data > 0 ? std::pow(std::sqrt(std::max(square, 0.0)) + data, 2) / 4 : square / 4;
      }
      lifted_.push_back(std::move(lifted));
      Q_ += misfits_[b].sum();
    }
    Q_ = std::max(Q_, 0.0);
    addWorkOfPressure([&](int i) { return facing_[i].gap; }, misfits_);
  }

  [[nodiscard]] Enclosure enclose(const Quantity& quantity) const {
    using Kind = Quantity::Kind;
    if (!hasComponent(quantity.kind) && quantity.kind != Kind::meanPressure)
      return {"only forces, mean displacements and mean pressures have one"};
    if (quantity.point && quantity.kind == Kind::reaction) return {"forces at a point have none"};
    const Goal goal = goalOf(pair_, quantity);
    Enclosure result = enclose(quantity, goal);
    if (!result.obstacle.empty()) return result;
    if (quantity.point) {
      const Vector& u = pair_.bodies[quantity.body].place().displacement;
      result.estimate = result.error(goal.loads[quantity.body].dot(u));
      result.obstacle = "displacements at a point have none, means of a label have";
    }
    if (quantity.kind != Kind::meanPressure) return result;
    const Goal other = goalOf(pair_, quantity, BoundSide::above);
    Enclosure above = enclose(quantity, other);
    if (!above.obstacle.empty()) return above;
    std::vector<Vector> between = none();
    addWorkOfPressure([&](int i) { return (other.r[i] - goal.r[i]) / 2; }, between);
    between = onOwnMeshes(between);
    for (size_t b = 0; b < between.size(); ++b)
      above.parts[b] = (above.parts[b] + result.parts[b]) / 2 + between[b];
    above.lower = std::max(0.0, result.lower);
    return above;
  }

 private:
  [[nodiscard]] Enclosure enclose(const Quantity& quantity, const Goal& goal) const {
    if (!goal.obstacle.empty()) return {goal.obstacle};
    Enclosure result{"no adjoint displacement and stress were found", -infinity, infinity};
    double least = infinity;
    // First as if contact stayed as it is, then with z and q cut to what costs nothing in R.
    double c = infinity;
    for (int i = 0; i < tries; ++i) {
      const std::optional<Trial> trial = attempt(quantity, goal, c);
      if (!trial) break;
      const double remainder = largestRemainder(Q_, trial->misfit, trial->c) + trial->rounding;
      if (std::isfinite(remainder)) {
        result.obstacle.clear();
        result.lower = std::max(result.lower, trial->centre - remainder);
        result.upper = std::min(result.upper, trial->centre + remainder);
        if (remainder < least) result.parts = partsOf(*trial, remainder);
        least = std::min(least, remainder);
      }
      if (!(Q_ > 0)) break;
      c = trial->misfit / (2 * std::sqrt(Q_));
    }
    return result;
  }

  static constexpr int tries = 3;
  struct Trial {
    double centre = 0;  ///< the quantity less R
    double misfit = 0;  ///< |E eps z - t|
    double c = 0;
    double rounding = 0;               ///< what forces left over in triangles, and glue that is off, may do
    std::vector<Vector> misfits = {};  ///< |E eps z - t|^2 by bodies and triangles
  };

  [[nodiscard]] std::vector<Vector> none() const {
    std::vector<Vector> result;
    for (const LoadedBody& body : pair_.bodies)
      result.emplace_back(Vector::Zero(static_cast<Eigen::Index>(body.mesh().triangles.size())));
    return result;
  }
  /// Adds the integrals of p^ times a linear function, given at facing vertices, half of each to the triangle
  /// on either side.
  template <class Function>
  void addWorkOfPressure(const Function& of, std::vector<Vector>& to) const {
    for (size_t k = 0; k < pair_.meshes.pieces.size(); ++k) {
      const MatchedPiece& piece = pair_.meshes.pieces[k];
      const auto& ends = pair_.lifting.facingOfPiece[k];
      const double work = integral(piece.length, pressureOn(piece, pair_.spread), {of(ends[0]), of(ends[1])});
      const auto& [nonmortar, mortar, coupling] = pair_.model.interfaces[piece.interface].pair();
      for (int side = 0; side < 2; ++side) {
        const int body = side == 0 ? nonmortar.body : mortar.body;
        const auto& [first, last] = piece.vertices[side];
        for (const int t : pair_.bodies[body].place().sides.trianglesAt(first)) {
          const auto& v = pair_.bodies[body].mesh().triangles[t];
          if (std::find(v.begin(), v.end(), last) != v.end()) to[body][t] += work / 2;
        }
      }
    }
  }
  [[nodiscard]] std::vector<Vector> onOwnMeshes(const std::vector<Vector>& values) const {
    std::vector<Vector> result;
    for (size_t b = 0; b < values.size(); ++b) {
      const std::vector<int>& parents = pair_.bodies[b].parents();
      result.emplace_back(
          Vector::Zero(static_cast<Eigen::Index>(pair_.model.bodies[b].mesh().triangles.size())));
      for (size_t t = 0; t < parents.size(); ++t)
        result[b][parents[t]] += values[b][static_cast<Eigen::Index>(t)];
    }
    return result;
  }
  /// Shares of triangles in `remainder`, about |E eps u^ - s^| |E eps z - t|: half of their share in the
  /// square of either norm.
  [[nodiscard]] std::vector<Vector> partsOf(const Trial& trial, double remainder) const {
    std::vector<Vector> parts = none();
    for (const std::vector<Vector>* squares : {&misfits_, &trial.misfits}) {
      double sum = 0;
      for (const Vector& each : *squares) sum += each.cwiseMax(0).sum();
      for (size_t b = 0; b < parts.size() && sum > 0; ++b)
        parts[b] += remainder / (2 * sum) * (*squares)[b].cwiseMax(0);
    }
    return onOwnMeshes(parts);
  }

  [[nodiscard]] std::optional<Trial> attempt(const Quantity& quantity, const Goal& goal, double c) const {
    const auto glued = displacement(goal, c);
    if (!glued) return std::nullopt;
    const auto& z = glued->solution.displacements;
    Trial trial;
    trial.c = glued->c / pair_.gapFraction;
    std::vector<LoadedBody> bodies;
    bodies.reserve(pair_.bodies.size());
    for (size_t b = 0; b < pair_.bodies.size(); ++b) bodies.push_back(pair_.bodies[b].unloaded(z[b]));
    if (goal.triangle >= 0)
      bodies[quantity.body].push(goal.triangle, goal.force);
    else
      bodies[quantity.body].pull(quantity.label, goal.traction);
    const auto q = adjointPressure(pair_, glued->solution.forces, bodies, c);
    if (!q) return std::nullopt;
    for (size_t k = 0; k < q->size(); ++k)
      for (Eigen::Index row = 0; row < (*q)[k].size(); ++row)
        if ((*q)[k][row] != 0) trial.c = std::max(trial.c, std::abs((*q)[k][row]) / pair_.spread[k][row]);
    double pressed = 0;  // force of p^
    for (size_t k = 0; k < pair_.meshes.pieces.size(); ++k) {
      const MatchedPiece& piece = pair_.meshes.pieces[k];
      const auto values = pressureOn(piece, *q);
      const auto pressures = pressureOn(piece, pair_.spread);
      pressed += piece.length * (pressures[0] + pressures[1]) / 2;
      press(piece, pair_.model, values, bodies);
      const auto& [first, last] = pair_.lifting.facingOfPiece[k];
      trial.centre += integral(piece.length, values, {facing_[first].gap, facing_[last].gap});
      trial.centre += integral(piece.length, pressures, {glued_.jump(z, first), glued_.jump(z, last)});
    }
    double misfit = 0;
    double left = 0;
    double moved = 0;
    for (size_t b = 0; b < bodies.size(); ++b) {
      if (!bodies[b].balance()) return std::nullopt;
      left = std::max(left, leftOf(bodies[b]));
      moved = std::max(moved, z[b].lpNorm<Eigen::Infinity>());
      misfit += bodies[b].energies().sum();
      trial.misfits.push_back(bodies[b].energies());
      trial.centre += goal.loads[b].dot(pair_.lifting.displacements[b]) + workIn(b, z[b], bodies[b]);
    }
    trial.misfit = std::sqrt(std::max(misfit, 0.0));
    for (size_t b = 0; b < bodies.size(); ++b) addData(b, quantity, goal, z[b], trial);
    trial.rounding = triangles_ * (left * moved_ + unbalanced_ * moved) + glued->off * pressed;
    for (size_t b = 0; b < bodies.size(); ++b)
      for (size_t t = 0; t < sizes_[b].size(); ++t)
        trial.rounding += bodies[b].momentsOf(static_cast<int>(t)).cwiseAbs().dot(sizes_[b][t]);
    return trial;
  }

  /// L(z) - integral of p^ [z.n] - (m, eps z) + (s^ - s(u^), E^-1 t)/2 in a body.
  [[nodiscard]] double workIn(size_t b, const Vector& z, const LoadedBody& adjoint) const {
    const LoadedBody& body = pair_.bodies[b];
    double twice =
        2 * body.load().dot(z) + body.leftOver(Vector::Zero(z.size()), lifted_[b]).dot(z);  // -(s(u^), eps z)
    for (int t = 0; t < static_cast<int>(lifted_[b].size()); ++t) {
      const auto& v = body.mesh().triangles[t];
      twice -= workOf(body.momentsOf(t), v, z);
      if (!body.forceOn(t).isZero(0)) {
        const Eigen::Matrix<double, 2, 3> forces = nodalForces(body.mesh(), t, body.forceOn(t));
        for (int k = 0; k < 3; ++k) twice -= forces.col(k).dot(z.segment<2>(2 * v[k]));
      }
      twice += adjoint.momentsOf(t).dot(products_[b][t]);
      if (!adjoint.forceOn(t).isZero(0)) twice += loadProduct(b, t, adjoint.forceOn(t));
    }
    return twice / 2;
  }
  /// What s_D and s_W, that of w and of initial stresses, have in the sums: (s_D - s_W, eps z), l(w), and
  /// half of (|s_D| + |s_W|) |t - E eps z|.
  void addData(size_t b, const Quantity& quantity, const Goal& goal, const Vector& z, Trial& trial) const {
    const BodyData& data = pair_.bodies[b].data();
    if (data.linear() && data.moved.empty()) return;
    for (int t = 0; t < static_cast<int>(data.forces.size()); ++t) {
      if (data.carried[t] + data.strained[t] == 0) continue;
      const Eigen::Vector3d strain = toCartesian(strainIn(pair_.bodies[b].mesh(), t, z));
      const Stress mean = data.meanCarried[t] - data.meanStrained[t];
      trial.centre += mean[0] * strain[0] + mean[1] * strain[1] + 2 * mean[2] * strain[2];
      trial.rounding +=
          (data.carried[t] + data.strained[t]) * std::sqrt(std::max(trial.misfits[b][t], 0.0)) / 2;
    }
    if (quantity.kind == Quantity::Kind::displacement && quantity.body == static_cast<int>(b) &&
        goal.triangle < 0)
      for (const BodyData::Moved& each : data.moved)
        if (each.label == quantity.label) {
          trial.centre += goal.traction.dot(each.integral);
          trial.rounding += goal.traction.norm() * each.error;
        }
  }
  /// What a body force of the adjoint adds to (s^ - s(u^), E^-1 t) beside the moments of t.
  [[nodiscard]] double loadProduct(size_t b, int t, const BodyLoad& f) const {
    const LoadedBody& body = pair_.bodies[b];
    const CompositeTriangle element = body.elementOf(t);
    const BodyLoad& g = body.forceOn(t);
    const Moments d = body.momentsOf(t) - element.momentsOf(lifted_[b][t]) - element.momentsOfLoad(g);
    return d.dot(element.loadProduct(f)) - element.momentsOfLoad(f).dot(products_[b][t]) +
           (element.loadEnergy(f + g) - element.loadEnergy(f) - element.loadEnergy(g)) / 2;
  }

  struct Adjoint {
    GluedBodies::Solution solution;
    double c = 0;    ///< with |r - [z.n]| <= c G
    double off = 0;  ///< of [z.n] from what it is glued to
  };
  /// z of least energy, glued to r where u^ is closed or p^ presses, and to r -+ c G where it would be
  /// further off.
  [[nodiscard]] std::optional<Adjoint> displacement(const Goal& goal, double c) const {
    GluedBodies::Given given{goal.held, goal.loads, {}, goal.r};
    for (const Facing& each : facing_) given.glued.push_back(each.weight > 0 || !(each.gap > 0) ? 1 : 0);
    while (true) {
      std::optional<GluedBodies::Solution> solution = glued_.solve(given);
      if (!solution) return std::nullopt;
      Adjoint found;
      bool more = false;
      for (size_t i = 0; i < facing_.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        const double jump = glued_.jump(solution->displacements, i);
        const double z = given.glued[i] != 0 ? given.jumps[at] : jump;
        found.off = std::max(found.off, std::abs(jump - z));
        const double off = goal.r[at] - z;
        if (off == 0) continue;
        found.c = std::max(found.c, std::abs(off) / facing_[i].gap);
        if (given.glued[i] != 0 || std::abs(off) <= c * facing_[i].gap) continue;
        given.glued[i] = 1;
        given.jumps[at] = goal.r[at] - std::copysign(c * facing_[i].gap, off);
        more = true;
      }
      if (more) continue;
      found.solution = std::move(*solution);
      return found;
    }
  }

  const Admissible& pair_;
  const std::vector<Facing>& facing_;
  GluedBodies glued_;
  double Q_ = 0;
  double triangles_ = 0;
  double unbalanced_ = 0;                       ///< the imbalance of s^ in a triangle [N/m]
  double moved_ = 0;                            ///< largest |u^| [m]
  std::vector<std::vector<Stress>> lifted_;     ///< s(u^) by bodies and triangles
  std::vector<std::vector<Moments>> sizes_;     ///< rounding of what follows: thin triangles cancel in it
  std::vector<Vector> misfits_;                 ///< what Q consists of, by bodies and triangles
  std::vector<std::vector<Moments>> products_;  ///< with moments of t: the energy product of s^ - s(u^) and t
};

}  // namespace

double largestRemainder(double Q, double misfit, double c) {
  if (2 * c * std::sqrt(Q) <= misfit) return std::sqrt(Q) * misfit;
  return c * Q + misfit * misfit / (4 * c);
}

std::vector<Enclosure> enclose(const Admissible& pair, const std::vector<Quantity>& quantities) {
  std::vector<Enclosure> result;
  if (quantities.empty()) return result;
  if (pair.lifting.facing.size() > mostFacing)
    return std::vector<Enclosure>(quantities.size(), {"the contact lines have too many vertices"});
  const Enclosing enclosing(pair);
  for (const Quantity& quantity : quantities) result.push_back(enclosing.enclose(quantity));
  return result;
}

}  // namespace mortier
