#pragma once

#include <string>
#include <vector>

namespace mortier {

struct LawCommand {
  std::string scene;
  std::vector<std::string> settings;  ///< key=value
  double stress = 0;                  ///< largest that is tried; 0: that of the scene's data
  double strain = 0;                  ///< largest that is tried; 0: that stress over Young's modulus
  int samples = 100;
};

/// Tries the law of every body and region that flows (material/law_check.h) and prints what it finds.
/// \returns 0, or 1 where a law is wrong: no number, a tangent that is not its derivative, energy made of
/// nothing, or not as isotropic as it is said to be. \throws InputError
int tryLaws(const LawCommand& command);

}  // namespace mortier
