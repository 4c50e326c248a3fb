// The material of a body or of a region: elasticity, and the law by which it flows.
#pragma once

#include "scene/scene.h"
#include "scene/table_reader.h"

namespace mortier {

/// The words that `law` may be, beside those of registered laws.
const Keys& lawsOfMortier();

/// \throws InputError of one line, also where a key belongs to another law.
MaterialDescription readMaterial(const Node& node, const std::string& path, const std::string& subject);

/// Plasticity has no rate at a given stress. \throws InputError where the steps of the scene need one.
void requireRates(const BodyDescription& body, const SceneDescription& scene);

}  // namespace mortier
