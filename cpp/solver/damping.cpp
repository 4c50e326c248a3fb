#include <algorithm>
#include <cmath>

#include "base/digits.h"
#include "solver/methods.h"

namespace mortier {
namespace {

/// The viscosity in parallel: elastic moduli of all bodies, and the strains where the motion was last.
struct Damper {
  const Model& model;
  std::vector<Matrix> moduli = {};
  std::vector<Matrix> lastStrain = {};

  /// E (strain - lastStrain)/delta in the plane; nothing where the law is linear.
  [[nodiscard]] Matrix stress(size_t body, const Matrix& strain, double delta) const {
    Matrix result = Matrix::Zero(strain.rows(), strain.cols());
    if (model.bodies[body].material().linear()) return result;
    for (int i = 0; i < strain.cols(); ++i) {
      const std::array<double, 9> D = moduliAt(moduli[body], i);
      result.col(i).head<3>() = Eigen::Map<const Eigen::Matrix3d>(D.data()) *
                                (strain.col(i) - lastStrain[body].col(i)).head<3>() / delta;
    }
    return result;
  }
  /// Largest |stress| over the yield stress.
  [[nodiscard]] double largest(const Iterate& iterate, double delta) const {
    double largest = 0;
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      const double unit = model.bodies[b].material().stressScale();
      if (unit == 0) continue;
      const Matrix of = stress(b, iterate.bodies[b].strain, delta);
      if (of.size() > 0) largest = std::max(largest, of.cwiseAbs().maxCoeff() / unit);
    }
    return model.largest(largest);
  }
};

/// One step of the motion, of length delta, solved roughly. \returns whether it could be.
bool advance(StepSystem& system, const Step& step, const Damper& damper, double delta, Iterate& next,
             StepOutcome& total) {
  constexpr int most = 3;
  constexpr double roughly = 0.1;  // material residual
  constexpr double diverged = 1e3;
  const StepSystem::LawOf damped = [&](int b) {
    BodyLaw law = system.law(step, b, step.data.weight, true);
    law.everywhere = [&, b](const BodyIterate& body, Linearisation& result) {
      if (damper.model.bodies[b].material().linear()) return;
      result.predictor += damper.stress(b, body.strain, delta);
      result.moduli += damper.moduli[b] / delta;
      result.elastic = 0;
    };
    return law;
  };
  for (int iteration = 0;; ++iteration) {
    const StepSystem::Linearised linearised = system.linearise(step, next, damped);
    const double residual = linearised.residual();
    if (iteration > 0 && residual <= roughly) return true;
    if (iteration == most || !std::isfinite(residual) || (iteration >= 2 && residual > diverged))
      return false;
    ++total.iterations;
    const std::optional<StepSystem::Factorised> factorised = linearised.factorise(total);
    if (!factorised || !factorised->solve(step, next, total)) return false;
    for (size_t b = 0; b < next.bodies.size(); ++b) {
      updateStrain(damper.model, step, b, next);
      next.bodies[b].stress -= damper.stress(b, next.bodies[b].strain, delta);
    }
  }
}

}  // namespace

StepOutcome restOfDampedMotion(StepSystem& system, const Step& step, int maxIterations, Iterate& solution) {
  constexpr double shorter = 4;
  constexpr double longer = 2;
  constexpr double shortest = 1e-4;
  constexpr double nearRest = 0.02;  // stress of the damping, in yield stresses
  constexpr int finishing = 7;

  StepOutcome total;
  Iterate at = startingIterate(step.state0);
  prescribe(system.model(), step, at);
  Damper damper{system.model()};
  const StepSystem::Linearised elastic = system.linearise(step, at, 0, false);
  for (size_t b = 0; b < at.bodies.size(); ++b) {
    damper.moduli.push_back(elastic.law(static_cast<int>(b)).moduli);
    damper.lastStrain.push_back(at.bodies[b].strain);
  }
  for (double delta = 1; total.iterations < maxIterations && delta > shortest;) {
    Iterate next = at;
    if (!advance(system, step, damper, delta, next, total)) {
      delta /= shorter;
      continue;
    }
    at = std::move(next);
    const double damping = damper.largest(at, delta);
    for (size_t b = 0; b < at.bodies.size(); ++b) damper.lastStrain[b] = at.bodies[b].strain;
    delta *= longer;
    if (!(damping <= nearRest)) continue;
    solution = at;
    total.follow(newton(
        system, step, step.data.weight,
        {std::min(finishing, maxIterations - total.iterations), system.options().tolerance, true}, solution));
    if (total.converged()) return total;
  }
  total.fail(Reason::unconverged,
             "the damped motion did not come to rest in " + counted(total.iterations, "iteration"));
  return total;
}

}  // namespace mortier
