// A line search for laws that are linearised at their strain. A step then minimises a convex energy of the
// displacement, and a linear solve leads down from where it began. With s* and p in equilibrium at its end,
// the slope on the way is
//   integral of (s(eps) - s*) : (eps* - eps_before) + p . g_before.
#include <cmath>

#include "solver/methods.h"

namespace mortier {

std::vector<Matrix> stressesOnLaw(const StepSystem::Linearised& linearised, const Iterate& iterate) {
  std::vector<Matrix> stresses;
  for (size_t b = 0; b < iterate.bodies.size(); ++b) {
    const Linearisation& law = linearised.law(static_cast<int>(b));
    stresses.push_back(law.predictor);
    for (Eigen::Index i = 0; i < stresses[b].cols(); ++i)
      stresses[b].col(i) += stressOf(law, iterate.bodies[b].strain.col(i), static_cast<int>(i));
  }
  return stresses;
}

StepSystem::Linearised shortened(StepSystem& system, const Step& step, double weight,
                                 const std::vector<Matrix>& stressBefore, const Iterate& before,
                                 StepSystem::Linearised linearised, Iterate& iterate) {
  constexpr double flat = 0.5;  // of the slope at the beginning
  constexpr int most = 12;
  const Model& model = system.model();
  const Iterate end = iterate;
  double overlap = 0;
  const std::vector<Vector> gapsBefore = gaps(model, step.gap0(), before);
  for (size_t k = 0; k < gapsBefore.size(); ++k) overlap += end.contactForce[k].dot(gapsBefore[k]);
  const auto slope = [&](const std::vector<Matrix>& stress) {
    double work = 0;
    for (size_t b = 0; b < stress.size(); ++b) {
      const Matrix way = end.bodies[b].strain - before.bodies[b].strain;
      const std::vector<double>& weights = model.bodies[b].weights();
      for (Eigen::Index i = 0; i < way.cols(); ++i)
        work += weights[i] * (stress[b].col(i) - end.bodies[b].stress.col(i)).dot(way.col(i));
    }
    return model.sum(work) + overlap;
  };
  const double first = slope(stressBefore);
  double low = 0;
  double high = 1;
  double length = 1;
  for (int i = 0; i < most; ++i) {
    const std::vector<Matrix> stress = stressesOnLaw(linearised, iterate);
    if (i > 0)
      for (size_t b = 0; b < stress.size(); ++b) iterate.bodies[b].stress = stress[b];
    const double here = slope(stress);
    if (!(first < 0) || std::abs(here) <= -flat * first || (length == 1 && here < 0)) break;
    (here > 0 ? high : low) = length;
    length = (low + high) / 2;
    for (size_t b = 0; b < iterate.bodies.size(); ++b) {
      TwoPartVector& increment = iterate.bodies[b].increment;
      increment = before.bodies[b].increment;
      increment += length * end.bodies[b].increment.minus(increment);
    }
    for (size_t k = 0; k < end.contactForce.size(); ++k)
      iterate.contactForce[k] =
          before.contactForce[k] + length * (end.contactForce[k] - before.contactForce[k]);
    linearised = system.linearise(step, iterate, weight, false);
  }
  return linearised;
}

}  // namespace mortier
