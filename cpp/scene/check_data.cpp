#include "scene/check_data.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "mesh/boundary_line.h"
#include "scene/document.h"

namespace mortier {

namespace {

/// The middles of the edges of a label.
std::vector<Point> middlesOn(const TriangleMesh& mesh, int label) {
  std::vector<Point> points;
  for (const auto& [a, b] : edgesOn(mesh, label)) {
    points.emplace_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
  }
  return points;
}

/// A few hundred centres of triangles are enough to find an expression that has no value.
std::vector<Point> centres(const TriangleMesh& mesh) {
  std::vector<Point> points;
  const size_t stride = 1 + mesh.triangles.size() / 500;
  for (size_t t = 0; t < mesh.triangles.size(); t += stride) {
    const auto [a, b, c] = mesh.triangles[t];
    points.emplace_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  }
  return points;
}

/// Where it acts, over the run: of a value that passes zero only this has digits.
double largestOf(const ConditionDescription& condition, const TriangleMesh& mesh,
                 const std::vector<double>& times) {
  std::vector<Point> points;
  if (condition.point)
    points.push_back(*condition.point);
  else
    for (const int v : verticesOn(mesh, condition.label)) points.push_back(mesh.vertices[v]);
  double largest = 0;
  for (const Point& p : points)
    for (const double t : times) largest = std::max(largest, std::abs(condition.value.value(p[0], p[1], t)));
  return largest;
}

}  // namespace

void requireFiniteData(const BodyDescription& body, const TriangleMesh& mesh,
                       const std::vector<double>& times) {
  for (const ConditionDescription& condition : body.conditions) {
    if (condition.value.constant) {
      continue;
    }
    std::vector<Point> points;
    if (condition.kind == ConditionDescription::Kind::traction) {
      points = middlesOn(mesh, condition.label);
    }
    if (condition.point) {
      points.push_back(*condition.point);
    } else {
      for (const int v : verticesOn(mesh, condition.label)) points.push_back(mesh.vertices[v]);
    }
    requireFinite(condition.value, points, times);
  }
  for (const std::optional<Expression>& force : body.force) {
    if (force && !force->constant) {
      requireFinite(*force, centres(mesh), times);
    }
  }
  const auto requireFiniteStress = [&](const StressDescription& stress) {
    for (const std::optional<Expression>& component : stress) {
      if (component && !component->constant) {
        requireFinite(*component, centres(mesh), {0});
      }
    }
  };
  requireFiniteStress(body.initialStress);
  for (const RegionDescription& region : body.regions) {
    requireFiniteStress(region.initialStress);
  }
}

void requireOneDisplacement(const Supports& supports,
                            const std::vector<const ConditionDescription*>& displacements,
                            const TriangleMesh& mesh, const std::vector<double>& times) {
  constexpr double rounding = 1e-9;  // normals of meshed circles are rounded
  std::vector<std::optional<double>> scales(displacements.size());
  const auto scaleOf = [&](int condition) {
    std::optional<double>& scale = scales[condition];
    if (!scale) scale = largestOf(*displacements[condition], mesh, times);
    return *scale;
  };
  for (const FurtherMotion& motion : supports.further()) {
    const NodeSupport& support = supports.nodes()[motion.support];
    const Point& p = mesh.vertices[support.node];
    for (const double t : times) {
      const auto valueOf = [&](int condition) {
        return displacements[condition]->value.value(p[0], p[1], t);
      };
      std::array<double, 2> values{0, 0};
      for (int i = 0; i < support.count; ++i) values[i] = valueOf(support.conditions[i]);
      const double implied = impliedMotion(support, values, motion.direction) + 0.0;  // no -0
      const double off = std::abs(valueOf(motion.condition) - implied);
      if (off == 0) continue;
      double scale = scaleOf(motion.condition);
      for (int i = 0; i < support.count; ++i) scale = std::max(scale, scaleOf(support.conditions[i]));
      if (off <= rounding * scale) continue;
      const auto placeOf = [&](int i) { return nameOfPlace(*displacements[support.conditions[i]]); };
      const int same = sameMotion(support, motion.direction);
      throw InputError(
          displacements[motion.condition]->value.where + " at (" + shortest(p[0]) + ", " + shortest(p[1]) +
          "), t = " + shortest(t) + ": expected the " + shortest(implied) + " that " +
          (same >= 0 ? placeOf(same) + " prescribes" : placeOf(0) + " and " + placeOf(1) + " prescribe") +
          " there");
    }
  }
}

}  // namespace mortier
