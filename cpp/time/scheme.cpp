#include "time/scheme.h"

#include <numbers>

namespace mortier {

Tableau tableau(Scheme scheme) {
  constexpr double gamma = 1 - std::numbers::sqrt2 / 2;
  switch (scheme) {
    case Scheme::crankNicolson:
      return {true, {{{0.5}, 0.5, 1}}, 0};
    case Scheme::sdirk2:
      return {false, {{{}, gamma, gamma}, {{1 - gamma}, gamma, 1}}, 3};
    case Scheme::backwardEuler:
      break;
  }
  return {false, {{{}, 1, 1}}, 2};
}

Tableau twoHalfSteps() {
  return {false, {{{}, 0.5, 0.5}, {{0.5}, 0.5, 1}}, 2};
}

}  // namespace mortier
