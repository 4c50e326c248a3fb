// What a run has by nodes and points, from the whole bodies to the parts of a rank (solver/model.h) and
// back.
#pragma once

#include "solver/model.h"
#include "time/memory.h"

namespace mortier {

/// What this rank has of a state and of a memory of whole bodies. \param model  in parts
State ofParts(const Model& model, const State& whole);
MarchMemory ofParts(const Model& model, const MarchMemory& whole);

/// Those of all ranks, on the first rank; of no use on others. Collective.
State gathered(const Model& model, const State& own);
MarchMemory gathered(const Model& model, const MarchMemory& own);

}  // namespace mortier
