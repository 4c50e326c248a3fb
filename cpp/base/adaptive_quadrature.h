// Functions on an edge or a triangle, resolved: parts of it are halved until a polynomial meets the function
// on each (Gauss and Kronrod's 7 and 15 points on edges, Dunavant's 12 on triangles), or until what one of
// them may hide does not matter. Kinks, jumps and waves are found by that; a peak between the points of a
// part where an enclosure of the values is known.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/datum.h"

namespace mortier {

/// A point of the rule that was found.
template <class Place>
struct Sample {
  Place at;
  double weight;  ///< parts of the whole: they sum to 1
  double value;
};

template <class Place>
struct Resolved {
  std::vector<Sample<Place>> samples;
  double size = 0;       ///< largest absolute value at a sample
  double uncertain = 0;  ///< mean of the part of the function that the samples may miss
  Place worst{};         ///< where they miss most
  [[nodiscard]] double mean() const {
    double sum = 0;
    for (const auto& sample : samples) sum += sample.weight * sample.value;
    return sum;
  }
  /// Whether what is missed is negligible; otherwise the budget of evaluations was used up.
  [[nodiscard]] bool complete() const { return !(uncertain > negligible * size); }
  static constexpr double negligible = 1e-3;
};

/// Of an edge, by the part of it from its first end.
using ResolvedEdge = Resolved<double>;
/// Of a triangle, by barycentric coordinates.
using ResolvedTriangle = Resolved<std::array<double, 3>>;

/// \param enclosure  of the values between two parts; may be empty
ResolvedEdge resolveOnEdge(const std::function<double(double)>& value,
                           const std::function<Interval(double, double)>& enclosure = {});

/// \param enclosure  of the values on the triangle of three points; may be empty
ResolvedTriangle resolveOnTriangle(
    const std::function<double(const std::array<double, 3>&)>& value,
    const std::function<Interval(const std::array<std::array<double, 3>, 3>&)>& enclosure = {});

}  // namespace mortier
