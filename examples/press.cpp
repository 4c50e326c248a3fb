// How far a press goes down, and with which force the bodies touch: press SCENE.toml [KEY=VALUE ...]
#include <cstdio>

#include "scene/build.h"
#include "time/march.h"

int main(int count, char** arguments) try {
  using namespace mortier;
  if (count < 2) throw std::runtime_error("usage: press SCENE.toml [KEY=VALUE ...]");
  std::vector<std::string> warnings;
  ResolvedScene resolved = resolveScene(readScene(arguments[1], {arguments + 2, arguments + count}));
  const Model model = buildModel(resolved, warnings);
  const SceneDescription& scene = resolved.description;
  State state = initialState(model);
  march(model, state, scene.time, scene.solver, [](const State& now, const StepReport& step) {
    std::printf("%.9g %.15g %.15g\n", now.time, now.bodies[0].displacement.minCoeff(), step.contactForce);
  });
} catch (const std::exception& error) {
  std::fprintf(stderr, "press: %s\n", error.what());
  return 1;
}
