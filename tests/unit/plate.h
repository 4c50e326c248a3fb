// A plate on which bodies are tested.
#pragma once

#include <random>

#include "fem/body.h"
#include "material/perzyna.h"
#include "mesh/generate.h"

namespace mortier::plate {

constexpr int bottom = 1;
constexpr int right = 2;
constexpr int top = 3;
constexpr int left = 4;

inline Function constant(double value) {
  return [value](double, double, double) { return value; };
}

/// A 2 x 1 rectangle whose inner and boundary nodes are moved a little, boundary nodes along their side.
inline TriangleMesh plateMesh() {
  TriangleMesh result = crissCrossMesh({.lower = {0, 0}, .upper = {2, 1}, .cellsX = 5, .cellsY = 3});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.05, 0.05);
  for (Point& x : result.vertices) {
    if (x.x() != 0 && x.x() != 2) x.x() += shift(random);
    if (x.y() != 0 && x.y() != 1) x.y() += shift(random);
  }
  return result;
}

inline Body body(Conditions conditions = {}, Projection projection = Projection::frobenius) {
  return {"plate", plateMesh(), perzynaMaterial({100, 0.3}, {10, 1, projection}), std::move(conditions)};
}

template <class F>
Vector field(const TriangleMesh& mesh, F u) {
  Vector result(2 * mesh.vertices.size());
  for (size_t v = 0; v < mesh.vertices.size(); ++v) result.segment<2>(2 * v) = u(mesh.vertices[v]);
  return result;
}

inline Matrix strainOf(const Body& plate, const Vector& u) {
  Matrix strain;
  strain.resize(3, plate.points());
  plate.strain({u, Vector::Zero(u.size())}, nullptr, strain, 0, plate.points());
  return strain;
}

}  // namespace mortier::plate
