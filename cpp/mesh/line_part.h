// A part of a labelled line, between two points of it, and the weight of a mean over it: 1 on the part,
// falling to 0 over a margin beyond each of its ends, as far as the line goes.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "mesh/boundary_line.h"

namespace mortier {

class LinePart {
 public:
  /// All of a line.
  explicit LinePart(const BoundaryLine& line);
  /// \param margin  0 or more [m]
  /// \throws InputError where a point is not on the line, where the part has no length, and on closed lines.
  LinePart(const BoundaryLine& line, const Point& from, const Point& to, double margin);

  /// How far along the line its point nearest to another is [m].
  [[nodiscard]] double along(const Point& x) const;
  /// Integral of the weight over the line [m], or over the surface that it is as it turns about the axis
  /// x = 0 [m^2].
  [[nodiscard]] double size(bool axisymmetric = false) const;
  /// Means of the weight times 1 - x and x over a stretch, x going from 0 to 1.
  [[nodiscard]] std::array<double, 2> moments(double first, double last) const;
  /// Values at both ends of linear functions that are nowhere below the weight on a stretch, or nowhere
  /// above.
  [[nodiscard]] std::array<double, 2> above(double first, double last) const;
  [[nodiscard]] std::array<double, 2> below(double first, double last) const;

 private:
  [[nodiscard]] double weight(double s) const;
  /// The ends of a stretch and the kinks of the weight in it.
  [[nodiscard]] std::vector<double> stretch(double first, double last) const;
  /// How far beside that of its ends the weight is, at most, to a side: +1 above, -1 below.
  [[nodiscard]] double deviation(double first, double last, int side) const;

  std::vector<Point> points_;
  std::vector<double> places_;  ///< of the points along the line [m]
  double begin_ = 0, end_ = 0;  ///< of the part
  double margin_ = 0;
};

}  // namespace mortier
