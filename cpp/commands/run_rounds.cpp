// The rounds of a run that is to have an accuracy (adapt/rounds.h), and the best of them: a round that comes
// out worse, cannot be solved, or is not done when the time is over, leaves the best one's result as it was.
#include <algorithm>
#include <filesystem>
#include <new>
#include <utility>

#include "adapt/unclear_contact.h"
#include "base/error.h"
#include "base/formatted.h"
#include "base/interrupt.h"
#include "commands/run.h"
#include "report/clock.h"
#include "report/result_files.h"

namespace mortier {
namespace {

void removeFields(const std::string& folder, const std::map<std::string, FileRecord>& files) {
  std::error_code none;  // what stays is no part of the result
  for (const auto& [name, record] : files)
    if (std::filesystem::path(name).extension() == ".vtu")  // others are written anew
      std::filesystem::remove(std::filesystem::path(folder) / name, none);
}

/// Work of a round: whatever fails in it that the scene's own data cannot explain ends the rounds and not the
/// run. \returns the reason, empty where there is none
std::string failureOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  } catch (const UnheldBodyError& error) {
    return error.what();
  } catch (const TimeIsUp&) {
    return timeIsUp;
  } catch (const std::bad_alloc&) {
    return "there is no memory for it";
  }
  return "";
}

/// The error of the quantity that is aimed at, as far as it is known.
AimedError aimOf(const Attempt& round) {
  const std::vector<Quantity>& quantities = round.facts.quantities;
  const auto at = std::find_if(quantities.begin(), quantities.end(),
                               [&](const Quantity& each) { return each.name == round.facts.aim; });
  const EnergyBound& bound = *round.solved.accuracy.bound;
  if (bound.quantities.empty()) return {bound.obstacle, 0, 0, false, {}};
  const Enclosure& enclosure = bound.quantities[at - quantities.begin()];
  const double value = evaluate({*at}, *round.model, round.solved.state)[0];
  const bool proved = enclosure.obstacle.empty();
  if (!proved && !enclosure.estimate) return {enclosure.obstacle, value, 0, false, {}};
  return {"", value, proved ? enclosure.error(value) : *enclosure.estimate, proved, enclosure.parts};
}

bool neverTouches(const RunReport& report) {
  return report.peaks.contactForce.value == 0;
}

bool overlaps(const Attempt& round) {
  const RunReport& report = round.solved.report;
  const bool space = round.model->bodies.front().dimension() == 3;
  return report.overlap.refused() || ((space || neverTouches(report)) && !report.overlap.explained);
}

}  // namespace

Rounds::Verdict Run::solveRound(const std::shared_ptr<Attempt>& attempt, std::vector<RoundFacts>& done) {
  Attempt& round = *attempt;
  double begin = 0;
  for (const RoundFacts& before : done) begin += before.seconds;
  ErrorHistory errors(*round.model, *round.error);
  round.facts.rounds = done;
  march(attempt, [&](const State&, const StepReport& report) { errors.add(report); });
  if (round.solved.report.status != Status::converged) return Rounds::Verdict::notReached;
  const double end = processSeconds();
  const double time = round.solved.report.timeError;
  RoundResult result{errors.errors(), errors.energy(), time, end - begin};
  if (const BodyOverlap& overlap = round.solved.report.overlap; overlaps(round))
    result.missed = {overlap.bodies, overlap.drawn, neverTouches(round.solved.report)};
  else if (std::optional<MissedContact> unclear = unclearContact(*round.model, round.solved.state)) {
    unclear->all = neverTouches(round.solved.report);
    result.missed = unclear;
  }
  if (!round.facts.aim.empty()) {
    round.solved.accuracy.bound = boundOf(round);
    result.aim = aimOf(round);
  } else if (round.scene().accuracy.bound) {
    result.bound = [&]() -> std::optional<double> {
      const EnergyBound& bound = round.solved.accuracy.bound.emplace(boundOf(round));
      return bound.obstacle.empty() ? std::optional(bound.relative()) : std::nullopt;
    };
  }
  const Rounds::Verdict verdict = rounds_->judge(result, end);
  RoundFacts facts{0,
                   0,
                   round.solved.report.steps,
                   rounds_->meshError(),
                   time,
                   end - begin,
                   evaluate(round.facts.quantities, *round.model, round.solved.state)};
  for (const Body& body : round.model->bodies) {
    facts.elements += body.elements();
    facts.unknowns += body.freeDofs();
  }
  round.facts.best = done.size();
  done.push_back(std::move(facts));
  log_.print(logRound(done));
  return verdict;
}

void Run::solveRounds() {
  const TimeLimit limit(attempt_->scene().accuracy.maxSeconds - processSeconds());
  std::vector<RoundFacts> done;
  const auto error = [&](const Attempt& of) { return done[of.facts.best].mesh + done[of.facts.best].time; };

  Rounds::Verdict verdict = solveRound(attempt_, done);
  if (attempt_->solved.report.status != Status::converged) return;
  bool aside = false;  // where the files of the best one are
  while (verdict == Rounds::Verdict::goOn && shortfall_.empty()) {
    if (!aside) {
      keepAside(temporary_, attempt_->solved.files);
      removeFields(temporary_, attempt_->solved.files);
    }
    aside = true;
    std::shared_ptr<Attempt> next;
    shortfall_ = failureOf([&] {
      next = std::make_shared<Attempt>(rounds_->scene(), options_.threads);
      verdict = solveRound(next, done);
    });
    if (shortfall_.empty()) shortfall_ = next->solved.report.reason;
    if (!shortfall_.empty()) {
      shortfall_.insert(0, "round " + std::to_string(done.size() + 1) + ": ");
    } else if (verdict == Rounds::Verdict::reached || overlaps(*next) < overlaps(*attempt_) ||
               (overlaps(*next) == overlaps(*attempt_) && error(*next) <= error(*attempt_))) {
      attempt_ = std::move(next);
      aside = false;
    } else {
      removeFields(temporary_, next->solved.files);
    }
  }
  if (verdict == Rounds::Verdict::notReached && shortfall_.empty()) shortfall_ = rounds_->reason();
  if (aside) bringBack(temporary_, attempt_->solved.files);
  attempt_->facts.rounds = std::move(done);
  if (!overlaps(*attempt_)) return;
  RunReport& report = attempt_->solved.report;
  report.status = Status::failed;
  report.reason = formatted("t = %g: ", report.overlap.time) + report.overlap.words;
}

}  // namespace mortier
