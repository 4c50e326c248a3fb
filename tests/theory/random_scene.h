// Random elastic contact of two blocks, and its solution by code of its own.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "theory/scenes.h"
#include "unit/enumerated_contact.h"

namespace mortier::scenes {

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

    RandomProblem c;
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

}  // namespace mortier::scenes
