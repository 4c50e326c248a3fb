// How many threads work on a model.
#pragma once

#include "solver/model.h"

namespace mortier {

/// Threads that are worth their start, at most so many.
inline int threadsFor(const Model& model, int most) {
  constexpr size_t elementsWorthThreads = 30000;
  size_t elements = 0;
  for (const Body& body : model.bodies) elements += body.elements();
  return elements >= elementsWorthThreads ? most : 1;
}

}  // namespace mortier
