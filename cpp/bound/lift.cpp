#include "bound/lift.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/interrupt.h"

namespace mortier {
namespace {

constexpr int fewestRings = 2;
constexpr int sweeps = 60;
constexpr double worthwhile = 1e-3;  ///< of what a sweep took away: it was the last
/// Moves are longer than each by itself should be, as its neighbours will go the same way (SOR).
constexpr double beyond = 1.5;
/// Triangles that face each other, by their longest sides: the first rings are enough. Where they differ more
/// vertices move as deep as the longer side times this.
constexpr double alike = 2;
constexpr double depth = 2;

class Lifting {
 public:
  Lifting(const std::vector<LoadedBody>& bodies, const Model& model, const std::vector<MatchedPiece>& pieces,
          const std::vector<std::array<double, 2>>& pressure)
      : strained_(bodies.size()) {
    for (const LoadedBody& loaded : bodies) {
      const MatchedBody& each = loaded.place();
      bodies_.push_back(&each);
      displacements_.push_back(each.displacement);
      strains_.emplace_back(each.body.mesh().triangles.size(), Eigen::Vector3d::Zero());
      moves_.emplace_back(each.body.nodes(), 0);
      reach_.emplace_back(each.body.nodes(), 0);
      facingAt_.emplace_back(each.body.nodes());
      const auto& supports = each.body.supports().nodes();
      std::vector<int> supportOf(each.body.nodes(), -1);
      for (size_t i = 0; i < supports.size(); ++i) supportOf[supports[i].node] = static_cast<int>(i);
      supportOf_.push_back(std::move(supportOf));
    }
    collect(model, pieces, pressure);
    spreadRings();
  }

  Lift result() {
    Lift lift;
    if (!separate()) {
      lift.obstacle = "bodies that are held penetrate each other";
      return lift;
    }
    double last = value();
    for (int i = 0; i < sweeps; ++i) {
      sweep();
      const double now = value();
      const bool done = last - now <= worthwhile * std::abs(last);
      last = now;
      if (done && i > 2) break;
    }
    for (size_t b = 0; b < bodies_.size(); ++b) {
      Vector energies = Vector::Zero(static_cast<Eigen::Index>(strains_[b].size()));
      for (const int t : strained_[b]) energies[t] = energyIn(b, t);
      lift.energies.push_back(std::move(energies));
    }
    for (const Facing& each : facing_) lift.gap += each.weight * each.gap;
    lift.displacements = displacements_;
    lift.facing = facing_;
    lift.facingOfPiece = facingOfPiece_;
    return lift;
  }

 private:
  [[nodiscard]] double area(size_t body, size_t t) const { return bodies_[body]->body.weights()[t]; }
  [[nodiscard]] double energyIn(size_t body, int t) const {
    return area(body, t) * strains_[body][t].dot(bodies_[body]->moduli[t] * strains_[body][t]);
  }

  void collect(const Model& model, const std::vector<MatchedPiece>& pieces,
               const std::vector<std::array<double, 2>>& pressure) {
    facingOfPiece_.resize(pieces.size());
    for (size_t k = 0; k < pieces.size(); ++k) {
      const MatchedPiece& piece = pieces[k];
      const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
      const std::array<int, 2> sides{nonmortar.body, mortar.body};
      std::array<double, 2> sizes{};
      for (int side = 0; side < 2; ++side)
        sizes[side] = sizeAt(sides[side], model.bodies[sides[side]].mesh(), piece.vertices[side]);
      const auto [small, large] = std::minmax(sizes[0], sizes[1]);
      const double reach = large > alike * small ? depth * large : 0;
      for (int end = 0; end < 2; ++end) {
        const std::array<int, 2> vertices{piece.vertices[0][end], piece.vertices[1][end]};
        for (int side = 0; side < 2; ++side)
          reach_[sides[side]][vertices[side]] = std::max(reach_[sides[side]][vertices[side]], reach);
        int index = -1;
        for (const int at : facingAt_[sides[0]][vertices[0]])
          if (facing_[at].vertices == vertices && facing_[at].bodies == sides &&
              facing_[at].normal.dot(piece.normal) > 1 - 1e-9)
            index = at;
        if (index < 0) {
          index = static_cast<int>(facing_.size());
          Facing facing{sides, vertices, piece.normal, 0, 0};
          facing.gap = piece.distance[end] - (bodies_[sides[0]]->displacement.segment<2>(2 * vertices[0]) -
                                              bodies_[sides[1]]->displacement.segment<2>(2 * vertices[1]))
                                                 .dot(piece.normal);
          facing_.push_back(facing);
          for (int side = 0; side < 2; ++side) facingAt_[sides[side]][vertices[side]].push_back(index);
        }
        facingOfPiece_[k][end] = index;
        facing_[index].weight += piece.length / 6 * (2 * pressure[k][end] + pressure[k][1 - end]);
      }
    }
  }

  /// The longest side of that triangle of the body's own mesh which has the side between two vertices.
  [[nodiscard]] double sizeAt(int body, const TriangleMesh& own, const std::array<int, 2>& side) const {
    const auto& [a, b] = side;
    double size = 0;
    for (const int t : bodies_[body]->sides.trianglesAt(a)) {
      const auto& v = bodies_[body]->body.mesh().triangles[t];
      if (std::find(v.begin(), v.end(), b) == v.end()) continue;
      const auto& corners = own.triangles[bodies_[body]->cut.parents[t]];
      for (int k = 0; k < 3; ++k)
        size = std::max(size, (own.vertices[corners[(k + 1) % 3]] - own.vertices[corners[k]]).norm());
    }
    return size;
  }

  /// Two rings around the line, and more where triangles of one side are much longer than those of the other.
  void spreadRings() {
    struct Reached {
      int vertex, from;
    };
    for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) {
      const TriangleMesh& mesh = bodies_[b]->body.mesh();
      std::vector<char> seen(mesh.triangles.size(), 0);
      std::vector<Reached> ring;
      const auto add = [&](int vertex, int from) {
        if (std::exchange(moves_[b][vertex], 1) != 0) return;
        ring.push_back({vertex, from});
        moving_.push_back({b, vertex});
        for (const int t : bodies_[b]->sides.trianglesAt(vertex))
          if (std::exchange(seen[t], 1) == 0) strained_[b].push_back(t);
      };
      for (const Facing& each : facing_)
        for (int side = 0; side < 2; ++side)
          if (each.bodies[side] == b) add(each.vertices[side], each.vertices[side]);
      for (int i = 0; !ring.empty(); ++i)
        for (const auto& [vertex, from] : std::exchange(ring, {}))
          for (const int t : bodies_[b]->sides.trianglesAt(vertex))
            for (const int other : mesh.triangles[t])
              if (i < fewestRings || (mesh.vertices[other] - mesh.vertices[from]).norm() <= reach_[b][from])
                add(other, from);
    }
  }

  /// The part of a direction along which the vertex is free.
  [[nodiscard]] Point freePart(int body, int vertex, Point direction) const {
    const int at = supportOf_[body][vertex];
    if (at < 0) return direction;
    const NodeSupport& support = bodies_[body]->body.supports().nodes()[at];
    if (support.count == 2) return {0, 0};
    const Point held = support.directions[0].head<2>();
    return direction - direction.dot(held) / held.squaredNorm() * held;
  }

  /// (p, q, r) of the strain of a motion of a vertex in one of its triangles.
  [[nodiscard]] Eigen::Vector3d strainOf(int body, int t, int vertex, const Point& motion) const {
    const auto& v = bodies_[body]->body.mesh().triangles[t];
    const int i = v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
    return symmetricPart(motion, hatGradient(bodies_[body]->body.mesh(), t, i) / area(body, t));
  }

  struct Step {
    int body, vertex;
    Point motion;
  };

  void apply(const std::vector<Step>& steps, double amount) {
    for (const Step& step : steps) {
      displacements_[step.body].segment<2>(2 * step.vertex) -= amount * step.motion;
      for (const int t : bodies_[step.body]->sides.trianglesAt(step.vertex))
        strains_[step.body][t] += amount * strainOf(step.body, t, step.vertex, step.motion);
      for (const int at : facingAt_[step.body][step.vertex]) facing_[at].gap += amount * opening(at, step);
    }
  }
  [[nodiscard]] double opening(int at, const Step& step) const {
    const Facing& facing = facing_[at];
    const bool first = facing.bodies[0] == step.body && facing.vertices[0] == step.vertex;
    return (first ? 1 : -1) * step.motion.dot(facing.normal);
  }

  /// Moves along the steps as far as is best and no gap closes.
  void move(const std::vector<Step>& steps) {
    double slope = 0;
    double curvature = 0;
    // Triangles of both vertices, where they are of one body, are none here: they face each other.
    for (const Step& step : steps)
      for (const int t : bodies_[step.body]->sides.trianglesAt(step.vertex)) {
        const Eigen::Vector3d strain = strainOf(step.body, t, step.vertex, step.motion);
        const Eigen::Vector3d stress = bodies_[step.body]->moduli[t] * strain;
        slope += area(step.body, t) * stress.dot(strains_[step.body][t]);
        curvature += area(step.body, t) * stress.dot(strain);
      }
    if (!(curvature > 0)) return;
    std::map<int, double> openings;
    for (const Step& step : steps)
      for (const int at : facingAt_[step.body][step.vertex]) openings[at] += opening(at, step);
    for (const auto& [at, by] : openings) slope += facing_[at].weight * by;
    double amount = -beyond * slope / curvature;
    for (const auto& [at, by] : openings)
      if (std::abs(by) > 1e-14 && by * amount < 0) {
        const double most = -facing_[at].gap / by;
        if (std::abs(most) < std::abs(amount)) amount = most;
      }
    if (amount == 0 || !std::isfinite(amount)) return;
    apply(steps, amount);
    for (const auto& [at, by] : openings) facing_[at].gap = std::max(facing_[at].gap, 0.0);
  }

  bool separate() {
    for (size_t i = 0; i < facing_.size(); ++i) {
      if (facing_[i].gap >= 0) continue;
      std::array<Step, 2> steps;
      std::array<double, 2> opens{};
      for (int side = 0; side < 2; ++side) {
        const int body = facing_[i].bodies[side];
        const int vertex = facing_[i].vertices[side];
        steps[side] = {body, vertex,
                       freePart(body, vertex, side == 0 ? facing_[i].normal : Point(-facing_[i].normal))};
        opens[side] = opening(static_cast<int>(i), steps[side]);
      }
      // By the softer part first: shares go with the compliance of the vertices.
      std::array<double, 2> share{};
      for (int side = 0; side < 2; ++side) {
        double stiffness = 0;
        for (const int t : bodies_[steps[side].body]->sides.trianglesAt(steps[side].vertex)) {
          const Eigen::Vector3d strain =
              strainOf(steps[side].body, t, steps[side].vertex, steps[side].motion);
          stiffness += area(steps[side].body, t) * strain.dot(bodies_[steps[side].body]->moduli[t] * strain);
        }
        share[side] = opens[side] > 1e-9 ? opens[side] * opens[side] / stiffness : 0;
      }
      const double all = share[0] + share[1];
      if (!(all > 0)) return false;
      const double gap = facing_[i].gap;
      for (int side = 0; side < 2; ++side)
        if (share[side] > 0) apply({steps[side]}, -gap * share[side] / all / opens[side]);
      facing_[i].gap = std::max(facing_[i].gap, 0.0);
    }
    return std::all_of(facing_.begin(), facing_.end(), [](const Facing& each) { return each.gap >= 0; });
  }

  void sweep() {
    stopIfInterrupted();
    for (const auto& [body, vertex] : moving_) {
      for (int c = 0; c < 2; ++c) {
        const Point motion = freePart(body, vertex, Point::Unit(c));
        if (motion.squaredNorm() > 1e-18) move({{body, vertex, motion}});
      }
    }
    for (const Facing& each : facing_) {
      std::vector<Step> steps;
      for (int side = 0; side < 2; ++side) {
        const Point motion = freePart(each.bodies[side], each.vertices[side], each.normal);
        if (std::abs(motion.dot(each.normal) - 1) > 1e-9) break;
        steps.push_back({each.bodies[side], each.vertices[side], each.normal});
      }
      if (steps.size() == 2) move(steps);
    }
  }

  [[nodiscard]] double value() const {
    double sum = 0;
    for (size_t b = 0; b < bodies_.size(); ++b)
      for (const int t : strained_[b]) sum += energyIn(b, t);
    for (const Facing& each : facing_) sum += 2 * each.weight * each.gap;
    return sum;
  }

  std::vector<const MatchedBody*> bodies_;
  std::vector<std::vector<Eigen::Vector3d>> strains_;  ///< of w, by bodies and triangles
  std::vector<std::vector<int>> strained_;             ///< triangles that may be, by bodies
  std::vector<std::vector<char>> moves_;               ///< by bodies and vertices
  std::vector<std::vector<double>> reach_;  ///< of the line, the same: how deep vertices move there [m]
  std::vector<std::vector<int>> supportOf_;
  std::vector<std::vector<std::vector<int>>> facingAt_;  ///< by bodies and vertices
  std::vector<Facing> facing_;
  std::vector<std::array<int, 2>> facingOfPiece_;
  std::vector<Vector> displacements_;  ///< u^ by bodies
  struct Moving {
    int body, vertex;
  };
  std::vector<Moving> moving_;
};

}  // namespace

Lift lift(const std::vector<LoadedBody>& bodies, const Model& model, const std::vector<MatchedPiece>& pieces,
          const std::vector<std::array<double, 2>>& pressure) {
  return Lifting(bodies, model, pieces, pressure).result();
}

}  // namespace mortier
