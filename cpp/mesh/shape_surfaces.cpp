// Surfaces of the program's own bodies in space.
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "mesh/geometry_surfaces.h"
#include "mesh/read.h"
#include "mesh/shape.h"

namespace mortier {
namespace {

const SpacePoint noNormal = SpacePoint::Constant(std::numeric_limits<double>::quiet_NaN());

/// Surfaces of which each is asked by itself, without curves of their own.
class ShapeSurfaces : public GeometrySurfaces {
 public:
  [[nodiscard]] std::vector<std::optional<SurfaceFoot>> feet(
      const std::vector<std::pair<int, SpacePoint>>& points) const override {
    std::vector<std::optional<SurfaceFoot>> result;
    for (const auto& [surface, x] : points) result.push_back(foot(surface, x));
    return result;
  }
  [[nodiscard]] std::optional<SpacePoint> onSharedCurve(int /*one*/, int /*other*/,
                                                        const SpacePoint& /*x*/) const override {
    return std::nullopt;
  }

 private:
  [[nodiscard]] virtual SurfaceFoot foot(int surface, const SpacePoint& x) const = 0;
};

SurfaceFoot footOnPlane(const SpacePoint& x, int axis, double at) {
  SurfaceFoot foot{x, SpacePoint::Unit(axis)};
  foot.at[axis] = at;
  return foot;
}

class RoundSurfaces : public ShapeSurfaces {
 public:
  explicit RoundSurfaces(const RoundBody& body) : body_(body) {}
  [[nodiscard]] bool isPlane(int surface) const override { return surface != roundLabel; }

 private:
  [[nodiscard]] SurfaceFoot foot(int surface, const SpacePoint& x) const override {
    const SpacePoint& centre = body_.centre;
    for (const auto& [axis, end, label] : boxSides)
      if (label == surface)
        return footOnPlane(x, axis, centre[axis] + (axis == 2 && end == 1 && !body_.ball ? body_.height : 0));
    SpacePoint normal = x - centre;
    if (!body_.ball) normal.z() = 0;
    normal.normalize();
    SpacePoint at = centre + body_.radius * normal;
    if (!body_.ball) at.z() = x.z();
    return {at, normal};
  }

  RoundBody body_;
};

/// What an edge of a plane mesh stands for: a straight line, a circle, or a curve.
struct PlaneCurve {
  Point a{0, 0}, b{0, 0};
  Point centre{0, 0};
  double radius = 0;  ///< 0 where it is straight [m]
  EdgeCurve curve = {};
};

PlaneCurve curveOf(const TriangleMesh& plane, size_t e) {
  constexpr double straight = 1e-9;
  PlaneCurve result{plane.vertices[plane.boundaryEdges[e][0]], plane.vertices[plane.boundaryEdges[e][1]]};
  if (plane.hasCurve(e)) {
    result.curve = plane.edgeCurves[e];
    return result;
  }
  if (plane.edgeMiddles.empty()) return result;
  const Point half = (result.b - result.a) / 2;
  const Point rise = plane.edgeMiddles[e] - result.a - half;
  const double sagitta = rise.norm();
  if (sagitta <= straight * half.norm()) return result;
  result.radius = (half.squaredNorm() + sagitta * sagitta) / (2 * sagitta);
  result.centre = plane.edgeMiddles[e] - result.radius / sagitta * rise;
  return result;
}

class SweptSurfaces : public ShapeSurfaces {
 public:
  SweptSurfaces(const TriangleMesh& plane, const Sweep& sweep) : sweep_(sweep) {
    for (size_t e = 0; e < plane.boundaryEdges.size(); ++e) curves_.push_back(curveOf(plane, e));
  }

  [[nodiscard]] bool isPlane(int surface) const override {
    if (surface >= static_cast<int>(curves_.size())) return true;
    const PlaneCurve& curve = curves_[surface];
    const bool straight = curve.radius == 0 && !curve.curve.known();
    return straight && (sweep_.length != 0 || curve.a.y() == curve.b.y());
  }

 private:
  [[nodiscard]] SurfaceFoot foot(int surface, const SpacePoint& x) const override {
    const int end = surface - static_cast<int>(curves_.size());
    if (end >= 0) return onEnd(x, end == 0 ? 0 : 1);
    if (sweep_.length != 0) {
      const auto [at, normal] = inPlane(curves_[surface], x.head<2>());
      return {{at.x(), at.y(), x.z()}, {normal.x(), normal.y(), 0}};
    }
    const double radius = std::hypot(x.x(), x.z());
    const double cosine = radius > 0 ? x.x() / radius : 1;
    const double sine = radius > 0 ? x.z() / radius : 0;
    const auto [at, normal] = inPlane(curves_[surface], {radius, x.y()});
    return {{at.x() * cosine, at.y(), at.x() * sine}, {normal.x() * cosine, normal.y(), normal.x() * sine}};
  }

  [[nodiscard]] SurfaceFoot onEnd(const SpacePoint& x, double part) const {
    if (sweep_.length != 0) return footOnPlane(x, 2, part * sweep_.length);
    const double angle = part * sweep_.angle;
    const SpacePoint normal(-std::sin(angle), 0, std::cos(angle));
    return {x - x.dot(normal) * normal, normal};
  }

  struct PlaneFoot {
    Point at, normal;
  };
  static PlaneFoot inPlane(const PlaneCurve& curve, const Point& x) {
    const Point along = (curve.b - curve.a).normalized();
    const Point across(along.y(), -along.x());
    if (curve.curve.known()) return {curve.curve.at(curve.curve.meeting(x, across)), noNormal.head<2>()};
    if (curve.radius == 0) return {curve.a + (x - curve.a).dot(along) * along, across};
    const Point normal = (x - curve.centre).normalized();
    return {curve.centre + curve.radius * normal, normal};
  }

  Sweep sweep_;
  std::vector<PlaneCurve> curves_;
};

}  // namespace

std::shared_ptr<const GeometrySurfaces> surfacesOf(const RoundBody& body) {
  return std::make_shared<const RoundSurfaces>(body);
}

std::shared_ptr<const GeometrySurfaces> surfacesOf(const TriangleMesh& plane, const Sweep& sweep) {
  return std::make_shared<const SweptSurfaces>(plane, sweep);
}

}  // namespace mortier
