#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/dense_templates.h"
#include "base/error.h"
#include "scene/build.h"

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

/// At places, as many in each element, the field that is linear on the elements, by its values at vertices.
template <class Mesh, class Place>
std::vector<double> linearOn(const Mesh& mesh, const std::vector<double>& values,
                             const std::vector<Place>& places) {
  constexpr int d = Place::RowsAtCompileTime;
  const auto& elements = elementsOf(mesh);
  std::vector<double> at;
  for (size_t i = 0; i < places.size(); ++i) {
    const auto& v = elements[i * elements.size() / places.size()];
    Eigen::Matrix<double, d, d> edges;
    Place rise;
    for (int k = 0; k < d; ++k) {
      edges.row(k) = mesh.vertices[v[k + 1]] - mesh.vertices[v[0]];
      rise[k] = values[v[k + 1]] - values[v[0]];
    }
    at.push_back(values[v[0]] + edges.partialPivLu().solve(rise).dot(places[i] - mesh.vertices[v[0]]));
  }
  return at;
}

}  // namespace

template <class Mesh, class Place>
Matrix expansionOf(const BodyDescription& body, const Mesh& mesh, Plane plane,
                   const std::vector<Place>& places, const std::vector<double>& times) {
  const TemperatureDescription& temperature = *body.temperature;
  requireFinite(temperature.value, places, times);
  Matrix expansion;
  const auto take = [&](const MaterialDescription& material, std::optional<int> region) {
    const std::vector<double> angles = anglesOf(material, places);
    const Eigen::Matrix3d axes =
        material.anisotropy ? material.anisotropy->axes : Eigen::Matrix3d::Identity();
    Vector along;
    for (size_t i = 0; i < places.size(); ++i) {
      if (i == 0 || angles.size() > 1)
        along = alongAxes(material.expansion, axesAt(angles[angles.size() > 1 ? i : 0]) * axes, plane);
      if (i == 0 && !region) expansion.resize(along.size(), static_cast<Eigen::Index>(places.size()));
      if (!region || mesh.regions[i * mesh.regions.size() / places.size()] == *region)
        expansion.col(static_cast<Eigen::Index>(i)) = along;
    }
  };
  take(body.material, {});
  for (const RegionDescription& region : body.regions)
    if (region.material) take(*region.material, region.label);
  if (expansion.isZero(0))
    throw InputError(temperature.where + ": temperature, expected expansion in a material of the body");
  if (temperature.file.empty()) return expansion;
  const std::vector<double> kelvin =
      linearOn(mesh, readValues(temperature.file, mesh.vertices.size(), temperature.where), places);
  return expansion * Eigen::Map<const Vector>(kelvin.data(), expansion.cols()).asDiagonal();
}

template Matrix expansionOf(const BodyDescription&, const TriangleMesh&, Plane, const std::vector<Point>&,
                            const std::vector<double>&);
template Matrix expansionOf(const BodyDescription&, const TetrahedronMesh&, Plane,
                            const std::vector<SpacePoint>&, const std::vector<double>&);

}  // namespace mortier
