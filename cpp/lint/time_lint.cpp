#include "base/counted.h"
#include "lint/lint.h"

namespace mortier {

void lintTime(const LintInput& input, Faults& faults) {
  constexpr double loose = 1e-6;
  constexpr double tight = 1e-13;
  constexpr int few = 20;
  constexpr double large = 4e9;  // bytes
  const SceneDescription& scene = input.scene;
  const bool equalSteps = !scene.time.controlled();
  if (equalSteps && scene.every > scene.time.steps)
    faults.add("output-every", input.where({"output", "every"}),
               "every = " + std::to_string(scene.every) + " with " + counted(scene.time.steps, "step") +
                   " keeps the first and the last state only");
  if (scene.solver.tolerance > loose)
    faults.add("tolerance-loose", input.where({"solver", "tolerance"}),
               "tolerance = " + shortest(scene.solver.tolerance) + " shows in the results");
  if (scene.solver.tolerance < tight)
    faults.add("tolerance-tight", input.where({"solver", "tolerance"}),
               "tolerance = " + shortest(scene.solver.tolerance) + " is below the rounding of the residual");
  if (scene.solver.maxIterations < few)
    faults.add("iterations-few", input.where({"solver", "max_iterations"}),
               "max_iterations = " + std::to_string(scene.solver.maxIterations) +
                   ", a step in which bodies yield may need more");
  // Numbers that a node and a triangle have in a file of fields; by Euler's formula a mesh has about as many
  // edges, each with a node of quadratic displacements, as vertices and triangles together.
  constexpr double ofNode = 6;
  const bool quadratic = scene.degree > 1;
  const double ofTriangle = quadratic ? 21.5 : 11;
  double bytes = 0;
  for (const TriangleMesh* mesh : input.meshes) {
    if (mesh == nullptr) continue;
    const auto vertices = static_cast<double>(mesh->vertices.size());
    const auto triangles = static_cast<double>(mesh->triangles.size());
    const double nodes = quadratic ? 2 * vertices + triangles : vertices;
    bytes += sizeof(double) * (ofNode * nodes + ofTriangle * triangles);
  }
  const int kept = equalSteps && scene.every > 0 ? 1 + scene.time.steps / scene.every : 1;
  if (bytes * kept > large)
    faults.add("output-large", input.where({"output", "every"}),
               std::to_string(kept) + " kept states, about " + shortest(std::round(bytes * kept / 1e8) / 10) +
                   " GB in all");
}

}  // namespace mortier
