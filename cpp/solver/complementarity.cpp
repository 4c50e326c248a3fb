#include "solver/complementarity.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace mortier {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// How a proximal term is weakened from one repetition to the next, and down to which weight.
constexpr double softer = 1e-2;
constexpr double softest = 1e-13;

std::vector<int> indices(const std::vector<char>& set) {
  std::vector<int> result;
  for (size_t i = 0; i < set.size(); ++i)
    if (set[i] != 0) result.push_back(static_cast<int>(i));
  return result;
}

class Pivoting {
 public:
  /// \param idle  conditions that stay inactive.
  Pivoting(const ContactProblem& problem, const std::vector<char>& idle, const Vector& slack,
           const Vector& p0, const Vector& balance)
      : problem_(problem), idle_(idle), slack_(slack), p0_(p0), balance_(balance) {
    // The proximal weight against the stiffness that all nodes together give to rigid motions.
    if (problem.G.cols() > 0) {
      const Matrix stiffness = problem.G.transpose() * solve(problem.W, problem.G);
      proximal_ = problem.proximal * stiffness.diagonal().maxCoeff();
      softest_ = softest * stiffness.diagonal().maxCoeff();
    }
  }

  /// Weakens the proximal term: repetitions converge faster than at any fixed weight (Rockafellar 1976).
  void soften() { proximal_ = std::max(softer * proximal_, std::min(proximal_, softest_)); }

  /// Ends at the active set of the proximal problem around z0. \returns false after too many pivots.
  bool run(const Vector& z0, ContactSolution& solution) const {
    constexpr int patience = 8;
    const auto n = static_cast<int>(slack_.size());
    const int limit = solution.pivots + 20 * n + 100;
    int fewestWrong = n + 1;
    int tries = 0;
    while (solution.pivots < limit) {
      ++solution.pivots;
      solveOn(indices(solution.active), z0, solution);
      if (redundant_) return false;
      std::vector<int> wrong = wrongSigns(solution);
      if (wrong.empty()) return true;
      const auto count = static_cast<int>(wrong.size());
      tries = count < fewestWrong ? 0 : tries + 1;
      fewestWrong = std::min(fewestWrong, count);
      if (tries > patience) wrong.resize(1);
      for (const int i : wrong) solution.active[i] = solution.active[i] != 0 ? 0 : 1;
    }
    return false;
  }

  /// Whether a matrix that was to be solved with is singular but for rounding.
  [[nodiscard]] bool redundant() const { return redundant_; }

  /// What the proximal term still carries of the balance, against all forces in it, or those that are usual.
  [[nodiscard]] double imbalance(const ContactSolution& solution, double usual = 0) const {
    const Vector rest = balance_ - problem_.G.transpose() * solution.change;
    const Vector forces = ((p0_.cwiseAbs() + (p0_ + solution.change).cwiseAbs()).array() + usual).matrix();
    const double scale =
        balance_.cwiseAbs().maxCoeff() + (problem_.G.cwiseAbs().transpose() * forces).maxCoeff();
    return scale > 0 ? rest.cwiseAbs().maxCoeff() / scale : 0;
  }

  /// Whether the load drives the bodies along a motion that opens contact or slides along it.
  [[nodiscard]] bool leaves(const ContactSolution& solution) const {
    constexpr double negligible = 1e-6;
    const Vector closing = problem_.G * solution.rigid;
    const double work = (balance_ + problem_.G.transpose() * p0_).dot(solution.rigid);
    return closing.maxCoeff() <= negligible * closing.cwiseAbs().maxCoeff() && work > 0;
  }

 private:
  [[nodiscard]] Matrix solve(const Matrix& block, const Matrix& right) const {
    constexpr double singular = 1e-12;
    if (problem_.symmetric) {
      const Eigen::LLT<Matrix> factor(block);
      const auto pivots = factor.matrixLLT().diagonal().array().square();
      redundant_ = redundant_ || factor.info() != Eigen::Success ||
                   !((pivots / block.diagonal().array()).minCoeff() > singular);
      return factor.solve(right);
    }
    const Eigen::PartialPivLU<Matrix> factor(block);
    const auto pivots = factor.matrixLU().diagonal().cwiseAbs();
    const Vector sizes = block.colwise().lpNorm<Eigen::Infinity>();
    redundant_ = redundant_ || !((pivots.array() / sizes.array()).minCoeff() > singular);
    return factor.solve(right);
  }

  /// p = 0 off the active set, s = 0 on it.
  void solveOn(const std::vector<int>& active, const Vector& z0, ContactSolution& solution) const {
    const Matrix& G = problem_.G;
    Vector& dp = solution.change;
    dp = -p0_;
    for (const int i : active) dp[i] = 0;
    Matrix right(active.size(), 1 + G.cols());
    right.col(0) = -(slack_ + problem_.W * dp)(active);
    right.rightCols(G.cols()) = G(active, Eigen::all);
    const Matrix solved = active.empty() ? right : solve(problem_.W(active, active), right);
    if (G.cols() > 0) {
      const Matrix Ga = G(active, Eigen::all);
      Matrix stiffness = Ga.transpose() * solved.rightCols(G.cols());
      stiffness.diagonal().array() += proximal_;
      const Vector force = balance_ - G.transpose() * dp - Ga.transpose() * solved.col(0) + proximal_ * z0;
      solution.rigid = stiffness.partialPivLu().solve(force);
    }
    if (active.empty()) return;
    dp(active) = solved.col(0);
    if (G.cols() > 0) dp(active) += solved.rightCols(G.cols()) * solution.rigid;
  }

  /// Signs are judged against rounding, slacks as the forces that would close them.
  [[nodiscard]] std::vector<int> wrongSigns(const ContactSolution& solution) const {
    constexpr double rounding = 64 * epsilon;
    Vector s = slack_ + problem_.W * solution.change;
    if (problem_.G.cols() > 0) s -= problem_.G * solution.rigid;
    const Vector p = p0_ + solution.change;
    double largest = 0;
    for (Eigen::Index i = 0; i < s.size(); ++i)
      if (idle_[i] == 0)
        largest =
            std::max({largest, std::abs(p[i]), std::abs(p0_[i]), std::abs(slack_[i]) / problem_.W(i, i)});
    std::vector<int> wrong;
    for (Eigen::Index i = 0; i < s.size(); ++i) {
      if (idle_[i] != 0) continue;
      const double value = solution.active[i] != 0 ? p[i] : s[i] / problem_.W(i, i);
      if (!(value >= -rounding * largest)) wrong.push_back(static_cast<int>(i));
    }
    return wrong;
  }

  const ContactProblem& problem_;
  const std::vector<char>& idle_;
  const Vector& slack_;
  const Vector& p0_;
  const Vector& balance_;
  double proximal_ = 0;
  double softest_ = 0;
  mutable bool redundant_ = false;
};

/// Conditions that no free motion can change: both sides are held there.
std::vector<char> idleConditions(const Matrix& W) {
  constexpr double rounding = 1e-24;  // W is quadratic in the rows of C
  std::vector<char> idle(W.rows(), 0);
  const double largest = W.rows() > 0 ? W.diagonal().cwiseAbs().maxCoeff() : 0;
  for (Eigen::Index i = 0; i < W.rows(); ++i) idle[i] = std::abs(W(i, i)) <= rounding * largest ? 1 : 0;
  return idle;
}

}  // namespace

namespace {

ContactSolution solveRegular(const ContactProblem& problem, const std::vector<char>& idle,
                             const Vector& slack, const Vector& p0, const Vector& balance,
                             const std::vector<char>& active, bool& redundant) {
  constexpr int repetitions = 12;
  constexpr double balanced = 1e-14;
  constexpr double slow = 1e-12;  // three repetitions leave no more than that, unless the term is too strong

  ContactSolution solution;
  solution.active = active;
  solution.rigid = Vector::Zero(problem.G.cols());
  Pivoting pivoting(problem, idle, slack, p0, balance);
  Vector z0 = solution.rigid;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    const bool ended = pivoting.run(z0, solution);
    redundant = pivoting.redundant();
    if (!ended) return solution;
    const double imbalance = problem.G.cols() == 0 ? 0 : pivoting.imbalance(solution);
    if (imbalance <= balanced) break;
    z0 = solution.rigid;
    if (repetition > 1 && imbalance > slow) pivoting.soften();
  }
  constexpr double hopeless = 1e-6;
  if (problem.G.cols() > 0 && pivoting.imbalance(solution, problem.force) > hopeless)
    solution.outcome =
        pivoting.leaves(solution) ? ContactSolution::Outcome::unbalanced : ContactSolution::Outcome::cycled;
  else
    solution.outcome = ContactSolution::Outcome::solved;
  return solution;
}

/// Conditions that say the same twice leave the forces undetermined and W singular: a proximal term on dp
/// makes it regular, repeated until it no longer acts.
/// \param weakest  weight of the term. The smaller, the fewer repetitions, and the more rounding in the signs of forces.
ContactSolution solveRedundant(const ContactProblem& problem, const std::vector<char>& idle,
                               const Vector& slack, const Vector& p0, const Vector& balance,
                               const std::vector<char>& active, double weakest) {
  constexpr int repetitions = 40;
  constexpr double done = 1e-15;
  ContactProblem regular = problem;
  double weight = std::max(problem.proximal, weakest);
  ContactSolution solution;
  solution.active = active;
  Vector before = Vector::Zero(slack.size());
  int pivots = 0;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    bool redundant = false;
    const Vector term = weight * problem.W.diagonal();
    regular.W.diagonal() = problem.W.diagonal() + term;
    solution = solveRegular(regular, idle, slack - term.cwiseProduct(before), p0, balance, solution.active,
                            redundant);
    pivots += solution.pivots;
    solution.pivots = pivots;
    if (solution.outcome != ContactSolution::Outcome::solved) break;
    const double left = term.cwiseProduct(solution.change - before).cwiseAbs().maxCoeff();
    const double scale =
        problem.W.diagonal().cwiseProduct(p0.cwiseAbs() + solution.change.cwiseAbs()).maxCoeff();
    if (left <= done * scale) break;
    before = solution.change;
    weight = std::max(softer * weight, weakest);
  }
  return solution;
}

}  // namespace

int dependentConditions(const Matrix& W) {
  constexpr double singular = 1e-12;  // as in Pivoting::solve
  const std::vector<char> idle = idleConditions(W);
  const auto idles = static_cast<Eigen::Index>(std::count(idle.begin(), idle.end(), 1));
  Eigen::ColPivHouseholderQR<Matrix> factor(W);
  factor.setThreshold(singular);
  return static_cast<int>(W.rows() - idles - factor.rank());
}

ContactSolution solveContact(const ContactProblem& problem, const Vector& slack, const Vector& p0,
                             const Vector& balance, std::vector<char> active) {
  if (slack.size() == 0) {
    ContactSolution solution;
    solution.change = p0;
    solution.rigid = Vector::Zero(problem.G.cols());
    solution.outcome = ContactSolution::Outcome::solved;
    return solution;
  }
  const std::vector<char> idle = idleConditions(problem.W);
  for (size_t i = 0; i < idle.size(); ++i)
    if (idle[i] != 0) active[i] = 0;
  const auto idles = static_cast<int>(std::count(idle.begin(), idle.end(), 1));
  bool dependent = false;
  if (idles == 0 || problem.G.cols() == 0) {
    ContactSolution solution = solveRegular(problem, idle, slack, p0, balance, active, dependent);
    solution.idle = idles;
    if (!dependent) return solution;
  }
  ContactProblem regular = problem;
  for (size_t i = 0; i < idle.size(); ++i)
    if (idle[i] != 0) regular.W(i, i) = problem.W.diagonal().maxCoeff();
  ContactSolution solution;
  for (const double weight : {1e-9, 1e-8, 1e-7}) {
    solution = solveRedundant(regular, idle, slack, p0, balance, active, weight);
    if (solution.outcome != ContactSolution::Outcome::cycled) break;
  }
  solution.idle = idles;
  solution.dependent = dependent;
  return solution;
}

}  // namespace mortier
