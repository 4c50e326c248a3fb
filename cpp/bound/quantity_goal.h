// What a quantity asks of the pair z, (t, q) by which it is enclosed (quantity_bound.h): boundary values of
// z, the load l of t, and the jump r that [z.n] shall have.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bound/lift.h"
#include "bound/loaded_body.h"
#include "bound/matched_meshes.h"
#include "mesh/line_part.h"

namespace mortier {

/// A number of the exact solution, of one label of a body.
struct Functional {
  enum class Kind {
    reaction,      ///< integral of e . (traction that the supports of the label exert)
    contactForce,  ///< integral of e . (traction that the other side of contact exerts)
    displacement,  ///< mean of e . u
    meanPressure   ///< of the contact pressure over a part of the label
  };
  Kind kind = Kind::reaction;
  int body = 0;
  int label = 0;
  Point direction{0, 0};  ///< e = direction + turn J (x - about), J a quarter turn counterclockwise
  double turn = 0;
  Point about{0, 0};                  ///< [m]
  std::string obstacle = {};          ///< why there is no bound of it at all
  std::optional<LinePart> part = {};  ///< of a mean pressure
  /// Of a displacement, in place of the label: l would not be bounded, so the mean of the triangle in which
  /// it is stands for it, and what comes of it is an estimate [m]
  std::optional<Point> point = {};

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
  int triangle = -1;          ///< the same, on a triangle [1/m^2]
  Point force{0, 0};
  std::string obstacle;
};

/// Of a mean pressure r shall be continuous, and its weight may jump: p is nowhere negative, so the exact
/// value is between those of an r that is nowhere above the weight, and of one that is nowhere below.
enum class Against { below, above };

Goal goalOf(const AdmissiblePair& pair, const Functional& functional, Against side = Against::below);

}  // namespace mortier
