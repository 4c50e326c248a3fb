// What no code can avoid, done as well as it can be: CHOLMOD (supernodal, METIS, OpenBLAS) analyses the
// elastic stiffness of some bodies once, then factorises it and solves with one right-hand side.
#pragma once

#include <memory>
#include <vector>

#include "fem/body.h"

namespace mortier::bench {

class BareCholmod {
 public:
  BareCholmod();
  BareCholmod(BareCholmod&&) noexcept;
  ~BareCholmod();

  /// Keeps a copy of the body's stiffness, not the body. \pre its supports hold it, its material is elastic.
  void add(const Body& body);
  /// Symbolic analysis of all bodies.
  void analyse();
  /// \param blasThreads  of OpenBLAS. OpenMP has one thread: Debian's CHOLMOD starts a team in every
  /// supernode.
  void factoriseAndSolve(int blasThreads);

 private:
  struct Matrix;
  std::vector<std::unique_ptr<Matrix>> matrices_;
};

}  // namespace mortier::bench
