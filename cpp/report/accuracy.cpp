#include "report/accuracy.h"

#include <cmath>

#include "fem/error_estimate.h"

namespace mortier {

Accuracy accuracyOf(const Model& model, const State& state) {
  Accuracy result;
  double error = 0;
  double energy = 0;
  double largest = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const ErrorEstimate estimate = ErrorEstimator(model.bodies[b])(state.bodies[b].stress);
    result.bodies.push_back(estimate.relative());
    error += estimate.error.sum();
    energy += estimate.energy;
    Eigen::Index worst = 0;
    if (!(estimate.error.maxCoeff(&worst) > largest)) continue;
    largest = estimate.error[worst];
    result.worstBody = model.bodies[b].name();
    const TriangleMesh& mesh = model.bodies[b].mesh();
    result.worst.setZero();
    for (const int vertex : mesh.triangles[worst]) result.worst += mesh.vertices[vertex] / 3;
  }
  result.all = energy > 0 ? std::sqrt(error / energy) : 0;
  return result;
}

}  // namespace mortier
