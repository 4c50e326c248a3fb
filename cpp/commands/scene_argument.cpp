#include "commands/scene_argument.h"

#include <algorithm>

#include "base/error.h"

namespace mortier {

void takeSceneFromSettings(std::vector<std::string>& settings, std::string& scene) {
  const auto found = std::find_if(settings.begin(), settings.end(), [](const std::string& each) {
    return each.find('=') == std::string::npos;
  });
  if (scene.empty() && found != settings.end()) {
    scene = *found;
    settings.erase(found);
  }
  if (scene.empty()) {
    throw InputError("no scene given, expected SCENE.toml (see --help)");
  }
}

}  // namespace mortier
