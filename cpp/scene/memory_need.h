// How much memory a run takes, reported before anything of that size is allocated: in 8 bytes,
//   contact   2 n^2 for W and its factor (n conditions), m^2 in each body for the Schur complement on its m
//             contact dofs, two in the one that is factorised last; or n (n + 2 m) while the rows are made,
//             where that is more; with friction a node has two conditions and both its dofs take part;
//             for long lines (solver/sparse_contact.h) 400 n, the rows of mortar contact and its fronts;
//   bodies    about 16 log2(N) + 150 for each of N vertices: factors, tangent, mesh and states;
// and 12 MiB for the program itself.
#pragma once

#include <string>
#include <vector>

#include "contact/interface.h"
#include "mesh/triangle_mesh.h"
#include "solver/model.h"

namespace mortier {

struct MemoryNeed {
  double all = 0;    ///< the peak [bytes]; within a factor of two of what runs take
  double dense = 0;  ///< of it, dense matrices over the contact conditions [bytes]
};

/// \param meshes  of all bodies; \param degree  of the displacements; \param rough  which pairs have
/// friction, none where empty.
MemoryNeed memoryNeed(const std::vector<const TriangleMesh*>& meshes, const std::vector<ContactPair>& pairs,
                      int degree, const std::vector<bool>& rough = {}, const SolverOptions& options = {});

MemoryNeed memoryNeed(const Model& model, const SolverOptions& options = {});

/// "about 45.7 GiB of it for the dense matrices that friction needs", of a run with friction; empty where
/// other things take more.
std::string forFriction(const MemoryNeed& need);

/// What the machine and the limits of the process leave [bytes]; infinity where it is not known.
double availableMemory();

/// \throws InputError with both numbers where a run needs more than there is.
void requireMemory(const std::vector<const TriangleMesh*>& meshes, const std::vector<ContactPair>& pairs,
                   int degree, const std::vector<bool>& rough = {}, const SolverOptions& options = {});

void requireMemory(const MemoryNeed& need, bool friction);

/// "about 130 MiB", "about 290 GiB".
std::string aboutMemory(double bytes);

}  // namespace mortier
