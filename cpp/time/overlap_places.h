// Where bodies are, for overlap_check.h and its parts in the plane and in space.
#pragma once

#include <vector>

#include "time/overlap_check.h"

namespace mortier {

/// Factors of what explains an overlap (docs/sliding.md).
namespace overlap {
constexpr double chords = 2;   ///< of the sagittas of reentrant curves
constexpr double sliding = 2;  ///< of the slip times the angle
constexpr double meshes = 2;   ///< of the turns of lines over an element
}  // namespace overlap

struct OverlapCheck::Places {
  std::vector<std::vector<Point>> inPlane;  ///< by bodies and nodes [m]
  std::vector<std::vector<SpacePoint>> inSpace;
  std::vector<MovedOutline> outlines;
  std::vector<MovedSurface> surfaces;
  double rounding = 0;  ///< of places [m]
  double residual = 0;  ///< of the gaps of a solution [m]

  void add(const Body& body, const Vector& u);
  [[nodiscard]] SpacePoint of(size_t b, int node) const {
    if (!inSpace.empty()) return inSpace[b][node];
    return {inPlane[b][node].x(), inPlane[b][node].y(), 0};
  }
  [[nodiscard]] double largest(size_t b) const;
  /// By their boxes.
  [[nodiscard]] bool apart(size_t one, size_t other) const {
    if (!surfaces.empty()) return !surfaces[one].box().intersects(surfaces[other].box());
    return ((outlines[one].low() - outlines[other].high()).array() > 0).any() ||
           ((outlines[other].low() - outlines[one].high()).array() > 0).any();
  }
};

}  // namespace mortier
