#include "material/own_material.h"

#include <limits>
#include <numeric>

#include "base/dense_templates.h"
#include "base/error.h"
#include "base/worst.h"
#include "material/component_basis.h"
#include "material/rate_law.h"
#include "material/stress.h"

namespace mortier {
namespace {

template <int n>
Eigen::Matrix<double, n, n> elasticityTensor(const Elasticity& elasticity) {
  if constexpr (n == 3) return elasticity.moduli().matrix().asDiagonal();
  const double shear = elasticity.young / (1 + elasticity.poisson);
  const double bulk = elasticity.young / (1 - 2 * elasticity.poisson);
  Eigen::Matrix<double, n, 1> volume = Eigen::Matrix<double, n, 1>::Zero();
  volume[0] = n == 6 ? 0 : rootTwoThirds;
  volume[n - 1] = n == 6 ? 1 : overRoot3;
  return shear * Eigen::Matrix<double, n, n>::Identity() + (bulk - shear) * volume * volume.transpose();
}

/// A x, column by column: a product of matrices rounds by how many columns they have.
template <int rows, int n>
Matrix times(const Eigen::Matrix<double, rows, n>& A, const Eigen::Ref<const Matrix>& x) {
  Matrix y(rows, x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Eigen::Matrix<double, n, 1> column = x.col(i);
    y.col(i) = Eigen::Matrix<double, rows, 1>(A * column);
  }
  return y;
}

template <int n>
class OwnMaterial final : public Material {
 public:
  using Vec = Eigen::Matrix<double, n, 1>;
  using Mat = Eigen::Matrix<double, n, n>;

  OwnMaterial(const OwnLaw& own, const Elasticity& elasticity, LawDescription description)
      : law_(own.law),
        description_(std::move(description)),
        E_(elasticityTensor<n>(elasticity)),
        C_(E_.inverse()),
        poisson_(elasticity.poisson) {}

  [[nodiscard]] std::vector<LawDescription> laws() const override { return {description_}; }
  [[nodiscard]] int components() const override { return n; }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress, int /*point*/) const override {
    return n == 4 ? poisson_ * std::numbers::sqrt2 * stress[0] : 0;
  }
  [[nodiscard]] bool symmetricTangent() const override { return false; }
  [[nodiscard]] bool linear() const override { return false; }
  [[nodiscard]] bool needsTotalStrain() const override { return law_->needsTotalStrain(); }
  [[nodiscard]] double stressScale() const override { return 0; }
  /// Not known without a stress.
  [[nodiscard]] double stiffness(double weight) const override { return weight > 0 ? 1 : 0; }
  [[nodiscard]] bool flows(const Matrix& stress, int point, const Matrix* /*strain*/) const override {
    if (needsTotalStrain()) return true;
    Points at(stress.col(point));
    evaluate(at, nullptr);
    return (at.rate.array() != 0).any();
  }

  LawReport linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                      int end) const override {
    constexpr double farthest = 1e4;  // of strains: no iterate that is near a solution has more
    const Local local = solve(step, stress, 1, begin, end);
    Worst change;
    for (int i = begin; i < end; ++i) {
      const Solved& at = local.solved[i - begin];
      const Vec predictor = local.points.stress.col(i - begin) + at.direction;
      change.add(Vector(predictor - stress.col(i)));
      if (!isOnLaw(local, i - begin)) {
        // Residuals are relative to the stresses of an iterate: those of such a strain hide that it has none.
        const bool lost = !(step.strain.col(i).norm() <= farthest);
        change.add(lost ? std::numeric_limits<double>::quiet_NaN() : at.direction.norm());
      }
      result.predictor.col(i) = predictor;
      store(at.moduli, i, result);
    }
    return {change.value(), 0};
  }

  /// With D = E: t solves 2 E^-1 t + weight G(t) = strain + E^-1 (s0 + s).
  LawReport regularise(const MaterialStep& step, const Matrix& stress, const Vector& /*penalty*/,
                       double relaxation, Linearisation& result, int begin, int end) const override {
    const Local local = solve(step, stress, 2, begin, end);
    Worst change;
    for (int i = begin; i < end; ++i) {
      const Vec towards =
          local.points.stress.col(i - begin) + local.solved[i - begin].direction - stress.col(i);
      change.add(Vector(towards));
      if (!isOnLaw(local, i - begin)) change.add(Vector(local.solved[i - begin].direction));
      result.predictor.col(i) = stress.col(i) + relaxation * towards;
      store(E_, i, result);
    }
    return {change.value(), 0};
  }

  void choosePenalty(const Matrix& /*stress*/, Vector& penalty, int begin, int end) const override {
    penalty.segment(begin, end - begin).setZero();
  }
  void viscoplasticRate(const MaterialState& state, Matrix& rate, int begin, int end) const override {
    Points at(state.stress.middleCols(begin, end - begin));
    if (needsTotalStrain()) at.total = state.strain->middleCols(begin, end - begin);
    evaluate(at, nullptr);
    rate.middleCols(begin, end - begin) = at.rate;
  }
  void elasticStrain(const Matrix& stress, Matrix& strain, int begin, int end) const override {
    strain.middleCols(begin, end - begin) = times(C_, stress.middleCols(begin, end - begin));
  }
  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(const PathStart& start,
                                                           std::vector<int> points) const override {
    return newtonPath(*this, start, std::move(points));
  }

 private:
  static constexpr int tensorRows = tensorSize<n>;
  using Slopes = Eigen::Matrix<double, tensorRows, tensorRows>;

  /// Points that are evaluated together, on p, q, r, s33 or the basis of space.
  struct Points {
    explicit Points(Matrix s) : stress(std::move(s)) {}
    Matrix stress;
    Matrix total = {};  ///< strain, where the law depends on it
    Matrix rate = {};
  };

  /// The law at the stress to which Newton's method has come: r, its size, H^-1 r and ds/dstrain.
  struct Solved {
    double residual = std::numeric_limits<double>::infinity();
    double size = 0;  ///< of the terms of r, in the norm of the residual
    Vec direction = Vec::Constant(std::numeric_limits<double>::quiet_NaN());
    Mat moduli = Mat::Constant(std::numeric_limits<double>::quiet_NaN());
  };
  struct Local {
    Points points;
    std::vector<Solved> solved;
  };

  [[nodiscard]] double norm(const Vec& strain) const { return std::sqrt(strain.dot(E_ * strain)); }

  void evaluate(Points& at, Matrix* slopes) const {
    const Eigen::Index points = at.stress.cols();
    Matrix strain = Matrix::Zero(tensorRows, points);
    if (needsTotalStrain() && at.total.size() > 0) strain = times(componentsBy<n>(), at.total);
    if (n == 3) strain.row(3).setConstant(std::numeric_limits<double>::quiet_NaN());
    Matrix rate(tensorRows, points);
    if (slopes != nullptr) slopes->resize(law_->slopeRows(tensorRows), points);
    const Matrix stress = times(componentsBy<n>(), at.stress);
    law_->evaluate(stress, strain, rate, slopes);
    if (slopes != nullptr) law_->takeSlopesBeside(stress, strain, E_.norm(), *slopes);
    if (n == 3) rate.row(3).setZero();
    at.rate = times(byComponents<n>(), rate);
  }

  /// Derivatives by components as those by the basis.
  static Mat turned(Slopes slopes) {
    if constexpr (n == 3) {
      slopes.row(3).setZero();
      slopes.col(3).setZero();
    }
    return byComponents<n>() * slopes * componentsBy<n>();
  }

  /// compliances E^-1 s + weight G(s) = rhs at all points, from `stress` or from where the residual is less.
  Local solve(const MaterialStep& step, const Matrix& stress, double compliances, int begin, int end) const {
    const int count = end - begin;
    Local local{Points(stress.middleCols(begin, count)), std::vector<Solved>(count)};
    const Matrix start = step.stress0.middleCols(begin, count);
    Matrix rhs = step.strain.middleCols(begin, count) + times(C_, start);
    if (compliances > 1) rhs += times(C_, local.points.stress);
    if (needsTotalStrain())
      local.points.total = step.strain0->middleCols(begin, count) + step.strain.middleCols(begin, count);
    const Problem problem{step.weight, compliances, rhs};
    if (!(step.weight > 0)) {
      local.points.stress = times(E_, rhs) / compliances;
      for (Solved& each : local.solved) each = {0, 0, Vec::Zero(), E_ / compliances};
      return local;
    }
    solveEach(problem, start, local);
    return local;
  }

  struct Problem {
    double weight;
    double compliances;
    const Matrix& rhs;
  };

  /// The law of the points `which` at stresses of theirs.
  std::vector<Solved> linearised(const Problem& problem, const Points& all, const std::vector<int>& which,
                                 const Matrix& stress) const {
    Points at(stress);
    if (all.total.size() > 0) at.total = all.total(Eigen::all, which);
    Matrix slopes;
    evaluate(at, &slopes);
    std::vector<Solved> result(which.size());
    for (size_t k = 0; k < which.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const Vec elastic = problem.compliances * (C_ * stress.col(column));
      const Vec flow = problem.weight * at.rate.col(column);
      const Vec r = problem.rhs.col(which[k]) - elastic - flow;
      if (!r.allFinite()) continue;
      const auto slopesAt = [&](int row) { return turned(Eigen::Map<const Slopes>(&slopes(row, column))); };
      const Mat tangent = problem.compliances * C_ + problem.weight * slopesAt(0);
      const Mat inverse = tangent.partialPivLu().inverse();
      Solved solved{norm(r), norm(elastic) + norm(flow) + norm(problem.rhs.col(which[k])), inverse * r,
                    inverse};
      if (needsTotalStrain())
        solved.moduli = inverse * (Mat::Identity() - problem.weight * slopesAt(tensorRows * tensorRows));
      // A rate beyond the square root of the largest number has no norm: such a stress is no iterate.
      if (std::isfinite(solved.size) && solved.direction.allFinite() && solved.moduli.allFinite())
        result[k] = solved;
    }
    return result;
  }

  /// Whether the last step of Newton's method leaves nothing, or rounding. Elsewhere that step may lead to
  /// the iterate itself, as across a jump of the rate, and is itself the stress of the law.
  [[nodiscard]] static bool isOnLaw(const Local& local, int i) {
    constexpr double enough = 1e-10;    // of the terms of the residual: the next residual is its square
    constexpr double rounding = 1e-15;  // of the stress
    const Solved& at = local.solved[i];
    return at.residual <= enough * at.size ||
           at.direction.norm() <= rounding * local.points.stress.col(i).norm();
  }

  /// Takes the stresses `from` of the points `which` where their residual is less.
  void takeBetter(const Problem& problem, const std::vector<int>& which, const Matrix& from,
                  Local& local) const {
    if (which.empty()) return;
    const std::vector<Solved> others = linearised(problem, local.points, which, from(Eigen::all, which));
    for (size_t k = 0; k < which.size(); ++k)
      if (others[k].residual < local.solved[which[k]].residual) {
        local.solved[which[k]] = others[k];
        local.points.stress.col(which[k]) = from.col(which[k]);
      }
  }

  /// Solves the law from the iterate or from the start of the step. Where a kink of the law stops that, as
  /// the yield surface seen from within, from the stress of no flow, which is beyond.
  void solveEach(const Problem& problem, const Matrix& start, Local& local) const {
    constexpr double good = 1e-3;
    constexpr int fewShort = 4;
    constexpr int manyShort = 60;
    const int count = static_cast<int>(start.cols());
    std::vector<int> all(count);
    std::iota(all.begin(), all.end(), 0);
    local.solved = linearised(problem, local.points, all, local.points.stress);
    std::vector<int> far;
    for (int i = 0; i < count; ++i)
      if (!(local.solved[i].residual <= good * local.solved[i].size)) far.push_back(i);
    takeBetter(problem, far, start, local);
    descend(problem, all, fewShort, local);

    std::vector<int> stuck;
    for (int i = 0; i < count; ++i)
      if (!isOnLaw(local, i)) stuck.push_back(i);
    if (stuck.empty()) return;
    const Local before = local;
    for (const int i : stuck) local.solved[i] = Solved();
    takeBetter(problem, stuck, times(E_, problem.rhs) / problem.compliances, local);
    descend(problem, stuck, manyShort, local);
    for (const int i : stuck)
      if (!(local.solved[i].residual <= before.solved[i].residual)) {
        local.solved[i] = before.solved[i];
        local.points.stress.col(i) = before.points.stress.col(i);
      }
  }

  /// Newton's method at each of the points, with a step length of its own, until so many were short.
  void descend(const Problem& problem, std::vector<int> active, int mostShort, Local& local) const {
    constexpr int rounds = 400;
    constexpr double descent = 1e-4;
    constexpr double isShort = 1e-3;
    constexpr double shortest = 1e-6;
    Vector part = Vector::Ones(local.points.stress.cols());
    std::vector<int> shortOnes(part.size());
    for (int round = 0; round < rounds; ++round) {
      std::erase_if(active, [&](int i) {
        return !std::isfinite(local.solved[i].residual) || isOnLaw(local, i) || shortOnes[i] > mostShort;
      });
      if (active.empty()) return;
      Matrix trial(n, active.size());
      for (size_t k = 0; k < active.size(); ++k)
        trial.col(static_cast<Eigen::Index>(k)) =
            local.points.stress.col(active[k]) + part[active[k]] * local.solved[active[k]].direction;
      const std::vector<Solved> next = linearised(problem, local.points, active, trial);
      for (size_t k = 0; k < active.size(); ++k) {
        const int i = active[k];
        const bool descends = next[k].residual <= (1 - descent * part[i]) * local.solved[i].residual;
        // Where no step is short enough the law has a kink: the slopes beyond it lead on.
        const bool crosses = part[i] < shortest && std::isfinite(next[k].residual);
        if (part[i] < isShort && (descends || crosses)) ++shortOnes[i];
        if (part[i] < shortest * shortest) shortOnes[i] = mostShort + 1;
        if (descends || crosses) {
          local.solved[i] = next[k];
          local.points.stress.col(i) = trial.col(static_cast<Eigen::Index>(k));
          part[i] = 1;
        } else {
          part[i] /= 2;
        }
      }
    }
  }

  static void store(const Mat& H, int point, Linearisation& result) {
    constexpr int block = n == 6 ? 6 : 3;
    result.moduli.col(point) = H.template topLeftCorner<block, block>().reshaped();
    if constexpr (n == 4) result.beyond.col(point) << H.row(3).transpose(), H.col(3).template head<3>();
  }

  std::shared_ptr<const RateLaw> law_;
  LawDescription description_;
  Mat E_;
  Mat C_;
  double poisson_;
};

template <int n>
std::shared_ptr<const Material> materialOf(const Elasticity& elasticity, const OwnLaw& law, Plane plane) {
  constexpr int rows = tensorSize<n>;
  constexpr const char* names[] = {"11", "22", "12", "33", "13", "23"};
  requireValid(elasticity);
  if (n == 4 && !law.inPlaneStrain)
    throw InputError(law.where + ", expected rate33 beside the others " +
                     (plane == Plane::strain ? "in plane strain" : "around an axis"));
  if (!law.law->takes(rows))
    throw InputError(law.where + ", expected a law " + (n == 6 ? "in space" : "in the plane") +
                     ": the rate of this one has " + (n == 6 ? "four components" : "six"));
  Matrix strain = Matrix::Zero(rows, 1);
  if (n == 3) strain(3, 0) = std::numeric_limits<double>::quiet_NaN();
  Matrix rate = Matrix::Zero(rows, 1);
  law.law->evaluate(Matrix::Zero(rows, 1), strain, rate, nullptr);
  for (int k = 0; k < (n == 3 ? 3 : rows); ++k)
    if (!std::isfinite(rate(k, 0)))
      throw InputError(law.where + ", expected a rate that is a number without stress and strain, is " +
                       (std::isnan(rate(k, 0)) ? "not one" : "infinite") + " in component " + names[k] +
                       (n == 3 ? " (e33 is not known in plane stress)" : ""));
  LawDescription description = describe(law.name, elasticity);
  for (const auto& [name, value] : law.parameters) description.parameters.push_back({name, value, ""});
  return std::make_shared<OwnMaterial<n>>(law, elasticity, std::move(description));
}

}  // namespace

std::shared_ptr<const Material> ownMaterial(const Elasticity& elasticity, const OwnLaw& law, Plane plane) {
  if (plane == Plane::stress) return materialOf<3>(elasticity, law, plane);
  if (plane == Plane::none) return materialOf<6>(elasticity, law, plane);
  return materialOf<4>(elasticity, law, plane);
}

}  // namespace mortier
