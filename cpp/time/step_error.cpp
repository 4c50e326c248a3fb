// The error of a step, by what its stages miss of the flow in between.
#include <algorithm>
#include <cmath>

#include "base/dense_templates.h"
#include "base/quadrature_rules.h"
#include "solver/state.h"
#include "time/error_norms.h"
#include "time/step_taker.h"

namespace mortier {
namespace {

constexpr int parts = 2;  // of the time between two stages

/// Lagrange's polynomials of the nodes at x.
std::vector<double> polynomials(const std::vector<double>& nodes, double x) {
  std::vector<double> values(nodes.size(), 1);
  for (size_t i = 0; i < nodes.size(); ++i)
    for (size_t j = 0; j < nodes.size(); ++j)
      if (j != i) values[i] *= (x - nodes[j]) / (nodes[i] - nodes[j]);
  return values;
}

/// Whether they are zero, at the points of this rank.
bool noneHere(const std::vector<Matrix>& fields) {
  return std::all_of(fields.begin(), fields.end(), [](const Matrix& field) { return field.isZero(0); });
}

}  // namespace

/// The stress of a body within the step: the polynomial through its start and its stages.
Matrix StepTaker::stressWithin(size_t body, double fraction) const {
  std::vector<double> nodes{0};
  for (const Stage& stage : tableau_.stages) nodes.push_back(stage.time);
  const std::vector<double> at = polynomials(nodes, fraction);
  Matrix stress = at[0] * state_.bodies[body].stress;
  for (size_t i = 0; i < solutions_.size(); ++i) stress += at[i + 1] * solutions_[i].bodies[body].stress;
  return stress;
}

/// The total strain of a body within the step, likewise; nothing where its law does not depend on it.
Matrix StepTaker::strainWithin(size_t body, double fraction) const {
  const Body& of = model_.bodies[body];
  if (!of.material().needsTotalStrain()) return {};
  Matrix strain = totalStrain(of.material(), state_.bodies[body]);
  std::vector<double> nodes{0};
  for (const Stage& stage : tableau_.stages) nodes.push_back(stage.time);
  const std::vector<double> at = polynomials(nodes, fraction);
  Matrix ofStage(strain.rows(), strain.cols());
  for (size_t i = 0; i < solutions_.size() && fraction > 0; ++i) {
    of.strain(solutions_[i].bodies[body].increment, nullptr, ofStage, 0, of.points());
    if (of.heated())
      ofStage -= of.thermalStrain(state_.time + tableau_.stages[i].time * (t1_ - state_.time)) -
                 state_.bodies[body].thermalStrain;
    strain += at[i + 1] * ofStage;
  }
  return strain;
}

/// r_i = integral of G to c_i k less k sum_j a_ij G_j, by stage; G of the stages given.
std::vector<Matrix> StepTaker::defects(size_t body, const std::vector<Matrix>& rates) const {
  const double k = t1_ - state_.time;
  const Material& material = model_.bodies[body].material();
  Matrix integral = Matrix::Zero(material.components(), model_.bodies[body].points());
  Matrix rate;
  std::vector<Matrix> missed;
  double from = 0;
  for (size_t i = 0; i < tableau_.stages.size(); ++i) {
    const Stage& stage = tableau_.stages[i];
    if (!material.linear()) {
      const double h = (stage.time - from) / parts;
      for (int part = 0; part < parts; ++part)
        for (const auto& [at, weight] : gaussThree) {
          const double fraction = from + h * (part + at);
          const Matrix strain = strainWithin(body, fraction);
          material.viscoplasticRate(stressWithin(body, fraction), rate, &strain);
          integral += k * h * weight * rate;
        }
    }
    Matrix r = integral - k * stage.diagonal * rates[i];
    for (size_t j = 0; j < stage.before.size(); ++j) r -= k * stage.before[j] * rates[j];
    missed.push_back(std::move(r));
    from = stage.time;
  }
  return missed;
}

/// What of a response is viscoplastic: B d - E^-1 s.
std::vector<Matrix> StepTaker::flowOf(const std::vector<Matrix>& strain,
                                      const std::vector<Response>& response) const {
  std::vector<Matrix> flow = strain;
  for (size_t b = 0; b < flow.size(); ++b) {
    const Vector zero = Vector::Zero(response[b].displacement.size());
    Matrix elastic;
    model_.bodies[b].strain({response[b].displacement, zero}, nullptr, flow[b], 0, model_.bodies[b].points());
    model_.bodies[b].material().elasticStrain(response[b].stress, elastic);
    flow[b] -= elastic;
  }
  return flow;
}

std::vector<Matrix> StepTaker::throughStages(const std::vector<std::vector<Matrix>>& strains,
                                             const std::vector<Vector>& slip) {
  std::vector<std::vector<Matrix>> flows;  // k J_j ds_j
  std::vector<Matrix> error;
  for (size_t i = 0; i < tableau_.stages.size(); ++i) {
    const Stage& stage = tableau_.stages[i];
    std::vector<Matrix> shift = strains[i];
    for (size_t j = 0; j < stage.before.size(); ++j)
      for (size_t b = 0; b < shift.size(); ++b) shift[b] += stage.before[j] * flows[j][b];
    reached_ = response(shift, slip);
    error = flowOf(shift, reached_);
    if (i + 1 == tableau_.stages.size()) break;
    std::vector<Matrix> flow = error;
    for (size_t b = 0; b < flow.size(); ++b) flow[b] = (flow[b] - shift[b]) / stage.diagonal;
    onlyWhereItFlows(i, flow);
    flows.push_back(std::move(flow));
  }
  return error;
}

void StepTaker::onlyWhereItFlows(size_t stage, std::vector<Matrix>& flow) const {
  for (size_t b = 0; b < flow.size(); ++b) {
    const Matrix total = strainWithin(b, tableau_.stages[stage].time);
    for (int p = 0; p < model_.bodies[b].points(); ++p)
      if (!model_.bodies[b].material().flows(solutions_[stage].bodies[b].stress, p, &total))
        flow[b].col(p).setZero();
  }
}

/// Displacement and stress of the strain that throughStages() found. Its elastic response is exact for one
/// stage. Of two stages what relaxes within the step is wrong in it, and taken from lag() instead.
StepError StepTaker::atEnd(std::vector<Matrix> strain, const std::vector<Vector>& slip) {
  std::vector<Response> at = tableau_.stages.size() == 1 ? std::move(reached_) : response(strain, slip);
  return {std::move(strain), std::move(at)};
}

/// By stage and body.
StepTaker::Fields StepTaker::stageRates() const {
  Fields rates;
  for (size_t i = 0; i < tableau_.stages.size(); ++i) {
    std::vector<Matrix>& own = rates.emplace_back(model_.bodies.size());
    for (size_t b = 0; b < own.size(); ++b) {
      const Matrix strain = strainWithin(b, tableau_.stages[i].time);
      model_.bodies[b].material().viscoplasticRate(solutions_[i].bodies[b].stress, own[b], &strain);
    }
  }
  return rates;
}

/// Where some points flow and others do not, stresses turn sharply between the stages and the polynomial
/// through them is no guide: no point misses more than a part of what it flows. That through one stage is a
/// line, and of a step that begins before yield it may miss all of it.
void StepTaker::limit(const Fields& rates, Fields& missed) const {
  const double largest = tableau_.stages.size() == 1 ? 1 : 0.3;
  const double k = t1_ - state_.time;
  const std::vector<Matrix> start = startingRates();
  if (noneHere(start) && std::all_of(rates.begin(), rates.end(), noneHere)) return;
  for (size_t b = 0; b < start.size(); ++b)
    for (Eigen::Index p = 0; p < start[b].cols(); ++p) {
      double rate = start[b].col(p).norm();
      for (const std::vector<Matrix>& stage : rates) rate = std::max(rate, stage[b].col(p).norm());
      for (std::vector<Matrix>& stage : missed) {
        const double norm = stage[b].col(p).norm();
        if (norm > largest * k * rate) stage[b].col(p) *= largest * k * rate / norm;
      }
    }
}

StepError StepTaker::localError() {
  const size_t stages = tableau_.stages.size();
  const Fields rates = stageRates();
  Fields missed(stages);
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    std::vector<Matrix> own;
    for (const std::vector<Matrix>& stage : rates) own.push_back(stage[b]);
    std::vector<Matrix> r = defects(b, own);
    for (size_t i = 0; i < stages; ++i) missed[i].push_back(std::move(r[i]));
  }
  limit(rates, missed);
  StepError error = atEnd(throughStages(missed));
  if (stages > 1) addLag(rates, error.response);
  return error;
}

StepError StepTaker::carried(const std::vector<Matrix>& strain, const std::vector<Vector>& slip) {
  return atEnd(throughStages(std::vector<std::vector<Matrix>>(tableau_.stages.size(), strain), slip), slip);
}

std::vector<Response> StepTaker::response(const std::vector<Matrix>& strain,
                                          const std::vector<Vector>& slip) {
  std::vector<Matrix> strains;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    strains.push_back(strain.empty() ? Matrix::Zero(body.material().components(), body.points())
                                     : strainAtTangent(b, strain[b]));
  }
  return system_.respond(strains, solutions_.back(), slip);
}

/// A law of the strain flows less where more has flowed. Its tangent has strains that are prescribed:
/// an error x of the flow is to it the strain y with (1 - k a_ss dG/deps) y = x.
Matrix StepTaker::strainAtTangent(size_t body, const Matrix& strain) const {
  constexpr double little = 1e-6;
  const Material& material = model_.bodies[body].material();
  if (!material.needsTotalStrain() || strain.isZero(0)) return strain;
  const double weight = (t1_ - state_.time) * tableau_.stages.back().diagonal;
  const Matrix& stress = solutions_.back().bodies[body].stress;
  const Matrix total = strainWithin(body, 1);
  const double h = little * std::max(total.cwiseAbs().maxCoeff(), strain.cwiseAbs().maxCoeff());
  Matrix before;
  material.viscoplasticRate(stress, before, &total);
  std::vector<Matrix> slopes(strain.rows());  // k a_ss dG/deps, by component of the strain
  for (Eigen::Index c = 0; c < strain.rows(); ++c) {
    Matrix changed = total;
    changed.row(c).array() += h;
    material.viscoplasticRate(stress, slopes[c], &changed);
    slopes[c] = weight / h * (slopes[c] - before);
  }
  Matrix strains = strain;
  Matrix system(strain.rows(), strain.rows());
  for (Eigen::Index i = 0; i < strain.cols(); ++i) {
    for (Eigen::Index c = 0; c < strain.rows(); ++c) system.col(c) = -slopes[c].col(i);
    system.diagonal().array() += 1;
    strains.col(i) = system.partialPivLu().solve(strain.col(i));
  }
  return strains;
}

std::vector<Response> StepTaker::change(size_t stage) const {
  std::vector<Response> change;
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    change.push_back({Vector::Zero(state_.bodies[b].displacement.size()),
                      solutions_[stage].bodies[b].stress - state_.bodies[b].stress});
  return change;
}

double StepTaker::share(double fraction) const {
  double points = 0;
  double flowing = 0;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    if (model_.bodies[b].material().linear()) continue;
    points += model_.bodies[b].points();
    const Matrix& stress = fraction > 0 ? solutions_.back().bodies[b].stress : state_.bodies[b].stress;
    const Matrix strain = strainWithin(b, fraction);
    for (int i = 0; i < model_.bodies[b].points(); ++i)
      flowing += model_.bodies[b].material().flows(stress, i, &strain) ? 1 : 0;
  }
  return points > 0 ? flowing / points : 0;
}

double StepTaker::flowing() const {
  return share(0);
}

double StepTaker::flowingAtEnd() const {
  return share(1);
}

/// The stress at the end of the attempt had it gone on as it began; nothing where that is not known.
std::vector<Matrix> StepTaker::extrapolatedStress() const {
  std::vector<Matrix> stress;
  const bool elastic = solutions_.size() > 1 && noneHere(rates_[0]);
  if (!elastic && memory_.increments.empty()) return stress;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Matrix& start = state_.bodies[b].stress;
    stress.push_back(
        elastic
            ? Matrix(start + (solutions_[0].bodies[b].stress - start) / tableau_.stages[0].time)
            : Matrix(start + (t1_ - state_.time) / memory_.timeStep * memory_.increments.back()[b].stress));
  }
  return stress;
}

std::vector<Response> StepTaker::turn() const {
  constexpr double part = 0.25;  // of the square: the flow keeps its last direction, which turns as it grows
  const std::vector<Matrix> expected = extrapolatedStress();
  std::vector<Response> turn;
  for (size_t b = 0; b < expected.size(); ++b) {
    const Material& material = model_.bodies[b].material();
    const Matrix& end = solutions_.back().bodies[b].stress;
    Matrix stress = Matrix::Zero(end.rows(), end.cols());
    // Without a yield stress there is no onset to turn at.
    const Matrix strain = strainWithin(b, 1);
    for (int i = 0; i < end.cols() && material.stressScale() > 0; ++i) {
      if (!material.flows(end, i, &strain)) continue;
      stress.col(i) = end.col(i) - expected[b].col(i);
      stress.col(i) *= part * stress.col(i).norm() / material.stressScale();
    }
    turn.push_back({Vector::Zero(state_.bodies[b].displacement.size()), std::move(stress)});
  }
  return turn;
}

double StepTaker::onset() const {
  constexpr int halvings = 12;
  // The polynomial through the stages has the curvature of the load,
  // the stress before the first flow how it would go on.
  const std::vector<Matrix> expected = extrapolatedStress();
  const auto anyFlows = [&](size_t b, const Matrix& stress, const Matrix& strain) {
    for (int i = 0; i < model_.bodies[b].points(); ++i)
      if (model_.bodies[b].material().flows(stress, i, &strain)) return true;
    return false;
  };
  const auto flowsAt = [&](double fraction) {
    for (size_t b = 0; b < model_.bodies.size(); ++b) {
      if (model_.bodies[b].material().linear()) continue;
      const Matrix& start = state_.bodies[b].stress;
      const Matrix strain = strainWithin(b, fraction);
      if (anyFlows(b, stressWithin(b, fraction), strain)) return true;
      if (!expected.empty() && anyFlows(b, start + fraction * (expected[b] - start), strain)) return true;
    }
    return false;
  };
  double below = 0;
  double above = 1;
  if (!flowsAt(above)) return 1;
  for (int i = 0; i < halvings; ++i) {
    const double middle = (below + above) / 2;
    (flowsAt(middle) ? above : below) = middle;
  }
  return below;
}

}  // namespace mortier
