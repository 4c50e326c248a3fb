// What ranks that share the bodies of a step tell each other. Each step of a linear solve is done for the
// part of the rank in all bodies first, then put together a body after the other.
#include "solver/step_system.h"

namespace mortier {

void StepSystem::agreeOnLaws() {
  const size_t count = bodies_.size();
  std::vector<double> largest;
  std::vector<double> elastic;
  for (const CondensedBody& body : bodies_) {
    const CondensedBody::LawFacts& facts = body.lawFacts();
    largest.insert(largest.end(), {facts.change, facts.predictor, facts.modulus});
    elastic.push_back(facts.elastic);
  }
  Ranks::all().largest(largest.data(), 3 * count);
  Ranks::all().sum(elastic.data(), count);
  for (size_t b = 0; b < count; ++b) {
    bodies_[b].take({largest[3 * b], largest[3 * b + 1], largest[3 * b + 2], static_cast<int>(elastic[b])});
  }
}

std::vector<Vector> StepSystem::condenseBodies(const std::vector<Vector>& force) {
  std::vector<Vector> motion(bodies_.size());
  forEachBody([&](int b) {
    bodies_[b].condense(force[b]);
    if (!shared()) motion[b] = bodies_[b].joinCondensed();
  });
  for (size_t b = 0; b < bodies_.size() && shared(); ++b) motion[b] = bodies_[b].joinCondensed();
  return motion;
}

void StepSystem::expandBodies(const ContactSolution& contact,
                              const std::function<Matrix&(int, const Vector&)>& stressOf) {
  if (sparse()) {
    forEachBody([&](int b) { stressOf(b, contact.motion[b]); });
    return;
  }
  const auto moveContact = [&](int b) { bodies_[b].moveContact(contact.change, motionOf(contact.rigid, b)); };
  if (!shared()) {
    forEachBody([&](int b) {
      moveContact(b);
      bodies_[b].expand();
      stressOf(b, bodies_[b].joinExpanded());
    });
    return;
  }
  for (size_t b = 0; b < bodies_.size(); ++b) moveContact(static_cast<int>(b));
  forEachBody([&](int b) { bodies_[b].expand(); });
  for (size_t b = 0; b < bodies_.size(); ++b)
    bodies_[b].share()->gather(stressOf(static_cast<int>(b), bodies_[b].joinExpanded()));
}

}  // namespace mortier
