// The hard cases must converge within the limits of their certificate; units must not matter; what nothing
// holds is named; random elastic scenes must agree with a solution found by trial of all active sets.
#include "theory/hard_cases.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <iostream>
#include <limits>
#include <optional>

#include "base/error.h"
#include "unit/enumerated_contact.h"

namespace mortier {
namespace {

using namespace scenes;
using namespace hardcases;

void expectWithinLimits(const std::string& family) {
  int count = 0;
  for (const HardCase& hard : hardCases()) {
    if (hard.slow || hard.open || hard.name.find(family) != 0) continue;
    SCOPED_TRACE(hard.name);
    const HardResult result = solve(hard.model(), hard.plan);
    const Certificate& worst = result.report.worst;
    EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
    EXPECT_LT(worst.forceBalance, forceBalanceLimit);
    EXPECT_LT(worst.materialResidual, materialResidualLimit);
    EXPECT_LT(worst.complementarity, complementarityLimit);
    ++count;
  }
  EXPECT_GT(count, 0);
  std::cout << count << " cases\n";
}

TEST(HardCases, coarseNonmortar) {
  expectWithinLimits("coarse nonmortar");
}
TEST(HardCases, data) {
  expectWithinLimits("data");
}
TEST(HardCases, geometry) {
  expectWithinLimits("geometry");
}
TEST(HardCases, eccentricLoad) {
  expectWithinLimits("eccentric");
}

// ---- units

std::vector<Compression> scenesForUnits() {
  std::vector<Compression> result;
  for (const CouplingKind coupling : couplings)
    for (const Projection projection : projections) {
      Compression scene;
      scene.coupling = coupling;
      scene.upperLaw.projection = scene.lowerLaw.projection = projection;
      result.push_back(scene);
    }
  return result;
}

// Powers of four for the stress: the factors of a scaled stiffness are scaled by its square root.
TEST(Units, powersOfTwoChangeNoBit) {
  for (const Compression& scene : scenesForUnits()) {
    const HardResult one = solve(scene.model(), {.end = 1, .steps = 10});
    ASSERT_EQ(one.report.status, Status::converged);
    for (const auto& [length, stress, time] :
         {std::array{0x1p+9, 0x1p-20, 0x1p-3}, std::array{0x1p-7, 0x1p+12, 0x1p+5}}) {
      Compression scaled = scene;
      scaled.length = length;
      scaled.stress = stress;
      scaled.time = time;
      const HardResult other = solve(scaled.model(), {.end = time, .steps = 10});
      EXPECT_EQ(other.report.iterations, one.report.iterations);
      EXPECT_EQ(other.report.factorisations, one.report.factorisations);
      for (size_t b = 0; b < 2; ++b) {
        EXPECT_EQ(other.state.bodies[b].displacement, length * one.state.bodies[b].displacement);
        EXPECT_EQ(other.state.bodies[b].stress, stress * one.state.bodies[b].stress);
        EXPECT_EQ(other.state.bodies[b].viscoplasticStrain, one.state.bodies[b].viscoplasticStrain);
      }
      EXPECT_EQ(other.state.contactForce[0], length * stress * one.state.contactForce[0]);
      EXPECT_EQ(other.report.worst.forceBalance, one.report.worst.forceBalance);
      EXPECT_EQ(other.report.worst.materialResidual, one.report.worst.materialResidual);
      EXPECT_EQ(other.report.worst.complementarity, one.report.worst.complementarity);
    }
  }
}

TEST(Units, millimetresAndMegapascalsTakeAsManyIterations) {
  for (const Compression& metres : scenesForUnits()) {
    Compression millimetres = metres;
    millimetres.length = 1e3;
    millimetres.stress = 1e-6;
    for (const int steps : {10, 13}) {
      const RunReport one = solve(metres.model(), {.end = 1, .steps = steps}).report;
      const RunReport other = solve(millimetres.model(), {.end = 1, .steps = steps}).report;
      std::cout << nameOf(metres.coupling) << ", " << nameOf(metres.upperLaw.projection) << ", N = " << steps
                << ": " << one.iterations << " and " << other.iterations << " iterations\n";
      ASSERT_EQ(other.status, Status::converged);
      EXPECT_EQ(other.iterations, one.iterations);
      EXPECT_EQ(other.maxIterationsInAStep, one.maxIterationsInAStep);
    }
  }
}

// ---- scenes without a solution

std::string unheldMessage(const Model& model) {
  try {
    run(model, 1, 1);
  } catch (const UnheldBodyError& error) {
    return error.what();
  }
  return "none";
}

void expectNames(const std::string& message, const std::string& body, const std::string& motion) {
  EXPECT_NE(message.find("body " + body), std::string::npos) << message;
  EXPECT_NE(message.find(motion), std::string::npos) << message;
}

Body heldBelow(TriangleMesh mesh) {
  return {"lower",
          std::move(mesh),
          elasticMaterial(noteElasticity),
          {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}}};
}

TEST(Unheld, translationAlongTheContactIsNamed) {
  Body upper("upper", square(0, 3), elasticMaterial(noteElasticity), {{}, {{top, 1, constant(-1)}}, {}});
  expectNames(unheldMessage(
                  contactModel(std::move(upper), heldBelow(square(-1, 4)), CouplingKind::mortar, upperBody)),
              "upper", "translation along (1, 0)");
}

// One contact node under the right corner, its force in the middle of the overlap from 0.9 to 1; rollers on the
// bottom leave the rotation about that.
TEST(Unheld, rotationAboutTheOnlyContactNodeIsNamed) {
  Body upper("upper", square(0, 3), elasticMaterial(noteElasticity),
             {{{bottom, 0, constant(0)}}, {{top, 1, constant(-1)}}, {}});
  TriangleMesh below = crissCrossMesh({{0.9, -1}, {1.9, 0}, 4, 4});
  expectNames(unheldMessage(contactModel(std::move(upper), heldBelow(std::move(below)), CouplingKind::mortar,
                                         upperBody)),
              "upper", "rotation about (0.95, ");
}

TEST(Unheld, bodyWithoutContactIsNamed) {
  Model model;
  model.bodies.push_back(heldBelow(square(-1, 2)));
  model.bodies.emplace_back("loose", square(0, 2), elasticMaterial(noteElasticity),
                            Conditions{{{left, 0, constant(0)}}, {}, {}});
  expectNames(unheldMessage(model), "loose", "translation along (0, 1)");
}

// The load turns round at t = 0.3, within a step or at its end, and pulls a block off that only contact holds.
TEST(Unheld, pullOffEndsAtTheLastEquilibrium) {
  constexpr double balance = 1e-10;
  constexpr double turn = 0.3;
  const Function load = [](double, double, double t) { return -10 * (1 - t / turn); };
  for (const bool elastic : {true, false})
    for (const CouplingKind coupling : couplings)
      for (const int steps : {7, 10, 13, 20, 23, 30}) {
        const auto material = elastic ? elasticMaterial(noteElasticity)
                                      : perzynaMaterial(noteElasticity, noteLaw(Projection::frobenius));
        Body upper("upper", square(0, 4), material, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
        Body lower("lower", square(-1, 7), material,
                   {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
        const Model model = contactModel(std::move(upper), std::move(lower), coupling, upperBody);
        SCOPED_TRACE(std::string(elastic ? "elastic, " : "viscoplastic, ") + nameOf(coupling) +
                     ", N = " + std::to_string(steps));
        const auto [state, report] = run(model, 1, steps);
        EXPECT_EQ(report.status, Status::unheld);
        expectNames(report.reason, "upper", "translation along (0, 1)");
        EXPECT_EQ(report.steps, static_cast<int>(0.3 * steps + 1e-9));
        EXPECT_EQ(state.time, 1.0 * report.steps / steps);
        std::vector<Vector> rest;
        for (size_t b = 0; b < 2; ++b)
          rest.push_back(model.bodies[b].load(state.time) -
                         model.bodies[b].internalForce(state.bodies[b].stress));
        model.interfaces[0].subtractForces(state.contactForce[0], rest[0], rest[1]);
        for (size_t b = 0; b < 2; ++b)
          for (int dof = 0; dof < model.bodies[b].dofs(); ++dof)
            if (model.bodies[b].equations()[dof] < 0) rest[b][dof] = 0;
        EXPECT_LE(rest[0].cwiseAbs().maxCoeff(), balance);
        EXPECT_LE(rest[1].cwiseAbs().maxCoeff(), balance);
      }
}

// ---- random scenes

/// An elastic scene of two single rows of cells, and its solution by code of its own: dense stiffness, trial
/// of all active sets. Only the rows of C are taken from the model. Supports and loads grow with time to
/// time 1.
class RandomScene {
 public:
  explicit RandomScene(unsigned seed) : random_(seed) {
    const Trace upperNodes = nodes(0, 1);
    Trace lowerNodes = nodes(-0.3 * random_.below(2), 1 + 0.3 * random_.below(2));
    if (random_.below(4) == 0) lowerNodes = upperNodes;
    const bool lowerNodeFaces =
        std::any_of(lowerNodes.begin(), lowerNodes.end(), [](double x) { return x >= 0 && x <= 1; });
    nonmortar_ = lowerNodeFaces ? random_.below(2) : upperBody;
    coupling_ = couplings[random_.below(2)];
    gap_ = random_.below(2) == 0 ? 0 : 0.05 * std::abs(random_.normal());
    sides_[0] = side(upperNodes, gap_);
    sides_[1] = side(lowerNodes, -1);
    sides_[1].held = {{bottom, 0, 0, 0}, {bottom, 1, 0, 0}};
    switch (random_.below(3)) {
      case 0:  // the top is moved
        sides_[0].held = {{top, 0, 0, 0}, {top, 1, -0.1 * random_.normal() - gap_, 0.2 * random_.normal()}};
        break;
      case 1:  // only contact holds it up
        floating_ = true;
        sides_[0].held = {{left, 0, 0, 0}};
        sides_[0].traction = -0.05 - 0.1 * std::abs(random_.normal());
        break;
      default:  // loaded either way, or not at all
        sides_[0].held = {{left, 0, 0, 0}, {left, 1, 0, 0}};
        sides_[0].traction = random_.below(4) == 0 ? 0 : 0.1 * random_.normal();
    }
  }

  [[nodiscard]] Model model() const {
    std::vector<Body> bodies;
    for (const Side& side : sides_) {
      Conditions conditions;
      for (const Held& held : side.held)
        conditions.displacements.push_back({held.label, held.component, [held](double x, double, double t) {
                                              return t * (held.value + held.slope * x);
                                            }});
      conditions.tractions.push_back({top, 1, constant(side.traction)});
      if (&side == &sides_[1]) conditions.tractions.clear();
      bodies.emplace_back(&side == &sides_[0] ? "upper" : "lower", side.mesh,
                          elasticMaterial(side.elasticity), conditions);
    }
    return contactModel(std::move(bodies[0]), std::move(bodies[1]), coupling_, nonmortar_);
  }

  struct Solution {
    Vector u;  ///< both bodies, upper first
    Vector p;
    double scale = 0;  ///< of forces
  };

  [[nodiscard]] std::optional<Solution> solve(const ContactInterface& interface) const {
    const Eigen::Index n0 = 2 * static_cast<Eigen::Index>(sides_[0].mesh.vertices.size());
    const Eigen::Index n = n0 + 2 * static_cast<Eigen::Index>(sides_[1].mesh.vertices.size());
    Matrix K = Matrix::Zero(n, n);
    Vector f = Vector::Zero(n);
    Vector u = Vector::Zero(n);
    std::vector<char> fixed(n, 0);
    for (size_t b = 0; b < 2; ++b) assemble(sides_[b], b == 0 ? 0 : n0, K, f, u, fixed);

    const bool upper = nonmortar_ == upperBody;
    Matrix C(interface.rows(), n);
    C << Matrix(upper ? interface.C1() : interface.C2()), Matrix(upper ? interface.C2() : interface.C1());

    std::vector<int> open;
    for (Eigen::Index i = 0; i < n; ++i)
      if (fixed[i] == 0) open.push_back(static_cast<int>(i));
    Matrix R = Matrix::Zero(static_cast<Eigen::Index>(open.size()), floating_ ? 1 : 0);
    for (size_t i = 0; floating_ && i < open.size(); ++i) R(i, 0) = open[i] < n0 && open[i] % 2 == 1 ? 1 : 0;
    if (floating_) R /= R.norm();
    const Matrix Kf = K(open, open) + R * R.transpose();
    const Matrix Cf = C(Eigen::all, open);
    const Vector force = (f - K * u)(open);
    const Eigen::LLT<Matrix> llt(Kf);

    Case c;
    c.problem.W = Cf * llt.solve(Matrix(Cf.transpose()));
    c.problem.G = Cf * R;
    c.slack = Vector::Constant(interface.rows(), gap_) - C * u - Cf * llt.solve(force);
    c.p0 = Vector::Zero(interface.rows());
    c.balance = R.transpose() * force;
    const auto found = enumerate(c);
    if (!found) return std::nullopt;
    Vector moved = llt.solve(Vector(force - Cf.transpose() * found->p));
    if (floating_) moved += R * (found->z - R.transpose() * moved);
    u(open) = moved;
    return Solution{u, found->p, force.cwiseAbs().maxCoeff() + found->p.cwiseAbs().maxCoeff()};
  }

 private:
  struct Held {
    int label = 0;
    int component = 0;
    double value = 0;
    double slope = 0;
  };
  struct Side {
    TriangleMesh mesh;
    Elasticity elasticity;
    std::vector<Held> held;
    double traction = 0;
  };

  Trace nodes(double begin, double end) {
    Trace trace{0};
    const int elements = 1 + random_.below(11);
    for (int i = 0; i < elements; ++i) trace.push_back(trace.back() + 0.1 + random_.below(10));
    for (double& x : trace) x = begin + (end - begin) * (x / trace.back());
    return trace;
  }

  Side side(const Trace& trace, double lowerY) {
    const int cells = static_cast<int>(trace.size()) - 1;
    TriangleMesh mesh = crissCrossMesh({{0, lowerY}, {static_cast<double>(cells), lowerY + 1}, cells, 1});
    for (Point& x : mesh.vertices) {
      const int cell = std::min(static_cast<int>(x.x()), cells - 1);
      x.x() = trace[cell] + (x.x() - cell) * (trace[cell + 1] - trace[cell]);
    }
    validate(mesh);
    return {mesh, {std::exp(random_.normal()), 0.1 * random_.below(10) - 0.5}, {}, 0};
  }

  static void assemble(const Side& side, Eigen::Index first, Matrix& K, Vector& f, Vector& u,
                       std::vector<char>& fixed) {
    const double E = side.elasticity.young;
    const double nu = side.elasticity.poisson;
    const Eigen::Matrix3d D =
        E / (1 - nu * nu) * Eigen::Matrix3d{{1, nu, 0}, {nu, 1, 0}, {0, 0, (1 - nu) / 2}};
    const TriangleMesh& mesh = side.mesh;
    for (const auto& triangle : mesh.triangles) {
      Eigen::Matrix3d corners;  // rows (1, x, y); columns of the inverse are the shape functions
      for (int i = 0; i < 3; ++i) corners.row(i) << 1, mesh.vertices[triangle[i]].transpose();
      const Eigen::Matrix3d shape = corners.inverse();
      Eigen::Matrix<double, 3, 6> B = Eigen::Matrix<double, 3, 6>::Zero();
      std::vector<Eigen::Index> dofs;
      for (int i = 0; i < 3; ++i) {
        B(0, 2 * i) = B(2, 2 * i + 1) = shape(1, i);
        B(1, 2 * i + 1) = B(2, 2 * i) = shape(2, i);
        for (int component = 0; component < 2; ++component)
          dofs.push_back(first + 2 * triangle[i] + component);
      }
      K(dofs, dofs) += corners.determinant() / 2 * B.transpose() * D * B;
    }
    for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
      const auto& [a, b] = mesh.boundaryEdges[e];
      for (const int node : {a, b}) {
        if (mesh.boundaryLabels[e] == top)
          f[first + 2 * node + 1] += side.traction * (mesh.vertices[a] - mesh.vertices[b]).norm() / 2;
        for (const Held& held : side.held)
          if (held.label == mesh.boundaryLabels[e]) {
            fixed[first + 2 * node + held.component] = 1;
            u[first + 2 * node + held.component] = held.value + held.slope * mesh.vertices[node].x();
          }
      }
    }
  }

  Randoms random_;
  int nonmortar_ = upperBody;
  CouplingKind coupling_ = CouplingKind::mortar;
  double gap_ = 0;
  bool floating_ = false;
  std::array<Side, 2> sides_;
};

TEST(RandomScenes, agreeWithTrialOfAllActiveSets) {
  constexpr int count = 10000;
  constexpr double tolerance = 1e-9;
  double worstForce = 0;
  double worstDisplacement = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const RandomScene scene(seed);
    const Model model = scene.model();
    const auto exact = scene.solve(model.interfaces[0]);
    ASSERT_TRUE(exact.has_value());
    const auto [state, report] = run(model, 1, 1);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    if (report.status != Status::converged) continue;
    Vector u(exact->u.size());
    u << state.bodies[0].displacement, state.bodies[1].displacement;
    const double force = (state.contactForce[0] - exact->p).cwiseAbs().maxCoeff() /
                         std::max(exact->scale, std::numeric_limits<double>::min());
    const double displacement = (u - exact->u).cwiseAbs().maxCoeff() / (1 + u.cwiseAbs().maxCoeff());
    EXPECT_LE(force, tolerance);
    EXPECT_LE(displacement, tolerance);
    worstForce = std::max(worstForce, force);
    worstDisplacement = std::max(worstDisplacement, displacement);
  }
  std::cout << count << " random scenes: forces agree to " << worstForce << ", displacements to "
            << worstDisplacement << "\n";
}

}  // namespace
}  // namespace mortier
