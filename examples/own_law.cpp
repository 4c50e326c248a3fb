// A user-defined law in a scene: own_law SCENE.toml, whose bodies may say law = "sinh-creep",
//   eps' = E^-1 sigma' + rate sinh(vM/stress) (3/2) dev sigma/vM   (F. Garofalo, 1965, exponent 1),
// with parameters = { rate = 1e-9, stress = 2e7 }. Prints the largest von Mises stress after each step.
#include <cstdio>

#include "material/stress.h"
#include "scene/build.h"
#include "scene/registered_laws.h"
#include "time/march.h"

namespace {

struct SinhCreep {
  static constexpr bool needsTotalStrain = false;
  double rate;    ///< [1/s]
  double stress;  ///< [Pa]

  template <class Number>
  mortier::Components<Number> rateOf(const mortier::Components<Number>& s,
                                     const mortier::Components<Number>& /*strain*/) const {
    using std::exp, std::sqrt;
    const Number mean = (s.c11 + s.c22 + s.c33) / 3;
    const Number a = s.c11 - mean;
    const Number b = s.c22 - mean;
    const Number c = s.c33 - mean;
    const Number relative = sqrt(1.5 * (a * a + b * b + c * c + 2 * (s.c12 * s.c12))) / stress;
    Number ratio = 1 + relative * relative / 6;  // sinh(x)/x near 0
    if (relative > 1e-4) ratio = (exp(relative) - exp(-relative)) / (2 * relative);
    const Number flow = 1.5 * rate / stress * ratio;
    return {flow * a, flow * b, flow * s.c12, flow * c};
  }
};

}  // namespace

int main(int count, char** arguments) try {
  using namespace mortier;
  if (count < 2) throw std::runtime_error("usage: own_law SCENE.toml [KEY=VALUE ...]");
  registerTypedLaw("sinh-creep", [](const LawParameters& given) {
    return SinhCreep{given["rate"], given["stress"]};
  });
  ResolvedScene resolved = resolveScene(readScene(arguments[1], {arguments + 2, arguments + count}));
  const Model model = buildModel(resolved);
  const SceneDescription& scene = resolved.description;
  State state = initialState(model);
  const RunReport report =
      march(model, state, scene.time, scene.solver, [](const State& now, const StepReport&) {
        double largest = 0;
        for (const BodyState& body : now.bodies)
          for (int i = 0; i < body.stress.cols(); ++i)
            largest = std::max(largest, vonMises(body.stress.col(i)));
        std::printf("%.9g %.15g\n", now.time, largest);
      });
  if (report.status != Status::converged) throw std::runtime_error(report.reason);
} catch (const std::exception& error) {
  std::fprintf(stderr, "own_law: %s\n", error.what());
  return 1;
}
