// Data on a triangle: their L2 projection onto linear functions, and bounds of what they are beside it, by
// enclosures on parts of the triangle (base/taylor.h).
#pragma once

#include <array>
#include <vector>

#include "base/datum.h"

namespace mortier {

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
