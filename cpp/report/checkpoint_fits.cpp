#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "bound/matched_meshes.h"
#include "report/checkpoint.h"
#include "report/checkpoint_files.h"

namespace mortier {

namespace {

/// Of the same shape, and finite.
template <class Values>
bool isLike(const Values& values, const Values& model) {
  return values.rows() == model.rows() && values.cols() == model.cols() && values.allFinite();
}

template <class Values>
bool areLike(const std::vector<Values>& values, const std::vector<Values>& model) {
  return std::equal(values.begin(), values.end(), model.begin(), model.end(), isLike<Values>);
}

bool isLike(const BodyState& body, const BodyState& model) {
  const auto& [external, contact, dissipated, thermal] = body.work;
  return isLike(body.displacement, model.displacement) && isLike(body.stress, model.stress) &&
         isLike(body.viscoplasticStrain, model.viscoplasticStrain) && std::isfinite(external) &&
         std::isfinite(contact) && std::isfinite(dissipated) && std::isfinite(thermal) &&
         isLike(body.thermalStrain, model.thermalStrain);
}

bool isLike(const BodyIncrement& increment, const BodyState& model) {
  return isLike(increment.displacement.high, model.displacement) &&
         isLike(increment.displacement.low, model.displacement) && isLike(increment.stress, model.stress);
}

template <class Parts>
bool oneABody(const Parts& parts, const std::vector<BodyState>& model) {
  return std::equal(parts.begin(), parts.end(), model.begin(), model.end(),
                    [](const auto& part, const BodyState& body) { return isLike(part, body); });
}

bool isSlipping(const std::vector<signed char>& signs, const std::vector<signed char>& model) {
  return signs.size() == model.size() &&
         std::all_of(signs.begin(), signs.end(), [](signed char sign) { return sign >= -1 && sign <= 1; });
}

bool isTime(double time) {
  return std::isfinite(time) && time >= 0;
}

bool isCourse(const ErrorCourse& course) {
  const auto areSums = [](const std::vector<double>& all) {
    return std::all_of(all.begin(), all.end(), [](double each) { return each >= 0; });
  };
  return course.growth >= 0 && course.misfit >= 0 && course.drift >= 0 && !course.lengths.empty() &&
         course.lengths.size() == course.sums.size() && areSums(course.lengths) && areSums(course.sums);
}

/// Stresses by the triangles of the matched meshes; none where nothing is bounded.
bool fitsBodies(const std::vector<Matrix>& stress, const Model& model) {
  if (stress.empty()) return true;
  const MatchedMeshes meshes = matchedMeshes(model);
  if (stress.size() != model.bodies.size() || !meshes.obstacle.empty()) return false;
  for (size_t b = 0; b < stress.size(); ++b)
    if (stress[b].rows() != model.bodies[b].material().components() ||
        stress[b].cols() != static_cast<Eigen::Index>(meshes.bodies[b].parents.size()) ||
        !stress[b].allFinite())
      return false;
  return true;
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
    require(oneABody(given.bodies, begin.bodies), "state");
    require(areLike(given.contactForce, begin.contactForce), "contact force");
    require(areLike(given.gap, begin.gap), "gap");
    require(areLike(given.frictionForce, begin.frictionForce) && isTime(given.frictionWork) &&
                given.frictionWorkOf.size() == begin.frictionWorkOf.size() &&
                std::all_of(given.frictionWorkOf.begin(), given.frictionWorkOf.end(), isTime) &&
                std::equal(given.slipping.begin(), given.slipping.end(), begin.slipping.begin(),
                           begin.slipping.end(), isSlipping),
            "friction");
    require(std::isfinite(given.gapWork), "work of distances");
  };
  requireState(state);
  require(memory.controller.trial >= 0, "trial");
  if (memory.controller.trial > 0) requireState(memory.controller.start);
  require(std::all_of(memory.increments.begin(), memory.increments.end(),
                      [&](const auto& stage) { return oneABody(stage, begin.bodies); }),
          "increment");
  const auto isPerBody = [&](const std::vector<char>& flags) {
    return flags.empty() || flags.size() == begin.bodies.size();
  };
  require(isPerBody(memory.solver.libraries) && isPerBody(memory.solver.elasticFactors), "solver memory");
  require(isTime(memory.begin) && isTime(memory.timeStep) && isTime(memory.controller.timeStep) &&
              isTime(memory.controller.local),
          "step length");
  const std::vector<Matrix>& strain = memory.controller.strain;
  require(strain.empty() || std::equal(strain.begin(), strain.end(), begin.bodies.begin(), begin.bodies.end(),
                                       [](const Matrix& a, const BodyState& b) {
                                         return a.rows() == b.stress.rows() && a.cols() == b.stress.cols();
                                       }),
          "error in time");
  for (const SlipAndWork& error : {memory.controller.slip, memory.controller.missed})
    require((error.slip.empty() || areLike(error.slip, begin.frictionForce)) && std::isfinite(error.work),
            "error in time");
  require(isTime(memory.controller.pairEnd), "step length");
  require(isTime(accuracy.energy) && isTime(accuracy.error) && isTime(accuracy.time) &&
              isTime(accuracy.flow.begin) && isTime(accuracy.flow.misfit) && isTime(accuracy.flow.opening) &&
              accuracy.flow.growth >= 0,
          "accuracy");
  require(isCourse(accuracy.total.fixed) && isCourse(accuracy.total.any) &&
              fitsBodies(accuracy.total.stress, model),
          "bound");
  require(memory.run.quantities.size() == quantities &&
              (last.quantities.empty() || last.quantities.size() == quantities),
          "number of quantities");
  require(isStatus(last.status) && isStatus(memory.run.status), "status");
}

}  // namespace mortier
