// Skeletons whose factor MUMPS (Amestoy, Duff, Koster and L'Excellent 2001) distributes among the ranks.
#pragma once

#include "linear/skeleton.h"

namespace mortier {

/// \pre the ranks are those of MPI (ranks/mpi_ranks.h), and some equations are eliminated
/// \throws std::bad_alloc, std::runtime_error from all of them, here and in what it makes
std::unique_ptr<Skeleton> mumpsSkeleton(const SkeletonShape& shape, Ranks& ranks);

}  // namespace mortier
