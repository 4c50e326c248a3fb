// The work that is done on bodies, step by step, where it is asked for.
//
// Every step satisfies B du = E^-1 (s1 - s0) + e, e its viscoplastic strain. Multiplied by the mean of the
// stresses at both ends,
//   1/2 (f0 + f1) . du = U1 - U0 + 1/2 sum |T| (s0 + s1) : e,   f = sum |T| B' s,
// so the work of all forces on a body is taken as that of their means (trapezoidal rule, which is exact for
// forces that are linear in the displacement), and in elastic bodies it is what is stored, to rounding.
// Contact does no work across the line, and along it what friction dissipates. Where a node closes, opens or
// begins to slip within the step, or directions change, the product of the means is another one: the
// difference is taken of contact and of loads and supports, of each body in the part that they do of all
// work. The dissipation takes the weights of the scheme, by which it is never negative:
//   D1 - D0 = sum |T| k sum b_i (s_i - X_i) : G_i,   X the back stress of hardening: X : eps_v / 2 is stored.
// Thermal strain that changes by a adds 1/2 sum |T| (s0 + s1) : a on the right: less that is its work.
// docs/theory.md has the difference of both where bodies flow.

#include <numeric>

#include "material/back_stress.h"
#include "time/nodal_forces.h"
#include "time/step_taker.h"

namespace mortier {
namespace {

/// r . du, r the part of `forces` along the directions that supports hold.
double workOfSupports(const Body& body, const Vector& forces, const Vector& du) {
  if (body.rigid()) return body.heldForce(forces).dot(body.motionOf(du));
  // Equations are orthonormal directions: what they leave is held.
  return forces.dot(du) - body.gather(forces).dot(body.gather(du));
}

/// sum |T| (s - X) : e, of the points that flow: elsewhere e is rounding.
double product(const Body& body, const Matrix& stress, const Matrix& flowed, const Matrix& strain) {
  double sum = 0;
  for (int i = 0; i < body.points(); ++i)
    if (body.material().flows(stress, i))
      sum +=
          body.weights()[i] * (stress.col(i) - backStressOf(body.material(), flowed, i)).dot(strain.col(i));
  return sum;
}

}  // namespace

/// sum b_i k (s_i - X_i) : G_i of the attempt.
double StepTaker::dissipated(size_t b) const {
  const Body& body = model_.bodies[b];
  if (body.material().linear() || t1_ == state_.time) return 0;
  const BodyState& start = state_.bodies[b];
  const double k = t1_ - state_.time;
  // a_ss k G_s of a stage, and the viscoplastic strain there.
  const auto flowOf = [&](size_t stage) {
    const BodyIterate& there = solutions_[stage].bodies[b];
    Matrix elastic;
    body.material().elasticStrain(there.stress - start.stress, elastic);
    return Matrix(there.strain - elastic);
  };
  const auto flowedAt = [&](size_t stage) {
    Matrix flowed = start.viscoplasticStrain + flowOf(stage);
    const std::vector<double>& before = tableau_.stages[stage].before;
    for (size_t j = 0; j < before.size(); ++j) flowed += before[j] * k * rates_[j][b];
    return flowed;
  };
  const size_t end = solutions_.size() - 1;
  double sum = product(body, solutions_[end].bodies[b].stress, flowedAt(end), flowOf(end));
  const Stage& last = tableau_.stages.back();
  for (size_t j = 0; j < last.before.size(); ++j) {
    const bool atStart = tableau_.explicitFirst && j == 0;
    const size_t stage = tableau_.explicitFirst ? j - 1 : j;
    const Matrix& stress = atStart ? start.stress : solutions_[stage].bodies[b].stress;
    const Matrix flowed = atStart ? start.viscoplasticStrain : flowedAt(stage);
    sum += last.before[j] * k * product(body, stress, flowed, rates_[j][b]);
  }
  return sum;
}

void StepTaker::countWork() {
  const Iterate& end = solutions_.back();
  // Rows that follow the bodies were others at the start.
  std::vector<ContactInterface> atEnd;
  std::vector<Vector> contactAtStart;
  if (follows()) {
    atEnd = model_.interfaces;
    follow(model_, displacementsOf(state_));
  }
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    contactAtStart.push_back(contactForces(model_, forcesOf(state_), static_cast<int>(b)));
  if (follows()) model_.interfaces = std::move(atEnd);
  std::vector<double> external;
  double means = 0;  // of contact, on all bodies
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    const int index = static_cast<int>(b);
    const Vector du = solutions_.back().bodies[b].increment.value();
    const Vector contact0 = contactAtStart[b];
    const Vector contact1 = contactForces(model_, {end.contactForce, end.frictionForce, end.tieForce}, index);
    const Vector load = body.load(t1_);
    // What loads and supports exert: at the start what the stress balances, as loads may begin at once.
    const Vector before = body.internalForce(state_.bodies[b].stress) + contact0;
    const Vector after = body.internalForce(end.bodies[b].stress) - load + contact1;
    external.push_back((before.dot(du) + load.dot(du) + workOfSupports(body, after, du)) / 2);
    const double contact = contact0.dot(du) + contact1.dot(du);
    double thermal = 0;
    if (body.heated()) {
      const Matrix change = body.thermalStrain(t1_) - state_.bodies[b].thermalStrain;
      const Matrix mean = (state_.bodies[b].stress + end.bodies[b].stress) / 2;
      for (int i = 0; i < body.points(); ++i) thermal += body.weights()[i] * mean.col(i).dot(change.col(i));
    }
    WorkDone& work = state_.bodies[b].work;
    work.external += external[b];
    work.contact -= contact / 2;
    means -= contact / 2;
    work.dissipated += dissipated(b);
    work.thermal -= thermal;
  }
  // Of what contact does: friction dissipates, distances that change do work, conditions and ties that yield
  // store it.
  const std::vector<double> friction = dissipatedByFriction();
  double work = gapWork(state_, end) - std::accumulate(friction.begin(), friction.end(), 0.0);
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const Vector& p0 = state_.contactForce[k];
    const Vector& p1 = end.contactForce[k];
    if (model_.interfaces[k].yields()) work -= (p0 + p1).dot(model_.interfaces[k].yielded(p1 - p0)) / 2;
  }
  for (size_t k = 0; k < model_.ties.size(); ++k) {
    const Vector& l0 = state_.tieForce[k];
    const Vector& l1 = end.tieForce[k];
    if (model_.ties[k].elastic()) work -= (l0 + l1).dot(model_.ties[k].yielded(l1 - l0)) / 2;
  }
  double all = 0;
  for (const double each : external) all += std::abs(each);
  for (size_t b = 0; b < external.size() && all > 0; ++b) {
    const double part = (work - means) * std::abs(external[b]) / all;
    state_.bodies[b].work.external -= part;
    state_.bodies[b].work.contact += part;
  }
}

}  // namespace mortier
