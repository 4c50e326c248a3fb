#include "bound/flow_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/datum.h"
#include "base/interrupt.h"
#include "bound/flow_potential.h"

namespace mortier {
namespace {

std::string obstacleOf(const Model& model, const Steps& steps) {
  if (!steps.backwardEuler) return otherScheme;
  return FlowPotential::obstacleOf(model);
}

/// Whether a datum is linear in time between two times, anywhere in a box.
bool isLinearInTime(const Datum& datum, const Point& least, const Point& largest, double t0, double t1) {
  constexpr double rounding = 1e-12;  // over the values; of the step: a kink at its end is none in it
  if (!datum.inTime) return true;
  const double k = t1 - t0;
  // At both ends, and where no formula is known at a few times: at corners.
  for (const Point& x : {least, largest, Point(least.x(), largest.y()), Point(largest.x(), least.y())}) {
    const std::array ends{datum(x.x(), x.y(), t0), datum(x.x(), x.y(), t1)};
    for (const double part : {0.25, 0.5, 0.75}) {
      const double value = datum(x.x(), x.y(), t0 + part * k);
      const double size = std::max({std::abs(ends[0]), std::abs(ends[1]), std::abs(value)});
      if (!(std::abs(value - (1 - part) * ends[0] - part * ends[1]) <= 100 * rounding * size)) return false;
    }
  }
  const Datum::Along along = datum.along ? datum.along() : Datum::Along();
  if (!along) return true;
  const Taylor f =
      along(Taylor::constant({least.x(), largest.x()}), Taylor::constant({least.y(), largest.y()}),
            Taylor::linear(t0, 1, {rounding * k, (1 - rounding) * k}));
  return k * k * f.c[2].magnitude() <= rounding * f.c[0].magnitude();
}

/// Of the forces that no support takes up, over the largest.
bool balanced(const Model& model, const State& state) {
  constexpr double balance = 1e-9;
  double largest = 0;
  double left = 0;
  std::vector<Vector> forces;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    forces.push_back(body.load(state.time));
    largest = std::max({largest, largestOf(forces[b]), body.largestForce(state.bodies[b].stress)});
    forces[b] -= body.internalForce(state.bodies[b].stress);
  }
  for (size_t i = 0; i < model.interfaces.size(); ++i) {
    const auto& [nonmortar, mortar, coupling] = model.interfaces[i].pair();
    model.interfaces[i].subtractForces(state.contactForce[i], forces[nonmortar.body], forces[mortar.body]);
  }
  for (size_t b = 0; b < model.bodies.size(); ++b)
    left = std::max(left, largestOf(model.bodies[b].gather(forces[b])));
  return left <= balance * largest;
}

}  // namespace

bool FlowBoundRecord::applies(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& body) { return !body.material().linear(); });
}

FlowBoundRecord::FlowBoundRecord(const Model& model, Steps steps, const State& state, FlowBoundMemory& memory)
    : model_(model), steps_(steps), memory_(memory) {
  for (const Body& body : model.bodies) {
    viscosities_.push_back(leastViscosity(body));
    for (const Point& x : body.mesh().vertices)
      rounding_ = std::max(rounding_, roundingOfSums * x.cwiseAbs().maxCoeff());
  }
  keep(state);
}

void FlowBoundRecord::keep(const State& state) {
  before_ = state;
  for (BodyState& body : before_.bodies) {
    body.displacement.resize(0);
    body.viscoplasticStrain.resize(0, 0);
  }
}

void FlowBoundRecord::begin(const State& state) {
  memory_ = {};
  memory_.begin = state.time;
  memory_.obstacle = obstacleOf(model_, steps_);
  bool moved = false;
  for (const Vector& gap : state.gap) moved = moved || (gap.array() > rounding_).any();
  if (memory_.obstacle.empty() && (moved || !balanced(model_, state)))
    memory_.obstacle = "what acts at the start is not in balance";
}

/// Between the ends of the step G : d rises, by no more than |d|^2/(2 lambda) in all: of such functions that
/// have their values at both ends none gives more than this.
double FlowBoundRecord::misfitTo(const State& state) const {
  double misfit = 0;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    if (body.material().linear()) continue;
    Matrix rate0;
    Matrix rate1;
    body.material().viscoplasticRate(before_.bodies[b].stress, rate0);
    body.material().viscoplasticRate(state.bodies[b].stress, rate1);
    for (int i = 0; i < body.points(); ++i) {
      const PointVector d = state.bodies[b].stress.col(i) - before_.bodies[b].stress.col(i);
      const double rise = d.dot(rate1.col(i) - rate0.col(i));
      const double most = d.squaredNorm() / (2 * viscosities_[b]);
      // A stress on the yield surface has an overstress of rounding.
      const double rounding = roundingOfSums * state.bodies[b].stress.col(i).norm() / d.norm();
      if (!(rise > rounding * most)) continue;
      const double rest = 1 - std::min(1.0, rise / most);
      misfit += body.weights()[i] * most * (1 - rest * rest * rest) / 6;
    }
  }
  return misfit * (state.time - before_.time);
}

void FlowBoundRecord::addContact(const State& state) {
  const auto change = [&](const char* how) {
    if (memory_.moved.empty()) memory_.moved = std::string("contact ") + how + " while bodies flow";
  };
  double growth = 1;
  for (size_t k = 0; k < model_.interfaces.size(); ++k)
    for (Eigen::Index i = 0; i < state.gap[k].size(); ++i) {
      const double p0 = before_.contactForce[k][i];
      const double p1 = state.contactForce[k][i];
      const double open0 = std::max(0.0, -before_.gap[k][i]);
      const double open1 = std::max(0.0, -state.gap[k][i]);
      if (p1 > 0) {
        if (p0 == 0 && open0 > rounding_) change("closes");
        growth = std::max(growth, p0 > 0 ? p1 / p0 : infinity);
      } else if (p0 > 0 && open1 > rounding_) {
        change("opens");
        memory_.opening += p0 * open1 / 2;
      } else if (open1 < open0 - rounding_) {
        growth = infinity;
      }
    }
  memory_.growth *= growth;
}

void FlowBoundRecord::addData(double t) {
  const double middle = (before_.time + t) / 2;
  const auto compare = [](const Vector& a, const Vector& m, const Vector& b, double& all, double& off) {
    all = std::max({all, largestOf(a), largestOf(m), largestOf(b)});
    off = std::max(off, largestOf(m - (a + b) / 2));
  };
  if (const std::string curved = curvedIn(before_.time, t); !curved.empty())
    memory_.obstacle = curved + " is not linear in time within a step";
  for (const Body& body : model_.bodies) {
    compare(body.load(before_.time), body.load(middle), body.load(t), memory_.load, memory_.loadOff);
    const auto prescribed = [&](double when) {
      Vector u = Vector::Zero(body.dofs());
      body.prescribe(when, u);
      return u;
    };
    compare(prescribed(before_.time), prescribed(middle), prescribed(t), memory_.motion, memory_.motionOff);
  }
}

/// The first of the data that is not known to be linear in time between two times; empty where all are.
std::string FlowBoundRecord::curvedIn(double t0, double t1) const {
  for (const Body& body : model_.bodies) {
    const std::vector<Point>& x = body.mesh().vertices;
    Point least = x.front();
    Point largest = x.front();
    for (const Point& each : x) {
      least = least.cwiseMin(each);
      largest = largest.cwiseMax(each);
    }
    const auto curved = [&](const Datum& value) { return !isLinearInTime(value, least, largest, t0, t1); };
    const Conditions& conditions = body.conditions();
    for (const PrescribedDisplacement& held : conditions.displacements)
      if (curved(held.value)) return "a displacement prescribed of " + body.name();
    for (const Traction& traction : conditions.tractions)
      if (curved(traction.value))
        return "the traction on label " + std::to_string(traction.label) + " of " + body.name();
    for (const BodyForce& force : conditions.forces)
      if (curved(force.value)) return "the body force of " + body.name();
    if (body.heated() && curved(conditions.temperature)) return "the temperature of " + body.name();
    for (const ContactInterface& interface : model_.interfaces)
      if (interface.given() && curved(interface.given())) return "the gap";
  }
  return "";
}

void FlowBoundRecord::add(const State& state, const StepReport& report) {
  try {
    addStep(state, report);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    memory_.obstacle = reasonOf(error);
  }
}

void FlowBoundRecord::addStep(const State& state, const StepReport& report) {
  if (report.step == 0) begin(state);
  if (report.step > 0 && memory_.obstacle.empty()) {
    const double misfit = misfitTo(state);
    // Before the first flow too: a peak within a step may be the first.
    addData(state.time);
    if (memory_.misfit == 0 && misfit == 0) {
      memory_.begin = state.time;
    } else {
      memory_.misfit += misfit;
      addContact(state);
      if (!steps_.chosen && report.rejections > 0)
        memory_.obstacle = "step " + std::to_string(report.step) + " was cut into parts";
    }
  }
  if (memory_.obstacle.empty()) keep(state);
}

FlowBound FlowBoundRecord::atEnd(const State& state) const {
  FlowBound result;
  result.obstacle = memory_.obstacle;
  if (!result.obstacle.empty()) return result;
  double viscosity = infinity;
  double strain = 0;
  double stress = 0;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    Matrix elastic;
    body.material().elasticStrain(state.bodies[b].stress, elastic);
    for (int i = 0; i < body.points(); ++i) {
      stress += body.weights()[i] * elastic.col(i).dot(state.bodies[b].stress.col(i));
      strain += body.weights()[i] * state.bodies[b].viscoplasticStrain.col(i).squaredNorm();
    }
    viscosity = std::min(viscosity, viscosities_[b]);
  }
  result.strainNorm = std::sqrt(strain);
  result.stressNorm = std::sqrt(stress);
  result.strain = std::sqrt((state.time - memory_.begin) * memory_.misfit / viscosity);
  result.stress = std::sqrt(2 * memory_.misfit);
  if (memory_.misfit > 0) result.factor = std::sqrt(memory_.growth * (1 + memory_.opening / memory_.misfit));
  result.moved = memory_.moved;
  const auto over = [](double off, double all) { return all > 0 ? off / all : 0; };
  result.data = std::max(over(memory_.loadOff, memory_.load), over(memory_.motionOff, memory_.motion));
  return result;
}

}  // namespace mortier
