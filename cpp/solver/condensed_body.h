// One body of a linearised step: its law linearised, its tangent factorised and condensed to its contact
// dofs.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "linear/condensing_solver.h"
#include "solver/contact_dofs.h"
#include "solver/dense_factor.h"
#include "solver/iterate.h"

namespace mortier {

/// Linearises the law of a body at its iterate (material/material.h).
struct BodyLaw {
  /// In the points [begin, end).
  std::function<LawReport(const BodyIterate& iterate, Linearisation& result, int begin, int end)> inBlock =
      {};
  /// Or at all points, the strain known everywhere.
  std::function<void(const BodyIterate& iterate, Linearisation& result)> everywhere = {};
};

class CondensedBody {
 public:
  /// The threads must outlive it. \param whole  the body is not condensed: its tangent is made, and nothing
  /// of what follows it.
  CondensedBody(const Model& model, int body, const std::vector<int>& firstRow, const SolverOptions& options,
                Threads& threads, bool whole = false);

  [[nodiscard]] const ContactDofs& contact() const { return contact_; }

  /// The strain of the iterate, and the law there. \returns the residual, scaled [-].
  double linearise(const Matrix& stress0, const Matrix* shift, BodyIterate& iterate, const BodyLaw& law);
  [[nodiscard]] const Linearisation& law() const { return law_; }  ///< as last linearised
  /// The point whose stress is furthest off the law as last linearised, and by how much [-]; -1 for none.
  [[nodiscard]] std::pair<int, double> furthest(const Matrix& stress0, const BodyIterate& iterate) const;
  /// What the rounding of the mesh and of its displacements makes of stresses, by the moduli of the last
  /// linearisation, over what residuals are measured against [-].
  [[nodiscard]] double rounding(const Matrix& stress0, const BodyIterate& iterate,
                                const Vector& displacement) const;

  /// What factorise() did.
  struct Factors {
    std::string failure;   ///< why there are none
    bool changed = false;  ///< whether it was any work that counts
  };
  /// Factorises the tangent of the last linearisation, unless that and the one factorised before are both of
  /// a body in which nothing flows.
  Factors factorise();
  /// The tangent that was factorised last, as values of the body's pattern.
  [[nodiscard]] const std::vector<double>& tangent() const { return values_; }
  /// Whether points began or ceased to flow in the linearisations since.
  [[nodiscard]] bool stale() const { return factorisedElastic_ != law_.elastic; }
  /// W += C S^-1 C'.
  void addCompliance(Matrix& W) const;
  /// Takes nodal forces (dofs) that are left over. \returns S^-1 times what they are on the contact dofs.
  Vector condense(const Vector& force);
  /// Displacement (dofs) under these and a change of the contact forces, with rigid motions `z` of this body.
  Vector expand(const Vector& forceChange, const Vector& z);

  /// From now on CHOLMOD or UMFPACK.
  void useLibraries();
  [[nodiscard]] bool usesLibraries() const { return engine_ == LinearEngine::suitesparse; }
  /// Whether the factors are those of elasticity.
  [[nodiscard]] bool elasticFactors() const { return elasticFactors_; }
  /// Those that the next factorise() makes were counted before a run was interrupted.
  void elasticFactorsWereCounted() { counted_ = true; }

 private:
  /// What stresses are measured against.
  [[nodiscard]] double residualScale(const Matrix& stress0, const BodyIterate& iterate) const;
  [[nodiscard]] Vector solveSchur(const Vector& f) const;

  const Body& body_;
  ContactDofs contact_;
  LinearEngine engine_;
  bool reduce_;
  bool whole_;
  Threads& threads_;
  std::unique_ptr<CondensingSolver> solver_;  ///< none where the body is whole
  std::vector<double> values_;                ///< of the tangent
  bool factorised_ = false;
  int factorisedElastic_ = -1;  ///< elastic points of the tangent as factorised
  bool elasticFactors_ = false;
  bool counted_ = false;
  Linearisation law_;
  DenseFactor schurFactor_;  ///< of S
  Vector residual_;          ///< right-hand side over equations, condensed in place
  Vector contactForce_;      ///< its part on the contact dofs
};

}  // namespace mortier
