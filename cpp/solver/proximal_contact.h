// The contact problem of complementarity.h where W is regular, on one active set after the other, with dense
// factors of W.
#pragma once

#include <Eigen/LU>
#include <vector>

#include "solver/active_factor.h"
#include "solver/contact_sets.h"

namespace mortier {

/// Operations done for a contact problem, and how many are allowed.
struct Work {
  explicit Work(const ContactProblem& problem);
  double factorisation = 0;
  double limit = 0;
  double done = 0;
};

class ProximalContact final : public ContactSets {
 public:
  /// \param idle  conditions that stay inactive. All that is given by reference must outlive this.
  ProximalContact(const ContactProblem& problem, const std::vector<char>& idle, const Vector& slack,
                  const Vector& p0, const Vector& balance, Work& work);

  /// Begins anew with another slack.
  void restart(const Vector& slack);
  void centre(const Vector& z0) override;
  void soften() override;
  bool solveOn(ContactSolution& solution) override;
  bool refactor(const std::vector<char>& active) override;
  [[nodiscard]] bool fresh() const override { return factor_.fresh(); }
  bool grow(int condition, ContactSolution& solution, Growth& growth) override;
  [[nodiscard]] bool capped() const override { return work_.done > work_.limit || pivotsLeft_ <= 0; }

 private:
  [[nodiscard]] Noise noise(const ContactSolution& solution) const override;
  [[nodiscard]] Vector compliance(const Vector& p);
  bool take(const std::vector<char>& active);
  Vector solve(const Vector& h, Vector& f);

  Vector z0_;
  Work& work_;
  ActiveFactor factor_;
  double stiffness_ = 0;  ///< of all nodes together against rigid motions
  double proximal_ = 0;
  Matrix held_, free_;  ///< motions that the set resists, and those that it does not
  Matrix forces_;       ///< W_AA^-1 G_A held
  Eigen::PartialPivLU<Matrix> stiffnessFactor_;
  int pivotsLeft_ = 0;  ///< sets of a few conditions cost next to no work
};

}  // namespace mortier
