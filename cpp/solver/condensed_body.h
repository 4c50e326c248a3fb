// One body of a linearised step: its law linearised, its tangent factorised and condensed to its contact
// dofs.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/blocks.h"
#include "linear/condensing_solver.h"
#include "solver/body_share.h"
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

  /// The strain of the iterate, and the law there: at the points of this rank where ranks share the body.
  void linearise(const Matrix* shift, BodyIterate& iterate, const BodyLaw& law);
  /// What the law asked for at its points; where ranks share the body it is to become that of all of them.
  struct LawFacts {
    double change = 0;     ///< of stress, the largest; infinite for NaN [Pa]
    double predictor = 0;  ///< the largest component, only where stresses are measured against it [Pa]
    double modulus = 0;    ///< the largest [Pa]
    int elastic = 0;       ///< points that are
  };
  [[nodiscard]] const LawFacts& lawFacts() const { return facts_; }
  void take(const LawFacts& facts);
  /// The residual of what was linearised, scaled [-].
  [[nodiscard]] double residual(const Matrix& stress0, const BodyIterate& iterate) const;
  [[nodiscard]] const Linearisation& law() const { return law_; }  ///< as last linearised
  /// Makes it known at all points, until it is linearised or factorised again. Collective.
  void completeLaw();
  /// Of the share of this rank; null where there is one rank.
  [[nodiscard]] const BodyShare* share() const { return share_ ? &*share_ : nullptr; }
  [[nodiscard]] double largestModulus() const;
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
    bool begun = false;    ///< whether there is anything to join
  };
  /// Factorises the tangent of the last linearisation, unless that and the one factorised before are both of
  /// a body in which nothing flows. Where ranks share the body it begins with that, each with its part.
  Factors factorise();
  /// The tangent that was factorised last, as values of the body's pattern.
  [[nodiscard]] const std::vector<double>& tangent() const { return values_; }
  /// What is left to do where ranks share the body. Collective.
  void join(Factors& factors);
  /// Whether points began or ceased to flow in the linearisations since.
  [[nodiscard]] bool stale() const { return factorisedElastic_ != law_.elastic; }
  /// W += C S^-1 C'.
  void addCompliance(Matrix& W) const;
  /// A load (dofs) less the forces of a stress. Where ranks share the body the stress is 0 at the points of
  /// others, each keeps these forces for condense(), and the load is returned as it is.
  [[nodiscard]] Vector leftOver(const Vector& load, const Matrix& stress);
  /// Takes nodal forces (dofs): those of leftOver(), and what has been added.
  void condense(const Vector& force);
  /// \returns S^-1 times what they are on the contact dofs. Collective.
  Vector joinCondensed();
  /// Finds the displacement under these and a change of the contact forces, with rigid motions `z` of this
  /// body: where it is in contact, and where ranks share it. Collective.
  void moveContact(const Vector& forceChange, const Vector& z);
  /// And elsewhere.
  void expand() { solver_->expand(residual_); }
  /// \returns it (dofs). Collective.
  Vector joinExpanded();
  /// Calls work(begin, end) for all points, or those of this rank.
  template <class Work>
  void forEachOwnBlock(const Work& work) const;

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
  [[nodiscard]] std::unique_ptr<CondensingSolver> newSolver() const;
  void clearLawOfOthers();
  void useSchurComplement(Factors& factors);

  const Body& body_;
  ContactDofs contact_;
  LinearEngine engine_;
  bool reduce_;
  int distributedFrom_;
  bool whole_;
  Threads& threads_;
  std::optional<BodyShare> share_;            ///< where ranks share the body
  std::unique_ptr<CondensingSolver> solver_;  ///< none where the body is whole
  std::vector<double> values_;                ///< of the tangent
  bool factorised_ = false;
  int factorisedElastic_ = -1;  ///< elastic points of the tangent as factorised
  bool elasticFactors_ = false;
  bool counted_ = false;
  Linearisation law_;
  LawFacts facts_;
  bool lawComplete_ = false;  ///< whether it is known at all points, or is 0 at those of other ranks
  DenseFactor schurFactor_;   ///< of S
  Vector ownForce_;           ///< of the triangles of this rank (dofs)
  Vector residual_;           ///< right-hand side over equations, condensed in place
  Vector contactForce_;       ///< its part on the contact dofs
};

template <class Work>
void CondensedBody::forEachOwnBlock(const Work& work) const {
  if (!share_) return forEachBlock(body_.points(), threads_, work);
  const std::vector<BodyShare::Run>& runs = share_->runs();
  threads_.forEach(static_cast<int>(runs.size()), [&](int i) { work(runs[i].first, runs[i].second); });
}

}  // namespace mortier
