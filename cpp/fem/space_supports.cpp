// What holds a body in space: supports of nodes, the equations that remain, and prescribed displacements.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Geometry>

#include "base/dense_templates.h"
#include "base/error.h"
#include "fem/space_elements.h"

namespace mortier {
namespace {

/// Triangles that turn by less are smooth.
const double smoothCosine = std::cos(40 * std::numbers::pi / 180);

/// Directions whose sine is below this are the same: flat sides have one, whatever coordinates round.
constexpr double sameNormal = 1e-5;

struct Corner {
  SpacePoint unit;      ///< outward normal of a triangle
  SpacePoint weighted;  ///< by which it counts at this node
};

/// Outward normals at the nodes of the triangles with a normal condition on a label. A vertex weighs them by
/// the sine of the angle over the lengths of both sides, which is exact on spheres (Max 1999).
std::map<int, std::vector<Corner>> cornersOf(const TetrahedronMesh& mesh, const SpaceNodes& nodes,
                                             int label) {
  std::map<int, std::vector<Corner>> corners;
  for (size_t i = 0; i < nodes.faces.size(); ++i) {
    if (mesh.boundaryLabels[i] != label) continue;
    const std::array<int, 6>& face = nodes.faces[i];
    for (int k = 0; k < 3; ++k) {
      const SpacePoint& x = nodes.places[face[k]];
      const SpacePoint a = nodes.places[face[(k + 1) % 3]] - x;
      const SpacePoint b = nodes.places[face[(k + 2) % 3]] - x;
      const SpacePoint normal = a.cross(b);
      const SpacePoint unit = normal.normalized();
      corners[face[k]].push_back({unit, normal / (a.squaredNorm() * b.squaredNorm())});
      if (nodes.degree > 1) corners[face[3 + k]].push_back({unit, unit});
    }
  }
  return corners;
}

/// The normals at a node, one for each smooth part of the boundary that meets there.
std::vector<SpacePoint> normalsAt(const std::vector<Corner>& corners) {
  std::vector<SpacePoint> normals;
  std::vector<char> taken(corners.size(), 0);
  for (size_t i = 0; i < corners.size(); ++i) {
    if (taken[i] != 0) continue;
    SpacePoint sum = SpacePoint::Zero();
    for (size_t j = i; j < corners.size(); ++j) {
      if (taken[j] != 0 || corners[j].unit.dot(corners[i].unit) < smoothCosine) continue;
      taken[j] = 1;
      sum += corners[j].weighted;
    }
    SpacePoint normal = sum.normalized();
    for (int c = 0; c < 3; ++c)
      if (const SpacePoint axis = SpacePoint::Unit(c); normal.cross(axis).norm() < sameNormal)
        normal = normal[c] > 0 ? axis : SpacePoint(-axis);
    normals.push_back(normal);
  }
  return normals;
}

/// Prescribes the motion along a direction unless the others of the node imply it.
void hold(SpaceSupport& support, const SpacePoint& direction, int condition) {
  SpacePoint beyond = direction;
  for (int i = 0; i < support.count; ++i) {
    const SpacePoint row = support.frame.row(i);
    beyond -= row.dot(beyond) * row;
  }
  if (support.count == 3 || beyond.norm() < sameNormal) return;
  support.directions.row(support.count) = direction;
  support.frame.row(support.count) = beyond.normalized();
  support.conditions[support.count++] = condition;
}

}  // namespace

void SpaceElements::findSupports(const std::string& body) {
  std::map<int, SpaceSupport> held;
  const auto at = [&](int node) -> SpaceSupport& {
    held[node].node = node;
    return held[node];
  };
  // Axes first: a normal that is one of them changes nothing.
  for (const bool turned : {false, true})
    for (size_t c = 0; c < conditions_.displacements.size(); ++c) {
      const SpaceCondition& condition = conditions_.displacements[c];
      if ((condition.component == spaceNormal) != turned) continue;
      const auto number = static_cast<int>(c);
      if (turned) {
        for (const auto& [node, corners] : cornersOf(mesh_, nodes_, condition.label))
          for (const SpacePoint& normal : normalsAt(corners)) hold(at(node), normal, number);
        continue;
      }
      const SpacePoint axis = SpacePoint::Unit(condition.component);
      if (condition.point) {
        const auto found = std::find_if(mesh_.vertices.begin(), mesh_.vertices.end(), [&](const auto& x) {
          return (x - *condition.point).norm() <= 1e-9 * extent(mesh_);
        });
        if (found == mesh_.vertices.end())
          throw InputError("body " + body + ": a point that is held is no vertex of " + mesh_.name);
        hold(at(static_cast<int>(found - mesh_.vertices.begin())), axis, number);
        continue;
      }
      for (size_t i = 0; i < nodes_.faces.size(); ++i)
        for (int a = 0; a < nodes_.perFace() && mesh_.boundaryLabels[i] == condition.label; ++a)
          hold(at(nodes_.faces[i][a]), axis, number);
    }
  for (auto& [node, support] : held) {
    for (int i = 0; i < support.count; ++i)
      support.turned = support.turned || support.directions.row(i).cwiseAbs().maxCoeff() != 1;
    if (support.count == 1) support.frame.row(1) = SpacePoint(support.frame.row(0)).unitOrthogonal();
    if (support.count < 3)
      support.frame.row(2) = SpacePoint(support.frame.row(0)).cross(SpacePoint(support.frame.row(1)));
    supports_.push_back(support);
  }
}

void SpaceElements::numberEquations() {
  equations_.assign(3 * static_cast<size_t>(nodes_.count()), 0);
  for (size_t k = 0; k < supports_.size(); ++k) {
    const SpaceSupport& support = supports_[k];
    if (support.turned && turnedOf_.empty()) turnedOf_.assign(nodes_.count(), -1);
    if (support.turned) turnedOf_[support.node] = static_cast<int>(k);
    for (int i = 0; i < support.count; ++i) {
      Eigen::Index axis = i;
      if (!support.turned) support.directions.row(i).cwiseAbs().maxCoeff(&axis);
      equations_[3 * support.node + axis] = -1;
    }
  }
  for (int& equation : equations_)
    if (equation >= 0) equation = freeDofs_++;
}

SpacePoint SpaceElements::inFrame(int node, const SpacePoint& vector) const {
  const int turned = turnedOf_.empty() ? -1 : turnedOf_[node];
  return turned < 0 ? vector : SpacePoint(supports_[turned].frame * vector);
}

Vector SpaceElements::gather(const Vector& nodal) const {
  Vector x(freeDofs_);
  for (int node = 0; node < nodes_.count(); ++node) {
    const SpacePoint vector = inFrame(node, nodal.segment<3>(3 * static_cast<Eigen::Index>(node)));
    for (int c = 0; c < 3; ++c)
      if (const int equation = equations_[3 * node + c]; equation >= 0) x[equation] = vector[c];
  }
  return x;
}

Vector SpaceElements::spread(const Vector& x) const {
  Vector nodal = Vector::Zero(static_cast<Eigen::Index>(equations_.size()));
  for (size_t dof = 0; dof < equations_.size(); ++dof)
    if (equations_[dof] >= 0) nodal[static_cast<Eigen::Index>(dof)] = x[equations_[dof]];
  for (const SpaceSupport& support : supports_)
    if (support.turned) {
      auto vector = nodal.segment<3>(3 * static_cast<Eigen::Index>(support.node));
      vector = (support.frame.transpose() * vector).eval();
    }
  return nodal;
}

// With the prescribed values v = D u along the directions D, u along the first rows F of the frame is
// (D F')^-1 v, as the directions lie in their span.
SpacePoint SpaceElements::prescribedAt(const SpaceSupport& support, double t) const {
  const Eigen::Index n = support.count;
  Vector values(n);
  for (Eigen::Index i = 0; i < n; ++i)
    values[i] = conditions_.displacements[support.conditions[i]].value(nodes_.places[support.node], t);
  const Matrix span = support.frame.topRows(n);
  const Matrix inSpan = support.directions.topRows(n) * span.transpose();  // lower triangular
  return span.transpose() * inSpan.triangularView<Eigen::Lower>().solve(values);
}

void SpaceElements::prescribe(double t, Vector& u) const {
  for (const SpaceSupport& support : supports_) {
    const SpacePoint held = prescribedAt(support, t);
    auto at = u.segment<3>(3 * static_cast<Eigen::Index>(support.node));
    if (!support.turned) {
      for (int i = 0; i < support.count; ++i) {
        Eigen::Index axis = 0;
        support.directions.row(i).cwiseAbs().maxCoeff(&axis);
        at[axis] = held[axis];
      }
      continue;
    }
    const auto span = support.frame.topRows(support.count);
    at += held - SpacePoint(span.transpose() * (span * at));
  }
}

void SpaceElements::prescribeIncrement(double t0, double t1, TwoPartVector& increment) const {
  for (const SpaceSupport& support : supports_) {
    const SpacePoint change = prescribedAt(support, t1) - prescribedAt(support, t0);
    const Eigen::Index first = 3 * static_cast<Eigen::Index>(support.node);
    if (!support.turned) {
      for (int i = 0; i < support.count; ++i) {
        Eigen::Index axis = 0;
        support.directions.row(i).cwiseAbs().maxCoeff(&axis);
        increment.set(first + axis, change[axis]);
      }
      continue;
    }
    const auto span = support.frame.topRows(support.count);
    auto high = increment.high.segment<3>(first);
    auto low = increment.low.segment<3>(first);
    high += change - SpacePoint(span.transpose() * (span * high));
    low -= SpacePoint(span.transpose() * (span * low)).eval();
  }
}

}  // namespace mortier
