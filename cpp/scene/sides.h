// Which side of a contact is nonmortar where the scene leaves it open (`sides`): the one with the finer mesh
// along the contact, measured by bench/nonmortar_side; stiffness does not matter.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace mortier {

/// Puts the chosen side first in every contact that leaves the choice open, and says why in `choice`; labels
/// are numbers (scene/resolve.h). A second call changes nothing. Contacts with a mesh that is missing
/// (nullptr) or a label that the mesh lacks stay as they are.
void decideSides(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes);

}  // namespace mortier
