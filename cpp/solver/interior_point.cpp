#include <algorithm>
#include <cmath>
#include <limits>

#include "base/digits.h"
#include "material/interior_path.h"
#include "solver/methods.h"

namespace mortier {
namespace {

/// The paths of all bodies; none of those whose law is linear.
class Paths {
 public:
  Paths(const Model& model, const Step& step) : model_(model) {
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      const Material& material = model.bodies[b].material();
      const Matrix& stress0 = step.state0.bodies[b].stress;
      paths_.push_back(material.interiorPath(step.data.weight, stress0, step.strain0(b)));
      if (!paths_[b]) continue;
      const double flow = paths_[b]->flowAtTwiceYield();
      points_ += paths_[b]->points();
      flow_ = std::max(flow_, flow);
      yieldStrain_ = std::min(yieldStrain_, flow / (1 + material.stiffness(step.data.weight)));
      // Stresses that are there may be far beyond yield already.
      if (stress0.size() > 0)
        overstress_ = std::max(overstress_, stress0.cwiseAbs().maxCoeff() / material.stressScale());
    }
  }
  /// `overstress` is counted in the stresses that are there, or the yield stress.
  void begin(double overstress) {
    for (const auto& path : paths_)
      if (path) path->begin(overstress * overstress_ * flow_);
  }
  [[nodiscard]] InteriorPath* operator[](size_t body) const { return paths_[body].get(); }
  [[nodiscard]] bool none() const { return points_ == 0; }
  [[nodiscard]] double yieldStrain() const { return yieldStrain_; }
  [[nodiscard]] double complementarity() const {
    double sum = 0;
    for (const auto& path : paths_) sum += path ? path->complementarity() : 0;
    return sum / points_;
  }

 private:
  std::vector<std::unique_ptr<InteriorPath>> paths_;
  const Model& model_;
  double points_ = 0;
  double flow_ = 0;
  double yieldStrain_ = std::numeric_limits<double>::infinity();
  double overstress_ = 1;
};

}  // namespace

// Near the end of the path it is known which triangles flow, and Newton's method finishes.
StepOutcome interiorPoint(StepSystem& system, const Step& step, int maxIterations, Iterate& solution) {
  constexpr double toBoundary = 0.99;
  constexpr double blocked = 1e-6;
  constexpr double leastCentering = 1e-6;
  constexpr int finishing = 20;
  constexpr int allIterations = 120;
  constexpr double ends[] = {1e-4, 1e-6, 1e-8};  // of mu over the yield strain

  const Model& model = system.model();
  StepOutcome total;
  Iterate iterate = startingIterate(step.state0);
  prescribe(model, step, iterate);
  Paths paths(model, step);
  if (paths.none()) {
    total.fail(Reason::unconverged, "no body has a law with a central path");
    return total;
  }
  paths.begin(system.options().firstOverstress);
  // Where the iterate would go in the direction that aims at `target`. \returns the largest step.
  const auto direct = [&](double target, bool correct, Iterate& next) -> std::optional<double> {
    const StepSystem::Linearised linearised = system.linearise(step, iterate, [&](int b) -> BodyLaw {
      if (!paths[b]) return system.law(step, b, step.data.weight, false);
      return {{}, [&, b](const BodyIterate& body, Linearisation& result) {
                paths[b]->linearise(body.strain, target, correct, result);
              }};
    });
    const std::optional<StepSystem::Factorised> factorised =
        correct ? linearised.keepFactors() : linearised.factorise(total);
    next = iterate;
    if (!factorised || !factorised->solve(step, next, total)) return std::nullopt;
    double largest = 1 / toBoundary;
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      updateStrain(model, step, b, next);
      if (paths[b])
        largest = std::min(largest, paths[b]->direct(next.bodies[b].strain - iterate.bodies[b].strain));
    }
    return largest;
  };
  for (const double end : ends) {
    for (double mu = paths.complementarity(); mu > end * paths.yieldStrain(); mu = paths.complementarity()) {
      if (total.iterations >= std::min(maxIterations, allIterations)) {
        total.fail(Reason::unconverged,
                   "the interior point method did not converge in " + counted(total.iterations, "iteration"));
        return total;
      }
      ++total.iterations;
      Iterate next;
      const std::optional<double> open = direct(0, false, next);
      if (!open) return total;
      const double centering = std::max(leastCentering, std::pow(1 - std::min(1.0, *open), 3));
      const std::optional<double> most = direct(centering * mu, true, next);
      if (!most) return total;
      const double length = std::min(1.0, toBoundary * *most);
      if (length < blocked) {
        total.fail(Reason::unconverged,
                   "line search of the interior point method failed: step length below 1e-6");
        return total;
      }
      for (size_t b = 0; b < model.bodies.size(); ++b) {
        BodyIterate& body = iterate.bodies[b];
        body.increment += length * next.bodies[b].increment.minus(body.increment);
        if (paths[b])
          paths[b]->advance(length, body.stress);
        else
          body.stress += length * (next.bodies[b].stress - body.stress);
      }
      for (size_t k = 0; k < iterate.contactForce.size(); ++k)
        iterate.contactForce[k] += length * (next.contactForce[k] - iterate.contactForce[k]);
      for (size_t k = 0; k < iterate.frictionForce.size(); ++k)
        iterate.frictionForce[k] += length * (next.frictionForce[k] - iterate.frictionForce[k]);
      for (size_t k = 0; k < iterate.tieForce.size(); ++k)
        iterate.tieForce[k] += length * (next.tieForce[k] - iterate.tieForce[k]);
      iterate.active = next.active;
      iterate.slipping = next.slipping;
      iterate.slipDirections = next.slipDirections;
    }
    solution = iterate;
    const int left = maxIterations - total.iterations;
    total.follow(newton(system, step, step.data.weight,
                        {std::min(finishing, left), system.options().tolerance, true}, solution));
    if (total.converged()) return total;
  }
  return total;
}

}  // namespace mortier
