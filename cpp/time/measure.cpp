#include "time/measure.h"

#include <algorithm>

#include "base/worst.h"

namespace mortier {

void compareActive(const ActiveSets& before, const ActiveSets& after, StepReport& report) {
  for (size_t k = 0; k < before.size(); ++k)
    for (size_t i = 0; i < before[k].size(); ++i) {
      report.active += after[k][i];
      report.joined += after[k][i] > before[k][i] ? 1 : 0;
      report.left += after[k][i] < before[k][i] ? 1 : 0;
    }
}

void measure(const Model& model, const State& state, StepReport& report) {
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const Vector& p = state.contactForce[k];
    report.penetration +=
        interface.interpenetration(state.bodies[interface.pair().nonmortar.body].displacement,
                                   state.bodies[interface.pair().mortar.body].displacement);
    report.maxPressure = std::max(report.maxPressure, interface.contactPressure(p).maxCoeff());
    report.contactForce += p.sum();
  }
  double area = 0;
  double flowing = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (int i = 0; i < body.points(); ++i) {
      area += body.weights()[i];
      if (body.material().flows(state.bodies[b].stress, i)) flowing += body.weights()[i];
    }
  }
  report.viscoplasticFraction = flowing / area;
}

Certificate worse(const Certificate& a, const Certificate& b) {
  return {worse(a.forceBalance, b.forceBalance),
          worse(a.materialResidual, b.materialResidual),
          worse(a.gapOnActive, b.gapOnActive),
          worse(a.openPenetration, b.openPenetration),
          worse(a.sign, b.sign),
          worse(a.complementarity, b.complementarity),
          worse(a.rounding, b.rounding)};
}

}  // namespace mortier
