// What a quantity asks of the pair z, (t, q) by which it is enclosed (quantity_bound.h): boundary values of
// z, the load l of t, and the jump r that [z.n] shall have.
#pragma once

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

struct AdmissiblePair {
  const Model& model;
  const MatchedMeshes& meshes;
  const std::vector<LoadedBody>& bodies;  ///< balanced: they have s^
  const std::vector<Vector>& spread;      ///< coefficients of p^ (pressures.h)
  const Lift& lifting;                    ///< u^
};

/// What is asked of z and t.
struct Goal {
  std::vector<Vector> held;   ///< boundary values of z by bodies (dofs)
  std::vector<Vector> loads;  ///< l by bodies (dofs)
  Vector r;                   ///< by facing vertices
  Point traction{0, 0};       ///< that is l, on the label [1/m]
  std::string obstacle;
};

Goal goalOf(const AdmissiblePair& pair, const Functional& functional);

}  // namespace mortier
