#include "scene/load_courses.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "scene/expression.h"

namespace mortier {
namespace {

/// Calls work(expression, places) for every datum of the scene that changes.
void forEachDatum(const SceneDescription& scene, const Model& model,
                  const std::function<void(const Expression&, const LoadPlaces&)>& work) {
  const auto call = [&](const Expression& expression, const Body& body, const int* label) {
    if (!expression.inTime) return;
    const LoadPlaces places = body.withMesh(
        [&](const auto& mesh, const auto&) { return loadPlaces(expression, mesh, label, scene.time); });
    if (!places.points.empty()) work(expression, places);
  };
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (const ConditionDescription& c : scene.bodies[b].conditions) {
      if (!c.point && !c.pointInSpace)
        call(c.value, body, &c.label);
      else if (c.value.inTime)
        work(c.value, loadPlaces(c.value, c.point ? asSpacePoint(*c.point) : *c.pointInSpace, scene.time));
    }
    for (const std::optional<Expression>& force : scene.bodies[b].force)
      if (force) call(*force, body, nullptr);
    if (const auto& temperature = scene.bodies[b].temperature) call(temperature->value, body, nullptr);
  }
  for (const ContactDescription& contact : scene.contacts)
    if (contact.gap)
      call(*contact.gap, model.bodies[bodyIndex(scene, contact.nonmortar().body)],
           &contact.nonmortar().label);
}

/// Found between the times of peaks, at which it has breaks.
Course resolvedBetween(const std::function<double(double)>& datum, const std::vector<double>& peaks,
                       const TimePlan& time, int fine) {
  const double end = time.end;
  Course course;
  double from = time.begin;
  for (size_t i = 0; i <= peaks.size(); ++i) {
    const double to = i < peaks.size() ? peaks[i] : end;
    if (!(to > from)) continue;
    const Course part = resolve(datum, from, to, fine);
    course.resolved = course.resolved && part.resolved;
    course.times.insert(course.times.end(), part.times.begin(), part.times.end());
    course.values.insert(course.values.end(), part.values.begin(), part.values.end());
    course.breaks.insert(course.breaks.end(), part.breaks.begin(), part.breaks.end());
    if (to < end) course.breaks.push_back(to);
    from = to;
  }
  const auto [least, largest] = std::minmax_element(course.values.begin(), course.values.end());
  course.range = *largest - *least;
  course.value = datum;
  return course;
}

Course courseAt(const Expression& expression, const Datum& value, const SpacePoint& p,
                const std::vector<double>& peaks, const SceneDescription& scene, int fine = 0) {
  const double begin = scene.time.begin;
  const double end = scene.time.end;
  const auto datum = [value, p](double t) { return value(p, t); };
  if (!expression.breaks.empty()) return tableCourse(datum, expression.breaks, begin, end);
  Course course =
      peaks.empty() ? resolve(datum, begin, end, fine) : resolvedBetween(datum, peaks, scene.time, fine);
  if (!course.resolved)
    throw InputError(expression.where +
                     formatted(", expected a datum that can be sampled in time: at (%.6g, %.6g", p[0], p[1]) +
                     (scene.inSpace() ? formatted(", %.6g", p[2]) : "") + ") it varies faster");
  return course;
}

}  // namespace

LoadCourses loadCourses(const SceneDescription& scene, const Model& model) {
  constexpr size_t finest = 100000;      // samples in time at a point
  constexpr size_t affordable = 200000;  // of a datum, at all its points
  LoadCourses loads;
  loads.breaks = scene.time.breaks;
  forEachDatum(scene, model, [&](const Expression& expression, const LoadPlaces& places) {
    const auto fine = static_cast<int>(std::min(finest, affordable / places.points.size()));
    const Datum value = finiteValue(expression, scene.inSpace());
    for (const SpacePoint& p : places.points) {
      Course course = courseAt(expression, value, p, places.times, scene, fine);
      loads.breaks.insert(loads.breaks.end(), course.breaks.begin(), course.breaks.end());
      loads.data.push_back(std::move(course));
    }
  });
  std::sort(loads.breaks.begin(), loads.breaks.end());
  loads.breaks.erase(std::unique(loads.breaks.begin(), loads.breaks.end()), loads.breaks.end());
  return loads;
}

std::vector<std::string> loadsBetweenSteps(const SceneDescription& scene, const Model& model) {
  constexpr double much = 0.25;
  std::vector<std::string> warnings;
  const double k = scene.time.step();
  const auto endOf = [&](double i) { return scene.time.begin + k * i; };
  forEachDatum(scene, model, [&](const Expression& expression, const LoadPlaces& places) {
    if (expression.formula && proportionalToTime(*expression.formula)) return;
    double most = much;
    std::string warning;
    const auto value = [&](const SpacePoint& p, double t) { return expression.value(p, t); };
    for (const SpacePoint& p : places.points) {
      const Course course = courseAt(expression, value, p, places.times, scene);
      // Of many steps most have no sample inside.
      double last = -1;
      for (const double t : course.times) {
        const double i = std::min(std::floor((t - scene.time.begin) / k), scene.time.steps - 1.0);
        if (i == std::exchange(last, i)) continue;
        if (const double part = peakBetween(course, endOf(i), endOf(i + 1)).height; part > most) {
          most = part;
          warning = expression.where + formatted(": between t = %.6g and %.6g ", endOf(i), endOf(i + 1)) +
                    scene.units.time +
                    formatted(", a step, it goes %.0f %% of its range beyond both ends", 100 * part);
        }
      }
    }
    if (!warning.empty()) warnings.push_back(std::move(warning));
  });
  return warnings;
}

}  // namespace mortier
