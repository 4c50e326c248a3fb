#include "plan/loads.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace mortier {

std::vector<const MaterialDescription*> materialsOf(const BodyDescription& body) {
  std::vector<const MaterialDescription*> materials{&body.material};
  for (const RegionDescription& region : body.regions)
    if (region.material) materials.push_back(&*region.material);
  return materials;
}

double SampledDatum::largest(double t) const {
  double result = 0;
  for (const Point& p : points) result = std::max(result, std::abs(value->value(p.x(), p.y(), t)));
  return result;
}

double SampledDatum::largestIn(const TimePlan& plan) const {
  const auto over = [&](const std::vector<double>& times) {
    double result = 0;
    for (const double t : times)
      result = std::max(result, kind == Kind::distance ? change(0, t) : largest(t));
    return result;
  };
  return over(value->value.degreeInTime <= 1 ? std::vector<double>{0, plan.end} : trialTimes(plan));
}

double SampledDatum::stressOfUnit(const SceneDescription& scene) const {
  if (kind == Kind::traction) return 1;
  return kind == Kind::force ? size : scene.bodies[body].material.elasticity.young / size;
}

double SampledDatum::change(double s, double t) const {
  double result = 0;
  for (const Point& p : points)
    result = std::max(result, std::abs(value->value(p.x(), p.y(), t) - value->value(p.x(), p.y(), s)));
  return result;
}

std::vector<SampledDatum> sampledData(const MeshedScene& input) {
  constexpr size_t enough = 60;
  const auto thinned = [](std::vector<Point> points) {
    const size_t stride = 1 + points.size() / enough;
    std::vector<Point> some;
    for (size_t i = 0; i < points.size(); i += stride) some.push_back(points[i]);
    return some;
  };
  std::vector<SampledDatum> data;
  for (size_t b = 0; b < input.meshes.size(); ++b) {
    if (input.meshes[b] == nullptr) continue;
    const TriangleMesh& mesh = *input.meshes[b];
    const double size = extent(mesh);
    for (const ConditionDescription& c : input.scene.bodies[b].conditions) {
      if (const BodyDescription& tool = input.scene.bodies[b]; tool.isTool()) {
        // A force is as of a pressure over its size, a rotation moves its ends by its size.
        const bool moves = c.kind == ConditionDescription::Kind::displacement;
        data.push_back({moves ? SampledDatum::Kind::displacement : SampledDatum::Kind::force,
                        b,
                        &c.value,
                        {*c.point},
                        moves ? (c.component > alongY ? 1 : size) : 1 / size});
        continue;
      }
      std::vector<Point> points;
      for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
        if (c.actsOn(mesh.boundaryLabels[e]))
          for (const int v : mesh.boundaryEdges[e]) points.push_back(mesh.vertices[v]);
      if (c.point) points.push_back(*c.point);
      const bool held = c.kind == ConditionDescription::Kind::displacement;
      data.push_back({held ? SampledDatum::Kind::displacement : SampledDatum::Kind::traction, b, &c.value,
                      thinned(std::move(points)), size});
    }
    for (const std::optional<Expression>& force : input.scene.bodies[b].force)
      if (force) data.push_back({SampledDatum::Kind::force, b, &*force, thinned(mesh.vertices), size});
    if (const auto& temperature = input.scene.bodies[b].temperature) {
      double expansion = 0;
      for (const MaterialDescription* material : materialsOf(input.scene.bodies[b]))
        for (const double each : material->expansion) expansion = std::max(expansion, std::abs(each));
      data.push_back({SampledDatum::Kind::temperature, b, &temperature->value, thinned(mesh.vertices),
                      1 / std::max(expansion, std::numeric_limits<double>::min())});
    }
  }
  for (const ContactDescription& contact : input.scene.contacts) {
    const int b = bodyIndex(input.scene, contact.nonmortar.body);
    if (!contact.gap || !contact.gap->inTime || input.meshes[b] == nullptr) continue;
    const TriangleMesh& mesh = *input.meshes[b];
    std::vector<Point> points;
    for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
      if (mesh.boundaryLabels[e] == contact.nonmortar.label)
        for (const int v : mesh.boundaryEdges[e]) points.push_back(mesh.vertices[v]);
    data.push_back({SampledDatum::Kind::distance, static_cast<size_t>(b), &*contact.gap,
                    thinned(std::move(points)), extent(mesh)});
  }
  return data;
}

std::vector<double> trialTimes(const TimePlan& plan) {
  constexpr int count = 64;
  constexpr double uneven = 0.3819660112501051;
  std::vector<double> times{0};
  for (int i = 0; i < count; ++i) {
    times.push_back(plan.end * (i + uneven) / count);
    times.push_back(plan.end * (i + 1) / count);
  }
  return times;
}

bool changesInTime(const SampledDatum& datum, const TimePlan& plan) {
  if (datum.value->constant) return false;
  for (const double t : trialTimes(plan))
    if (datum.change(0, t) != 0) return true;
  return false;
}

double nominalStress(const SceneDescription& scene, const std::vector<SampledDatum>& data, double t) {
  double result = 0;
  for (const SampledDatum& datum : data) {
    const double value = datum.kind == SampledDatum::Kind::distance ? datum.change(0, t) : datum.largest(t);
    result = std::max(result, value * datum.stressOfUnit(scene));
  }
  return result;
}

double nominalStress(const SceneDescription& scene, const std::vector<SampledDatum>& data) {
  double result = 0;
  for (const SampledDatum& datum : data)
    result = std::max(result, datum.largestIn(scene.time) * datum.stressOfUnit(scene));
  return result;
}

std::string drivingDatum(const MeshedScene& input, double from, double to) {
  const std::vector<SampledDatum> data = sampledData(input);
  const SampledDatum* most = nullptr;
  double largest = 0;
  for (const SampledDatum& datum : data) {
    const double stress = datum.stressOfUnit(input.scene) * datum.change(from, to);
    if (!(stress > largest)) continue;
    largest = stress;
    most = &datum;
  }
  if (most == nullptr) return "";
  char sizes[160];
  const char* unit = input.scene.units.time.c_str();
  std::snprintf(sizes, sizeof sizes, ", of size %.4g at t = %.6g %.16s and %.4g at t = %.6g %.16s",
                most->largest(from), from, unit, most->largest(to), to, unit);
  return most->value->where + sizes;
}

}  // namespace mortier
