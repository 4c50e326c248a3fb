// How many threads work on a model.
#pragma once

#include "solver/model.h"

namespace mortier {

/// Threads that are worth their start, at most so many.
inline int threadsFor(const Model& model, int most) {
  constexpr size_t trianglesWorthThreads = 30000;
  constexpr size_t trianglesOfTetrahedron = 30;  // of as much work, fill of the factor included
  size_t triangles = 0;
  for (const Body& body : model.bodies)
    triangles += (body.space() != nullptr ? trianglesOfTetrahedron : 1) * body.elements();
  return triangles >= trianglesWorthThreads ? most : 1;
}

}  // namespace mortier
