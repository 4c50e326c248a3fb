#include "bound/run_misfit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/interrupt.h"
#include "bound/flow_potential.h"

namespace mortier {
namespace {

constexpr int cuts = 2;       // of the sides of parts
constexpr int intervals = 2;  // of a step

/// The law in triangles that the lift has moved: their strain is not that of the finite elements.
class MovedLaw {
 public:
  MovedLaw(const Body& own, const Matrix& stress, double timeStep)
      : material_(own.material()),
        timeStep_(timeStep),
        trial_(Matrix::Zero(stress.rows(), stress.cols())),
        strain_(trial_),
        iterate_(trial_),
        step_(material_.room(own.points())) {}

  /// The stress that the law has at the end of a step, nearly; \param strain  what it adds
  PointVector stressAfter(const PointVector& before, const PointVector& strain, PointVector guess,
                          int point) {
    constexpr int most = 30;
    constexpr double enough = 1e-12;
    trial_.col(point) = before;
    strain_.col(point) = strain;
    for (int i = 0; i < most; ++i) {
      iterate_.col(point) = guess;
      const LawReport report =
          material_.linearise({timeStep_, trial_, strain_}, iterate_, step_, point, point + 1);
      if (!std::isfinite(report.change)) break;
      guess = step_.predictor.col(point);
      if (report.change <= enough * guess.norm()) break;
    }
    return guess;
  }

 private:
  const Material& material_;
  double timeStep_;
  Matrix trial_, strain_, iterate_;
  Linearisation step_;
};

/// D(s^; t) in the triangles of a body, and the square that is above it.
class FlowIntegrals {
 public:
  FlowIntegrals(const Body& own, const std::vector<int>& parents, const Matrix& before, const Matrix& after,
                const Matrix& t)
      : potential_(own, parents), before_(before), after_(after), t_(t) {}

  /// Means over the triangles, by weights.
  std::vector<Vector> means(const std::vector<StepWeights>& weights) {
    const Eigen::Index triangles = t_.cols();
    std::vector<Vector> result(weights.size(), Vector::Zero(triangles));
    for (int first = 0; first < triangles;) {
      stopIfInterrupted();
      first_ = first;
      count_ = static_cast<int>(std::min<Eigen::Index>(potential_.together(first), triangles - first));
      first += count_;
      rates_ = potential_.rates(first_, t_.middleCols(first_, count_));
      above_.setZero(intervals + 1, count_);
      below_.setZero(intervals, count_);
      flows_ = !rates_.isZero(0);
      for (const int end : {0, intervals}) addAbove(end);
      if (!flows_) continue;  // B is convex: nothing flows in between
      for (int k = 1; k < intervals; ++k) addAbove(k);
      for (int k = 0; k < intervals; ++k) addBelow(k);
      for (int i = 0; i < count_; ++i)
        for (size_t w = 0; w < weights.size(); ++w) result[w][first_ + i] = mean(i, weights[w]);
    }
    return result;
  }

 private:
  [[nodiscard]] double fluidity(int i) const { return potential_.fluidity()[first_ + i]; }
  [[nodiscard]] Matrix valuesAt(int part, const Place& place, double time) const {
    Matrix values(t_.rows(), count_);
    for (int i = 0; i < count_; ++i) {
      values.col(i).setZero();
      for (int v = 0; v < 3; ++v) {
        const Eigen::Index column = 9 * (first_ + i) + 3 * part + v;
        values.col(i) += place.at[v] * ((1 - time) * before_.col(column) + time * after_.col(column));
      }
    }
    return values;
  }
  /// At the vertices of small triangles: no less than the integral.
  void addAbove(int k) {
    for (int part = 0; part < 3; ++part)
      for (const Place& place : places_) {
        if (!place.vertex) continue;
        const Matrix values = valuesAt(part, place, static_cast<double>(k) / intervals);
        const Matrix rates = potential_.rates(first_, values);
        flows_ = flows_ || !rates.isZero(0);
        for (int i = 0; i < count_; ++i)
          if (fluidity(i) > 0)
            above_(k, i) += place.share / 3 *
                            FlowExcess{at(i), rateAt(i), fluidity(i)}.above(values.col(i), rates.col(i));
      }
  }
  /// At the centroids, of what the square has beyond D: no more than the integral.
  void addBelow(int k) {
    for (int part = 0; part < 3; ++part)
      for (const Place& place : places_) {
        if (place.vertex) continue;
        const Matrix values = valuesAt(part, place, (k + 0.5) / intervals);
        const Matrix rates = potential_.rates(first_, values);
        for (int i = 0; i < count_; ++i)
          if (fluidity(i) > 0)
            below_(k, i) += place.share / 3 *
                            FlowExcess{at(i), rateAt(i), fluidity(i)}.below(values.col(i), rates.col(i));
      }
  }
  PointVector& at(int i) { return point_ = t_.col(first_ + i); }
  PointVector& rateAt(int i) { return rate_ = rates_.col(i); }

  /// From above in time, too: D is convex along the line from s^ before to s^ after.
  double mean(int i, const StepWeights& weights) {
    if (fluidity(i) == 0) return 0;
    constexpr double h = 1.0 / intervals;
    const auto chord = [&](int k) {
      if (k > 0 || !weights.fromRest()) return h * weights.at(k * h) * (above_(k, i) + above_(k + 1, i)) / 2;
      return above_(0, i) == 0 ? weights.moment(1) * above_(1, i) : weights.moment(0);
    };
    double chords = 0;
    for (int k = 0; k < intervals; ++k) chords += chord(k);
    if (weights.fromRest()) return chords;
    const Eigen::Index components = t_.rows();
    const PointMatrix one = PointMatrix::Identity(components, components);
    double s00 = 0;
    double s01 = 0;
    double s11 = 0;
    for (int part = 0; part < 3; ++part) {
      PointVector a[3];
      PointVector b[3];
      for (int v = 0; v < 3; ++v) {
        const Eigen::Index column = 9 * (first_ + i) + 3 * part + v;
        a[v] = before_.col(column) - t_.col(first_ + i);
        b[v] = after_.col(column) - t_.col(first_ + i);
      }
      s00 += product(one, a, a) / 3;
      s01 += product(one, a, b) / 3;
      s11 += product(one, b, b) / 3;
    }
    const auto m = [&](int k) { return weights.moment(k); };
    double square = fluidity(i) / 2 * (s00 * (m(0) - 2 * m(1) + m(2)) + 2 * s01 * (m(1) - m(2)) + s11 * m(2));
    for (int k = 0; k < intervals; ++k) square -= h * weights.at((k + 1) * h) * below_(k, i);
    return std::max(0.0, std::min(chords, square));
  }

  FlowPotential potential_;
  const Matrix &before_, &after_, &t_;
  std::vector<Place> places_ = placesIn(cuts);
  int first_ = 0, count_ = 0;
  bool flows_ = false;
  Matrix rates_, above_, below_;  ///< of a group; the last two by times and triangles
  PointVector point_, rate_;
};

/// A stress whose overstress is but what a run leaves of its law is taken back to the yield surface.
PointVector withoutRounding(FlowPotential& potential, int triangle, const PointVector& t) {
  constexpr double rounding = 1e-10;
  const double rate = potential.rates(triangle, Matrix(t)).norm();
  const bool little = rate <= rounding * potential.fluidity()[triangle] * t.norm();
  return little && rate > 0 ? PointVector((1 - rounding) * t) : t;
}

/// (p, q, r, and 0 beyond the plane) of a displacement.
PointVector strainOf(const LoadedBody& loaded, int triangle, const Vector& u, Eigen::Index n) {
  PointVector strain = PointVector::Zero(n);
  strain.head<3>() = loaded.strainIn(triangle, u);
  return strain;
}

}  // namespace

RunBody::RunBody(const Body& own) : own_(own) {
  const Material& material = own.material();
  const Eigen::Index n = material.components();
  compliances_.assign(own.points(), PointMatrix(n, n));
  Matrix strain;
  for (Eigen::Index k = 0; k < n; ++k) {
    material.elasticStrain(Vector::Unit(n, k).replicate(1, own.points()), strain);
    for (int i = 0; i < own.points(); ++i) compliances_[i].col(k) = strain.col(i);
  }
  for (const PointMatrix& each : compliances_) moduli_.emplace_back(each.inverse());
}

RunFields RunBody::fields(const BodyState& state, const LoadedBody& loaded, const Vector& lifted,
                          double weight) const {
  RunFields fields;
  fields.displacement = lifted;
  const Eigen::Index n = state.stress.rows();
  const Linearisation law = linearisedLaw(own_, state.stress, weight);
  const std::vector<int>& parents = loaded.parents();
  fields.balanced.resize(n, 9 * static_cast<Eigen::Index>(parents.size()));
  for (int t = 0; t < static_cast<int>(parents.size()); ++t) {
    const PartStress added = addedIn(loaded, t, law, n);
    for (int v = 0; v < 9; ++v) fields.balanced.col(9 * t + v) = state.stress.col(parents[t]) + added[v];
  }
  return fields;
}

RunFields RunBody::start(const BodyState& state, const LoadedBody& loaded, const Vector& lifted) const {
  RunFields fields = this->fields(state, loaded, lifted, 0);
  const Eigen::Index n = state.stress.rows();
  const Vector lowered = loaded.lifted().displacement - lifted;
  fields.stress.resize(n, static_cast<Eigen::Index>(loaded.parents().size()));
  for (int t = 0; t < fields.stress.cols(); ++t) {
    const int parent = loaded.parents()[t];
    fields.stress.col(t) = state.stress.col(parent) - moduli_[parent] * strainOf(loaded, t, lowered, n);
  }
  return fields;
}

RunFields RunBody::rest(const CutMesh& cut) const {
  const Eigen::Index n = own_.material().components();
  const auto triangles = static_cast<Eigen::Index>(cut.parents.size());
  return {Matrix::Zero(n, triangles), Matrix::Zero(n, 9 * triangles),
          Vector::Zero(2 * static_cast<Eigen::Index>(cut.mesh.vertices.size()))};
}

RunFields RunBody::step(const RunFields& fields, const BodyState& before, const BodyState& state,
                        const LoadedBody& loaded, const Vector& lifted, double timeStep, double weight,
                        const std::vector<StepWeights>& weights, RunMisfit& misfit) const {
  const bool linear = own_.material().linear();
  const std::vector<int>& parents = loaded.parents();
  const auto triangles = static_cast<int>(parents.size());
  const Eigen::Index n = state.stress.rows();
  const Vector lowered = loaded.lifted().displacement - lifted;
  const Vector moved = lifted - fields.displacement;
  RunFields result = this->fields(state, loaded, lifted, weight);
  Matrix t(n, triangles);
  MovedLaw law(own_, state.stress, timeStep);
  std::optional<FlowPotential> potential;
  if (!linear) potential.emplace(own_, parents);
  result.stress.resize(n, triangles);
  for (int k = 0; k < triangles; ++k) {
    const int parent = parents[k];
    const PointVector less = strainOf(loaded, k, lowered, n);
    t.col(k) = state.stress.col(parent);
    result.stress.col(k) = t.col(k);
    if (linear) {
      result.stress.col(k) -= moduli_[parent] * less;
    } else if (!less.isZero(0) || fields.stress.col(k) != before.stress.col(parent)) {
      const PointVector strain = strainOf(loaded, k, moved, n);
      const PointVector after = law.stressAfter(fields.stress.col(k), strain, t.col(k), parent);
      const PointVector rate = potential->rates(k, Matrix(after)).col(0);
      t.col(k) = after;
      result.stress.col(k) = fields.stress.col(k) + moduli_[parent] * (strain - timeStep * rate);
    }
    if (!linear) t.col(k) = withoutRounding(*potential, k, t.col(k));
  }
  const std::vector<double>& areas = loaded.body().weights();
  for (int k = 0; k < triangles; ++k)
    for (int part = 0; part < 3; ++part) {
      PointVector r[3];
      for (int v = 0; v < 3; ++v) {
        const Eigen::Index column = 9 * k + 3 * part + v;
        r[v] = result.stress.col(k) - fields.stress.col(k) -
               (result.balanced.col(column) - fields.balanced.col(column));
      }
      misfit.change += areas[k] / 3 * product(compliances_[parents[k]], r, r);
    }
  misfit.flow.resize(weights.size());
  if (linear) return result;
  FlowIntegrals integrals(own_, parents, fields.balanced, result.balanced, t);
  const std::vector<Vector> means = integrals.means(weights);
  for (size_t w = 0; w < weights.size(); ++w)
    for (int k = 0; k < triangles; ++k)
      if (means[w][k] > 0) misfit.flow[w] += timeStep * areas[k] * means[w][k];
  return result;
}

double RunBody::misfit(const RunFields& fields, const LoadedBody& loaded) const {
  double sum = 0;
  for (int k = 0; k < fields.stress.cols(); ++k)
    for (int part = 0; part < 3; ++part) {
      PointVector r[3];
      for (int v = 0; v < 3; ++v) r[v] = fields.stress.col(k) - fields.balanced.col(9 * k + 3 * part + v);
      sum += loaded.body().weights()[k] / 3 * product(compliances_[loaded.parents()[k]], r, r);
    }
  return sum;
}

std::array<double, 2> RunBody::distance(const RunFields& fields, const BodyState& state,
                                        const LoadedBody& loaded) const {
  std::array<double, 2> sums{};
  const Eigen::Index n = state.stress.rows();
  const Vector lowered = loaded.lifted().displacement - fields.displacement;
  for (int k = 0; k < fields.stress.cols(); ++k) {
    const int parent = loaded.parents()[k];
    const double area = loaded.body().weights()[k];
    const PointVector s = state.stress.col(parent);
    for (int part = 0; part < 3; ++part) {
      PointVector off[3];
      for (int v = 0; v < 3; ++v) off[v] = s - fields.balanced.col(9 * k + 3 * part + v);
      sums[0] += area / 3 * product(compliances_[parent], off, off);
    }
    const PointVector flown =
        strainOf(loaded, k, lowered, n) + compliances_[parent] * (fields.stress.col(k) - s);
    sums[1] += area * flown.squaredNorm();
  }
  return sums;
}

}  // namespace mortier
