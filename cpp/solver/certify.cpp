#include <algorithm>
#include <cmath>
#include <limits>

#include "base/worst.h"
#include "solver/step_system.h"

namespace mortier {
namespace {

/// The largest depth of a body: 1, or the circumference where it turns about the axis [m].
double depthOf(const Body& body) {
  if (!body.axisymmetric()) return 1;
  double depth = 0;
  for (const Point& vertex : body.mesh().vertices) depth = std::max(depth, body.depthAt(vertex));
  return depth;
}

}  // namespace

Certificate StepSystem::certify(const Step& step, const Iterate& iterate, double materialResidual,
                                bool repeated) const {
  constexpr double roundingOfMotion = 1e-15;
  constexpr double farBelowYield = 1e-6;  // of the force of a triangle as large as the body
  constexpr double roundingOfForces = 1e-13;
  Worst force;
  Worst load;
  Worst ofRounding;  // forces that the rounding of distances makes
  Worst length;      // gaps are differences of displacements
  Worst rounding;
  const std::vector<Vector> u = displacements(step.state0, iterate);
  std::vector<Vector> residual(bodies_.size());
  struct Largest {
    double now = 0;     ///< force of a triangle
    double before = 0;  ///< at the start of the step, of which rounding is left
    double rounded = 0;
    double loose = 0;  ///< of what expands freely rounding is left of the stress that it would have
    double load = 0, displacement = 0, increment = 0, depth = 0;
  };
  std::vector<Largest> largest(bodies_.size());
  const double motion = largestMotion(iterate);
  constexpr int tasks = 4;
  threads_.forEach(tasks * static_cast<int>(bodies_.size()), [&](int i) {
    const size_t b = i / tasks;
    const Body& body = model_.bodies[b];
    const Matrix& stress0 = step.state0.bodies[b].stress;
    const BodyIterate& unknowns = iterate.bodies[b];
    switch (i % tasks) {
      case 0:
        residual[b] = -body.internalForce(unknowns.stress);
        break;
      case 1:
        largest[b].now = body.largestForce(unknowns.stress);
        break;
      case 2:
        largest[b].before = body.largestForce(stress0);
        break;
      default:
        largest[b].rounded = bodies_[b].rounding(stress0, unknowns, motion, u[b]);
    }
  });
  const auto largestOf = [](const Vector& entries) {
    Worst worst;
    worst.add(entries);
    return worst.value();
  };
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = model_.bodies[b];
    residual[b] += step.loads[b];
    Largest& of = largest[b];
    of.load = largestOf(step.loads[b]);
    of.displacement = largestOf(u[b]);
    of.increment = largestOf(iterate.bodies[b].increment.high);
    of.depth = depthOf(body);
    if (body.heated() && !step.data.thermal.empty()) {
      const Matrix strain = step.state0.bodies[b].thermalStrain + step.data.thermal[b];
      Matrix held(strain.rows(), strain.cols());
      for (int i = 0; i < body.points(); ++i) held.col(i) = stressOf(bodies_[b].law(), strain.col(i), i);
      of.loose = body.largestForce(held);
    }
    for (const double each : {of.now, of.before, of.load, of.loose}) force.add(each);
    for (const double each : {of.load, of.loose}) load.add(each);
    // A body that moves without any load, or touches another without any, has forces that are nothing but the
    // rounding of its motion, and of distances, unless it is beyond yield.
    const double yieldStress = body.material().stressScale();
    const bool far = of.now <= farBelowYield * yieldStress * body.extent() * of.depth;
    if (bodies_[b].elastic() || yieldStress <= 0 || far) {
      const double rounded = model_.interfaces.empty() ? of.increment : std::max(of.increment, body.extent());
      ofRounding.add(roundingOfMotion * bodies_[b].largestModulus() * rounded * of.depth);
    }
    length.add(body.extent());
    length.add(of.displacement);
    rounding.add(of.rounded);
  }
  subtractContact(iterate.contactForce, iterate.frictionForce, residual);
  subtractTies(iterate.tieForce, residual);
  Worst beyondBound;
  Worst wrongSlip;
  const std::vector<Vector> slip = slips(model_, iterate);
  Worst contactForce;
  for (const Vector& p : iterate.contactForce) contactForce.add(p);
  Worst gapOnActive;
  Worst openPenetration;
  Worst complementarity;
  // However soft and thin a body is, motions that the rounding of forces makes count as these forces.
  const Vector compliance = compliances();
  const auto moved = [&](double by, Eigen::Index condition) {
    const double part = by / length.value();
    if (!(by > 0) || condition >= compliance.size() || !(compliance[condition] > 0)) return part;
    const double pull = by / compliance[condition];
    return pull <= roundingOfForces * force.value() ? std::min(part, pull / force.value()) : part;
  };
  Eigen::Index along = rows();
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    const int b1 = interface.pair().nonmortar.body;
    const int b2 = interface.pair().mortar.body;
    const Vector& p = iterate.contactForce[k];
    if (interface.hasFriction()) {
      const Vector& t = iterate.frictionForce[k];
      const Vector bound = interface.frictionBound(p);
      const int m = interface.slipComponents();
      for (Eigen::Index i = 0; i < bound.size(); ++i) {
        const int sign = iterate.slipping[k][i];
        const auto tangential = t.segment(m * i, m);
        const auto slipped = slip[k].segment(m * i, m);
        beyondBound.add(tangential.norm() - bound[i]);
        if (!(bound[i] > 0)) continue;
        const Vector direction = sign == 0 ? Vector::Zero(m)
                                 : m == 1  ? Vector::Constant(1, sign)
                                           : Vector(tangential / bound[i]);
        const double against = -direction.dot(slipped);
        const double aside = (slipped + against * direction).norm();  // all of it where the node sticks
        wrongSlip.add(moved(std::max(aside, against), along + m * i));
      }
      along += t.size();
    }
    Vector g = interface.gap(u[b1], u[b2], step.data.time);
    if (interface.yields()) g -= interface.yielded(p);
    for (Eigen::Index i = 0; i < g.size(); ++i) {
      const double off = moved(std::abs(g[i]), firstRow_[k] + i);
      if (iterate.active[k][i] != 0)
        gapOnActive.add(off);
      else
        openPenetration.add(g[i] / length.value());
      if (contactForce.value() != 0) complementarity.add(p[i] / contactForce.value() * off);
    }
  }
  for (const Vector& jump : jumps(model_, step.state0, iterate))
    gapOnActive.add(jump.lpNorm<Eigen::Infinity>() / length.value());
  Worst own;
  for (size_t b = 0; b < bodies_.size(); ++b) own.add(model_.bodies[b].gather(residual[b]));
  const double balance = own.value();
  const double rounded = ofRounding.value();
  const bool unloaded = repeated && load.value() == 0 && std::max(force.value(), balance) <= rounded;
  force.add(rounded);
  const auto overForce = [&](double value) {
    if (!std::isfinite(force.value())) return std::numeric_limits<double>::quiet_NaN();
    return value == 0 || (unloaded && value <= rounded) ? 0 : value / force.value();
  };
  Certificate result;
  result.forceBalance = overForce(balance);
  result.materialResidual = materialResidual;
  result.gapOnActive = gapOnActive.value();
  result.openPenetration = openPenetration.value();
  result.sign = overForce(iterate.largestTension);
  result.complementarity = complementarity.value();
  result.friction = worse(overForce(beyondBound.value()), wrongSlip.value());
  result.rounding = rounding.value();
  return result;
}

Vector StepSystem::compliances() const {
  return sparse() ? sparse_->compliance() : Vector(contact_.W.diagonal());
}

double StepSystem::gapRoundoff(const Step& step, const Iterate& iterate) const {
  const Vector compliance = compliances();
  const std::vector<Vector> gap = gaps(model_, step.gap0(), iterate);
  double largest = 0;
  double force = 0;
  for (size_t k = 0; k < gap.size(); ++k)
    for (Eigen::Index i = 0; i < gap[k].size(); ++i) {
      if (iterate.active[k][i] == 0) continue;
      largest = std::max(largest, std::abs(gap[k][i]) / compliance[firstRow_[k] + i]);
      force = std::max(force, iterate.contactForce[k][i]);
    }
  return force > 0 ? largest / force : 0;
}

}  // namespace mortier
