#pragma once

#include "scene/document.h"
#include "scene/scene.h"

namespace mortier {

/// One [[quantity]]; the bodies of the scene are there. \throws InputError
QuantityDescription readQuantity(const Node& node, const SceneDescription& scene);

}  // namespace mortier
