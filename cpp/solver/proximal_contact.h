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
  bool refactor(const std::vector<char>& active) override;
  [[nodiscard]] bool fresh() const override { return factor_.fresh(); }
  [[nodiscard]] bool capped() const override { return work_.done > work_.limit || ContactSets::capped(); }

 private:
  bool take(const std::vector<char>& active) override;
  void solveTaken(ContactSolution& solution) override;
  void growTaken(int condition, Growth& growth) override;
  [[nodiscard]] Noise noise(const ContactSolution& solution) const override;
  [[nodiscard]] Vector compliance(const Vector& p);
  Vector solve(const Vector& h, Vector& f);

  Work& work_;
  ActiveFactor factor_;
  double stiffness_ = 0;  ///< of all nodes together against rigid motions
  RigidMotions motions_;
  Matrix forces_;  ///< W_AA^-1 G_A held
  Eigen::PartialPivLU<Matrix> stiffnessFactor_;
};

}  // namespace mortier
