#include "solver/contact_dofs.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/rigid_modes.h"

namespace mortier {
namespace {

/// A motion that moves the contact nodes by less than this part of the others is not held by contact.
constexpr double motionTolerance = 1e-14;

/// A support along the contact normal leaves no more than this part of a row.
constexpr double negligible = 1e-14;

/// Entries of the rows of an interface on one body as (row, node, vector).
template <class Visit>
void forEachEntry(const ContactInterface& interface, int body, const ConstraintRows& nonmortar,
                  const ConstraintRows& mortar, Visit visit) {
  const auto visitAll = [&](const ConstraintRows& C) {
    for (int node = 0; 2 * node < C.outerSize(); ++node) {
      ConstraintRows::InnerIterator x(C, 2 * node);
      ConstraintRows::InnerIterator y(C, 2 * node + 1);
      while (x || y) {
        const auto row = static_cast<int>(!y || (x && x.row() < y.row()) ? x.row() : y.row());
        Point vector = Point::Zero();
        if (x && x.row() == row) vector.x() = x.value(), ++x;
        if (y && y.row() == row) vector.y() = y.value(), ++y;
        visit(row, node, vector);
      }
    }
  };
  if (interface.pair().nonmortar.body == body) visitAll(nonmortar);
  if (interface.pair().mortar.body == body) visitAll(mortar);
}

}  // namespace

ContactDofs::ContactDofs(const Model& model, int body, const std::vector<int>& firstRow) {
  findEquations(model, body, firstRow);
  findMotions(model.bodies[body]);
}

void ContactDofs::findEquations(const Model& model, int body, const std::vector<int>& firstRow) {
  std::vector<int> column(model.bodies[body].freeDofs(), -1);
  int rows = firstRow.back();
  const auto forEachEquation = [&](auto visit) {
    const auto visitParts = [&](int first) {
      return [&, first](int row, int node, const Point& vector) {
        for (const auto& [equation, value] : model.bodies[body].parts(node, vector))
          if (equation >= 0 && std::abs(value) > negligible * vector.norm())
            visit(first + row, equation, value);
      };
    };
    for (size_t k = 0; k < model.interfaces.size(); ++k) {
      const ContactInterface& interface = model.interfaces[k];
      forEachEntry(interface, body, interface.C1(), interface.C2(), visitParts(firstRow[k]));
    }
    rows = firstRow.back();
    for (const ContactInterface& interface : model.interfaces) {
      if (!interface.rough()) continue;
      forEachEntry(interface, body, interface.T1(), interface.T2(), visitParts(rows));
      rows += interface.rows();
    }
  };
  forEachEquation([&](int, int equation, double) {
    if (column[equation] >= 0) return;
    column[equation] = static_cast<int>(equations.size());
    equations.push_back(equation);
  });
  std::vector<Eigen::Triplet<double>> entries;
  forEachEquation(
      [&](int row, int equation, double value) { entries.emplace_back(row, column[equation], value); });
  C.resize(rows, static_cast<Eigen::Index>(equations.size()));
  C.setFromTriplets(entries.begin(), entries.end());
}

void ContactDofs::findMotions(const Body& body) {
  motions = rigidModes(body);
  R.resize(static_cast<Eigen::Index>(equations.size()), motions.cols());
  for (Eigen::Index i = 0; i < motions.cols(); ++i) R.col(i) = body.gather(motions.col(i))(equations);
  if (motions.cols() == 0) return;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(R.transpose() * R);
  const double largest = std::max(1.0, eigen.eigenvalues().maxCoeff());
  if (eigen.eigenvalues()[0] <= motionTolerance * largest)
    throw UnheldBodyError("body " + body.name() + ": nothing holds its " +
                          describeRigidMotion(body, motions * eigen.eigenvectors().col(0)) +
                          "; a support (ux, uy) or a contact would");
  const Matrix T = eigen.eigenvectors() * eigen.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal();
  motions *= T;
  R *= T;
}

Vector ContactDofs::rigidForce(const Vector& load) const {
  constexpr double roundingOfSums = 1e-14;
  Vector force = motions.transpose() * load;
  const Vector size = motions.cwiseAbs().transpose() * load.cwiseAbs();
  for (Eigen::Index i = 0; i < force.size(); ++i)
    if (std::abs(force[i]) <= roundingOfSums * size[i]) force[i] = 0;
  return force;
}

}  // namespace mortier
