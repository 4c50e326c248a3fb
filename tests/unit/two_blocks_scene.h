// A scene of two blocks with its meshes, for tests of what is read and of what is decided.
#pragma once

#include "mesh/generate.h"
#include "scene/readers.h"
#include "unit/messages.h"
#include "unit/scene_folder.h"

namespace mortier {

inline const std::string twoBlocks = R"toml(title = "two blocks"
[[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1, projection = "elasticity" }
force = { y = "-9.81*t" }
[[body.boundary]]
label = 4
ux = 0
[[body.boundary]]
label = 3
ty = "-10*t"
[[body]]
name = "lower"
mesh = "lower.mesh"
material = { young = 2e11, poisson = 0.25 }
boundary = [ { label = 4, ux = 0 }, { label = 1, uy = "0.5*x*(t > 1)" } ]
)toml" + std::string(contactOfTwoBlocks) +
                                     "steps = 20\n";

/// Two meshes and a scene.
class SceneFiles : public SceneFolder {
 protected:
  SceneFiles() : SceneFolder("two_blocks") {
    writeMedit(crissCrossMesh({{0, 0}, {1, 1}, 2, 2}), folder + "/upper.mesh");
    writeMedit(crissCrossMesh({{0, -1}, {1, 0}, 3, 3}), folder + "/lower.mesh");
    write(twoBlocks);
  }

  /// The message of a scene that is wrong, without the folder.
  [[nodiscard]] std::string fault(const std::vector<std::string>& settings) const {
    std::string text = messageOf([&] { return modelOf(readScene(path(), settings)); });
    for (size_t at = text.find(folder + "/"); at != std::string::npos; at = text.find(folder + "/")) {
      text.erase(at, folder.size() + 1);
    }
    return text;
  }
};

}  // namespace mortier
