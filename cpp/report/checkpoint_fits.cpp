#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "report/checkpoint_members.h"

namespace mortier {

namespace {

/// The sizes of all matrices and lists in a value, in their order, and whether all of its numbers are finite:
/// an archive that members are visited by.
struct Shape {
  std::vector<size_t> sizes;
  bool finite = true;

  template <class... T>
  void operator()(T&... values) {
    (add(values), ...);
  }

 private:
  void add(double value) { finite = finite && std::isfinite(value); }
  void add(signed char value) { finite = finite && std::abs(value) <= 1; }  // of what slips
  template <int Columns>
  void add(Eigen::Matrix<double, Eigen::Dynamic, Columns>& m) {
    sizes.insert(sizes.end(), {static_cast<size_t>(m.rows()), static_cast<size_t>(m.cols())});
    finite = finite && m.allFinite();
  }
  template <class T>
  void add(std::vector<T>& values) {
    sizes.push_back(values.size());
    for (T& value : values) add(value);
  }
  template <class T>
  void add(T& value) {
    visitMembers(*this, value);
  }
};

/// Of the same shape as a value of the model, and finite.
template <class T>
bool isLike(const T& value, const T& ofModel) {
  Shape one;
  Shape other;
  one(const_cast<T&>(value));  // one list of members serves reading and writing
  other(const_cast<T&>(ofModel));
  return one.finite && one.sizes == other.sizes;
}

bool isTime(double time) {
  return std::isfinite(time) && time >= 0;
}

bool isStatus(Status status) {
  return status == Status::converged || status == Status::failed || status == Status::unheld;
}

}  // namespace

void requireFits(const Checkpoint& checkpoint, const Model& model, const std::string& folder,
                 size_t quantities) {
  const auto require = [&](bool fits, const char* what) {
    if (!fits)
      throw InputError(folder + "/" + checkpointName + ": its " + what +
                       " is not one of this scene, expected a checkpoint that this program wrote");
  };
  const State begin = initialState(model);
  const auto& [identity, empty, files, last, state, memory, accuracy] = checkpoint;
  require(isTime(state.time) && isTime(last.time) && last.step >= 0 && last.step == memory.run.steps, "time");
  const auto requireState = [&](const State& given) {
    require(isLike(given, begin) && isTime(given.frictionWork) &&
                std::all_of(given.frictionWorkOf.begin(), given.frictionWorkOf.end(), isTime),
            "state");
  };
  requireState(state);
  require(memory.controller.trial >= 0, "trial");
  if (memory.controller.trial > 0) requireState(memory.controller.start);
  std::vector<BodyIncrement> increments;
  std::vector<Matrix> stresses;
  for (const BodyState& body : begin.bodies) {
    increments.push_back({{body.displacement, body.displacement}, body.stress});
    stresses.push_back(body.stress);
  }
  require(std::all_of(memory.increments.begin(), memory.increments.end(),
                      [&](const auto& stage) { return isLike(stage, increments); }),
          "increment");
  const auto isPerBody = [&](const std::vector<char>& flags) {
    return flags.empty() || flags.size() == begin.bodies.size();
  };
  require(isPerBody(memory.solver.enginesGivenUp) && isPerBody(memory.solver.elasticFactors),
          "solver memory");
  require(isTime(memory.begin) && isTime(memory.timeStep) && isTime(memory.controller.timeStep) &&
              isTime(memory.controller.local),
          "step length");
  require(memory.controller.strain.empty() || isLike(memory.controller.strain, stresses), "error in time");
  for (const SlipAndWork& error : {memory.controller.slip, memory.controller.missed})
    require((error.slip.empty() || isLike(error.slip, begin.frictionForce)) && std::isfinite(error.work) &&
                (error.strain.empty() || isLike(error.strain, stresses)),
            "error in time");
  require(isTime(memory.controller.pairEnd), "step length");
  require(isTime(accuracy.energy) && isTime(accuracy.error) && isTime(accuracy.time), "accuracy");
  require(memory.run.quantities.size() == quantities &&
              (last.quantities.empty() || last.quantities.size() == quantities),
          "number of quantities");
  require(isStatus(last.status) && isStatus(memory.run.status), "status");
}

}  // namespace mortier
