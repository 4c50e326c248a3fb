// One body of a linearised step: its law linearised, its tangent factorised and condensed to its contact
// dofs.
#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "linear/condensing_solver.h"
#include "solver/dense_factor.h"
#include "solver/iterate.h"
#include "solver/model.h"

namespace mortier {

// A body as contact has it: the equations that its conditions act on, its columns of C there, and the
// rigid motions that its supports leave free.

struct ContactDofs {
  /// \param firstRow  of each interface among the conditions across contact, and their number at the end.
  /// Those along the line come after all of them, for each interface with friction as many, then the rows of
  /// ties.
  /// \throws UnheldBodyError where a motion does not move the contact dofs.
  ContactDofs(const Model& model, int body, const std::vector<int>& firstRow);

  /// Takes the rows of interfaces that have followed the bodies.
  void updateConstraints(const Model& model, int body, const std::vector<int>& firstRow);

  std::vector<int> equations;     ///< of the contact dofs; all of a line that may touch anywhere
  Eigen::SparseMatrix<double> C;  ///< contact conditions and ties x contact dofs
  Matrix motions;                 ///< rigid motions, by dofs
  Matrix R;                       ///< the same on the contact dofs, orthonormal there

  /// Whether no condition acts on the body.
  [[nodiscard]] bool none() const { return equations.empty(); }
  /// The rigid motion with these coefficients, in words.
  [[nodiscard]] std::string describe(const Body& body, const Vector& z) const;
  /// Work of nodal forces (dofs) on the rigid motions: what only contact can balance. Stresses do none.
  /// Forces that balance each other but for rounding give zero.
  [[nodiscard]] Vector rigidForce(const Vector& load) const;

 private:
  void findEquations(const Model& model, int body, const std::vector<int>& firstRow);
  void findMotions(const Model& model, int body);

  std::vector<int> column_;  ///< of C, by equations of the body; -1: none
};

/// Linearises the law of a body at its iterate (material/material.h).
struct BodyLaw {
  /// In the points [begin, end).
  std::function<LawReport(const BodyIterate& iterate, Linearisation& result, int begin, int end)> inBlock =
      {};
  /// Or at all points.
  std::function<void(const BodyIterate& iterate, Linearisation& result)> everywhere = {};
};

class CondensedBody {
 public:
  /// The threads must outlive it. \param whole  the body is not condensed: its tangent is made, and nothing
  /// of what follows it.
  CondensedBody(const Model& model, int body, const std::vector<int>& firstRow, const SolverOptions& options,
                Threads& threads, bool whole = false);

  [[nodiscard]] const ContactDofs& contact() const { return contact_; }
  [[nodiscard]] ContactDofs& contact() { return contact_; }

  /// The strain of the iterate, and the law there.
  void linearise(const Matrix* explicitStrain, BodyIterate& iterate, const BodyLaw& law);
  /// The residual of what was linearised, scaled [-].
  /// \param motion  the largest of any body: contact hands on what its rounding strains [m]
  [[nodiscard]] double residual(const Matrix& stress0, const BodyIterate& iterate, double motion) const;
  [[nodiscard]] const Linearisation& law() const { return law_; }  ///< as last linearised
  /// Whether all points are elastic.
  [[nodiscard]] bool elastic() const { return law_.elastic == body_.points(); }
  [[nodiscard]] double largestModulus() const;
  /// The point whose stress is furthest off the law as last linearised, and by how much [-]; -1
  /// for none.
  [[nodiscard]] std::pair<int, double> worstPoint(const Matrix& stress0, const BodyIterate& iterate,
                                                  double motion) const;
  /// What the rounding of the mesh and of its displacements makes of stresses, by the moduli of the last
  /// linearisation, over what residuals are measured against [-].
  [[nodiscard]] double rounding(const Matrix& stress0, const BodyIterate& iterate, double motion,
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
  /// Takes nodal forces (dofs). \returns S^-1 times what they are on the contact dofs.
  Vector condense(const Vector& force);
  /// The displacement (dofs) under these and a change of the contact forces, with rigid motions `z` of this
  /// body.
  Vector expand(const Vector& forceChange, const Vector& z);

  /// From now on double precision; where that was in use, CHOLMOD or UMFPACK.
  void useNextEngine();
  [[nodiscard]] int enginesGivenUp() const { return enginesGivenUp_; }
  [[nodiscard]] bool inSinglePrecision() const { return engine_ == LinearEngine::single && !whole_; }
  /// Whether the factors are those of elasticity.
  [[nodiscard]] bool elasticFactors() const { return elasticFactors_; }
  /// Those that the next factorise() makes were counted before a run was interrupted.
  void restoreCount() { counted_ = true; }

 private:
  /// What stresses are measured against.
  [[nodiscard]] double residualScale(const Matrix& stress0, const BodyIterate& iterate, double motion) const;
  [[nodiscard]] Vector solveSchur(const Vector& f) const;
  void useSchurComplement(Factors& factors);

  const Body& body_;
  ContactDofs contact_;
  LinearEngine engine_;
  int enginesGivenUp_ = 0;
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
  double stressChange_ = 0;  ///< by the law as last linearised; NaN where it has none [Pa]
  DenseFactor schurFactor_;  ///< of S
  Vector residual_;      ///< right-hand side over equations, condensed in place; of a rigid body its motion
  Vector contactForce_;  ///< its part on the contact dofs
};

}  // namespace mortier
