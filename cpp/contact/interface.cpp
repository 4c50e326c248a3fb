#include "contact/interface.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"

namespace mortier {
namespace {

/// Lines straight and bodies touching up to this part of their length.
constexpr double straightness = 1e-9;
/// Distances as meshed below this part of the length are rounding.
constexpr double touching = 1e-12;

Point direction(const BoundaryLine& line) {
  return (line.points.back() - line.points.front()).normalized();
}

double length(const BoundaryLine& line) {
  return (line.points.back() - line.points.front()).norm();
}

void requireStraight(const BoundaryLine& line, const TriangleMesh& mesh, int label) {
  const Point t = direction(line);
  double previous = -1;
  for (const Point& point : line.points) {
    const Point x = point - line.points.front();
    const double s = x.dot(t);
    if (line.closed || std::abs(x.x() * t.y() - x.y() * t.x()) > straightness * length(line) ||
        !(s > previous)) {
      std::ostringstream message;
      message << mesh.name << ": label " << label << " is bent at (" << point.x() << ", " << point.y()
              << "), expected a straight contact line";
      throw InputError(message.str());
    }
    previous = s;
  }
}

Trace abscissae(const BoundaryLine& line, const Point& origin, const Point& tangent) {
  Trace trace;
  for (const Point& point : line.points) trace.push_back((point - origin).dot(tangent));
  return trace;
}

/// weights (rows x nodes) times the normal, as rows over the dofs of a mesh.
ConstraintRows rowsAlong(const Point& normal, const Matrix& weights, const std::vector<int>& nodes,
                         const TriangleMesh& mesh) {
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t j = 0; j < nodes.size(); ++j)
    for (Eigen::Index i = 0; i < weights.rows(); ++i)
      for (int c = 0; c < 2; ++c)
        if (const double value = weights(i, static_cast<Eigen::Index>(j)) * normal[c]; value != 0)
          entries.emplace_back(static_cast<int>(i), 2 * nodes[j] + c, value);
  ConstraintRows C(weights.rows(), 2 * static_cast<Eigen::Index>(mesh.vertices.size()));
  C.setFromTriplets(entries.begin(), entries.end());
  return C;
}

double normalComponent(const Vector& u, int node, const Point& n) {
  return u[2 * node] * n.x() + u[2 * node + 1] * n.y();
}

}  // namespace

ContactInterface::ContactInterface(const ContactPair& pair, const TriangleMesh& nonmortarMesh,
                                   const TriangleMesh& mortarMesh)
    : pair_(pair),
      nonmortarLine_(boundaryLine(nonmortarMesh, pair.nonmortar.label)),
      mortarLine_(boundaryLine(mortarMesh, pair.mortar.label)) {
  requireStraight(nonmortarLine_, nonmortarMesh, pair.nonmortar.label);
  requireStraight(mortarLine_, mortarMesh, pair.mortar.label);
  const Point tangent = direction(nonmortarLine_);
  normal_ = {tangent.y(), -tangent.x()};
  const double angle = direction(mortarLine_).dot(tangent);
  const std::string names = nonmortarMesh.name + " label " + std::to_string(pair.nonmortar.label) + " and " +
                            mortarMesh.name + " label " + std::to_string(pair.mortar.label);
  if (!(angle < -1 + straightness)) {
    std::ostringstream message;
    message << names << " do not face each other: their outward normals make an angle of "
            << std::acos(std::clamp(angle, -1.0, 1.0)) * 180 / M_PI << " degrees, expected 180";
    throw InputError(message.str());
  }
  std::reverse(mortarLine_.nodes.begin(), mortarLine_.nodes.end());
  std::reverse(mortarLine_.points.begin(), mortarLine_.points.end());

  nonmortarTrace_ = abscissae(nonmortarLine_, nonmortarLine_.points.front(), tangent);
  mortarTrace_ = abscissae(mortarLine_, nonmortarLine_.points.front(), tangent);
  const double shorter = std::min(length(nonmortarLine_), length(mortarLine_));
  overlap_ = std::max(0.0, overlapOf(nonmortarTrace_, mortarTrace_).length()) / shorter;
  coupling_ = couple(pair.coupling, nonmortarTrace_, mortarTrace_);
  if (coupling_.nodes.empty())
    throw InputError(names + " overlap at no nonmortar node, expected bodies that face each other");
  for (const int node : coupling_.nodes) nonmortarNodes_.push_back(nonmortarLine_.nodes[node]);
  mortarNodes_ = mortarLine_.nodes;
  const auto rows = static_cast<Eigen::Index>(nonmortarNodes_.size());
  C1_ = rowsAlong(normal_, Matrix::Identity(rows, rows), nonmortarNodes_, nonmortarMesh);
  C2_ = rowsAlong(normal_, -coupling_.A, mortarNodes_, mortarMesh);

  Vector x1(coupling_.nodes.size());
  for (size_t i = 0; i < coupling_.nodes.size(); ++i)
    x1[i] = (nonmortarLine_.points[coupling_.nodes[i]] - nonmortarLine_.points.front()).dot(normal_);
  Vector x2(mortarLine_.points.size());
  for (size_t j = 0; j < mortarLine_.points.size(); ++j)
    x2[j] = (mortarLine_.points[j] - nonmortarLine_.points.front()).dot(normal_);
  distance_ = coupling_.A * x2 - x1;
  for (double& distance : distance_)
    if (std::abs(distance) < touching * shorter) distance = 0;
  if (distance_.minCoeff() < -straightness * shorter) {
    std::ostringstream message;
    message << names << " penetrate each other by " << -distance_.minCoeff()
            << " m as meshed, expected a distance >= 0";
    throw InputError(message.str());
  }
}

Vector ContactInterface::gap(const Vector& uNonmortar, const Vector& uMortar) const {
  return C1_ * uNonmortar + C2_ * uMortar - distance_;
}

void ContactInterface::subtractForces(const Vector& p, Vector& fNonmortar, Vector& fMortar) const {
  fNonmortar -= C1_.transpose() * p;
  fMortar -= C2_.transpose() * p;
}

Vector ContactInterface::contactPressure(const Vector& p) const {
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(coupling_.M).solve(p);
}

double ContactInterface::interpenetration(const Vector& uNonmortar, const Vector& uMortar) const {
  const auto position = [&](const BoundaryLine& line, int i, const Vector& u) {
    return (line.points[i] - nonmortarLine_.points.front()).dot(normal_) +
           normalComponent(u, line.nodes[i], normal_);
  };
  double integral = 0;
  for (const Segment& segment : commonRefinement(nonmortarTrace_, mortarTrace_)) {
    const auto jump = [&](double s) {
      const Eigen::Vector2d phi = hats(nonmortarTrace_, segment.nonmortar, s);
      const Eigen::Vector2d psi = hats(mortarTrace_, segment.mortar, s);
      double value = 0;
      for (int i = 0; i < 2; ++i) {
        value += phi[i] * position(nonmortarLine_, segment.nonmortar + i, uNonmortar);
        value -= psi[i] * position(mortarLine_, segment.mortar + i, uMortar);
      }
      return value;
    };
    const double a = jump(segment.begin);
    const double b = jump(segment.end);
    const double h = segment.end - segment.begin;
    if (a >= 0 && b >= 0)
      integral += h * (a + b) / 2;
    else if (a > 0 || b > 0)
      integral += h * std::max(a, b) * std::max(a, b) / (2 * std::abs(a - b));
  }
  return integral;
}

}  // namespace mortier
