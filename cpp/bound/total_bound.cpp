#include "bound/total_bound.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/interrupt.h"
#include "bound/flow_potential.h"
#include "bound/pressures.h"

namespace mortier {
namespace {

/// How a piece of a contact line has been so far.
enum Touch : char { unknown, closed, open };

/// The law by which s^ is made near s: what flows at all flows as long as the run has taken.
double weightAt(double time) {
  return time;
}

std::string inStep(int number) {
  return " in step " + std::to_string(number);
}

}  // namespace

TotalBoundRecord::TotalBoundRecord(const Model& model, const State& state, TotalBoundMemory& memory)
    : model_(model), memory_(memory), first_(state) {
  for (const Body& body : model.bodies) {
    bodies_.emplace_back(body);
    for (const Point& x : body.mesh().vertices) extent_ = std::max(extent_, x.cwiseAbs().maxCoeff());
    viscosity_ = std::min(viscosity_, leastViscosity(body));
  }
}

bool TotalBoundRecord::atRest(const State& state) const {
  bool rest = true;
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    rest = rest && state.bodies[b].displacement.isZero(0) && state.bodies[b].stress.isZero(0) &&
           model_.bodies[b].load(state.time).isZero(0);
  for (const Vector& force : state.contactForce) rest = rest && force.isZero(0);
  return rest;
}

TotalBoundRecord::Moment TotalBoundRecord::rest(const State& state, TotalBoundMemory& memory) const {
  Moment moment{state, {}, {}, {}, true};
  const MatchedMeshes meshes = matchedMeshes(model_);
  memory.obstacle = meshes.obstacle;
  if (!memory.obstacle.empty()) return moment;
  for (size_t b = 0; b < bodies_.size(); ++b) moment.bodies.push_back(bodies_[b].rest(meshes.bodies[b]));
  for (const MatchedPiece& piece : meshes.pieces)
    moment.contact.push_back(
        {{0, 0}, {std::max(0.0, piece.distance[0]), std::max(0.0, piece.distance[1])}, piece.length});
  return moment;
}

std::vector<TotalBoundRecord::Contact> TotalBoundRecord::contactOf(const Admissible& pair) const {
  std::vector<Contact> contact;
  for (size_t i = 0; i < pair.meshes.pieces.size(); ++i) {
    const MatchedPiece& piece = pair.meshes.pieces[i];
    contact.push_back({pressureOn(piece, pair.spread), {}, piece.length});
    for (int end = 0; end < 2; ++end)
      contact[i].gap[end] = pair.lifting.facing[pair.lifting.facingOfPiece[i][end]].gap;
  }
  return contact;
}

/// Before anything has flowed (I) bounds the error (energy_bound.h).
TotalBoundRecord::Moment TotalBoundRecord::begin(const State& state, TotalBoundMemory& memory) const {
  memory = {};
  memory.obstacle = FlowPotential::obstacleOf(model_);
  for (const Body& body : model_.bodies)
    if (body.degree() != 1) memory.obstacle = "displacements are quadratic";
  if (!memory.obstacle.empty()) return {};
  if (atRest(state)) {
    memory.any.growth = model_.interfaces.empty() ? 1 : 0;
    return rest(state, memory);
  }
  const Admissible pair(model_, state);
  memory.obstacle = pair.obstacle;
  if (!memory.obstacle.empty()) return {};
  Moment moment{state, {}, contactOf(pair), pair.spread};
  for (size_t b = 0; b < bodies_.size(); ++b) {
    moment.bodies.push_back(bodies_[b].start(state.bodies[b], pair.bodies[b], pair.lifting.displacements[b]));
    memory.fixed.misfit += bodies_[b].misfit(moment.bodies[b], pair.bodies[b]) / 2;
  }
  memory.any.misfit = memory.fixed.misfit + pair.lifting.gap;
  return moment;
}

/// Whether a gap becomes smaller.
bool TotalBoundRecord::closes(const std::vector<Contact>& contact) const {
  double largest = extent_;
  for (const RunFields& body : now_->bodies) largest = std::max(largest, largestOf(body.displacement));
  for (size_t i = 0; i < contact.size(); ++i)
    for (int end = 0; end < 2; ++end)
      if (contact[i].gap[end] < now_->contact[i].gap[end] - roundingOfSums * largest) return true;
  return false;
}

/// Whether a place is pressed that was not.
bool TotalBoundRecord::pressesAnew(const std::vector<Contact>& contact) const {
  for (size_t i = 0; i < contact.size(); ++i)
    for (int end = 0; end < 2; ++end)
      if (!now_->rest && contact[i].pressure[end] > 0 && now_->contact[i].pressure[end] == 0) return true;
  return false;
}

/// By how much the pressure grows at most in a step; notes where there is no bound whatever contact does.
double TotalBoundRecord::growthTo(const std::vector<Contact>& contact, int number,
                                  TotalBoundMemory& memory) const {
  double growth = 1;
  const auto stop = [&](const std::string& why) {
    if (memory.closes.empty()) memory.closes = why + inStep(number);
  };
  if (closes(contact)) stop("a gap becomes smaller");
  if (pressesAnew(contact)) stop("contact presses where it did not");
  for (size_t i = 0; i < contact.size(); ++i)
    for (int end = 0; end < 2; ++end) {
      const double p0 = now_->contact[i].pressure[end];
      const double p1 = contact[i].pressure[end];
      if (now_->rest || p1 <= p0) continue;
      growth = std::max(growth, p1 / p0);
    }
  return growth;
}

void TotalBoundRecord::classify(const std::vector<Contact>& contact, int number,
                                TotalBoundMemory& memory) const {
  memory.contact.resize(contact.size(), unknown);
  double largest = extent_;
  for (const RunFields& body : now_->bodies) largest = std::max(largest, largestOf(body.displacement));
  for (size_t i = 0; i < contact.size() && memory.moved.empty(); ++i) {
    const auto& [pressure, gap, length] = contact[i];
    const bool presses = std::max(pressure[0], pressure[1]) > 0;
    const bool gapes = std::max(gap[0], gap[1]) > roundingOfSums * largest;
    if (presses && gapes) memory.moved = "a pressure and a gap overlap at an end of contact" + inStep(number);
    if (!presses && !gapes) continue;
    const char now = presses ? closed : open;
    if (memory.contact[i] != unknown && memory.contact[i] != now)
      memory.moved = std::string("contact ") + (presses ? "closes" : "opens") + inStep(number);
    memory.contact[i] = now;
  }
}

TotalBoundRecord::Moment TotalBoundRecord::step(const State& state, int number,
                                                TotalBoundMemory& memory) const {
  if (now_->rest && atRest(state)) {
    Moment moment = *now_;
    moment.state = state;
    return moment;
  }
  const double timeStep = state.time - now_->state.time;
  memory.earlier = {};
  auto found = std::make_unique<const Admissible>(model_, state, weightAt(state.time));
  memory.obstacle = found->obstacle;
  if (!memory.obstacle.empty()) {
    memory.obstacle += inStep(number);
    return {};
  }
  Moment moment{state, {}, contactOf(*found)};
  classify(moment.contact, number, memory);
  // Where contact is not closed and open as in the run u^ and p^ have but to be of those that do not close
  // gaps and press nowhere anew.
  if (!memory.moved.empty() && memory.closes.empty() &&
      (closes(moment.contact) || pressesAnew(moment.contact))) {
    for (const Contact& each : now_->contact) memory.earlier.gaps.push_back(each.gap);
    memory.earlier.pressures = now_->pressures;
    auto other = std::make_unique<const Admissible>(model_, state, weightAt(state.time), memory.earlier);
    if (other->obstacle.empty()) {
      found = std::move(other);
      moment.contact = contactOf(*found);
    } else {
      memory.earlier = {};
    }
  }
  moment.pressures = found->spread;
  const Admissible& pair = *found;
  const double factor = growthTo(moment.contact, number, memory);
  const std::vector<StepWeights> weights{memory.fixed.weights(1),
                                         memory.any.weights(std::isfinite(factor) ? factor : 1)};
  RunMisfit misfit;
  memory.stress.clear();
  for (size_t b = 0; b < bodies_.size(); ++b) {
    moment.bodies.push_back(bodies_[b].step(now_->bodies[b], now_->state.bodies[b], state.bodies[b],
                                            pair.bodies[b], pair.lifting.displacements[b], timeStep,
                                            weightAt(state.time), weights, misfit));
    memory.stress.push_back(moment.bodies.back().stress);
  }
  const double change = std::sqrt(misfit.change);
  memory.fixed.add(weights[0], 1, timeStep, misfit.flow[0], change);
  // Integral of p^ G(u^)'/rho; from rest also what the integral of p^ G(u)/rho begins with.
  double opening = 0;
  for (size_t i = 0; i < moment.contact.size(); ++i) {
    const Contact& before = now_->contact[i];
    const Contact& after = moment.contact[i];
    std::array<double, 2> pressure{};
    std::array<double, 2> opens{};
    for (int end = 0; end < 2; ++end) {
      const double rest =
          now_->rest ? 0 : before.pressure[end] * (weights[1].moment(0) - weights[1].moment(1));
      pressure[end] = rest + after.pressure[end] * weights[1].moment(1);
      opens[end] = std::max(0.0, after.gap[end] - before.gap[end]);
    }
    const auto moments = momentsOfLinear(pressure, after.length);
    opening += moments[0] * opens[0] + moments[1] * opens[1];
    if (!now_->rest) continue;
    const auto first = momentsOfLinear(after.pressure, after.length);
    opening += first[0] * before.gap[0] + first[1] * before.gap[1];
  }
  if (memory.closes.empty()) memory.any.add(weights[1], factor, timeStep, misfit.flow[1] + opening, change);
  if (memory.closes.empty() && !(std::isfinite(memory.any.misfit) && std::isfinite(memory.any.growth)))
    memory.closes = "bodies flow in the first step";
  if (!memory.moved.empty() && !memory.closes.empty())
    memory.obstacle = memory.moved == memory.closes ? memory.moved : memory.moved + ", " + memory.closes;
  return moment;
}

/// What is known of the state that a stopped run has reached.
void TotalBoundRecord::goOn() {
  if (memory_.stress.empty()) {
    TotalBoundMemory memory;
    now_ = begin(first_, memory);
    return;
  }
  const Admissible pair(model_, first_, weightAt(first_.time), memory_.earlier);
  now_ = {first_, {}, contactOf(pair), pair.spread};
  for (size_t b = 0; b < bodies_.size(); ++b) {
    now_->bodies.push_back(bodies_[b].fields(first_.bodies[b], pair.bodies[b], pair.lifting.displacements[b],
                                             weightAt(first_.time)));
    now_->bodies[b].stress = memory_.stress[b];
  }
}

void TotalBoundRecord::look(const State& state, int number) {
  next_.reset();
  nextMemory_ = number == 0 ? TotalBoundMemory{} : memory_;
  if (!nextMemory_.obstacle.empty()) return;
  try {
    if (number > 0 && !now_) goOn();
    next_ = number == 0 ? begin(state, nextMemory_) : step(state, number, nextMemory_);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    nextMemory_.obstacle = reasonOf(error);
  }
  const auto lost = [](const ErrorCourse& course) {
    return std::isnan(course.misfit) || std::isnan(course.drift) || std::isnan(course.growth);
  };
  if (nextMemory_.obstacle.empty() && (lost(nextMemory_.fixed) || lost(nextMemory_.any)))
    nextMemory_.obstacle = "it is not finite" + inStep(number);
}

void TotalBoundRecord::add(const std::string& obstacle) {
  memory_ = std::move(nextMemory_);
  now_ = std::move(next_);
  if (!obstacle.empty()) memory_.obstacle = obstacle;
  if (memory_.obstacle.empty()) return;
  memory_.stress.clear();
  now_.reset();
}

TotalBound TotalBoundRecord::atEnd(const State& state, const FlowBound& steps) const {
  TotalBound result;
  result.obstacle = memory_.obstacle;
  if (result.obstacle.empty() && !now_) result.obstacle = "the run made no step";
  if (!result.obstacle.empty()) return result;
  result.moved = memory_.moved;
  result.closes = memory_.closes;
  result.data = steps.data;
  result.strainNorm = steps.strainNorm;
  result.stressNorm = steps.stressNorm;
  const MatchedMeshes meshes = matchedMeshes(model_);
  std::array<double, 2> off{};
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const LoadedBody loaded(model_, state, meshes.bodies[b], static_cast<int>(b));
    const auto [stress, strain] = bodies_[b].distance(now_->bodies[b], state.bodies[b], loaded);
    off[0] += stress;
    off[1] += strain;
  }
  result.lifted = std::sqrt(off[1]);
  const auto errors = [&](const ErrorCourse& course) {
    return TotalBound::Errors{result.lifted + course.rateIntegral(viscosity_),
                              std::sqrt(off[0]) + course.energyNorm()};
  };
  if (result.moved.empty()) result.fixed = errors(memory_.fixed);
  if (result.closes.empty()) result.any = errors(memory_.any);
  return result;
}

}  // namespace mortier
