#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include "base/error.h"
#include "material/stress.h"
#include "scene/build.h"
#include "scene/finite_value.h"

namespace mortier {
namespace {

std::vector<double> readValues(const std::string& path, size_t count, const std::string& where) {
  const auto reject = [&](const std::string& what) {
    throw InputError(where + ": temperature: file " + path + " " + what + ", expected " +
                     std::to_string(count) + " finite numbers, one for each vertex of the mesh");
  };
  std::error_code error;
  std::ifstream file;
  if (std::filesystem::is_regular_file(path, error)) file.open(path);
  if (!file.is_open()) reject("cannot be read");
  std::vector<double> values;
  std::string word;
  while (values.size() <= count && file >> word) {
    std::istringstream text(word);
    double value = NAN;
    if (!(text >> value) || !text.eof() || !std::isfinite(value))
      reject("has no number at place " + std::to_string(values.size() + 1));
    values.push_back(value);
  }
  if (values.size() > count) reject("has more");
  if (values.size() < count) reject("has " + std::to_string(values.size()));
  return values;
}

/// A field by its values at the vertices of a mesh, one number a line in the order of the mesh, linear on its
/// triangles; beyond the mesh that of the nearest triangle goes on.
class NodalField {
 public:
  /// \param where  what messages begin with
  /// \throws InputError unless the file has one finite number a vertex.
  NodalField(const TriangleMesh& ofMesh, const std::string& file, const std::string& where)
      : mesh(ofMesh), values(readValues(file, mesh.vertices.size(), where)) {
    Point upper = mesh.vertices[0];
    lower = upper;
    for (const Point& p : mesh.vertices) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    across = 1 + static_cast<int>(std::sqrt(static_cast<double>(mesh.triangles.size())));
    size = (upper - lower).maxCoeff() / across;
    triangles.resize(static_cast<size_t>(across) * across);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      Point low = mesh.vertices[mesh.triangles[t][0]];
      Point high = low;
      for (const int v : mesh.triangles[t]) {
        low = low.cwiseMin(mesh.vertices[v]);
        high = high.cwiseMax(mesh.vertices[v]);
      }
      for (int j = indexOf(low.y(), lower.y()); j <= indexOf(high.y(), lower.y()); ++j)
        for (int i = indexOf(low.x(), lower.x()); i <= indexOf(high.x(), lower.x()); ++i)
          triangles[static_cast<size_t>(j) * across + i].push_back(static_cast<int>(t));
    }
  }

  double operator()(const Point& x) const {
    constexpr double rounding = 1e-12;
    const int i = indexOf(x.x(), lower.x());
    const int j = indexOf(x.y(), lower.y());
    std::pair<double, double> best{0, -std::numeric_limits<double>::infinity()};
    const auto visit = [&](int triangle) {
      const auto found = at(triangle, x);
      if (found.second > best.second) best = found;
    };
    for (const int t : triangles[static_cast<size_t>(j) * across + i]) visit(t);
    if (best.second < -rounding)
      for (size_t t = 0; t < mesh.triangles.size(); ++t) visit(static_cast<int>(t));
    return best.first;
  }

 private:
  TriangleMesh mesh;
  std::vector<double> values;
  Point lower;
  double size = 0;
  int across = 1;
  std::vector<std::vector<int>> triangles;  ///< by the squares of a grid that they meet

  [[nodiscard]] int indexOf(double x, double from) const {
    return std::clamp(static_cast<int>(std::floor((x - from) / size)), 0, across - 1);
  }
  /// The value of the linear function of a triangle, and how far inside the point is (< 0: outside).
  [[nodiscard]] std::pair<double, double> at(int triangle, const Point& x) const {
    const auto& v = mesh.triangles[triangle];
    const double area = doubleArea(mesh, triangle);
    double value = 0;
    double inside = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const Point& a = mesh.vertices[v[(k + 1) % 3]];
      const Point& b = mesh.vertices[v[(k + 2) % 3]];
      const double weight = cross(a - x, b - x) / area;
      value += weight * values[v[k]];
      inside = std::min(inside, weight);
    }
    return {value, inside};
  }
};

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
                              field = std::make_shared<const NodalField>(
                                  mesh, temperature.file, temperature.where)](double x, double y, double t) {
      return factor(x, y, t) * (*field)({x, y});
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
