#include <algorithm>
#include <cmath>
#include <limits>

#include "base/dense_templates.h"
#include "solver/contact_sets.h"
#include "solver/sparse_contact.h"

namespace mortier {
namespace {

class SparseSets final : public ContactSets {
 public:
  SparseSets(SparseContact& matrix, const ContactProblem& problem, const std::vector<char>& idle,
             const Vector& force, const Vector& slack, const Vector& p0, const Vector& balance)
      : ContactSets(problem, idle, matrix.compliance(), slack, p0, balance), matrix_(matrix), force_(force) {
    if (balance.size() == 0) return;
    const Vector carried =
        matrix.springMotions().transpose().partialPivLu().solve(balance + problem.G.transpose() * p0);
    const double unit = matrix.stiffnessAtSprings();
    weight_ = proximalStiffness(problem.proximal, carried.lpNorm<Eigen::Infinity>() / unit,
                                slack.size() > 0 ? slack.maxCoeff() : 0);
    weakest_ = weakestProximal;
  }

  // Most sets are left again: only one that seems to be the last is solved on to rounding.
  bool refactor(const std::vector<char>& active) override {
    last_ = active;
    return true;
  }
  [[nodiscard]] bool fresh() const override { return exact_; }

  /// What closed conditions resist is no rigid motion, but the part of the strain that springs resist.
  [[nodiscard]] Vector rigid(const ContactSolution& solution) const override {
    const Matrix free = rigidMotionsOn(solution.active, problem_.G).free;
    return free * (free.transpose() * solution.rigid);
  }

  [[nodiscard]] const Vector& motion() const { return solved_.motion; }

 private:
  bool take(const std::vector<char>& active) override {
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
  void solveTaken(ContactSolution& solution) override {
    exact_ = solution.active == last_;
    solved_ = matrix_.solve(force_, p0_, slack_, matrix_.springMotions() * z0_, exact_);
    solution.change = solved_.change;
    solution.rigid = solved_.rigid;
    open_ = slack_ - matrix_.C() * solved_.motion;
    if (z0_.size() > 0) open_ -= problem_.G * solved_.rigid;
  }
  void growTaken(int condition, Growth& growth) override {
    const Vector load = -matrix_.C().row(condition).transpose();
    const Vector zero = Vector::Zero(slack_.size());
    const SparseContact::Solution rate = matrix_.solve(load, zero, zero, Vector::Zero(z0_.size()), true);
    growth.force = rate.change;
    growth.force[condition] = 1;
    growth.slack = -(matrix_.C() * rate.motion);
    if (z0_.size() > 0) growth.slack -= problem_.G * rate.rigid;
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
  std::vector<char> last_;  ///< to be solved on to rounding
  bool exact_ = false;
  SparseContact::Solution solved_;
};

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
  ContactSolution solution = solveBalanced(contact, active);
  solution.idle = static_cast<int>(std::count(idle.begin(), idle.end(), 1));
  solution.work = matrix.factorisations() - before;
  motion = contact.motion();
  // The motion along which bodies leave is found without what was taken first.
  if (solution.outcome == ContactSolution::Outcome::unbalanced)
    solution.rigid = contact.rigid(solution);
  else
    solution.rigid += moved;
  return solution;
}

}  // namespace mortier
