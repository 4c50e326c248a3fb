// Time schemes. The viscoplastic strain is the only quantity with a rate, so a diagonally implicit
// Runge-Kutta scheme turns a step into backward Euler steps with a strain shift, equilibrium and contact
// holding at every stage time:
//   E^-1 (s_i - s_n) + a_ii k G(s_i) = eps(u_i - u_n) - sum_{j<i} a_ij k G_j,   G = (s - P_B s)/(2 lambda)
// All schemes here end in their last stage.
#pragma once

#include <vector>

namespace mortier {

enum class Scheme {
  backwardEuler,  ///< order 1; never overshoots the yield surface
  crankNicolson,  ///< order 2 where smooth; rings for theta e >> 1
  sdirk2          ///< order 2, L-stable (Alexander 1977), gamma = 1 - 1/sqrt2, guarded (step_taker.h)
};

struct Stage {
  std::vector<double>
      before;           ///< a_ij, j < i; G_0 is the rate at the start of the step where `explicitFirst`
  double diagonal = 1;  ///< a_ii
  double time = 1;      ///< c_i
};

struct Tableau {
  bool explicitFirst = false;
  std::vector<Stage> stages;  ///< the implicit ones
  int errorOrder = 0;         ///< the local error falls as this power of k
};

Tableau tableau(Scheme scheme);

/// Two half steps of backward Euler as the stages of one step.
Tableau twoHalfSteps();

}  // namespace mortier
