// Guaranteed bounds of forces and mean displacements, from the pair u^ in K, (s^, p^) in S of an energy bound
// (energy_bound.h) and a pair for the quantity: z with the support's share of a reaction as its boundary
// values, and (t, q) with
//
//   (t, eps v) + integral of q [v.n] = l(v)       for all v that vanish where supports act.
//
// For the quantity l(u) + integral of p r + reaction, with m = (s^ + s(u^))/2 and a c that has
// |r - [z.n]| <= c G(u^), |q| <= c p^ at every point of the contact line (docs/bounds.md has the proof):
//
//   quantity = l(u^) + L(z) - (m, eps z) + (s^ - s(u^), E^-1 t)/2 + integral of q G(u^) + R,
//   |R| <= max over 0 <= x <= Q of  c x + sqrt(Q - x) |E eps z - t|,
//   Q = |s^ - s(u^)|^2/4 + integral of p^ G(u^).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bound/admissible.h"
#include "bound/energy_bound.h"
#include "bound/lift.h"
#include "bound/loaded_body.h"
#include "linear/condensing_solver.h"

namespace mortier {

/// The conditions of a quantity on z and t.
struct Goal {
  std::vector<Vector> held;   ///< boundary values of z by bodies (dofs)
  std::vector<Vector> loads;  ///< l by bodies (dofs)
  Vector r;                   ///< that [z.n] shall be, by facing vertices
  Point traction{0, 0};       ///< that is l, on the label [1/m]
  int triangle = -1;          ///< the same, on a triangle [1/m^2]
  Point force{0, 0};
  std::string obstacle;
};

/// Of a mean pressure r shall be continuous, and its weight may jump: p is nowhere negative, so the exact
/// value is between those of an r that is nowhere above the weight, and of one that is nowhere below.
enum class BoundSide { below, above };

Goal goalOf(const Admissible& pair, const Quantity& quantity, BoundSide side = BoundSide::below);

/// Coefficients of q, spread as p^ and zero where it is, |q| <= c p^. \param glue  forces by facing vertices
/// \param bodies  of z, under their loads. \returns none where no such q is in equilibrium with them
std::optional<std::vector<Vector>> adjointPressure(const Admissible& pair, const Vector& glue,
                                                   const std::vector<LoadedBody>& bodies, double c);

/// The largest |R|. \param misfit  |E eps z - t|
double largestRemainder(double Q, double misfit, double c);

std::vector<Enclosure> enclose(const Admissible& pair, const std::vector<Quantity>& quantities);

// Linear elastic bodies whose contact lines are glued in part: displacements z by matched meshes with
//
//   (E eps z, eps v) + sum of l_i [v.n]_i = f(v),     [z.n]_i = jump_i   at the glued vertices i,
//
// for all v that vanish where supports act; l_i are the forces of the glue, 0 where it is not. Bodies are
// condensed to the motions along which vertices of the line are glued, once for all solutions.

class GluedBodies {
 public:
  /// What it is given must outlive it.
  GluedBodies(const std::vector<LoadedBody>& bodies, const std::vector<Facing>& facing);

  struct Given {
    std::vector<Vector> held;   ///< by bodies (dofs), what supports prescribe; 0 beside
    std::vector<Vector> loads;  ///< by bodies (dofs) [N/m]
    std::vector<char> glued;    ///< by facing vertices
    Vector jumps;               ///< [z.n] where glued
  };
  struct Solution {
    std::vector<Vector> displacements;  ///< z by bodies (dofs)
    Vector forces;                      ///< l by facing vertices [N/m]
  };
  /// None where supports and glue leave a body free to move, or supports contradict the glue.
  [[nodiscard]] std::optional<Solution> solve(const Given& given) const;
  /// [v.n] at a facing vertex.
  [[nodiscard]] double jump(const std::vector<Vector>& v, size_t facing) const;

 private:
  struct Entry {
    int place;  ///< of all kept motions
    double value;
  };
  const std::vector<LoadedBody>& bodies_;
  const std::vector<Facing>& facing_;
  std::vector<std::unique_ptr<CondensingSolver>> solvers_;  ///< null where the body cannot be factorised
  std::vector<std::vector<int>> kept_;                      ///< equations by bodies
  std::vector<std::vector<Entry>> rows_;                    ///< [z.n] by facing vertices
  int size_ = 0;                                            ///< kept motions of all bodies
};

}  // namespace mortier
