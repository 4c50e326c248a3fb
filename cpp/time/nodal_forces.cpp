#include "time/nodal_forces.h"

namespace mortier {
namespace {

bool is(const ContactSide& side, int body, std::optional<int> label) {
  return side.body == body && (!label || side.label == *label);
}

}  // namespace

bool isTieSide(const Tie& tie, size_t side, int body, std::optional<int> label) {
  if (side == 0) return is(tie.pair().nonmortar, body, label);
  if (side == 1) return is(tie.pair().mortar, body, label);
  return tie.sides()[side].body == body && !label;
}

Vector contactForces(const Model& model, const InterfaceForces& given, int body, std::optional<int> label) {
  const auto& [p, t, l] = given;
  Vector forces = Vector::Zero(model.bodies[body].dofs());
  for (size_t k = 0; k < model.ties.size(); ++k) {
    const Tie& tie = model.ties[k];
    for (size_t side = 0; side < tie.sides().size(); ++side)
      if (isTieSide(tie, side, body, label)) forces += tie.sides()[side].C.transpose() * l[k];
  }
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    if (is(interface.pair().nonmortar, body, label)) forces += interface.C1().transpose() * p[k];
    if (is(interface.pair().mortar, body, label)) forces += interface.C2().transpose() * p[k];
    if (!interface.hasFriction()) continue;
    if (is(interface.pair().nonmortar, body, label)) forces += interface.T1().transpose() * t[k];
    if (is(interface.pair().mortar, body, label)) forces += interface.T2().transpose() * t[k];
  }
  return forces;
}

bool isSide(const ContactPair& pair, int body, std::optional<int> label) {
  return is(pair.nonmortar, body, label) || is(pair.mortar, body, label);
}

}  // namespace mortier
