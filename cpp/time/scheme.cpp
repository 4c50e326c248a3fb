#include "time/scheme.h"

#include <numbers>

namespace mortier {

Tableau tableau(Scheme scheme) {
  constexpr double gamma = 1 - std::numbers::sqrt2 / 2;
  // All weights that sum to zero and are blind to linear rates are multiples of these. 0.0286 is the error
  // where the rate is a given function of time, 0.195 where it is proportional to the strain; this is
  // between.
  constexpr double embedded = 0.1143;
  switch (scheme) {
    case Scheme::crankNicolson:
      return {true, {{{0.5}, 0.5, 1}}, {}, 0};
    case Scheme::sdirk2:
      return {false,
              {{{}, gamma, gamma}, {{1 - gamma}, gamma, 1}},
              {embedded * (1 / gamma - 1), -embedded / gamma, embedded},
              3};
    case Scheme::backwardEuler:
      break;
  }
  return {false, {{{}, 1, 1}}, {-0.5, 0.5}, 2};
}

Tableau twoHalfSteps() {
  return {false, {{{}, 0.5, 0.5}, {{0.5}, 0.5, 1}}, {-0.25, 0, 0.25}, 2};
}

}  // namespace mortier
