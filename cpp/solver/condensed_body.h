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
  /// Those along the line come after all of them, for each interface with friction as many.
  /// \throws UnheldBodyError where a motion does not move the contact dofs.
  ContactDofs(const Model& model, int body, const std::vector<int>& firstRow);

  /// Takes the rows of interfaces that have followed the bodies.
  void takeRows(const Model& model, int body, const std::vector<int>& firstRow);

  std::vector<int> equations;     ///< of the contact dofs; all of a line that may touch anywhere
  Eigen::SparseMatrix<double> C;  ///< contact conditions x contact dofs
  Matrix motions;                 ///< rigid motions, by dofs
  Matrix R;                       ///< the same on the contact dofs, orthonormal there

  /// Whether no condition acts on the body.
  [[nodiscard]] bool none() const { return equations.empty(); }
  /// The rigid motion with these coefficients, in words. Collective.
  [[nodiscard]] std::string describe(const Model& model, int body, const Vector& z) const;
  /// Work of nodal forces (dofs) on the rigid motions: what only contact can balance. Stresses do none.
  /// Forces that balance each other but for rounding give zero.
  /// \param load  complete at all nodes
  [[nodiscard]] Vector rigidForce(const Model& model, int body, const Vector& load) const;

 private:
  void findEquations(const Model& model, int body, const std::vector<int>& firstRow);
  void findMotions(const Model& model, int body);

  Matrix basis_;             ///< of the motions by those of rigidModes()
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
  void linearise(const Matrix* shift, BodyIterate& iterate, const BodyLaw& law);
  /// What a part has found where it was linearised, which is to become what all have; the largest each.
  struct LawFacts {
    double change = 0;     ///< of stress; infinite for NaN [Pa]
    double predictor = 0;  ///< a component [Pa]
    double modulus = 0;    ///< [Pa]
    double before = 0;     ///< stress at the start of the step [Pa]
    double stress = 0;     ///< of the iterate [Pa]
    double elastic = 0;    ///< points that are: their number
  };
  [[nodiscard]] LawFacts factsOfPart(const Matrix& stress0, const BodyIterate& iterate) const;
  void take(const LawFacts& facts);
  /// The residual of what was linearised, scaled [-].
  /// \param motion  the largest of any body: contact hands on what its rounding strains [m]
  [[nodiscard]] double residual(const Matrix& stress0, const BodyIterate& iterate, double motion) const;
  [[nodiscard]] const Linearisation& law() const { return law_; }  ///< as last linearised
  /// Whether all points of all ranks are elastic.
  [[nodiscard]] bool elastic() const { return law_.elastic == allPoints_; }
  /// Of all ranks.
  [[nodiscard]] double largestModulus() const;
  /// The point of this rank whose stress is furthest off the law as last linearised, and by how much [-]; -1
  /// for none.
  [[nodiscard]] std::pair<int, double> furthest(const Matrix& stress0, const BodyIterate& iterate,
                                                double motion) const;
  /// What the rounding of the mesh and of its displacements makes of stresses, by the moduli of the last
  /// linearisation, over what residuals are measured against [-].
  [[nodiscard]] double rounding(const Matrix& stress0, const BodyIterate& iterate, double motion,
                                const Vector& displacement) const;

  /// What factorise() did.
  struct Factors {
    std::string failure;   ///< why there are none
    bool changed = false;  ///< whether it was any work that counts
    bool begun = false;    ///< whether there is anything to join
  };
  /// Factorises the tangent of the last linearisation, unless that and the one factorised before are both of
  /// a body in which nothing flows. A rank begins with that for its part.
  Factors factorise();
  /// The tangent that was factorised last, as values of the body's pattern.
  [[nodiscard]] const std::vector<double>& tangent() const { return values_; }
  /// The remaining work for parts. Collective.
  void join(Factors& factors);
  /// Whether points began or ceased to flow in the linearisations since.
  [[nodiscard]] bool stale() const { return factorisedElastic_ != law_.elastic; }
  /// W += C S^-1 C'.
  void addCompliance(Matrix& W) const;
  /// A load (dofs) less the forces of a stress. Of a part these forces are kept for condense(), as what is
  /// added to the load meanwhile is that of all ranks.
  [[nodiscard]] Vector leftOver(const Vector& load, const Matrix& stress);
  /// Takes nodal forces (dofs): those of leftOver(), and what has been added.
  void condense(const Vector& force);
  /// \returns S^-1 times what they are on the contact dofs. Collective.
  Vector joinCondensed();
  /// Finds the displacement under these and a change of the contact forces, with rigid motions `z` of this
  /// body: where it is in contact, and where ranks share it. Collective.
  void moveContact(const Vector& forceChange, const Vector& z);
  /// \returns it everywhere (dofs); of a part before it is completed at its nodes.
  Vector expand();

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
  [[nodiscard]] std::unique_ptr<CondensingSolver> newSolver() const;
  [[nodiscard]] LawFacts measured(const Matrix& stress0, const BodyIterate& iterate) const;
  void useSchurComplement(Factors& factors);

  const Body& body_;
  ContactDofs contact_;
  LinearEngine engine_;
  int enginesGivenUp_ = 0;
  bool reduce_;
  int distributedFrom_;
  bool whole_;
  Threads& threads_;
  const BodyPart* part_ = nullptr;  ///< where the body is one
  Ranks* ranks_ = nullptr;
  int allPoints_;
  std::unique_ptr<CondensingSolver> solver_;  ///< none where the body is whole
  std::vector<double> values_;                ///< of the tangent
  bool factorised_ = false;
  int factorisedElastic_ = -1;  ///< elastic points of the tangent as factorised
  bool elasticFactors_ = false;
  bool counted_ = false;
  Linearisation law_;
  LawFacts facts_;
  DenseFactor schurFactor_;  ///< of S
  Vector ownForce_;          ///< of the triangles of a part (dofs)
  Vector residual_;      ///< right-hand side over equations, condensed in place; of a rigid body its motion
  Vector contactForce_;  ///< its part on the contact dofs
};

}  // namespace mortier
