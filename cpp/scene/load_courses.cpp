#include "scene/load_courses.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

#include "base/error.h"
#include "mesh/boundary_line.h"
#include "scene/finite_value.h"

namespace mortier {
namespace {

/// Vertices of a labelled boundary, or of the whole mesh, not too many.
std::vector<Point> samplePoints(const TriangleMesh& mesh, const int* label) {
  constexpr size_t enough = 24;
  std::vector<Point> points;
  if (label == nullptr) {
    points = mesh.vertices;
  } else {
    for (const auto& [from, to] : edgesOn(mesh, *label)) points.push_back(mesh.vertices[from]);
  }
  const size_t stride = 1 + points.size() / enough;
  std::vector<Point> sample;
  for (size_t i = 0; i < points.size(); i += stride) sample.push_back(points[i]);
  return sample;
}

/// One point is enough where the datum is the same everywhere.
std::vector<Point> needed(const Expression& expression, const std::vector<Point>& points, double end) {
  constexpr double times[] = {0, 0.1357, 0.3819, 0.6542, 0.8713, 1};
  for (const double t : times)
    for (const Point& p : points)
      if (expression.value(p[0], p[1], t * end) != expression.value(points[0][0], points[0][1], t * end))
        return points;
  return {points[0]};
}

/// Names and numbers of an expression, and its other characters one by one.
std::vector<std::string> tokens(const std::string& text) {
  std::vector<std::string> result;
  bool inWord = false;
  for (const char c : text) {
    if (c == ' ') continue;
    const bool ofWord = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
    if (ofWord && inWord)
      result.back() += c;
    else
      result.emplace_back(1, c);
    inWord = ofWord;
  }
  return result;
}

/// Whether an expression is a product, one factor of which is t, and nothing else depends on t.
bool proportionalToTime(const std::string& text) {
  int depth = 0;
  int times = 0;
  std::string before = "*";
  for (const std::string& token : tokens(text)) {
    if (token == "-" && before == "*") continue;  // a sign
    if (token == "t" && (depth > 0 || before != "*" || ++times > 1)) return false;
    if (depth == 0 && token.find_first_of("+-^<>=!?:&|,%") == 0) return false;
    depth += token == "(" ? 1 : token == ")" ? -1 : 0;
    before = token;
  }
  return times == 1;
}

/// Calls work(expression, points) for every datum of the scene.
void forEachDatum(const SceneDescription& scene, const Model& model,
                  const std::function<void(const Expression&, const std::vector<Point>&)>& work) {
  const auto call = [&](const Expression& expression, const std::vector<Point>& points) {
    if (!expression.constant && !points.empty()) work(expression, needed(expression, points, scene.time.end));
  };
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const TriangleMesh& mesh = model.bodies[b].mesh();
    for (const ConditionDescription& c : scene.bodies[b].conditions) {
      call(c.value, c.point ? std::vector<Point>{*c.point} : samplePoints(mesh, &c.label));
    }
    for (const std::optional<Expression>& force : scene.bodies[b].force)
      if (force) call(*force, samplePoints(mesh, nullptr));
    if (const auto& temperature = scene.bodies[b].temperature)
      call(temperature->value, samplePoints(mesh, nullptr));
  }
  for (const ContactDescription& contact : scene.contacts)
    if (contact.gap && contact.gap->inTime)
      call(*contact.gap, samplePoints(model.bodies[bodyIndex(scene, contact.nonmortar.body)].mesh(),
                                      &contact.nonmortar.label));
}

std::string text(const char* pattern, double a, double b) {
  char buffer[128];
  std::snprintf(buffer, sizeof buffer, pattern, a, b);
  return buffer;
}

Course courseAt(const Expression& expression, const Function& value, const Point& p, double end,
                int fine = 0) {
  const auto datum = [value, p](double t) { return value(p[0], p[1], t); };
  if (!expression.breaks.empty()) return tableCourse(datum, expression.breaks, 0, end);
  Course course = resolve(datum, 0, end, fine);
  if (!course.resolved)
    throw InputError(expression.where +
                     text(", expected a datum that can be sampled in time: at (%.6g, %.6g) it varies "
                          "faster",
                          p[0], p[1]));
  return course;
}

}  // namespace

LoadCourses loadCourses(const SceneDescription& scene, const Model& model) {
  constexpr size_t finest = 100000;      // samples in time at a point
  constexpr size_t affordable = 200000;  // of a datum, at all its points
  LoadCourses loads;
  loads.breaks = scene.time.breaks;
  forEachDatum(scene, model, [&](const Expression& expression, const std::vector<Point>& points) {
    const auto fine = static_cast<int>(std::min(finest, affordable / points.size()));
    for (const Point& p : points) {
      Course course = courseAt(expression, finiteValue(expression), p, scene.time.end, fine);
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
  const double k = scene.time.end / scene.time.steps;
  forEachDatum(scene, model, [&](const Expression& expression, const std::vector<Point>& points) {
    if (proportionalToTime(expression.text)) return;
    double most = much;
    std::string warning;
    for (const Point& p : points) {
      const Course course = courseAt(expression, expression.value, p, scene.time.end);
      // Of many steps most have no sample inside.
      double last = -1;
      for (const double t : course.times) {
        const double i = std::min(std::floor(t / k), scene.time.steps - 1.0);
        if (i == std::exchange(last, i)) continue;
        if (const double part = beyondEnds(course, k * i, k * (i + 1)); part > most) {
          most = part;
          warning = expression.where + text(": between t = %.6g and %.6g ", k * i, k * (i + 1)) +
                    scene.units.time +
                    text(", a step, it goes %.0f %% of its range beyond both ends", 100 * part, 0);
        }
      }
    }
    if (!warning.empty()) warnings.push_back(std::move(warning));
  });
  return warnings;
}

}  // namespace mortier
