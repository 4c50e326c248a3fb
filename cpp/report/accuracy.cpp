#include "report/accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mortier {
namespace {

/// The energy norm, squared, of stresses that the rounding of displacements makes: strains of `displacement` times epsilon
/// over the size of a triangle.
double roundingOf(const Body& body, double displacement) {
  constexpr double roundings = 4;
  const double u = roundings * std::numeric_limits<double>::epsilon() * displacement;
  Matrix strain;
  body.material().elasticStrain(Matrix::Ones(body.material().components(), body.points()), strain);
  double sum = 0;
  for (int i = 0; i < body.points(); ++i) sum += u * u / strain.col(i).cwiseAbs().head<3>().minCoeff();
  return sum;
}

/// Below this part of the largest energy of a run an error, squared, is rounding.
constexpr double negligible = 1e-24;

}  // namespace

void AccuracyRecord::prepare() {
  for (size_t b = estimators_.size(); b < model_.bodies.size(); ++b)
    estimators_.emplace_back(model_.bodies[b]);
}

void AccuracyRecord::add(const State& state, const StepReport& report, bool kept) {
  constexpr double often = 2;
  if (!kept && !(report.energy > often * memory_.energy)) return;
  prepare();
  memory_.energy = std::max(memory_.energy, report.energy);
  double error = 0;
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    error += estimators_[b](state.bodies[b].stress).error.sum();
  if (!(error > memory_.error)) return;
  memory_.error = error;
  memory_.time = report.time;
}

Accuracy AccuracyRecord::atEnd(const State& state, const Peaks& peaks) {
  prepare();
  const double largestEnergy = 2 * peaks.energy.value;
  Accuracy result;
  double error = 0;
  double energy = 0;
  double largest = 0;
  double allRounding = negligible * largestEnergy;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const ErrorEstimate estimate = estimators_[b](state.bodies[b].stress);
    const double rounding = roundingOf(model_.bodies[b], peaks.displacement.value);
    allRounding += rounding;
    energy += estimate.energy;
    const bool real = estimate.error.sum() > rounding + negligible * largestEnergy;
    result.bodies.push_back(real ? estimate.relative() : 0);
    if (!real) continue;
    error += estimate.error.sum();
    Eigen::Index worst = 0;
    if (!(estimate.error.maxCoeff(&worst) > largest)) continue;
    largest = estimate.error[worst];
    result.worstBody = model_.bodies[b].name();
    const TriangleMesh& mesh = model_.bodies[b].mesh();
    result.worst.setZero();
    for (const int vertex : mesh.triangles[worst]) result.worst += mesh.vertices[vertex] / 3;
  }
  result.all = energy > 0 ? std::sqrt(error / energy) : 0;
  result.time = result.largestTime = state.time;
  double most = error;
  if (memory_.error > error) {
    most = memory_.error;
    result.largestTime = memory_.time;
  }
  result.largest = largestEnergy > 0 && most > allRounding ? std::sqrt(most / largestEnergy) : 0;
  return result;
}

}  // namespace mortier
