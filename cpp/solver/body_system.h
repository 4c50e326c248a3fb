// One body's side of a linearised step: its tangent condensed to the contact dofs, its rows of C there, and
// the rigid motions that only contact holds.
#pragma once

#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

#include "base/two_part_vector.h"
#include "linear/condensing_solver.h"
#include "material/interior_path.h"
#include "solver/dense_factor.h"
#include "solver/model.h"

namespace mortier {

/// The unknowns of a body in a step.
struct BodyIterate {
  TwoPartVector increment;  ///< du (dofs) [m]
  Matrix stress;            ///< s
  Matrix strain;            ///< B du - shift, components x points, as of the last linearisation
};

/// 1 or -1, the sign of the determinant of a factorised matrix.
int determinantSign(const Eigen::PartialPivLU<Matrix>& lu);

class BodySystem {
 public:
  /// \param firstRow  of each interface among all contact conditions, and their number at the end.
  BodySystem(const Model& model, int body, const std::vector<int>& firstRow, const SolverOptions& options);

  /// Linearises the law at the iterate, whose strain (that of `step`) becomes B du - shift; no shift where null.
  /// \returns the material residual, scaled [-].
  double linearise(const MaterialStep& step, const Matrix* shift, BodyIterate& iterate);
  /// Regularises the law at the iterate instead (material/material.h). \returns the change of stress that is
  /// still asked for, over the yield stress (an elastic body: its largest stress) [-].
  double regularise(const MaterialStep& step, const Matrix* shift, double relaxation, BodyIterate& iterate);
  /// Chooses the penalties for a stress field; the next factorise() takes them over.
  void choosePenalty(const Matrix& stress);
  /// Linearises along the path instead, for the strain of an iterate.
  void linearise(InteriorPath& path, const Matrix& strain, double target, bool correct) {
    law_.elastic = 0;
    path.linearise(strain, target, correct, law_);
  }
  /// What the rounding of the mesh and of its displacements makes of stresses, by the moduli of the last linearisation,
  /// over what residuals are measured against [-].
  [[nodiscard]] double rounding(const Matrix& stress0, const BodyIterate& iterate,
                                const Vector& displacement) const;
  /// Factorises the tangent of the last linearisation, unless that and the last one are both of a body in which
  /// nothing flows.
  /// \returns why that is impossible, or nothing.
  std::string factorise();
  /// Whether the factors are those of elasticity.
  [[nodiscard]] bool elasticFactors() const { return elasticFactors_; }
  /// Goes on with a run in which these have been made and counted before.
  void resumeElastic() { counted_ = true; }
  /// 1 or -1, the sign of the determinant of the tangent as factorised.
  [[nodiscard]] int determinantSign() const;
  /// Whether points began or ceased to flow in the linearisations since.
  [[nodiscard]] bool stale() const { return factorisedElastic_ != law_.elastic; }
  /// Whether the last factorise() did any work that counts.
  [[nodiscard]] bool refactorised() const { return refactorised_; }
  /// Works on these threads from now on; they must outlive the system.
  void use(Threads& threads);
  /// From now on CHOLMOD or UMFPACK.
  void useLibraries();
  [[nodiscard]] bool usesLibraries() const { return engine_ == LinearEngine::suitesparse; }

  /// Condenses nodal forces (dofs) left over; \returns S^-1 f on the contact dofs.
  Vector condense(const Vector& force);
  /// Completes the linear solve for a change of the contact forces and rigid motions `z` of this body, and
  /// takes it over.
  void expand(const Vector& forceChange, const Vector& z, BodyIterate& iterate);
  /// The same, \returns the displacement (dofs) without taking it over.
  Vector displacementOf(const Vector& forceChange, const Vector& z);
  /// H^-1 of the last linearisation times a strain (components x points).
  [[nodiscard]] Matrix stressOf(const Matrix& strain) const;
  /// Puts a stress moduli strain/delta beside that of the last linearisation (solver/damping.cpp); a linear material is
  /// left alone.
  void damp(const Matrix& moduli, double delta, const Matrix& strain);
  /// That stress, in the plane.
  [[nodiscard]] Matrix dampingStress(const Matrix& moduli, double delta, const Matrix& strain) const;

  [[nodiscard]] const Linearisation& law() const { return law_; }  ///< as last linearised
  [[nodiscard]] const Matrix& moduli() const { return law_.moduli; }
  [[nodiscard]] const Matrix& predictor() const { return law_.predictor; }
  [[nodiscard]] bool inContact() const { return !kept_.empty(); }
  [[nodiscard]] const Eigen::SparseMatrix<double>& C() const { return C_; }  ///< contact rows x contact dofs
  /// W += C S^-1 C'.
  void addCompliance(Matrix& W) const;
  [[nodiscard]] const Matrix& R() const { return R_; }  ///< rigid motions on the contact dofs, orthonormal
  [[nodiscard]] const Matrix& motions() const { return motions_; }  ///< and by dofs
  /// Work of nodal forces (dofs) on the rigid motions: what only contact can balance. Stresses do none. Forces that
  /// balance each other but for rounding give zero.
  [[nodiscard]] Vector rigidForce(const Vector& load) const;

 private:
  /// Points that stay in the cache from one loop over them to the next; a multiple of the lanes.
  static constexpr int block = 2048;
  [[nodiscard]] int blocks() const { return (body_.points() + block - 1) / block; }
  /// Calls work(begin, end) for all points, a block at a time.
  template <class Work>
  void forEachBlock(const Work& work);
  /// Strain at the iterate, then the law's law(begin, end) for all points. \returns the largest change, scaled.
  template <class Law>
  double evaluate(const MaterialStep& step, const Matrix* shift, BodyIterate& iterate, const Law& law);
  void findContactDofs(const Model& model, int body, const std::vector<int>& firstRow);
  void findRigidMotions();
  /// What stresses are measured against.
  [[nodiscard]] double residualScale(const Matrix& stress0, const BodyIterate& iterate) const;
  [[nodiscard]] Vector solveSchur(const Vector& f) const;

  const Body& body_;
  std::vector<int> kept_;  ///< equations of the contact dofs
  Eigen::SparseMatrix<double> C_;
  Matrix motions_;
  Matrix R_;
  LinearEngine engine_;
  bool reduce_;
  Threads* threads_ = &Threads::none();
  std::unique_ptr<CondensingSolver> solver_;
  std::vector<double> values_;
  bool factorised_ = false;
  bool refactorised_ = false;
  int factorisedElastic_ = -1;  ///< elastic points of the tangent as factorised
  bool elasticFactors_ = false;
  bool counted_ = false;
  Linearisation law_;
  Vector penalty_;
  DenseFactor schurFactor_;  ///< of S
  Vector residual_;          ///< right-hand side over equations, condensed in place
  Vector contactForce_;      ///< its part on the contact dofs
};

}  // namespace mortier
