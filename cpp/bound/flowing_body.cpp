#include "bound/flowing_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/dense_templates.h"
#include "base/interrupt.h"
#include "bound/flow_potential.h"
#include "material/stress.h"

namespace mortier {
namespace {

constexpr int intervals = 2;  // of a step

/// Values at the vertices of the parts of a triangle.
using Corners = Eigen::Matrix<double, Eigen::Dynamic, 9, 0, 4, 9>;

/// Mean over a triangle of v : A w, of functions that are linear in each part.
double meanProduct(const PointMatrix& A, const Corners& v, const Corners& w) {
  double sum = v.cwiseProduct(A * w).sum();
  for (int part = 0; part < 9; part += 3)
    sum += v.middleCols<3>(part).rowwise().sum().dot(A * w.middleCols<3>(part).rowwise().sum());
  return sum / 36;
}
/// Of the values in a triangle, less a constant, with themselves.
double meanSquare(const PointMatrix& A, const Matrix& values, int triangle, const PointVector& off) {
  const Corners v = values.middleCols<9>(9 * triangle).colwise() - off;
  return meanProduct(A, v, v);
}
PointMatrix identity(Eigen::Index n) {
  return PointMatrix::Identity(n, n);
}

/// Calls add(first, count) for groups of triangles that a potential handles at once. \throws Interrupted
template <class Add>
void forGroups(const FlowPotential& potential, int triangles, const Add& add) {
  for (int first = 0; first < triangles;) {
    stopIfInterrupted();
    const int count = std::min(potential.together(first), triangles - first);
    add(first, count);
    first += count;
  }
}

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

/// Means over a step and triangles of D(s^; t), by weights, from above in time, too: D is convex along the
/// line from s^ before to s^ after.
std::vector<Vector> flowMeans(FlowPotential& potential, const Matrix& before, const Matrix& after,
                              const Matrix& t, const std::vector<StepWeights>& weights) {
  constexpr double h = 1.0 / intervals;
  std::vector<Vector> result(weights.size(), Vector::Zero(t.cols()));
  forGroups(potential, static_cast<int>(t.cols()), [&](int first, int count) {
    const Matrix own = t.middleCols(first, count);
    const Matrix rates = potential.rates(first, own);
    const auto balancedAt = [&](double time) -> Matrix {
      return (1 - time) * before.middleCols(9 * first, 9 * count) +
             time * after.middleCols(9 * first, 9 * count);
    };
    Matrix above = Matrix::Zero(count, intervals + 1);
    Matrix below(count, intervals);
    for (const int end : {0, intervals})
      above.col(end) = potential.excessAbove(first, balancedAt(end * h), own, rates);
    if (above.isZero(0)) return;
    for (int k = 1; k < intervals; ++k)
      above.col(k) = potential.excessAbove(first, balancedAt(k * h), own, rates);
    for (int k = 0; k < intervals; ++k)
      below.col(k) = potential.squareBeyond(first, balancedAt((k + 0.5) * h), own, rates);
    for (int i = 0; i < count; ++i) {
      const double fluidity = potential.fluidity()[first + i];
      if (fluidity == 0) continue;
      const Corners a = before.middleCols<9>(9 * (first + i)).colwise() - own.col(i);
      const Corners b = after.middleCols<9>(9 * (first + i)).colwise() - own.col(i);
      const PointMatrix one = identity(t.rows());
      const double s00 = meanProduct(one, a, a);
      const double s01 = meanProduct(one, a, b);
      const double s11 = meanProduct(one, b, b);
      for (size_t w = 0; w < weights.size(); ++w) {
        const auto m = [&](int k) { return weights[w].moment(k); };
        double& mean = result[w][first + i];
        if (weights[w].fromRest()) {
          mean = above(i, 0) == 0 ? m(1) * above(i, 1) : m(0);
          for (int k = 1; k < intervals; ++k)
            mean += h * weights[w].at(k * h) * (above(i, k) + above(i, k + 1)) / 2;
          continue;
        }
        double square =
            fluidity / 2 * (s00 * (m(0) - 2 * m(1) + m(2)) + 2 * s01 * (m(1) - m(2)) + s11 * m(2));
        for (int k = 0; k < intervals; ++k) {
          mean += h * weights[w].at(k * h) * (above(i, k) + above(i, k + 1)) / 2;
          square -= h * weights[w].at((k + 1) * h) * below(i, k);
        }
        mean = std::max(0.0, std::min(mean, square));
      }
    }
  });
  return result;
}

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
  strain.head<3>() = strainIn(loaded.mesh(), triangle, u);
  return strain;
}

}  // namespace

FlowingBody::FlowingBody(const Body& own) : own_(own) {
  const Material& material = own.material();
  const Eigen::Index n = material.components();
  compliances_.assign(own.points(), PointMatrix(n, n));
  Matrix strain;
  for (Eigen::Index k = 0; k < n; ++k) {
    material.elasticStrain(Vector::Unit(n, k).replicate(1, own.points()), strain);
    for (int i = 0; i < own.points(); ++i) compliances_[i].col(k) = strain.col(i);
  }
  for (const PointMatrix& each : compliances_) moduli_.emplace_back(Matrix(each).inverse());
}

RunFields FlowingBody::fields(const BodyState& state, const LoadedBody& loaded, const Vector& lifted,
                              double weight) const {
  RunFields fields;
  fields.displacement = lifted;
  const Eigen::Index n = state.stress.rows();
  const Linearisation law = linearisedLaw(own_, state.stress, weight);
  const std::vector<int>& parents = loaded.parents();
  fields.balanced.resize(n, 9 * static_cast<Eigen::Index>(parents.size()));
  for (int t = 0; t < static_cast<int>(parents.size()); ++t) {
    const CompositeTriangle element = loaded.elementOf(t);
    const BodyLoad& f = loaded.forceOn(t);
    const std::array<Stress, 9> added = element.stressOf(
        loaded.momentsOf(t) - element.momentsOf(loaded.stress()[t]) - element.momentsOfLoad(f), f);
    const auto D = moduliAt(law.moduli, parents[t]);
    const Eigen::Matrix3d inverse = Eigen::Map<const Eigen::Matrix3d>(D.data()).inverse();
    for (int v = 0; v < 9; ++v) {
      auto stress = fields.balanced.col(9 * t + v);
      stress = state.stress.col(parents[t]);
      stress.head<3>() += fromCartesian(added[v]);
      // What is not of the plane is free: it is chosen as the law would.
      if (n > 3) stress[3] += (inverse * law.beyond.col(parents[t]).head<3>()).dot(fromCartesian(added[v]));
    }
  }
  return fields;
}

RunFields FlowingBody::start(const BodyState& state, const LoadedBody& loaded, const Vector& lifted) const {
  RunFields fields = this->fields(state, loaded, lifted, 0);
  const Eigen::Index n = state.stress.rows();
  const Vector lowered = loaded.place().displacement - lifted;
  fields.stress.resize(n, static_cast<Eigen::Index>(loaded.parents().size()));
  for (int t = 0; t < fields.stress.cols(); ++t) {
    const int parent = loaded.parents()[t];
    fields.stress.col(t) = state.stress.col(parent) - moduli_[parent] * strainOf(loaded, t, lowered, n);
  }
  return fields;
}

RunFields FlowingBody::rest(const CutMesh& cut) const {
  const Eigen::Index n = own_.material().components();
  const auto triangles = static_cast<Eigen::Index>(cut.parents.size());
  return {Matrix::Zero(n, triangles), Matrix::Zero(n, 9 * triangles),
          Vector::Zero(2 * static_cast<Eigen::Index>(cut.mesh.vertices.size()))};
}

RunFields FlowingBody::step(const RunFields& fields, const BodyState& before, const BodyState& state,
                            const LoadedBody& loaded, const Vector& lifted, double timeStep, double weight,
                            const std::vector<StepWeights>& weights, RunMisfit& misfit) const {
  const bool linear = own_.material().linear();
  const std::vector<int>& parents = loaded.parents();
  const auto triangles = static_cast<int>(parents.size());
  const Eigen::Index n = state.stress.rows();
  const Vector lowered = loaded.place().displacement - lifted;
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
  const Matrix change = result.balanced - fields.balanced;
  for (int k = 0; k < triangles; ++k)
    misfit.change += areas[k] * meanSquare(compliances_[parents[k]], change, k,
                                           result.stress.col(k) - fields.stress.col(k));
  misfit.flow.resize(weights.size());
  if (linear) return result;
  const std::vector<Vector> means = flowMeans(*potential, fields.balanced, result.balanced, t, weights);
  for (size_t w = 0; w < weights.size(); ++w)
    for (int k = 0; k < triangles; ++k)
      if (means[w][k] > 0) misfit.flow[w] += timeStep * areas[k] * means[w][k];
  return result;
}

double FlowingBody::misfit(const RunFields& fields, const LoadedBody& loaded) const {
  double sum = 0;
  for (int k = 0; k < fields.stress.cols(); ++k)
    sum += loaded.body().weights()[k] *
           meanSquare(compliances_[loaded.parents()[k]], fields.balanced, k, fields.stress.col(k));
  return sum;
}

std::array<double, 2> FlowingBody::distance(const RunFields& fields, const BodyState& state,
                                            const LoadedBody& loaded) const {
  std::array<double, 2> sums{};
  const Eigen::Index n = state.stress.rows();
  const Vector lowered = loaded.place().displacement - fields.displacement;
  for (int k = 0; k < fields.stress.cols(); ++k) {
    const int parent = loaded.parents()[k];
    const double area = loaded.body().weights()[k];
    const PointVector s = state.stress.col(parent);
    sums[0] += area * meanSquare(compliances_[parent], fields.balanced, k, s);
    const PointVector flown =
        strainOf(loaded, k, lowered, n) + compliances_[parent] * (fields.stress.col(k) - s);
    sums[1] += area * flown.squaredNorm();
  }
  return sums;
}

/// t is s, or in triangles that the lift moves what the law nearly has there, whichever costs less.
void FlowingBody::addStep(const BodyState& state, const LoadedBody& loaded, const Vector& lifted,
                          double weight, FlowMisfit& misfit) const {
  const std::vector<int>& parents = loaded.parents();
  const Eigen::Index n = state.stress.rows();
  const Vector lowered = loaded.place().displacement - lifted;
  const Matrix balanced = fields(state, loaded, lifted, weight).balanced;
  FlowPotential potential(own_, parents);
  MovedLaw law(own_, state.stress, weight);
  misfit.fluidity = std::max(misfit.fluidity, potential.fluidity().maxCoeff());
  forGroups(potential, static_cast<int>(parents.size()), [&](int first, int count) {
    Matrix stress(n, count);
    for (int i = 0; i < count; ++i) stress.col(i) = state.stress.col(parents[first + i]);
    const Matrix rates = potential.rates(first, stress);
    Matrix other = stress;
    Matrix otherRates = rates;
    Matrix less(n, count);  // strain
    for (int i = 0; i < count; ++i) {
      const int parent = parents[first + i];
      less.col(i) = strainOf(loaded, first + i, lowered, n);
      if (less.col(i).isZero(0)) continue;
      other.col(i) = law.stressAfter(stress.col(i) + moduli_[parent] * (weight * rates.col(i)), -less.col(i),
                                     stress.col(i), parent);
      otherRates.col(i) = potential.rates(first + i, Matrix(other.col(i))).col(0);
    }
    Vector least = Vector::Constant(count, std::numeric_limits<double>::infinity());
    Matrix best(3, count);  // lift, flow, shift
    const auto consider = [&](int from, int number, const Matrix& t, const Matrix& r) {
      const Matrix corners = balanced.middleCols(9 * (first + from), 9 * number);
      const Vector above = potential.excessAbove(first + from, corners, t, r);
      const Vector below = potential.squareBeyond(first + from, corners, t, r);
      for (int k = 0; k < number; ++k) {
        const int i = from + k;
        const double fluidity = potential.fluidity()[first + i];
        const PointVector flown = weight * (r.col(k) - rates.col(i));
        const PointVector off = less.col(i) + flown;
        const double square = fluidity / 2 * meanSquare(identity(n), balanced, first + i, t.col(k));
        const double flow = 2 * weight * std::max(0.0, std::min(above[k], square - below[k]));
        const double lift = off.dot(moduli_[parents[first + i]] * off);
        if (!(lift + flow < least[i])) continue;
        least[i] = lift + flow;
        best.col(i) << lift, flow, flown.squaredNorm();
      }
    };
    consider(0, count, stress, rates);
    for (int i = 0, end = 0; i < count; i = end + 1) {  // what is moved, in ranges
      for (end = i; end < count && !less.col(end).isZero(0);) ++end;
      if (end > i) consider(i, end - i, other.middleCols(i, end - i), otherRates.middleCols(i, end - i));
    }
    for (int i = 0; i < count; ++i) {
      const PointMatrix& compliance = compliances_[parents[first + i]];
      const double area = loaded.body().weights()[first + i];
      misfit.stress += area * meanSquare(compliance, balanced, first + i, stress.col(i));
      misfit.lift += area * best(0, i);
      misfit.flow += area * best(1, i);
      misfit.shift += area * best(2, i);
      misfit.norm += area * stress.col(i).dot(compliance * stress.col(i));
      misfit.strain += area * weight * weight * rates.col(i).squaredNorm();
    }
  });
}

}  // namespace mortier
