#include "solution.h"

#include <cmath>
#include <mutex>
#include <shared_mutex>

#include "report/clock.h"

namespace mortier::python {

namespace {

/// Of max_seconds there is one in the process (base/interrupt.h): a run that has them has no other beside it.
std::shared_mutex timeLimit;

/// What is kept of a march.
struct Record {
  std::vector<std::vector<HistoryValue>> rows;
  std::vector<std::shared_ptr<Step>> kept;

  std::shared_ptr<Step> stepOf(const std::shared_ptr<Attempt>& attempt, const StepReport& report,
                               const State& state) const {
    return std::make_shared<Step>(
        Step{attempt, report, hasRow(report) ? rows.back() : std::vector<HistoryValue>(), state});
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

Solution solveScene(const Scene& scene, const RunOptions& options, bool keepAll,
                    const std::function<void(std::shared_ptr<Step>)>& onStep) {
  std::unique_lock exclusive(timeLimit, std::defer_lock);
  std::shared_lock shared(timeLimit, std::defer_lock);
  if (std::isfinite(scene.resolved.description.accuracy.maxSeconds))
    exclusive.lock();
  else
    shared.lock();
  beginClock();
  Run run(scene.resolved, options);
  static_cast<void>(run.settle());
  run.open();
  std::map<std::shared_ptr<const Attempt>, Record>
      records;  // of the best round and of the one that is solved
  run.solve([&](const std::shared_ptr<Attempt>& now, const State& state, const StepReport& report) {
    if (report.step == 0) {
      std::erase_if(records, [&](const auto& each) { return each.first != run.attempt(); });
      records[now] = {};
    }
    Record& record = records[now];
    if (hasRow(report)) record.rows.push_back(historyRow(report));
    const int every = keepAll ? 1 : now->scene().every;
    if (onStep) {
      const std::shared_ptr<Step> step = record.stepOf(now, report, state);
      shared.unlock();
      onStep(step);
      shared.lock();
    } else if (every > 0 && report.step % every == 0) {
      record.kept.push_back(record.stepOf(now, report, state));
    }
  });

  Solution solution;
  solution.ending = run.finish();
  solution.folder = run.folder();
  solution.summary = run.summary();
  const std::shared_ptr<Attempt>& best = run.attempt();
  Record& record = records[best];
  const StepReport& last = best->solved.last;
  if (record.kept.empty() || record.kept.back()->report.step != last.step)
    record.kept.push_back(record.stepOf(best, last, best->solved.state));
  solution.history = columnsOf(*best, record);
  solution.steps = std::move(record.kept);
  return solution;
}

}  // namespace mortier::python
