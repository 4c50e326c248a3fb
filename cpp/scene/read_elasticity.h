// The elasticity of a material: isotropic by young and poisson, orthotropic by nine constants, general by its
// matrix, and the axes it is turned by; the coefficients of thermal expansion.
#pragma once

#include "scene/scene.h"
#include "scene/table_reader.h"

namespace mortier {

/// Fills what is not of the flow. \throws InputError
void readElasticity(const TableReader& table, MaterialDescription& material);

/// \throws InputError for a law that asks for isotropic elasticity beside another.
void requireTakesElasticity(const TableReader& table, const MaterialDescription& material);

}  // namespace mortier
