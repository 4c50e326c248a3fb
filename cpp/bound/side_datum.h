// A datum on a straight side, s from 0 to 1: its moments, and bounds of what it is beside the linear function
// between its values at the ends. Pieces of the side are halved, the worst first, until an enclosure of the
// datum and of its derivatives on each (base/taylor.h) leaves little; no quadrature point has to meet a peak.
#pragma once

#include <array>
#include <vector>

#include "base/datum.h"

namespace mortier {

struct SideDatum {
  std::array<double, 2> ends{};     ///< values
  std::array<double, 2> moments{};  ///< integrals of it times 1 - s, and times s
  double momentError = 0;           ///< of these, at most
  double size = 0;                  ///< the largest value known
  double off = 0;                   ///< at least: square root of the integral of (f - linear)^2
  double slope = 0;                 ///< the same of the derivative of f - linear by s; infinite at a jump
  /// The same of integrals of the square of the derivative times 1 - s, and times s.
  std::array<double, 2> slopeMoments{};
  double least = 0, largest = 0;  ///< bounds of f - linear
  std::vector<double> jumps;      ///< where it nearly is a jump
  bool known = true;              ///< whether it is enclosed: of other functions a few values are known

  [[nodiscard]] bool linear() const;
  /// A part of it.
  [[nodiscard]] SideDatum times(double part) const;
};

SideDatum onSide(const Datum& datum, const Point& first, const Point& last, double t);

// Data on a triangle: their L2 projection onto linear functions, and bounds of what they are beside it, by
// enclosures on parts of the triangle (base/taylor.h).

struct TriangleDatum {
  std::array<double, 3> linear{};  ///< values of the projection at the corners, nearly
  double rest = 0;                 ///< root of the mean square of f - linear, at most
  // Of a function that is linear on parts: its mean, the mean square of what it is beside that; and the root
  // of the mean square of what f is beside the function, at most.
  double mean = 0;
  double variance = 0;
  double off = 0;
  double error = 0;   ///< of integrals of f - linear times a linear function of size 1, over the area
  bool known = true;  ///< whether the datum is enclosed

  /// Root of the mean square of f - value, at most.
  [[nodiscard]] double distanceTo(double value) const;
};

/// Some data at a time, for many triangles.
class DataOnTriangles {
 public:
  /// \param triangles  how many are asked for: many get fewer parts each
  DataOnTriangles(const std::vector<Datum>& values, double t, int triangles);
  [[nodiscard]] TriangleDatum on(int datum, const std::array<Point, 3>& corners) const;

 private:
  std::vector<Datum> values_;
  std::vector<Datum::Along> along_;
  double t_;
  int deepest_;
};

}  // namespace mortier
