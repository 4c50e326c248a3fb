// The numbers of the exact solution that are enclosed (quantity_bound.h), and between what.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/types.h"
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

struct Enclosure {
  std::string obstacle;  ///< why there is none; empty where there is
  double lower = 0;      ///< the exact value is not below
  double upper = 0;      ///< and not above
  /// What each triangle of the bodies' own meshes adds to the half of upper - lower, nearly.
  std::vector<Vector> parts = {};
  std::optional<double> estimate = {};  ///< of an error of which nothing is proved

  /// Of a computed value, at most.
  [[nodiscard]] double error(double value) const { return std::max({value - lower, upper - value, 0.0}); }
};

}  // namespace mortier
