#include "scene/load_breaks.h"

#include <algorithm>

#include "mesh/boundary_line.h"
#include "scene/labels.h"
#include "time/breaks.h"

namespace mortier {
namespace {

/// A few vertices of a labelled boundary, or of the whole mesh.
std::vector<Point> samplePoints(const TriangleMesh& mesh, const int* label) {
  constexpr size_t few = 4;
  std::vector<Point> points;
  if (label == nullptr) {
    points = mesh.vertices;
  } else {
    for (const auto& [from, to] : edgesOn(mesh, *label)) points.push_back(mesh.vertices[from]);
  }
  const size_t stride = 1 + points.size() / few;
  std::vector<Point> sample;
  for (size_t i = 0; i < points.size(); i += stride) sample.push_back(points[i]);
  return sample;
}

}  // namespace

std::vector<double> loadBreaks(const SceneDescription& scene, const Model& model) {
  std::vector<std::function<double(double)>> data;
  std::vector<double> breaks = scene.time.breaks;
  const auto add = [&](const Expression& expression, const std::vector<Point>& points) {
    for (const double t : expression.breaks)
      if (t > 0 && t < scene.time.end) breaks.push_back(t);
    if (expression.constant || !expression.breaks.empty()) return;
    for (const Point& p : points)
      data.emplace_back([&expression, p](double t) { return expression.value(p[0], p[1], t); });
  };
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const TriangleMesh& mesh = model.bodies[b].mesh();
    for (const ConditionDescription& c : scene.bodies[b].conditions) {
      const int label = boundaryLabel(mesh, c.label, c.labelName, c.where);
      add(c.value, samplePoints(mesh, &label));
    }
    for (const std::optional<Expression>& force : scene.bodies[b].force)
      if (force) add(*force, samplePoints(mesh, nullptr));
  }
  const std::vector<double> found = findBreaks(data, 0, scene.time.end);
  breaks.insert(breaks.end(), found.begin(), found.end());
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  return breaks;
}

}  // namespace mortier
