#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "solver/model.h"

namespace mortier {

/// `mortier freefem`: the scene as data for the FreeFEM method in freefem/.
struct FreefemCommand {
  std::string scene;
  std::string file;                   ///< empty: standard output
  std::vector<std::string> settings;  ///< key=value
  std::string stepsOf;                ///< the folder of a run whose steps are to be taken; empty: none
};

/// \throws InputError also when the scene holds what the FreeFEM method does not know, OutputError
int writeFreefem(const FreefemCommand& command);

/// Why `mortier freefem` would refuse the scene, in the same words; empty where it would not.
/// \param stepsGiven  whether it is told the steps of a run
std::string freefemObstacle(const SceneDescription& scene, const Model& model, bool stepsGiven);

}  // namespace mortier
