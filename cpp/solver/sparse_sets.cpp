#include "solver/sparse_sets.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mortier {
namespace {

/// How a proximal term is weakened from one repetition to the next, and down to which weight.
constexpr double softer = 1e-2;
constexpr double softest = 1e-13;

class SparseSets final : public ContactSets {
 public:
  SparseSets(SparseContact& matrix, const ContactProblem& problem, const std::vector<char>& idle,
             const Vector& force, const Vector& slack, const Vector& p0, const Vector& balance)
      : ContactSets(problem, idle, matrix.compliance(), slack, p0, balance),
        matrix_(matrix),
        force_(force),
        anchors_(Vector::Zero(balance.size())) {
    if (balance.size() == 0) return;
    weight_ = problem.proximal;
    // Where a body has to travel until contact closes, weak enough that the load takes it there.
    constexpr double farther = 10;
    const double open = slack.size() > 0 ? slack.maxCoeff() : 0;
    const Vector carried =
        matrix.springMotions().transpose().partialPivLu().solve(balance + problem.G.transpose() * p0);
    const double load = carried.lpNorm<Eigen::Infinity>();
    if (open > 0 && load > 0)
      weight_ = std::min(weight_, load / (farther * open * matrix.stiffnessAtSprings()));
  }

  void centre(const Vector& z0) override {
    anchors_ = matrix_.springMotions() * z0;
    pivotsLeft_ = 20 * static_cast<int>(slack_.size()) + 100;
  }
  void soften() override { weight_ = std::max(softer * weight_, std::min(weight_, weakest_)); }

  bool solveOn(ContactSolution& solution) override {
    ++solution.pivots;
    --pivotsLeft_;
    if (!take(solution.active)) return false;
    exact_ = solution.active == last_;
    solved_ = matrix_.solve(force_, p0_, slack_, anchors_, exact_);
    solution.change = solved_.change;
    solution.rigid = solved_.rigid;
    open_ = slack_ - matrix_.C() * solved_.motion;
    if (anchors_.size() > 0) open_ -= problem_.G * solved_.rigid;
    return true;
  }
  // Most sets are left again: only one that seems to be the last is solved on to rounding.
  bool refactor(const std::vector<char>& active) override {
    last_ = active;
    return true;
  }
  [[nodiscard]] bool fresh() const override { return exact_; }

  bool grow(int condition, ContactSolution& solution, Growth& growth) override {
    ++solution.pivots;
    --pivotsLeft_;
    if (!take(solution.active)) return false;
    const Vector load = -matrix_.C().row(condition).transpose();
    const Vector zero = Vector::Zero(slack_.size());
    const SparseContact::Solution rate = matrix_.solve(load, zero, zero, Vector::Zero(anchors_.size()), true);
    growth.force = rate.change;
    growth.force[condition] = 1;
    growth.slack = -(matrix_.C() * rate.motion);
    if (anchors_.size() > 0) growth.slack -= problem_.G * rate.rigid;
    return true;
  }
  /// What closed conditions resist is no rigid motion, but what springs see of the strain.
  [[nodiscard]] Vector rigid(const ContactSolution& solution) const override {
    constexpr double heldFraction = 1e-14;
    Matrix closed = problem_.G;
    for (Eigen::Index i = 0; i < closed.rows(); ++i)
      if (solution.active[i] == 0) closed.row(i).setZero();
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(closed.transpose() * closed);
    const auto loose = (eigen.eigenvalues().array() <= heldFraction * problem_.G.squaredNorm()).count();
    const Matrix free = eigen.eigenvectors().leftCols(loose);
    return free * (free.transpose() * solution.rigid);
  }
  [[nodiscard]] bool capped() const override { return pivotsLeft_ <= 0; }

  [[nodiscard]] const Vector& motion() const { return solved_.motion; }

 private:
  bool take(const std::vector<char>& active) {
    constexpr double strongest = 1e-6;
    matrix_.setSprings(weight_);
    while (!matrix_.factorise(active)) {
      if (weight_ == 0 || weight_ >= strongest) {
        redundant_ = true;
        return false;
      }
      weakest_ = weight_ = weight_ / softer;  // lost in the rounding of the stiffness
      matrix_.setSprings(weight_);
    }
    return true;
  }
  [[nodiscard]] Noise noise(const ContactSolution& solution) const override {
    // Forces beside those that are there; slacks beside the motions whose differences they are.
    constexpr double corrections = 4;
    const double force = std::max(p0_.cwiseAbs().maxCoeff(), (p0_ + solved_.change).cwiseAbs().maxCoeff());
    double length = slack_.cwiseAbs().maxCoeff() + (slack_ - open_).cwiseAbs().maxCoeff();
    length = std::max(rounding * length, corrections * solved_.motionNoise);
    for (Eigen::Index i = 0; i < open_.size(); ++i)
      if (solution.active[i] != 0) length = std::max(length, 2 * std::abs(open_[i]));
    return {std::max(rounding * force, corrections * solved_.forceNoise),
            (length * diagonal_.cwiseInverse()).eval()};
  }

  SparseContact& matrix_;
  const Vector& force_;
  Vector anchors_;
  double weight_ = 0;
  double weakest_ = softest;
  std::vector<char> last_;  ///< to be solved on to rounding
  bool exact_ = false;
  int pivotsLeft_ = 0;
  SparseContact::Solution solved_;
};

/// Semismooth Newton steps: forces that pull are dropped and what overlaps is closed, all at once. That takes
/// a few sets where bodies are thick, and may go round where they are thin. \returns the set with the fewest
/// wrong signs, for principal pivoting to go on from.
std::vector<char> startingSet(SparseSets& contact, const std::vector<char>& active) {
  constexpr int most = 20;
  constexpr int patience = 3;
  constexpr double fewer = 0.9;
  ContactSolution solution;
  solution.active = active;
  std::vector<char> best = active;
  size_t least = std::numeric_limits<size_t>::max();
  contact.centre(Vector::Zero(contact.problem().G.cols()));
  for (int left = patience, k = 0; left > 0 && k < most && contact.solveOn(solution); ++k) {
    const ContactSets::Signs signs = contact.signsOf(solution);
    const size_t wrong = signs.pulls.size() + signs.overlaps.size();
    left = static_cast<double>(wrong) < fewer * static_cast<double>(least) ? patience : left - 1;
    if (wrong < least) {
      least = wrong;
      best = solution.active;
    }
    if (wrong == 0) break;
    for (const int i : signs.pulls) solution.active[i] = 0;
    for (const int i : signs.overlaps) solution.active[i] = 1;
  }
  return best;
}

}  // namespace

ContactSolution solveSparse(SparseContact& matrix, const ContactProblem& problem, const Vector& force,
                            const Vector& fullSlack, const Vector& p0, const Vector& balance,
                            std::vector<char> active, Vector& motion) {
  Vector slack = fullSlack;
  const Vector moved = moveRigidBodiesIntoContact(problem.G, active, slack);
  const std::vector<char> idle = idleConditions(matrix.compliance());
  for (size_t i = 0; i < idle.size(); ++i)
    if (idle[i] != 0) active[i] = 0;
  const int before = matrix.factorisations();
  SparseSets contact(matrix, problem, idle, force, slack, p0, balance);
  ContactSolution solution = solveBalanced(contact, startingSet(contact, active));
  solution.idle = static_cast<int>(std::count(idle.begin(), idle.end(), 1));
  solution.work = matrix.factorisations() - before;
  motion = contact.motion();
  // The motion along which bodies leave is told without what was taken first.
  if (solution.outcome == ContactSolution::Outcome::unbalanced)
    solution.rigid = contact.rigid(solution);
  else
    solution.rigid += moved;
  return solution;
}

}  // namespace mortier
