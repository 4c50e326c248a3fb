#include "solution.h"

#include <cmath>
#include <mutex>
#include <shared_mutex>

#include "adapt/rounds.h"
#include "base/interrupt.h"
#include "commands/solve_rounds.h"
#include "report/clock.h"
#include "report/summary.h"
#include "scene/build.h"
#include "scene/document.h"

namespace mortier::python {

namespace {

/// Of max_seconds there is one in the process (base/interrupt.h): a run that has them has no other beside it.
std::shared_mutex timeLimit;

/// What a march leaves behind.
struct Record {
  std::vector<std::vector<HistoryValue>> rows;
  std::vector<Step> kept;

  void keep(const StepReport& report, const State& state) {
    kept.push_back({{}, report, hasRow(report) ? rows.back() : std::vector<HistoryValue>(), state});
  }
};

/// Where the result goes, a folder or memory alone, and what belongs to it.
struct Output {
  std::unique_ptr<OutputFolder> folder;
  std::string temporary;  ///< empty: in memory alone
  Checkpoints checkpoints;
  Log quiet;
  bool inRounds;
  std::string again;

  Output(const RunOptions& options, const Attempt& first)
      : folder(options.out.empty() ? nullptr : std::make_unique<OutputFolder>(options.out)),
        temporary(folder ? folder->temporary() : ""),
        checkpoints(temporary, options.checkpoint,
                    folder ? identityOf(first.scene(), *first.model) : RunIdentity()),
        quiet(true, first.scene().time.end),
        inRounds(first.scene().accuracy.asked() > 0),
        again("; mortier run --restart " + options.out +
              (inRounds ? " begins the rounds again" : " goes on")) {}

  Solved solve(Attempt& attempt, const Observer& observe) {
    return mortier::solve({attempt.scene(),
                           *attempt.model,
                           attempt.solvedModel(),
                           *attempt.error,
                           attempt.facts,
                           temporary,
                           quiet,
                           attempt.state,
                           {},
                           checkpoints,
                           again,
                           observe,
                           inRounds});
  }
};

std::vector<std::pair<std::string, HistoryColumn>> columnsOf(const Attempt& attempt, const Record& record) {
  const std::vector<std::string> names =
      historyColumns(*attempt.model, attempt.facts.quantities, attempt.facts.units);
  std::vector<std::pair<std::string, HistoryColumn>> columns;
  for (size_t c = 0; c < names.size(); ++c) {
    HistoryColumn column = std::vector<double>();
    const auto fill = [&]<class Value>(const Value& /*first*/) {
      std::vector<Value> values;
      for (const auto& row : record.rows) values.push_back(std::get<Value>(row[c]));
      column = std::move(values);
    };
    if (!record.rows.empty()) std::visit(fill, record.rows.front()[c]);
    columns.emplace_back(names[c], std::move(column));
  }
  return columns;
}

}  // namespace

Solution solveScene(const Scene& scene, const RunOptions& options,
                    const std::function<void(std::shared_ptr<Step>)>& onStep) {
  std::unique_lock alone(timeLimit, std::defer_lock);
  std::shared_lock besideOthers(timeLimit, std::defer_lock);
  if (std::isfinite(scene.resolved.description.accuracy.maxSeconds))
    alone.lock();
  else
    besideOthers.lock();
  beginClock();
  ResolvedScene resolved = scene.resolved;
  std::optional<Rounds> rounds = beginRounds(resolved);
  const AttemptOptions forAttempt{options.threads};
  auto first = std::make_unique<Attempt>(std::move(resolved), forAttempt);
  findInitialEquilibrium(first->scene(), *first->model, first->state);
  Output output(options, *first);

  std::shared_ptr<Attempt> attempt;
  std::map<const Attempt*, Record> records;
  const auto solveIt = [&](Attempt& now, const Observer& alsoObserve) {
    Record& record = records[&now];
    const int every = options.keepAll ? 1 : now.scene().every;
    const Observer observe = [&](const State& state, const StepReport& report) {
      if (report.step == 0) record = {};
      if (hasRow(report)) record.rows.push_back(historyRow(report));
      if (onStep) {
        record.keep(report, state);
        record.kept.back().of = attempt;
        const auto step = std::make_shared<Step>(std::move(record.kept.back()));
        record.kept.clear();
        besideOthers.unlock();
        onStep(step);
        besideOthers.lock();
      } else if (every > 0 && report.step % every == 0) {
        record.keep(report, state);
      }
      if (alsoObserve) alsoObserve(state, report);
    };
    now.solved = output.solve(now, observe);
    const Solved& solved = now.solved;
    if (record.kept.empty() || record.kept.back().report.step != solved.last.step)
      record.keep(solved.last, solved.state);
  };
  std::string shortfall;
  if (rounds) {
    shortfall = solveRounds(*rounds, first, forAttempt, output.temporary, output.quiet, solveIt);
    attempt = std::move(first);
  } else {
    attempt = std::move(first);
    solveIt(*attempt, {});
    shortfall = attempt->solved.report.shortfall;
  }

  Solution solution;
  addVerdict(*attempt, rounds ? &*rounds : nullptr, shortfall);
  if (output.folder) solution.folder = putInPlace(*attempt, *output.folder);
  const Solved& solved = attempt->solved;
  solution.summary = output.folder ? readSceneText(solution.folder + "/summary.json")
                                   : summaryText("summary", attempt->facts, *attempt->model, solved.state,
                                                 solved.last, solved.report, solved.accuracy);
  solution.ending = endingOf(*attempt, shortfall, solution.folder);
  Record& record = records.at(attempt.get());
  solution.history = columnsOf(*attempt, record);
  for (Step& kept : record.kept) {
    kept.of = attempt;
    solution.steps.push_back(std::make_shared<Step>(std::move(kept)));
  }
  return solution;
}

}  // namespace mortier::python
