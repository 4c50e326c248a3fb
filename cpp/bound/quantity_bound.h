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

#include <algorithm>
#include <string>
#include <vector>

#include "bound/lift.h"
#include "bound/loaded_body.h"
#include "bound/matched_meshes.h"

namespace mortier {

/// A number of the exact solution, of one label of a body.
struct Functional {
  enum class Kind {
    reaction,      ///< integral of e . (traction that the supports of the label exert)
    contactForce,  ///< integral of e . (traction that the other side of contact exerts)
    displacement   ///< mean of e . u
  };
  Kind kind = Kind::reaction;
  int body = 0;
  int label = 0;
  Point direction{0, 0};  ///< e = direction + turn J (x - about), J a quarter turn counterclockwise
  double turn = 0;
  Point about{0, 0};          ///< [m]
  std::string obstacle = {};  ///< why there is no bound of it at all

  [[nodiscard]] Point at(const Point& x) const {
    return direction + turn * Point(about.y() - x.y(), x.x() - about.x());
  }
};

struct Enclosure {
  std::string obstacle;  ///< why there is none; empty where there is
  double lower = 0;      ///< the exact value is not below
  double upper = 0;      ///< and not above

  /// Of a computed value, at most.
  [[nodiscard]] double error(double value) const { return std::max({value - lower, upper - value, 0.0}); }
};

struct AdmissiblePair {
  const Model& model;
  const MatchedMeshes& meshes;
  const std::vector<LoadedBody>& bodies;  ///< balanced: they have s^
  const std::vector<Vector>& spread;      ///< coefficients of p^ (pressures.h)
  const Lift& lifting;                    ///< u^
};

/// The largest |R|. \param misfit  |E eps z - t|
double largestRemainder(double Q, double misfit, double c);

std::vector<Enclosure> enclose(const AdmissiblePair& pair, const std::vector<Functional>& functionals);

}  // namespace mortier
