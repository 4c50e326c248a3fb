#pragma once

#include <string>
#include <vector>

namespace mortier {

/// --set takes any number of values and so takes the scene, too, where that follows it: gives it back.
/// \throws InputError when there is no scene.
void takeSceneFromSettings(std::vector<std::string>& settings, std::string& scene);

}  // namespace mortier
