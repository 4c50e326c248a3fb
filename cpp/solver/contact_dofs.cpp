#include "solver/condensed_body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/dense_templates.h"
#include "base/error.h"
#include "fem/rigid_modes.h"

namespace mortier {
namespace {

/// A motion that moves the contact nodes by less than this part of the others is not held by contact.
constexpr double motionTolerance = 1e-14;

/// A support along the contact normal leaves no more than this part of a row.
constexpr double negligibleShare = 1e-14;

/// Entries of rows on a body as (row, node, vector).
template <class Visit>
void forEachNode(const ConstraintRows& C, int dimension, Visit visit) {
  for (int row = 0; row < C.rows(); ++row)
    for (ConstraintRows::InnerIterator entry(C, row); entry;) {
      const int node = static_cast<int>(entry.col()) / dimension;
      SpacePoint vector = SpacePoint::Zero();
      for (; entry && entry.col() / dimension == node; ++entry)
        vector[entry.col() % dimension] = entry.value();
      visit(row, node, vector);
    }
}

/// The same of the rows of an interface.
template <class Visit>
void forEachEntry(const ContactInterface& interface, int body, const ConstraintRows& nonmortar,
                  const ConstraintRows& mortar, Visit visit) {
  if (interface.pair().nonmortar.body == body) forEachNode(nonmortar, interface.dimension(), visit);
  if (interface.pair().mortar.body == body) forEachNode(mortar, interface.dimension(), visit);
}

/// A rigid body has no equations of nodes: contact takes the dofs themselves, which its motions move.
bool takesDofs(const Body& body) {
  return body.rigid() && body.freeDofs() > 0;
}

std::array<Body::Part, 3> partsOf(const Body& body, int node, const SpacePoint& vector) {
  if (!takesDofs(body)) return body.parts(node, vector);
  std::array<Body::Part, 3> parts;
  for (int c = 0; c < body.dimension(); ++c) parts[c] = {body.dimension() * node + c, vector[c]};
  return parts;
}

/// Entries of all conditions on one body as (condition, equation, value).
template <class Visit>
void forEachEquation(const Model& model, int body, const std::vector<int>& firstRow, Visit visit) {
  const auto visitParts = [&](int first) {
    return [&, first](int row, int node, const SpacePoint& vector) {
      for (const auto& [equation, value] : partsOf(model.bodies[body], node, vector))
        if (equation >= 0 && std::abs(value) > negligibleShare * vector.norm())
          visit(first + row, equation, value);
    };
  };
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    forEachEntry(interface, body, interface.C1(), interface.C2(), visitParts(firstRow[k]));
  }
  int rows = firstRow.back();
  for (const ContactInterface& interface : model.interfaces) {
    if (!interface.hasFriction()) continue;
    forEachEntry(interface, body, interface.T1(), interface.T2(), visitParts(rows));
    rows += interface.slipRows();
  }
  for (const Tie& tie : model.ties) {
    for (const TieSide& side : tie.sides())
      if (side.body == body) forEachNode(side.C, tie.dimension(), visitParts(rows));
    rows += tie.rows();
  }
}

}  // namespace

ContactDofs::ContactDofs(const Model& model, int body, const std::vector<int>& firstRow) {
  findEquations(model, body, firstRow);
  updateConstraints(model, body, firstRow);
  findMotions(model, body);
}

void ContactDofs::findEquations(const Model& model, int body, const std::vector<int>& firstRow) {
  const Body& of = model.bodies[body];
  column_.assign(takesDofs(of) ? of.dofs() : of.freeDofs(), -1);
  const auto add = [&](int equation) {
    if (equation < 0 || column_[equation] >= 0) return;
    column_[equation] = static_cast<int>(equations.size());
    equations.push_back(equation);
  };
  // Those of lines that follow come first: their order depends on no place where the bodies were.
  for (const ContactInterface& interface : model.interfaces) {
    if (!interface.follows()) continue;
    const int dimension = of.dimension();
    const auto addLine = [&](const std::vector<int>& nodes) {
      for (const int node : nodes)
        for (int dof = dimension * node; dof < dimension * (node + 1); ++dof)
          add(takesDofs(of) ? dof : of.equations()[dof]);
    };
    if (interface.pair().nonmortar.body == body) addLine(interface.nonmortarLine());
    if (interface.pair().mortar.body == body) addLine(interface.mortarNodes());
  }
  forEachEquation(model, body, firstRow, [&](int, int equation, double) { add(equation); });
}

void ContactDofs::updateConstraints(const Model& model, int body, const std::vector<int>& firstRow) {
  int conditions = firstRow.back();
  for (const ContactInterface& interface : model.interfaces) conditions += interface.slipRows();
  for (const Tie& tie : model.ties) conditions += tie.rows();
  Triplets entries;
  forEachEquation(model, body, firstRow, [&](int row, int equation, double value) {
    entries.emplace_back(row, column_[equation], value);
  });
  C = assembled(conditions, static_cast<Eigen::Index>(equations.size()), entries);
}

void ContactDofs::findMotions(const Model& model, int body) {
  const Body& of = model.bodies[body];
  motions = rigidModes(of);
  R.resize(static_cast<Eigen::Index>(equations.size()), motions.cols());
  for (Eigen::Index i = 0; i < motions.cols(); ++i)
    R.col(i) = (of.rigid() ? Vector(motions.col(i)) : of.gather(motions.col(i)))(equations);
  if (motions.cols() == 0) return;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(Matrix(R.transpose() * R));
  const double largest = std::max(1.0, eigen.eigenvalues().maxCoeff());
  if (eigen.eigenvalues()[0] <= motionTolerance * largest)
    throw UnheldBodyError("body " + of.name() + ": nothing holds its " +
                          describe(of, eigen.eigenvectors().col(0)) + "; a support or a contact would");
  const Matrix T = eigen.eigenvectors() * eigen.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal();
  motions *= T;
  R *= T;
}

std::string ContactDofs::describe(const Body& body, const Vector& z) const {
  return describeRigidMotion(body, motions * z);
}

Vector ContactDofs::rigidForce(const Vector& load) const {
  constexpr double roundingOfTotals = 1e-14;
  Vector force = motions.transpose() * load;
  const Vector total = motions.cwiseAbs().transpose() * load.cwiseAbs();
  for (Eigen::Index i = 0; i < force.size(); ++i)
    if (std::abs(force[i]) <= roundingOfTotals * total[i]) force[i] = 0;
  return force;
}

}  // namespace mortier
