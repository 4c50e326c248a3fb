// Which side of a contact is nonmortar where the scene leaves it open (`sides`): the one with the finer mesh
// along the contact, measured by bench/nonmortar_side. A body that is far stiffer than the other is mortar
// (but with interpolation): a soft body cannot tell the nodes of a finer stiff one apart, and nodal pressures
// alternate.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace mortier {

/// Whether one body of a contact is so much stiffer than the other that it is to be mortar.
bool farStiffer(const SceneDescription& scene, const ContactDescription& contact, const SideDescription& one,
                const SideDescription& other);

/// Puts the chosen side first in every contact that leaves the choice open, and says why in `choice`; labels
/// are numbers (scene/resolve.h). A second call changes nothing. Contacts with a mesh that is missing
/// (nullptr) or a label that the mesh lacks stay as they are.
void decideSides(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes);

}  // namespace mortier
