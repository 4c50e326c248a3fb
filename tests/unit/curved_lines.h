// Two meshes whose common line is bent, and the interface between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "contact/interface.h"
#include "mesh/generate.h"

namespace mortier::curved {

inline constexpr double pi = std::numbers::pi;
inline constexpr int bottom = 1;
inline constexpr int top = 3;
inline constexpr double circleRounding = 1e-13;  // of a radius of one
inline constexpr CouplingKind kinds[] = {CouplingKind::mortar, CouplingKind::interpolation};

/// Cells of random width over [0, 1] x [lower, upper], mapped.
template <class Map>
TriangleMesh mapped(std::mt19937& random, int cells, double lower, double upper, Map map) {
  std::uniform_real_distribution<double> width(1, 2);
  std::vector<double> x{0};
  for (int i = 0; i < cells; ++i) x.push_back(x.back() + width(random));
  TriangleMesh mesh = crissCrossMesh(
      {.lower = {0, lower}, .upper = {static_cast<double>(cells), upper}, .cellsX = cells, .cellsY = 2});
  for (Point& v : mesh.vertices) {
    const int cell = std::min(static_cast<int>(v.x()), cells - 1);
    v = map(Point((x[cell] + (v.x() - cell) * (x[cell + 1] - x[cell])) / x.back(), v.y()));
  }
  validate(mesh);
  return mesh;
}

/// Two bodies that meet on y = 0 before they are mapped; the upper one is nonmortar or the lower one.
struct LinePair {
  TriangleMesh upper;
  TriangleMesh lower;

  [[nodiscard]] ContactInterface meet(CouplingKind kind, bool upperNonmortar,
                                      const InterfaceOptions& options = {}) const {
    const ContactSide upperSide{0, bottom};
    const ContactSide lowerSide{1, top};
    if (upperNonmortar) return {{upperSide, lowerSide, kind}, upper, lower, options};
    return {{lowerSide, upperSide, kind}, lower, upper, options};
  }
};

template <class Map>
LinePair pairOf(std::mt19937& random, int upperCells, int lowerCells, Map map) {
  return {mapped(random, upperCells, 0, 0.5, map), mapped(random, lowerCells, -0.5, 0, map)};
}

/// A bow of the given angle and radius 1 about the origin, the upper body outside.
inline auto bow(double angle, double turned = 0) {
  return [=](const Point& x) {
    const double phi = turned - angle * (x.x() - 0.5);
    return Point((1 + x.y()) * std::sin(-phi), (1 + x.y()) * std::cos(phi));
  };
}

inline auto wave(double height) {
  return [=](const Point& x) { return Point(x.x(), x.y() + height * std::sin(2 * pi * x.x())); };
}

/// Force and moment of the rows, for random p, over the sum of |p|.
inline double imbalance(const ContactInterface& interface, const TriangleMesh& nonmortar,
                        const TriangleMesh& mortar, std::mt19937& random) {
  std::uniform_real_distribution<double> value(0, 1);
  double worst = 0;
  for (int trial = 0; trial < 5; ++trial) {
    const Vector p =
        Vector::NullaryExpr(interface.rows(), [&](Eigen::Index) { return std::pow(value(random), 4); });
    Vector f1 = Vector::Zero(2 * nonmortar.vertices.size());
    Vector f2 = Vector::Zero(2 * mortar.vertices.size());
    interface.subtractForces(p, f1, f2);
    Point force = Point::Zero();
    double moment = 0;
    for (const auto& [mesh, f] : {std::pair(&nonmortar, &f1), std::pair(&mortar, &f2)})
      for (size_t v = 0; v < mesh->vertices.size(); ++v) {
        force += f->segment<2>(2 * v);
        moment += mesh->vertices[v].x() * (*f)[2 * v + 1] - mesh->vertices[v].y() * (*f)[2 * v];
      }
    worst = std::max({worst, force.norm() / p.sum(), std::abs(moment) / p.sum()});
  }
  return worst;
}

}  // namespace mortier::curved
