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

#include <string>
#include <vector>

#include "bound/admissible.h"
#include "bound/functional.h"

namespace mortier {

/// What a quantity asks of z and t.
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
enum class Against { below, above };

Goal goalOf(const Admissible& pair, const Functional& functional, Against side = Against::below);

/// The largest |R|. \param misfit  |E eps z - t|
double largestRemainder(double Q, double misfit, double c);

std::vector<Enclosure> enclose(const Admissible& pair, const std::vector<Functional>& functionals);

}  // namespace mortier
