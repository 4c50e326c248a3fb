#include "scene/nodal_field.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/error.h"

namespace mortier {
namespace {

std::vector<double> readValues(const std::string& path, size_t count, const std::string& where) {
  const auto reject = [&](const std::string& what) {
    throw InputError(where + ": temperature: file " + path + " " + what + ", expected " +
                     std::to_string(count) + " finite numbers, one for each vertex of the mesh");
  };
  std::ifstream file(path);
  if (!file) reject("cannot be read");
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

}  // namespace

struct NodalField::Cells {
  TriangleMesh mesh;
  std::vector<double> values;
  Point lower;
  double size = 0;
  int across = 1;
  std::vector<std::vector<int>> triangles;

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

NodalField::NodalField(const TriangleMesh& mesh, const std::string& file, const std::string& where) {
  const auto cells = std::make_shared<Cells>();
  cells->mesh = mesh;
  cells->values = readValues(file, mesh.vertices.size(), where);
  Point upper = mesh.vertices[0];
  cells->lower = upper;
  for (const Point& p : mesh.vertices) {
    cells->lower = cells->lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  cells->across = 1 + static_cast<int>(std::sqrt(static_cast<double>(mesh.triangles.size())));
  cells->size = (upper - cells->lower).maxCoeff() / cells->across;
  cells->triangles.resize(static_cast<size_t>(cells->across) * cells->across);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    Point low = mesh.vertices[mesh.triangles[t][0]];
    Point high = low;
    for (const int v : mesh.triangles[t]) {
      low = low.cwiseMin(mesh.vertices[v]);
      high = high.cwiseMax(mesh.vertices[v]);
    }
    for (int j = cells->indexOf(low.y(), cells->lower.y()); j <= cells->indexOf(high.y(), cells->lower.y());
         ++j)
      for (int i = cells->indexOf(low.x(), cells->lower.x()); i <= cells->indexOf(high.x(), cells->lower.x());
           ++i)
        cells->triangles[static_cast<size_t>(j) * cells->across + i].push_back(static_cast<int>(t));
  }
  cells_ = cells;
}

double NodalField::operator()(const Point& x) const {
  constexpr double rounding = 1e-12;
  const int i = cells_->indexOf(x.x(), cells_->lower.x());
  const int j = cells_->indexOf(x.y(), cells_->lower.y());
  std::pair<double, double> best{0, -std::numeric_limits<double>::infinity()};
  const auto visit = [&](int triangle) {
    const auto found = cells_->at(triangle, x);
    if (found.second > best.second) best = found;
  };
  for (const int t : cells_->triangles[static_cast<size_t>(j) * cells_->across + i]) visit(t);
  if (best.second < -rounding)
    for (size_t t = 0; t < cells_->mesh.triangles.size(); ++t) visit(static_cast<int>(t));
  return best.first;
}

}  // namespace mortier
