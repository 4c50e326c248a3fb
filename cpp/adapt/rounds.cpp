#include "adapt/rounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/digits.h"
#include "base/formatted.h"
#include "base/interrupt.h"
#include "material/deviatoric.h"
#include "plan/loads.h"

namespace mortier {
namespace {

/// An estimate may be this part of the error, so that it has to be below this part of what is asked.
constexpr double leastShare = 0.87;
constexpr double careful = 0.75;  // aims are this part of what is asked
/// By which a round divides the error, about. In space unknowns cost more than rounds do, and meshes of
/// several small steps have fewer.
constexpr double reductionInPlane = 3;
constexpr double reductionInSpace = 2;
constexpr double carefulInSpace = 0.86;

/// The same where a large error is asked for: what the recovered stress misses is of higher order.
double leastOf(double asked) {
  constexpr double small = 0.01;
  constexpr double large = 0.1;
  return leastShare * (1 - 2.5 * (std::clamp(asked, small, large) - small));
}

AdaptedMeshes firstMeshes(const ResolvedScene& scene) {
  const int degree = scene.description.degree;
  if (scene.spaceMeshes.empty()) return {scene.meshes, degree};
  std::vector<CurvedFaces> curves;
  std::vector<TetrahedronMesh> meshes = scene.spaceMeshes;
  for (TetrahedronMesh& mesh : meshes) {
    putOntoGeometry(mesh);
    curves.push_back(curvesBehind(mesh));
    mesh.geometry = {};  // of the first triangles
  }
  return {meshes, std::move(curves), degree};
}

}  // namespace

void ErrorHistory::add(const StepReport& report) {
  if (report.step == 0) {
    largest_.clear();
    for (const Body& body : model_.bodies)
      largest_.emplace_back(Vector::Zero(static_cast<Eigen::Index>(body.elements())));
    largestSum_ = energy_ = displacement_ = 0;
    if (report.vonMises == 0) return;  // nothing acts yet
  }
  double error = 0;
  double energy = 0;
  const CurrentMeshError::Estimates estimates = error_.estimates();
  for (size_t b = 0; b < estimates->size(); ++b) {
    const ErrorEstimate& estimate = (*estimates)[b];
    largest_[b] = largest_[b].cwiseMax(estimate.error);
    error += estimate.error.sum();
    energy += estimate.energy;
  }
  largestSum_ = std::max(largestSum_, error);
  energy_ = std::max(energy_, energy);
  displacement_ = std::max(displacement_, report.displacement);
}

std::vector<Vector> ErrorHistory::errors() const {
  constexpr double negligible = 1e-24;  // of the energy
  double rounding = negligible * energy_;
  double sum = 0;
  for (size_t b = 0; b < largest_.size(); ++b) {
    rounding += error_.roundingOf(b, displacement_);
    sum += largest_[b].sum();
  }
  std::vector<Vector> errors = largest_;
  for (Vector& error : errors) error *= largestSum_ > rounding ? largestSum_ / sum : 0;
  return errors;
}

Rounds::Rounds(ResolvedScene scene)
    : description_(scene.description),
      meshes_(firstMeshes(scene)),
      least_(leastOf(description_.accuracy.energy)) {
  constexpr double firstTolerance = 0.1;
  if (timeShare() > 0) timeTolerance_ = std::max(timeShare(), firstTolerance);
}

double Rounds::timeShare() const {
  return stepsMatter(description_) ? stepTolerance(description_) : 0;
}

ResolvedScene Rounds::scene() const {
  ResolvedScene scene{description_, {}};
  scene.description.time.overlapEnds = false;  // coarse meshes miss contact that finer ones find
  for (size_t b = 0; b < description_.bodies.size(); ++b)
    if (meshes_.inSpace())
      scene.spaceMeshes.push_back(meshes_.spaceMesh(b));
    else
      scene.meshes.push_back(meshes_.mesh(b));
  if (timeTolerance_ > 0) scene.description.time.tolerance = timeTolerance_;
  return scene;
}

Rounds::Verdict Rounds::judge(const RoundResult& result, double seconds) {
  constexpr int mostMissed = 16;
  if (result.missed && result.missed->all) {
    ++done_;
    meshError_ = 0;
    corrected_ = std::numeric_limits<double>::infinity();
    if (++missed_ > mostMissed)
      return stop("meshes that become finer where the bodies overlap find no contact");
    return refine(result, 0, result.seconds, seconds) ? Verdict::goOn : Verdict::notReached;
  }
  if (aims()) return judgeAim(result, seconds);
  const double asked = description_.accuracy.energy;
  double sum = 0;
  for (const Vector& error : result.errors) sum += error.sum();
  meshError_ = result.energy > 0 ? std::sqrt(sum / result.energy) : 0;
  ++done_;
  meshes_.learn(result.errors);
  corrected_ = result.energy > 0 ? std::sqrt((sum + meshes_.unresolved()) / result.energy) : 0;
  const double error = corrected_ + result.time;
  // Bounds of coarse meshes are many times the error, and fall faster.
  const bool far = error > least_ * asked && corrected_ > bounded_ / 2;
  if (!isFirst() && error <= leastOf(asked) * asked && !far && !result.missed) {
    const std::optional<double> bound = result.bound ? result.bound() : std::nullopt;
    if (!bound || *bound <= asked) return Verdict::reached;
    least_ = careful * corrected_ / std::min(*bound, 1.0);
    bounded_ = corrected_;
  }
  const double ofMeshes = least_ * asked - timeShare();

  if (corrected_ > 0) sizes_.emplace_back(meshes_.unknowns(), corrected_);

  // The steps alone are too long.
  const bool lastSteps = timeTolerance_ <= timeShare();
  if (!isFirst() && corrected_ <= ofMeshes && !result.missed) {
    if (lastSteps)
      return stop("the error of the steps, " + digits(100 * result.time) + " %" + ", does not fall");
    timeTolerance_ = timeShare();
    return Verdict::goOn;
  }
  return goOn(result, ofMeshes, seconds);
}

Rounds::Verdict Rounds::judgeAim(RoundResult result, double seconds) {
  const AimedError& aim = *result.aim;
  ++done_;
  corrected_ = std::numeric_limits<double>::infinity();
  if (!aim.obstacle.empty()) return stop(aim.obstacle);
  const double size = std::abs(aim.value);
  if (size == 0 && aim.error > 0) return stop("the quantity is 0, which no relative error is of");
  double sum = 0;
  for (const Vector& part : aim.parts) sum += part.sum();
  result.errors = aim.parts;
  for (Vector& part : result.errors) part *= sum > 0 ? aim.error / sum : 0;
  result.energy = size;
  meshError_ = corrected_ = size > 0 ? std::sqrt(aim.error / size) : 0;
  meshes_.learn(result.errors);
  const double asked = std::sqrt(description_.accuracy.tolerance);
  least_ = aim.proved ? 1 : leastShare;
  if ((aim.proved || !isFirst()) && corrected_ <= least_ * asked && !result.missed) return Verdict::reached;
  return goOn(result, least_ * asked, seconds);
}

Rounds::Verdict Rounds::goOn(const RoundResult& result, double ofMeshes, double seconds) {
  constexpr double short_ = 2;
  constexpr double stalled = 0.9;
  constexpr int few = 2000;  // unknowns, of which a round costs next to nothing
  const int often = meshError_ > 1 || meshes_.unknowns() < few ? 6 : 4;
  constexpr double first = 0.7;
  constexpr double last = 0.9;
  // On coarse meshes a round may fall short, as bodies that touch between their nodes do so on finer meshes
  // only: more often where the meshes are small or the error is larger than the solution.
  const bool fell = meshError_ < stalled * lowest_;
  lowest_ = std::min(lowest_, meshError_);
  if (!std::isfinite(meshError_)) return stop("no stress of finite energy meets the data");
  shortfalls_ = aim_ > 0 && meshError_ > short_ * aim_ && !fell ? shortfalls_ + 1 : 0;
  if (shortfalls_ >= often) return stop("the error does not fall as it should");
  const bool space = meshes_.inSpace();
  const double excess = corrected_ / ((space ? carefulInSpace : careful) / leastShare * ofMeshes);
  const double reduction = space ? reductionInSpace : reductionInPlane;
  const double toCome = std::max(1.0, std::round(std::log(excess) / std::log(reduction)));
  const double factor = std::clamp(std::pow(excess, -1 / toCome), 1.0 / 8, isFirst() ? first : last);
  double cost = result.seconds;
  if (timeTolerance_ > 0) {
    constexpr double part = 0.4;
    const double order =
        description_.time.scheme == Scheme::backwardEuler || hasFriction(description_) ? 1 : 2;
    const double steps = timeTolerance_;
    timeTolerance_ =
        toCome > 1 ? std::max(timeShare(), std::min(timeTolerance_, part * meshError_)) : timeShare();
    cost *= std::pow(steps / timeTolerance_, 1 / order);  // as steps get shorter
  }
  return refine(result, factor * meshError_, cost, seconds) ? Verdict::goOn : Verdict::notReached;
}

bool Rounds::refine(const RoundResult& result, double aim, double cost, double seconds) {
  constexpr double power = 1.2;  // seconds grow like this power of the unknowns
  constexpr double gain = 0.9;
  const AccuracyGoal& goal = description_.accuracy;
  const int before = meshes_.unknowns();
  const AdaptedMeshes kept = meshes_;
  constexpr const char* tooLong = "a further round would take more than max_seconds";
  try {
    // Where the meshes that are wanted are too large, those that are not.
    for (; aim == 0 || aim <= gain * meshError_ || isFirst(); aim = std::sqrt(aim * meshError_)) {
      meshes_ = kept;
      if (meshError_ > 0)
        meshes_.refine(result.errors, aim * std::sqrt(result.energy));
      else if (!result.missed)
        meshes_.refineAll();
      for (size_t i = 0; result.missed && i < 2; ++i)
        for (int halving = 0; halving < 2; ++halving)
          meshes_.halveAt(bodyIndex(description_, result.missed->bodies[i]), result.missed->places[i]);
      if (done_ == 1 && !meshes_.inSpace())
        for (const ContactDescription& contact : description_.contacts)
          meshes_.faceCorners(bodyIndex(description_, contact.nonmortar().body), contact.nonmortar().label,
                              bodyIndex(description_, contact.mortar().body), contact.mortar().label);
      // Pressures are as coarse as the nonmortar side, however little of the error is in its body.
      if (aims())
        for (const ContactDescription& contact : description_.contacts)
          meshes_.faceSizes(bodyIndex(description_, contact.nonmortar().body), contact.nonmortar().label,
                            bodyIndex(description_, contact.mortar().body), contact.mortar().label);
      const int unknowns = meshes_.unknowns();
      const double expected = cost * std::pow(double(unknowns) / before, power);
      const bool small = unknowns <= goal.maxUnknowns;
      if (small && seconds + expected <= goal.maxSeconds) {
        aim_ = aim;
        return true;
      }
      stop(small ? tooLong : "a further round would have more unknowns than max_unknowns" + unknownsToCome());
      if (meshError_ == 0 || aim > gain * meshError_) break;
    }
  } catch (const TimeIsUp&) {
    stop(tooLong);
  }
  meshes_ = kept;
  return false;
}

std::string Rounds::unknownsToCome() const {
  constexpr size_t rounds = 3;  // single ones scatter
  constexpr double fastest = 1.5;
  if (aims() || sizes_.size() < rounds) return "";
  const auto& [before, larger] = sizes_[sizes_.size() - rounds];
  const auto& [unknowns, error] = sizes_.back();
  const double smooth = double(description_.degree) / (meshes_.inSpace() ? 3 : 2);
  const double fallen = std::log(larger / error) / std::log(double(unknowns) / before);
  const double excess = std::max(error / (least_ * description_.accuracy.energy - timeShare()), 1.0);
  const double needed = unknowns * std::pow(excess, 1 / std::max(std::min(fallen, fastest), smooth));
  const double digit = std::pow(10, std::floor(std::log10(needed)));
  return formatted(", about %.0f are needed", std::ceil(needed / digit) * digit);
}

Rounds::Verdict Rounds::stop(const std::string& reason) {
  reason_ = reason;
  return Verdict::notReached;
}

std::vector<std::string> Rounds::doubts() const {
  std::vector<std::string> doubts;
  for (size_t b = 0; b < description_.bodies.size(); ++b)
    for (const std::string& line : meshes_.polygons(b))
      doubts.push_back("body " + description_.bodies[b].name + ": " + line +
                       " is a polygon of whose curve nothing is known, which refinement does not change");
  for (size_t b = 0; b < description_.bodies.size(); ++b)
    if (const std::vector<SpacePoint> off = meshes_.offCurve(b); !off.empty())
      doubts.push_back("body " + description_.bodies[b].name + ": not on the " +
                       (meshes_.inSpace() ? "surface" : "curve") +
                       " of its boundary, where elements would turn over: " + counted(off.size(), "vertex") +
                       ", the first at " + placeText(off.front(), meshes_.inSpace() ? 3 : 2));
  return doubts;
}

}  // namespace mortier
