// A guaranteed bound of what steps and meshes together do to a run of bodies that flow, against the solution
// that is continuous in time and space. With u^ in K, (s^, p^) in S at the ends of all steps and linear in
// between, any rate G(t) of flow, s~ = E (eps(u^) - eps^_p) and r = s~ - s^
//
//   |s^ - sigma| <= Y = sqrt(2 A) + R,    lambda (integral of ||G(t) - eps_p'||^2) <= A + R Y,
//   A = |r(0)|^2/2 + integral of D(s^; t),    R = integral of |r'|
//
// where contact is closed and open as in the run; and with weights (error_course.h), in which contact forces
// grow, whatever contact does, unless gaps become smaller (docs/bounds.md has the proofs).
#pragma once

#include <string>
#include <vector>

#include "bound/earlier_contact.h"
#include "bound/error_course.h"

namespace mortier {

/// The sums of a run so far.
struct TotalBoundMemory {
  std::string obstacle;    ///< why there is no bound
  std::string moved;       ///< why contact is not closed and open as in the run
  std::string closes;      ///< why there is no bound whatever contact does
  double oscillation = 0;  ///< of the data on the meshes: others than linear ones have an obstacle
  ErrorCourse fixed, any;
  std::vector<char> contact;   ///< of the pieces of contact lines: Touch
  std::vector<Matrix> stress;  ///< s~ by bodies
  EarlierContact earlier;      ///< by which u^ and p^ of the last step were made
};

struct TotalBound {
  std::string obstacle;  ///< why there is none
  std::string moved;     ///< why there is none of the two where contact is closed and open as in the run
  std::string closes;    ///< why there is none whatever contact does
  struct Errors {
    double strain = 0;  ///< ||eps_p,h - eps_p|| [m]
    double stress = 0;  ///< |s - sigma| [sqrt(J/m)]
  };
  Errors fixed, any;
  double lifted = 0;       ///< ||eps^_p - eps_p,h||, which is in both [m]
  double strainNorm = 0;   ///< ||eps_p,h|| [m]
  double stressNorm = 0;   ///< |s| [sqrt(J/m)]
  double oscillation = 0;  ///< of the data on the meshes: others than linear ones have an obstacle
  double data = 0;         ///< how far data are from linear within steps (flow_bound.h)
};

}  // namespace mortier
