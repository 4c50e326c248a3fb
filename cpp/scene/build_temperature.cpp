#include "scene/build_temperature.h"

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "material/stress.h"
#include "scene/finite_value.h"
#include "scene/nodal_field.h"

namespace mortier {
namespace {

/// On p, q, r and s33, at an angle of axis 1.
Vector expansionOf(const std::array<double, 3>& along, double angle, Plane plane) {
  const double q = (along[0] - along[1]) / std::numbers::sqrt2;
  Vector strain(plane == Plane::stress ? 3 : 4);
  strain.head<3>() << (along[0] + along[1]) / std::numbers::sqrt2, q * std::cos(2 * angle),
      q * std::sin(2 * angle);
  if (strain.size() > 3) strain[3] = along[2];
  return strain;
}

const MaterialDescription& materialOf(const BodyDescription& body, int region) {
  for (const RegionDescription& each : body.regions)
    if (each.label == region && each.material) return *each.material;
  return body.material;
}

}  // namespace

void addTemperature(const BodyDescription& body, const TriangleMesh& mesh, Plane plane,
                    const std::vector<Point>& places, const std::vector<double>& times,
                    Conditions& conditions) {
  if (!body.temperature) return;
  const TemperatureDescription& temperature = *body.temperature;
  requireFinite(temperature.value, places, times);
  conditions.temperature = finiteValue(temperature.value);
  if (!temperature.file.empty()) {
    const int degree = conditions.temperature.degree;
    conditions.temperature = [factor = conditions.temperature,
                              field = NodalField(mesh, temperature.file, temperature.where)](
                                 double x, double y, double t) {
      return factor(x, y, t) * field({x, y});
    };
    if (degree == 0) conditions.temperature.degree = 1;  // on every triangle
  }
  conditions.expansion.resize(plane == Plane::stress ? 3 : 4, static_cast<Eigen::Index>(places.size()));
  for (size_t i = 0; i < places.size(); ++i) {
    const MaterialDescription& material =
        materialOf(body, mesh.regions.empty() ? 0 : mesh.regions[i * mesh.regions.size() / places.size()]);
    const bool turned = material.anisotropy && material.anisotropy->angle;
    const double angle = turned ? material.anisotropy->angle->value(places[i].x(), places[i].y(), 0) : 0;
    conditions.expansion.col(static_cast<Eigen::Index>(i)) = expansionOf(material.expansion, angle, plane);
  }
  if (conditions.expansion.isZero(0))
    throw InputError(temperature.where + ": temperature, expected expansion in a material of the body");
}

}  // namespace mortier
