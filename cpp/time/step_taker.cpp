#include "time/step_taker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/formatted.h"
#include "base/parallel.h"
#include "material/stress.h"
#include "solver/state.h"
#include "time/facing_limit.h"
#include "time/measure.h"

namespace mortier {

StepTaker::StepTaker(const Model& model, State& state, MarchMemory& memory, Scheme scheme,
                     const SolverOptions& options, bool countsWork, bool overlapEnds)
    : model_(model),
      state_(state),
      memory_(memory),
      scheme_(scheme),
      system_(model, options),
      countsWork_(countsWork),
      overlapEnds_(overlapEnds) {
  if (memory.run.steps > 0) system_.resume(memory.solver);
  showState();
}

void StepTaker::keepRows() {
  rowsBefore_.clear();
  for (const ContactInterface& interface : model_.interfaces)
    if (follows()) rowsBefore_.push_back({interface.T1(), interface.T2()});
}

StepOutcome StepTaker::solveStage(StepData& data, Iterate& iterate, Effort effort) {
  return anyFollows(model_) ? repeatOnMovedBodies(data, iterate, effort)
                            : solveStep(system_, state_, data, iterate, effort);
}

StepOutcome StepTaker::jump() {
  StepOutcome outcome = attempt(state_.time, Scheme::backwardEuler);
  if (!outcome.converged()) return outcome;
  commit();
  memory_.increments.clear();
  startSolved_ = true;
  return outcome;
}

StepOutcome StepTaker::attempt(double t1, Scheme scheme, Effort effort) {
  t1_ = t1;
  tableau_ = tableau(scheme);
  guarded_ = false;
  if (!showsState_ && anyFriction(model_)) showState();  // T of the state alone, as after a restart
  showsState_ = false;
  return hold(solveStages(t1, effort));
}

// An explicit or second-order scheme may overshoot into the elastic domain, where nothing brings the stress
// back. When the flow turns round between the stages in more than a small share of the bodies, the step is
// redone with backward Euler, which cannot. Two half steps of it are never worse than the one of a run with
// backward Euler: an overstress is divided by (1 + z/2)^2 instead of 1 + z.
bool StepTaker::flowReversed() const {
  constexpr double most = 0.05;
  return tableau_.errorOrder == 3 && reversedShare() > most;
}

StepOutcome StepTaker::guard(const StepOutcome& before, Effort effort) {
  tableau_ = twoHalfSteps();
  guarded_ = true;
  StepOutcome again = hold(solveStages(t1_, effort));
  again.iterations += before.iterations;
  again.factorisations += before.factorisations;
  return again;
}

namespace {

/// Sets values to zero whose cubes have no digits: stresses that relax for long become so small.
template <class Values>
void dropIfVanishing(Values& values) {
  const double least = std::cbrt(std::numeric_limits<double>::min());
  if (values.template lpNorm<Eigen::Infinity>() < least) values.setZero();
}

/// The first residual of a solution that is beyond `most`, in words; empty where none is.
std::string beyond(const Certificate& found, double most) {
  const std::pair<const char*, double> residuals[] = {
      {"force balance", found.forceBalance},        {"material residual", found.materialResidual},
      {"gap on active contact", found.gapOnActive}, {"negative contact force", found.sign},
      {"complementarity", found.complementarity},   {"friction", found.friction}};
  for (const auto& [name, value] : residuals)
    if (!(value <= most)) return formatted("%s of the solution %g, expected at most %g", name, value, most);
  return "";
}

}  // namespace

/// Refuses a solution whose residuals are no rounding, one that could be anywhere along a motion (in a jump
/// the next step may hold it), and one in which bodies overlap although no contact explains it.
StepOutcome StepTaker::hold(StepOutcome outcome) {
  const double most = std::max(residualTolerance, system_.options().tolerance);
  if (const std::string residual = outcome.converged() ? beyond(outcome.certificate, most) : "";
      !residual.empty())
    outcome.fail(Reason::unconverged, residual);
  const bool asked = outcome.converged() && t1_ > state_.time;
  if (const std::string motion = asked ? system_.looseMotion(state_, solutions_.back()) : ""; !motion.empty())
    outcome.fail(Reason::unheld, "no closed contact holds " + motion);
  if (outcome.converged()) {
    overlap_ = overlapOf(solutions_.back(), t1_);
    if (overlapEnds_ && overlap_.refused()) outcome.fail(Reason::overlap, overlap_.words);
  }
  if (outcome.converged())
    frictionAtSlip_ = system_.frictionAtSlip(state_, gap0_, solutions_.back());
  else
    memory_.increments.clear();
  memory_.solver = system_.memory();
  return outcome;
}

BodyOverlap StepTaker::overlapOf(const Iterate& iterate, double time) {
  if (!overlapCheck_) overlapCheck_.emplace(model_);
  const double residual = std::max(residualTolerance, system_.options().tolerance);
  return overlapCheck_->find(displacements(state_, iterate), iterate.contactForce, time, residual);
}

StepOutcome StepTaker::solveStages(double t1, Effort effort) {
  const double k = t1 - state_.time;
  rates_.clear();
  solutions_.clear();
  unsolved_.reset();
  if (tableau_.explicitFirst) rates_.push_back(startingRates());
  StepOutcome total;
  for (size_t i = 0; i < tableau_.stages.size(); ++i) {
    const Stage& stage = tableau_.stages[i];
    shiftOf(stage, k);
    const double time = stage.time == 1 ? t1 : state_.time + stage.time * k;
    StepData data{time, stage.diagonal * k, shift_, startSolved_ || memory_.run.steps > 0};
    addThermalStrain(model_, state_, data);
    Iterate iterate = guess(i, k);
    StepOutcome outcome = solveStage(data, iterate, effort);
    gap0_ = data.gap.empty() ? state_.gap : data.gap;
    outcome.iterations += total.iterations;
    outcome.factorisations += total.factorisations;
    outcome.certificate = worse(outcome.certificate, total.certificate);
    if (i > 0 && (outcome.method == SolutionMethod::rest || total.method > SolutionMethod::newton))
      outcome.method = total.method;
    total = std::move(outcome);
    if (!total.converged()) {
      unsolved_.emplace(data, std::move(iterate));
      return total;
    }
    if (tableau_.stages.size() > 1) rates_.push_back(ratesOf(iterate, data.weight));
    solutions_.push_back(std::move(iterate));
  }
  return total;
}

std::optional<StuckPlace> StepTaker::stuck() {
  if (!unsolved_) return std::nullopt;
  auto& [data, iterate] = *unsolved_;
  return system_.worstPoint(system_.step(state_, data), iterate, data.weight);
}

std::string StepTaker::stressAt(const StuckPlace& place) const {
  const Body& body = model_.bodies[place.body];
  if (!unsolved_) return "";
  const Matrix& stress = unsolved_->second.bodies[place.body].stress;
  const int first = place.triangle * body.pointsOfTriangle();
  int point = first;
  while (point + 1 < first + body.pointsOfTriangle() && body.placeOfPoint(point) != place.at) ++point;
  std::array<double, 6> s{};
  if (body.dimension() == 3) {
    const SpaceStress all = toSpaceCartesian(stress.col(point).head<6>());
    s = {all[0], all[1], all[3], all[2], all[4], all[5]};
  } else {
    const Eigen::Vector3d plane = toCartesian(stress.col(point).head<3>());
    s = {plane[0], plane[1], plane[2], stress.rows() > 3 ? stress(3, point) : 0};
  }
  std::string text = formatted(", at the stress s11 = %g, s22 = %g, s12 = %g", s[0], s[1], s[2]);
  if (stress.rows() > 3) text += formatted(", s33 = %g", s[3]);
  if (body.dimension() == 3) text += formatted(", s13 = %g, s23 = %g", s[4], s[5]);
  return text;
}

std::string StepTaker::nearFacingLimit() {
  showState();
  return mortier::nearFacingLimit(model_, state_);
}

/// sum_{j<i} a_ij k G_j
void StepTaker::shiftOf(const Stage& stage, double k) {
  shift_.clear();
  for (size_t b = 0; b < model_.bodies.size() && !stage.before.empty(); ++b) {
    shift_.push_back(Matrix::Zero(model_.bodies[b].material().components(), model_.bodies[b].points()));
    for (size_t j = 0; j < stage.before.size(); ++j) shift_[b] += stage.before[j] * k * rates_[j][b];
  }
}

/// In steady flow the last increments, scaled to the step, are a good guess; a hard step before makes them a
/// bad one.
Iterate StepTaker::guess(size_t stage, double k) {
  constexpr double sameStep = 1e-9;
  Iterate iterate = startingIterate(state_);
  constexpr double farthest = 10;
  const bool sameStages = !guarded_ && memory_.increments.size() == tableau_.stages.size();
  if (!sameStages || k > farthest * memory_.timeStep) return iterate;
  const double ratio = std::abs(memory_.timeStep - k) > sameStep * k ? k / memory_.timeStep : 1;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const BodyIncrement& last = memory_.increments[stage][b];
    TwoPartVector& increment = iterate.bodies[b].increment;
    forEachBlock(static_cast<int>(increment.high.size()), system_.threads(), [&](int begin, int end) {
      increment.high.segment(begin, end - begin) = ratio * last.displacement.high.segment(begin, end - begin);
      increment.low.segment(begin, end - begin) = ratio * last.displacement.low.segment(begin, end - begin);
    });
    Matrix& stress = iterate.bodies[b].stress;
    forEachBlock(static_cast<int>(stress.cols()), system_.threads(), [&](int begin, int end) {
      stress.middleCols(begin, end - begin) += ratio * last.stress.middleCols(begin, end - begin);
    });
  }
  return iterate;
}

std::vector<Matrix> StepTaker::startingRates() const {
  std::vector<Matrix> rates(model_.bodies.size());
  for (size_t b = 0; b < rates.size(); ++b) {
    const Matrix strain = strainWithin(b, 0);
    model_.bodies[b].material().viscoplasticRate(state_.bodies[b].stress, rates[b], &strain);
  }
  return rates;
}

/// From the strain that elasticity leaves: from the stress, its rounding times theta would strain the next
/// stage (Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.8).
std::vector<Matrix> StepTaker::ratesOf(const Iterate& stage, double weight) const {
  std::vector<Matrix> rates(model_.bodies.size());
  for (size_t b = 0; b < rates.size(); ++b) {
    const Material& material = model_.bodies[b].material();
    const auto& [increment, stress, strain] = stage.bodies[b];
    rates[b].setZero(stress.rows(), stress.cols());
    if (material.linear()) continue;
    Matrix elastic;
    material.elasticStrain(stress - state_.bodies[b].stress, elastic);
    Matrix total = strainOfLaw(material, state_.bodies[b]);
    if (total.size() > 0) total += strain;
    if (total.size() > 0 && !shift_.empty()) total += shift_[b];
    for (int i = 0; i < stress.cols(); ++i)
      if (material.flows(stress, i, &total)) rates[b].col(i) = (strain.col(i) - elastic.col(i)) / weight;
  }
  return rates;
}

/// Share of |G_1| in triangles where G_1 : G_2 <= 0.
double StepTaker::reversedShare() const {
  double all = 0;
  double against = 0;
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    for (int i = 0; i < model_.bodies[b].points(); ++i) {
      const double flow = model_.bodies[b].weights()[i] * rates_[0][b].col(i).norm();
      all += flow;
      if (rates_[0][b].col(i).dot(rates_[1][b].col(i)) <= 0) against += flow;
    }
  return all > 0 ? against / all : 0;
}

void StepTaker::commit() {
  if (std::exchange(showsState_, false)) gap0_ = followTo(solutions_.back());
  if (countsWork_) countWork();
  BodyOverlap& deepest = memory_.run.overlap;
  if (overlap_.refused() > deepest.refused() ||
      (overlap_.refused() == deepest.refused() && overlap_.depth > deepest.depth))
    deepest = overlap_;
  state_.gap = solvedGaps(model_, gap0_, solutions_.back());
  const std::vector<double> work = dissipatedByFriction();
  for (size_t k = 0; k < work.size(); ++k) {
    state_.frictionWorkOf[k] += work[k];
    state_.frictionWork += work[k];
  }
  state_.gapWork += gapWork(state_, solutions_.back());
  memory_.increments.clear();
  memory_.timeStep = t1_ - state_.time;
  for (size_t i = 0; i < solutions_.size(); ++i) {
    const bool last = i + 1 == solutions_.size();
    std::vector<BodyIncrement> increments;
    for (size_t b = 0; b < model_.bodies.size(); ++b) {
      BodyState& body = state_.bodies[b];
      BodyIterate& step = solutions_[i].bodies[b];
      if (last) {
        forEachBlock(static_cast<int>(body.displacement.size()), system_.threads(), [&](int begin, int end) {
          body.displacement.segment(begin, end - begin) += step.increment.high.segment(begin, end - begin) +
                                                           step.increment.low.segment(begin, end - begin);
        });
        if (model_.bodies[b].heated()) body.thermalStrain = model_.bodies[b].thermalStrain(t1_);
        model_.bodies[b].prescribe(t1_, body.displacement);  // sums of increments would drift
      }
      // The state takes the stress of the last stage, the memory the increments.
      if (last) step.stress.swap(body.stress);
      const Material& material = model_.bodies[b].material();
      const bool strains = last && t1_ > state_.time && !material.linear();
      Matrix elastic(strains ? step.stress.rows() : 0, strains ? step.stress.cols() : 0);
      forEachBlock(model_.bodies[b].points(), system_.threads(), [&](int begin, int end) {
        const auto part = [&](auto& all) { return all.middleCols(begin, end - begin); };
        part(step.stress) = last ? Matrix(part(body.stress) - part(step.stress))
                                 : Matrix(part(step.stress) - part(body.stress));
        if (!strains) return;
        // What the elastic part leaves of the strain of the step.
        material.elasticStrain(step.stress, elastic, begin, end);
        part(body.viscoplasticStrain) += part(step.strain) - part(elastic);
        if (!shift_.empty()) part(body.viscoplasticStrain) += part(shift_[b]);
      });
      if (strains) {
        dropIfVanishing(body.stress);
        dropIfVanishing(body.viscoplasticStrain);
      }
      increments.push_back({std::move(step.increment), std::move(step.stress)});
    }
    if (!guarded_) memory_.increments.push_back(std::move(increments));
  }
  state_.contactForce = std::move(solutions_.back().contactForce);
  state_.frictionForce = std::move(solutions_.back().frictionForce);
  for (Vector& force : state_.contactForce) dropIfVanishing(force);
  for (Vector& force : state_.frictionForce) dropIfVanishing(force);
  state_.slipping = std::move(solutions_.back().slipping);
  state_.tieForce = std::move(solutions_.back().tieForce);
  state_.time = t1_;
  active_ = std::move(solutions_.back().active);
  solutions_.clear();
  if (follows()) follow(model_, displacementsOf(state_), true);  // supports were sums of increments
}

}  // namespace mortier
