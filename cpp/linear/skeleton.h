// The skeleton between the parts of ranks: a matrix that is the sum of dense ones, one of each rank, of which
// all equations but the last are eliminated.
#pragma once

#include <memory>
#include <vector>

#include "linear/condensing_solver.h"

namespace mortier {

struct SkeletonShape {
  int size = 0;  ///< equations, numbered alike on all ranks
  int kept = 0;  ///< of them, the last ones
  bool symmetric = true;
  std::vector<int> places;  ///< equations of this rank, ascending
};

/// Made and used by all ranks together.
class Skeleton {
 public:
  virtual ~Skeleton() = default;
  /// \param own  over the places of this rank, its lower triangle at least where symmetric
  /// \param regular  whether this rank has one \returns whether all have and their sum is regular
  virtual bool factorise(Matrix own, bool regular, Threads& threads) = 0;
  [[nodiscard]] virtual const Matrix& schurComplement() const = 0;
  [[nodiscard]] virtual Matrix takeSchurComplement() = 0;
  /// f (size), of which every rank has a part, in place: the sum of them condensed.
  virtual void condense(Vector& f) const = 0;
  /// f of the last condense() with the solution in its kept part: becomes the solution.
  virtual void expand(Vector& f) const = 0;
};

/// The sum and its factor on every rank.
std::unique_ptr<Skeleton> replicatedSkeleton(const SkeletonShape& shape,
                                             const CondensingSolverFactory& engine, Ranks& ranks);

using SkeletonFactory = std::unique_ptr<Skeleton> (*)(const SkeletonShape& shape, Ranks& ranks);

/// Skeletons with a factor that ranks share are made this way; there is none unless this is called.
void distributeSkeletonsBy(SkeletonFactory way);

/// \param smallest  eliminated equations from which on the factor is shared, where there is a way
std::unique_ptr<Skeleton> newSkeleton(const SkeletonShape& shape, const CondensingSolverFactory& engine,
                                      Ranks& ranks, int smallest);

}  // namespace mortier
