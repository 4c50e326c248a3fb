// What quantities are besides numbers: forces as the work that forces at the nodes do on a motion, largest
// values with their places.
#pragma once

#include "time/quantity.h"

namespace mortier {

/// x, y or z, of a component or of the axis that it turns about, as a number.
int axisOf(const Quantity& quantity);
/// Which motion of a rigid body it is (Body::motionOf).
int motionNumber(const Quantity& quantity, const Body& body);

/// The component as a unit motion at a place: along an axis, or by a unit angle about a point.
SpacePoint motionAt(const Quantity& quantity, const SpacePoint& x);

/// The motion (dofs) on which the work of forces at the nodes is a reaction, for those of supports, or a
/// contact force, for those that contact takes from the body.
Vector motionOf(const Quantity& quantity, const Model& model);
/// That of a reaction, on any mesh of its body.
Vector reactionMotion(const Quantity& quantity, const Body& body);

/// A largest value, and where it is.
struct PlaceOfLargest {
  double value = 0;
  SpacePoint place{0, 0, 0};  ///< as meshed [m]; z = 0 in the plane
  size_t interface = 0;       ///< of a pressure
  Eigen::Index row = 0;       ///< of C; of a stress its point
};
/// None of other quantities, and where nothing is above 0.
std::optional<PlaceOfLargest> placeOfLargest(const Quantity& quantity, const Model& model,
                                             const State& state);

}  // namespace mortier
