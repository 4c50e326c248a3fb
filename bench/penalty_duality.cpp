// The note's own algorithm beside the mixed Newton: iterations and seconds of whole runs of the note's test.
#include <cstdio>

#include "theory/hard_cases.h"

int main() {
  using namespace mortier;
  using namespace mortier::scenes;
  std::printf("%-13s %-10s %8s %4s | %23s | %23s %6s | %10s\n", "coupling", "projection", "theta e", "N",
              "Newton: linear solves, s", "penalty-duality", "worst", "difference");
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation})
    for (const Projection projection : {Projection::elasticity, Projection::frobenius})
      for (const double stiffness : {1.0, 1e2, 1e4, 1e6, 2.142857142857143e8})
        for (const int steps : {4, 10}) {
          Viscoplasticity law = noteLaw(projection);
          law.viscosity = 0.1 * noteElasticity.moduli()[0] / (2 * stiffness);
          const Model model = compression(6, 16, perzynaMaterial(noteElasticity, law), coupling, upperBody);
          const Result newton = run(model, 1, steps);
          SolverOptions options;
          options.method = Method::penaltyDuality;
          options.maxIterations = defaultIterations(options.method);
          const Result duality = run(model, 1, steps, options);
          double difference = 0;
          double largest = 0;
          for (size_t b = 0; b < 2; ++b) {
            const Vector& u = newton.state.bodies[b].displacement;
            difference =
                std::max(difference, (duality.state.bodies[b].displacement - u).cwiseAbs().maxCoeff());
            largest = std::max(largest, u.cwiseAbs().maxCoeff());
          }
          std::printf("%-13s %-10s %8.1e %4d | %15d %7.3f | %15d %7.3f %6d | ", hardcases::nameOf(coupling),
                      hardcases::nameOf(projection), stiffness, steps, newton.report.iterations,
                      newton.report.solveSeconds, duality.report.iterations, duality.report.solveSeconds,
                      duality.report.maxIterationsInAStep);
          if (duality.report.status == Status::converged)
            std::printf("%10.1e\n", difference / largest);
          else
            std::printf("given up after %d steps\n", duality.report.steps);
          std::fflush(stdout);
        }
}
