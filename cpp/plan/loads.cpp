#include "plan/loads.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "base/formatted.h"
#include "mesh/simplices.h"

namespace mortier {

MeshedScene meshedScene(const SceneDescription& scene, const Model& model) {
  MeshedScene result{scene, {}};
  for (const Body& body : model.bodies) {
    if (body.space() != nullptr)
      result.spaceMeshes.push_back(&body.space()->mesh());
    else
      result.meshes.push_back(&body.mesh());
  }
  return result;
}

double SampledDatum::at(const SpacePoint& point, double t) const {
  return value->value(point, t);
}

double SampledDatum::largest(double t) const {
  double result = 0;
  for (const SpacePoint& point : points) result = std::max(result, std::abs(at(point, t)));
  return result;
}

double SampledDatum::largestIn(const TimePlan& plan) const {
  const auto over = [&](const std::vector<double>& times) {
    double result = 0;
    for (const double t : times)
      result = std::max(result, kind == Kind::distance ? change(plan.begin, t) : largest(t));
    return result;
  };
  return over(value->value.degreeInTime <= 1 ? std::vector<double>{plan.begin, plan.end} : trialTimes(plan));
}

double SampledDatum::stressOfUnit(const SceneDescription& scene) const {
  if (kind == Kind::traction) return 1;
  return kind == Kind::force ? size : scene.bodies[body].material.elasticity.young / size;
}

double SampledDatum::change(double s, double t) const {
  double result = 0;
  for (const SpacePoint& point : points) result = std::max(result, std::abs(at(point, t) - at(point, s)));
  return result;
}

namespace {

/// Some of the places of a mesh.
struct Places {
  std::vector<SpacePoint> all;
  double size = 0;
  std::vector<std::pair<int, std::vector<SpacePoint>>> sides = {};  ///< label and vertices of each side

  template <class Mesh>
  explicit Places(const Mesh& mesh) : size(extent(mesh)) {
    for (const auto& vertex : mesh.vertices) all.push_back(asSpacePoint(vertex));
    for (size_t e = 0; e < labelledSides(mesh).size(); ++e) {
      auto& vertices = sides.emplace_back(mesh.boundaryLabels[e], std::vector<SpacePoint>{}).second;
      for (const int v : labelledSides(mesh)[e]) vertices.push_back(all[v]);
    }
  }

  [[nodiscard]] std::vector<SpacePoint> on(const std::function<bool(int)>& label) const {
    std::vector<SpacePoint> points;
    for (const auto& [each, vertices] : sides)
      if (label(each)) points.insert(points.end(), vertices.begin(), vertices.end());
    return points;
  }
};

std::optional<Places> placesOf(const MeshedScene& input, size_t body) {
  if (body < input.spaceMeshes.size()) return Places(*input.spaceMeshes[body]);
  if (input.meshes[body] == nullptr) return std::nullopt;
  return Places(*input.meshes[body]);
}

std::vector<SpacePoint> thinned(const std::vector<SpacePoint>& points) {
  constexpr size_t enough = 60;
  const size_t stride = 1 + points.size() / enough;
  std::vector<SpacePoint> some;
  for (size_t i = 0; i < points.size(); i += stride) some.push_back(points[i]);
  return some;
}

}  // namespace

std::vector<SampledDatum> sampledData(const MeshedScene& input) {
  std::vector<SampledDatum> data;
  for (size_t b = 0; b < input.scene.bodies.size(); ++b) {
    const std::optional<Places> places = placesOf(input, b);
    if (!places) continue;
    const double size = places->size;
    for (const ConditionDescription& c : input.scene.bodies[b].conditions) {
      if (const BodyDescription& tool = input.scene.bodies[b]; tool.isTool()) {
        // A force is as of a pressure over its size, a rotation moves its ends by its size.
        const bool moves = c.kind == ConditionDescription::Kind::displacement;
        data.push_back({moves ? SampledDatum::Kind::displacement : SampledDatum::Kind::force,
                        b,
                        &c.value,
                        {*tool.reference},
                        moves ? (c.turns() ? 1 : size) : 1 / size});
        continue;
      }
      std::vector<SpacePoint> points = places->on([&](int label) { return c.actsOn(label); });
      if (c.point) points.push_back(asSpacePoint(*c.point));
      if (c.pointInSpace) points.push_back(*c.pointInSpace);
      const bool held = c.kind == ConditionDescription::Kind::displacement;
      const bool atPoint = c.point || c.pointInSpace;
      data.push_back({held      ? SampledDatum::Kind::displacement
                      : atPoint ? SampledDatum::Kind::force
                                : SampledDatum::Kind::traction,
                      b, &c.value, thinned(points), held || !atPoint ? size : 1 / size});
    }
    for (const std::optional<Expression>& force : input.scene.bodies[b].force)
      if (force) data.push_back({SampledDatum::Kind::force, b, &*force, thinned(places->all), size});
    if (const auto& temperature = input.scene.bodies[b].temperature) {
      double expansion = 0;
      for (const MaterialDescription* material : materialsOf(input.scene.bodies[b]))
        for (const double each : material->expansion) expansion = std::max(expansion, std::abs(each));
      data.push_back({SampledDatum::Kind::temperature, b, &temperature->value, thinned(places->all),
                      1 / std::max(expansion, std::numeric_limits<double>::min())});
    }
  }
  for (const ContactDescription& contact : input.scene.contacts) {
    const int b = bodyIndex(input.scene, contact.nonmortar().body);
    if (!contact.gap || !contact.gap->inTime) continue;
    const std::optional<Places> places = placesOf(input, b);
    if (!places) continue;
    const auto nonmortar = [&](int label) { return label == contact.nonmortar().label; };
    data.push_back({SampledDatum::Kind::distance, static_cast<size_t>(b), &*contact.gap,
                    thinned(places->on(nonmortar)), places->size});
  }
  return data;
}

std::vector<double> trialTimes(const TimePlan& plan) {
  constexpr int count = 64;
  std::vector<double> times{plan.begin};
  for (int i = 0; i < count; ++i) {
    times.push_back(plan.begin + plan.duration() * (i + unevenPart) / count);
    times.push_back(plan.begin + plan.duration() * (i + 1) / count);
  }
  return times;
}

bool changesInTime(const SampledDatum& datum, const TimePlan& plan) {
  if (datum.value->constant) return false;
  for (const double t : trialTimes(plan))
    if (datum.change(plan.begin, t) != 0) return true;
  return false;
}

double nominalStress(const SceneDescription& scene, const std::vector<SampledDatum>& data, double t) {
  double result = 0;
  for (const SampledDatum& datum : data) {
    const double value =
        datum.kind == SampledDatum::Kind::distance ? datum.change(scene.time.begin, t) : datum.largest(t);
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
  const char* unit = input.scene.units.time.c_str();
  return most->value->where + formatted(", of size %.4g at t = %.6g %.16s and %.4g at t = %.6g %.16s",
                                        most->largest(from), from, unit, most->largest(to), to, unit);
}

bool hasFriction(const SceneDescription& scene) {
  return std::any_of(scene.contacts.begin(), scene.contacts.end(),
                     [](const ContactDescription& contact) { return contact.friction.any(); });
}

bool stepsMatter(const SceneDescription& scene) {
  return hasFriction(scene) || std::any_of(scene.bodies.begin(), scene.bodies.end(), mayFlow);
}

double stepTolerance(const SceneDescription& scene) {
  if (!(scene.accuracy.energy > 0) || !stepsMatter(scene)) return scene.time.tolerance;
  const double share = (scene.degree == 1 ? 0.2 : 0.25) * scene.accuracy.energy;
  return scene.time.controlled() ? std::min(share, scene.time.tolerance) : share;
}

}  // namespace mortier
