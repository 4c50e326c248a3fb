#pragma once

#include <random>

#include "theory/scenes.h"

namespace mortier::scenes {

/// A square with its nodes moved at random, those of its sides along them.
inline TriangleMesh shakenSquare(double lowerY, int cells, unsigned seed) {
  TriangleMesh mesh = square(lowerY, cells);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-0.2 / cells, 0.2 / cells);
  for (Point& x : mesh.vertices) {
    if (x.x() != 0 && x.x() != 1) x.x() += shift(random);
    if (x.y() != lowerY && x.y() != lowerY + 1) x.y() += shift(random);
  }
  validate(mesh);
  return mesh;
}

}  // namespace mortier::scenes
