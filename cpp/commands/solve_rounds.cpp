#include "commands/solve_rounds.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <utility>

#include "adapt/error_history.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "commands/bound_of.h"
#include "report/clock.h"

namespace mortier {
namespace {

void clearFields(const std::string& folder, const std::map<std::string, FileRecord>& files) {
  std::error_code none;  // what stays is no part of the result
  for (const auto& [name, record] : files)
    if (std::filesystem::path(name).extension() == ".vtu")  // others are written anew
      std::filesystem::remove(std::filesystem::path(folder) / name, none);
}

/// What its own data cannot explain: it may go on without the round. \returns the reason, empty where there
/// is none
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

}  // namespace

std::optional<Rounds> beginRounds(ResolvedScene& resolved) {
  if (!(resolved.description.accuracy.asked() > 0)) return std::nullopt;
  Rounds rounds(std::move(resolved));
  resolved = rounds.scene();
  return rounds;
}

std::string solveRounds(Rounds& rounds, std::unique_ptr<Attempt>& attempt, const AttemptOptions& options,
                        const std::string& folder, Log& log, const SolveAttempt& solve) {
  const TimeLimit limit(attempt->scene().accuracy.maxSeconds - processSeconds());
  std::vector<RoundFacts> done;
  Rounds::Verdict verdict = Rounds::Verdict::goOn;
  double begin = 0;
  const auto march = [&](Attempt& round) {
    ErrorHistory errors(*round.model, *round.error);
    round.facts.rounds = done;
    solve(round, [&](const State&, const StepReport& report) { errors.add(report); });
    if (round.solved.report.status != Status::converged) return;
    const double end = processSeconds();
    const double time = round.solved.report.timeError;
    RoundResult result{errors.errors(), errors.energy(), time, end - begin};
    if (!round.facts.aim.empty()) {
      round.solved.accuracy.bound = boundOf(round);
      result.aim = aimOf(round);
    } else if (round.scene().accuracy.bound)
      result.bound = [&]() -> std::optional<double> {
        const EnergyBound& bound = round.solved.accuracy.bound.emplace(boundOf(round));
        return bound.obstacle.empty() ? std::optional(bound.relative()) : std::nullopt;
      };
    verdict = rounds.judge(result, end);
    round.facts.best = done.size();
    done.push_back({round.triangles(), round.unknowns(), round.solved.report.steps, rounds.meshError(), time,
                    end - begin, evaluate(round.facts.quantities, *round.model, round.solved.state)});
    log.print(logRound(done));
    begin = end;
  };
  const auto error = [&](const Attempt& of) { return done[of.facts.best].mesh + done[of.facts.best].time; };

  march(*attempt);
  if (attempt->solved.report.status != Status::converged) return "";
  std::unique_ptr<Attempt> best = std::move(attempt);
  std::string shortfall;
  bool aside = false;  // where the best one's files are
  while (verdict == Rounds::Verdict::goOn && shortfall.empty()) {
    if (!aside) keepAside(folder, best->solved.files);
    if (!aside) clearFields(folder, best->solved.files);
    aside = true;
    shortfall = failureOf([&] {
      attempt = std::make_unique<Attempt>(rounds.scene(), options);
      march(*attempt);
    });
    if (shortfall.empty()) shortfall = attempt->solved.report.reason;
    if (!shortfall.empty()) {
      shortfall.insert(0, "round " + std::to_string(done.size() + 1) + ": ");
    } else if (verdict == Rounds::Verdict::reached || error(*attempt) <= error(*best)) {
      best = std::move(attempt);
      aside = false;
    } else {
      clearFields(folder, attempt->solved.files);
    }
  }
  if (verdict == Rounds::Verdict::notReached) shortfall = rounds.reason();
  if (aside) bringBack(folder, best->solved.files);
  best->facts.rounds = std::move(done);
  attempt = std::move(best);
  return shortfall;
}

}  // namespace mortier
