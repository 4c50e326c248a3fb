#include "report/accuracy.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/formatted.h"

namespace mortier {
namespace {

/// Below this part of the largest energy of a run an error, squared, is rounding.
constexpr double negligible = 1e-24;

}  // namespace

bool AccuracyRecord::needs(const StepReport& report, bool kept) const {
  constexpr double often = 2;
  const bool solved = report.step > 0 || report.energy > 0;  // nothing may act in the first state
  return solved && (kept || report.energy > often * memory_.energy);
}

void AccuracyRecord::add(const StepReport& report, bool kept) {
  if (!needs(report, kept)) return;
  memory_.energy = std::max(memory_.energy, report.energy);
  double error = 0;
  for (const ErrorEstimate& estimate : *error_.estimates()) error += estimate.error.sum();
  if (!(error > memory_.error)) return;
  memory_.error = error;
  memory_.time = report.time;
}

namespace {

/// The largest value of the run that is of the kind of a quantity; none where none is known. Moments are
/// those of the largest force about an end of the body.
double largestLike(const Quantity& quantity, const Model& model, const Peaks& peaks) {
  using Kind = Quantity::Kind;
  switch (quantity.kind) {
    case Kind::displacement:
      return peaks.displacement.value;
    case Kind::storedEnergy:
      return peaks.energy.value;
    case Kind::largestMises:
      return peaks.vonMises.value;
    case Kind::largestPressure:
    case Kind::meanPressure:
      return peaks.pressure.value;
    case Kind::reaction:
    case Kind::contactForce:
      return peaks.contactForce.value *
             (isMoment(quantity.component) ? model.bodies[quantity.body].extent() : 1);
    default:
      return 0;
  }
}

/// An estimate is a product of two that are small: it is none where the stress itself is not known, and where
/// it is far above all values of its kind.
void dropUnknown(double relative, const Model& model, const Peaks& peaks,
                 const std::vector<Quantity>& quantities, const std::vector<double>& values,
                 std::vector<QuantityError>& errors) {
  constexpr double most = 10;
  for (size_t i = 0; i < errors.size() && i < values.size(); ++i) {
    const double largest = std::max(std::abs(values[i]), largestLike(quantities[i], model, peaks));
    if (relative > 1)
      withdraw(errors[i], values[i],
               formatted("the estimated error of the stress is %.0f %%", 100 * relative));
    else if (largest > 0 && errors[i].size > most * largest)
      withdraw(errors[i], values[i], "its estimate is more than ten times all values of its kind");
  }
}

}  // namespace

Accuracy AccuracyRecord::atEnd(const Peaks& peaks, std::vector<QuantityError> quantities,
                               const std::vector<Quantity>& of, const std::vector<double>& values) {
  const double largestEnergy = 2 * peaks.energy.value;
  Accuracy result;
  double error = 0;
  double energy = 0;
  double largest = 0;
  double allRounding = negligible * largestEnergy;
  const CurrentMeshError::Estimates estimates = error_.estimates();
  for (const ErrorEstimate& estimate : *estimates) energy += estimate.energy;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const ErrorEstimate& estimate = (*estimates)[b];
    const double rounding = error_.roundingOf(b, peaks.displacement.value);
    allRounding += rounding;
    const double nothing = rounding + negligible * largestEnergy;
    const bool real = estimate.error.sum() > nothing;
    // The energy of a body without stress is rounding: its error is over that of all bodies.
    const double own = estimate.energy > nothing ? estimate.energy : energy;
    result.bodies.push_back(real && own > 0 ? std::sqrt(estimate.error.sum() / own) : 0);
    if (!real) continue;
    error += estimate.error.sum();
    Eigen::Index worst = 0;
    if (!(estimate.error.maxCoeff(&worst) > largest)) continue;
    largest = estimate.error[worst];
    result.worstBody = model_.bodies[b].name();
    result.worst = model_.bodies[b].centreOf(static_cast<size_t>(worst));
  }
  result.all = energy > 0 ? std::sqrt(error / energy) : 0;
  result.time = result.largestTime = error_.state().time;
  double most = error;
  if (memory_.error > error) {
    most = memory_.error;
    result.largestTime = memory_.time;
  }
  result.quantities = std::move(quantities);
  if (result.all == 0)
    for (QuantityError& each : result.quantities) each.size = 0;
  dropUnknown(result.all, model_, peaks, of, values, result.quantities);
  result.largest = largestEnergy > 0 && most > allRounding ? std::sqrt(most / largestEnergy) : 0;
  return result;
}

std::optional<double> overExact(double error, double norm) {
  if (error == 0) return 0;
  return error < norm ? std::optional(error / (norm - error)) : std::nullopt;
}

std::optional<RoundChange> changeInRounds(const RunFacts& facts, size_t quantity) {
  constexpr double noticeable = 0.05;  // of the value, a round
  constexpr double hardlyLess = 0.5;   // than the change of the round before
  if (facts.best < 1 || facts.rounds.size() <= facts.best) return {};
  const auto at = [&](size_t round) { return facts.rounds[round].quantities[quantity]; };
  const double last = at(facts.best) - at(facts.best - 1);
  RoundChange change{std::abs(last)};
  const Quantity::Kind kind = facts.quantities[quantity].kind;
  if (facts.best > 1 && (kind == Quantity::Kind::largestPressure || kind == Quantity::Kind::largestMises)) {
    const double before = at(facts.best - 1) - at(facts.best - 2);
    change.grows = before > noticeable * at(facts.best - 2) && last > noticeable * at(facts.best - 1) &&
                   last > hardlyLess * before;
  }
  return change;
}

QuantityError errorOf(const RunFacts& facts, const Accuracy& accuracy, size_t quantity) {
  if (accuracy.quantities.empty()) return {0, "the run is not complete", 0};
  QuantityError error = accuracy.quantities[quantity];
  const Quantity& of = facts.quantities[quantity];
  const bool summed = needsWork(of) || of.kind == Quantity::Kind::frictionWork;  // known by rounds alone
  if (facts.rounds.empty() || (!error.obstacle.empty() && !summed)) return error;
  const std::optional<RoundChange> change = changeInRounds(facts, quantity);
  if (!change) return {0, "there is one round only", 0};
  if (change->grows) return {0, "it grows with every round: stresses are unbounded there", 0};
  return {std::max(change->size, error.size), "", 0};
}

}  // namespace mortier
