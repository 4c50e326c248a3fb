// What ranks that share the bodies of a step tell each other. Each step of a linear solve is done for the
// part of the rank in all bodies first, then put together a body after the other.
#include "solver/step_system.h"

namespace mortier {

void StepSystem::agreeOnLaws(const Step& step, const Iterate& iterate) {
  constexpr size_t each = 5;
  std::vector<double> largest;
  std::vector<double> elastic;
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const auto facts = bodies_[b].factsOfPart(step.state0.bodies[b].stress, iterate.bodies[b]);
    largest.insert(largest.end(), {facts.change, facts.predictor, facts.modulus, facts.before, facts.stress});
    elastic.push_back(facts.elastic);
  }
  model_.largest(largest.data(), largest.size());
  model_.sum(elastic.data(), elastic.size());
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const double* of = &largest[each * b];
    bodies_[b].take({of[0], of[1], of[2], of[3], of[4], elastic[b]});
  }
}

std::vector<Vector> StepSystem::condenseBodies(const std::vector<Vector>& force) {
  std::vector<Vector> motion(bodies_.size());
  const bool parts = model_.inParts();
  forEachBody([&](int b) {
    bodies_[b].condense(force[b]);
    if (!parts) motion[b] = bodies_[b].joinCondensed();
  });
  for (size_t b = 0; b < bodies_.size() && parts; ++b) motion[b] = bodies_[b].joinCondensed();
  return motion;
}

void StepSystem::expandBodies(const ContactSolution& contact,
                              const std::function<void(int, const Vector&)>& take) {
  if (sparse()) {
    forEachBody([&](int b) { take(b, contact.motion[b]); });
    return;
  }
  const auto moveContact = [&](int b) { bodies_[b].moveContact(contact.change, motionOf(contact.rigid, b)); };
  if (!model_.inParts()) {
    forEachBody([&](int b) {
      moveContact(b);
      take(b, bodies_[b].expand());
    });
    return;
  }
  std::vector<Vector> motion(bodies_.size());
  for (size_t b = 0; b < bodies_.size(); ++b) moveContact(static_cast<int>(b));
  forEachBody([&](int b) { motion[b] = bodies_[b].expand(); });
  for (size_t b = 0; b < bodies_.size(); ++b) completeAtNodes(model_.parts[b], *model_.ranks, motion[b]);
  forEachBody([&](int b) { take(b, motion[b]); });
}

}  // namespace mortier
