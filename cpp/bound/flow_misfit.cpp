#include "bound/flow_misfit.h"

#include <Eigen/Dense>
#include <array>
#include <optional>

#include "base/interrupt.h"
#include "bound/part_stress.h"
#include "material/stress.h"

namespace mortier {
namespace {

/// A stress t, and what its integrals are.
struct Candidate {
  PointVector t, rate;
  double lift = 0;   ///< |a - s|^2, by area
  double above = 0;  ///< mean of D, by vertices
  double below = 0;  ///< mean of (m/2) |s^ - t|^2 - D, by centroids
};

class Misfits {
 public:
  Misfits(const Body& own, const BodyState& state, const LoadedBody& loaded, const Vector& lowered,
          double weight)
      : own_(own),
        state_(state),
        loaded_(loaded),
        lowered_(lowered),
        weight_(weight),
        potential_(own, loaded.parents()),
        elastic_(linearisedLaw(own, state.stress, 0)),
        law_(linearisedLaw(own, state.stress, weight)) {}

  FlowMisfit sum() {
    result_.fluidity = potential_.fluidity().maxCoeff();
    const auto triangles = static_cast<int>(loaded_.parents().size());
    for (int first = 0; first < triangles;) {
      stopIfInterrupted();
      const int count = std::min(potential_.together(first), triangles - first);
      add(first, count);
      first += count;
    }
    return result_;
  }

 private:
  [[nodiscard]] PointVector stressAt(int triangle) const {
    return state_.stress.col(loaded_.parents()[triangle]);
  }
  [[nodiscard]] PointVector elasticStress(int triangle, const PointVector& strain) const {
    return mortier::stressOf(elastic_, strain, loaded_.parents()[triangle]);
  }
  [[nodiscard]] PointMatrix complianceOf(int triangle) const {
    const Eigen::Index n = state_.stress.rows();
    PointMatrix E(n, n);
    for (Eigen::Index k = 0; k < n; ++k) E.col(k) = elasticStress(triangle, PointVector::Unit(n, k));
    return E.inverse();
  }

  /// The stress that the law nearly has where the strain is less by `strain`.
  PointVector stressWithout(int triangle, const PointVector& strain, const PointVector& rate) {
    constexpr int most = 30;
    constexpr double enough = 1e-12;
    const int parent = loaded_.parents()[triangle];
    const Material& material = own_.material();
    PointVector stress = stressAt(triangle);
    if (trial_.size() == 0) {
      trial_.setZero(state_.stress.rows(), state_.stress.cols());
      strain_ = iterate_ = trial_;
      step_ = material.room(own_.points());
    }
    trial_.col(parent) = stress + elasticStress(triangle, weight_ * rate);
    strain_.col(parent) = -strain;
    for (int i = 0; i < most; ++i) {
      iterate_.col(parent) = stress;
      const LawReport report =
          material.linearise({weight_, trial_, strain_}, iterate_, step_, parent, parent + 1);
      if (!std::isfinite(report.change)) break;
      stress = step_.predictor.col(parent);
      if (report.change <= enough * stress.norm()) break;
    }
    return stress;
  }

  void add(int first, int count) {
    const Eigen::Index n = state_.stress.rows();
    Matrix stress(n, count);
    for (int i = 0; i < count; ++i) stress.col(i) = stressAt(first + i);
    const Matrix rates = potential_.rates(first, stress);
    std::vector<std::vector<Candidate>> candidates(count);
    std::vector<PartStress> added(count);
    std::vector<PointMatrix> compliances(count);
    for (int i = 0; i < count; ++i) {
      const int t = first + i;
      added[i] = addedIn(loaded_, t, law_, n);
      compliances[i] = complianceOf(t);
      candidates[i].push_back({stress.col(i), rates.col(i)});
      const Eigen::Vector3d lowered = loaded_.strainIn(t, lowered_);
      if (lowered == Eigen::Vector3d::Zero()) continue;
      PointVector strain = PointVector::Zero(n);
      strain.head<3>() = lowered;
      candidates[i].push_back({stressWithout(t, strain, rates.col(i)), {}});
      candidates[i].back().rate = potential_.rates(t, candidates[i].back().t).col(0);
      for (Candidate& each : candidates[i]) {
        const PointVector off = elasticStress(t, strain + weight_ * (each.rate - rates.col(i)));
        each.lift = off.dot(compliances[i] * off);
      }
    }
    for (int part = 0; part < 3; ++part)
      for (const Place& place : places_) {
        const auto valueAt = [&](int i) -> PointVector {
          const PointVector* v = &added[i][3 * part];
          return stress.col(i) + place.at[0] * v[0] + place.at[1] * v[1] + place.at[2] * v[2];
        };
        Matrix values(n, count);
        for (int i = 0; i < count; ++i) values.col(i) = valueAt(i);
        const Matrix flows = potential_.rates(first, values);
        for (int i = 0; i < count; ++i) {
          const double fluidity = potential_.fluidity()[first + i];
          if (fluidity == 0) continue;
          for (Candidate& each : candidates[i]) {
            const FlowExcess excess{each.t, each.rate, fluidity};
            if (place.vertex)
              each.above += place.share / 3 * excess.above(values.col(i), flows.col(i));
            else
              each.below += place.share / 3 * excess.below(values.col(i), flows.col(i));
          }
        }
      }
    for (int i = 0; i < count; ++i)
      finish(first + i, stress.col(i), rates.col(i), added[i], compliances[i], candidates[i]);
  }

  void finish(int t, const PointVector& stress, const PointVector& rate, const PartStress& added,
              const PointMatrix& compliance, const std::vector<Candidate>& candidates) {
    const double area = loaded_.body().weights()[t];
    const double fluidity = potential_.fluidity()[t];
    const auto integral = [&](const PointMatrix& A, const PointVector& off) {
      double sum = 0;
      for (int part = 0; part < 3; ++part) {
        const PointVector v[] = {added[3 * part] + off, added[3 * part + 1] + off, added[3 * part + 2] + off};
        sum += product(A, v, v) / 3;
      }
      return area * sum;
    };
    const PointMatrix half = fluidity / 2 * PointMatrix::Identity(state_.stress.rows(), state_.stress.rows());
    const Candidate* best = nullptr;
    double least = 0;
    double flow = 0;
    for (const Candidate& each : candidates) {
      const double D = fluidity == 0
                           ? 0
                           : std::max(0.0, std::min(area * each.above,
                                                    integral(half, stress - each.t) - area * each.below));
      const double all = area * each.lift + 2 * weight_ * D;
      if (best != nullptr && !(all < least)) continue;
      best = &each;
      least = all;
      flow = 2 * weight_ * D;
    }
    result_.stress += integral(compliance, PointVector::Zero(stress.size()));
    result_.lift += area * best->lift;
    result_.flow += flow;
    result_.shift += area * weight_ * weight_ * (best->rate - rate).squaredNorm();
    result_.norm += area * stress.dot(compliance * stress);
    result_.strain += area * weight_ * weight_ * rate.squaredNorm();
  }

  const Body& own_;
  const BodyState& state_;
  const LoadedBody& loaded_;
  const Vector& lowered_;
  double weight_;
  FlowPotential potential_;
  Linearisation elastic_, law_;
  std::vector<Place> places_ = placesIn(2);
  Matrix trial_, strain_, iterate_;  ///< by points, for stressWithout()
  Linearisation step_;
  FlowMisfit result_;
};

}  // namespace

FlowMisfit flowMisfit(const Body& own, const BodyState& state, const LoadedBody& loaded,
                      const Vector& lowered, double weight) {
  return Misfits(own, state, loaded, lowered, weight).sum();
}

}  // namespace mortier
