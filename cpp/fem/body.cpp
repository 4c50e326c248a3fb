#include "fem/body.h"

#include <algorithm>
#include <numbers>

#include "base/double_double.h"
#include "base/error.h"
#include "fem/element.h"
#include "material/stress.h"

namespace mortier {
namespace {

using Element = LinearTriangle;

/// Calls f(edge length, vertex, midpoint weight...) for the edges of a label.
template <class Visit>
void forEachEdge(const TriangleMesh& mesh, int label, Visit visit) {
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    if (mesh.boundaryLabels[e] == label) visit(mesh.boundaryEdges[e]);
}

void requireLabel(const TriangleMesh& mesh, const std::string& body, int label) {
  if (std::find(mesh.boundaryLabels.begin(), mesh.boundaryLabels.end(), label) == mesh.boundaryLabels.end())
    throw InputError("body " + body + ": label = " + std::to_string(label) +
                     ", expected a boundary label of " + mesh.name);
}

}  // namespace

Body::Body(std::string name, TriangleMesh mesh, std::shared_ptr<const Material> material,
           Conditions conditions)
    : name_(std::move(name)),
      mesh_(std::move(mesh)),
      material_(std::move(material)),
      conditions_(std::move(conditions)),
      supports_(mesh_, conditions_.displacements) {
  for (const auto& condition : conditions_.displacements) requireLabel(mesh_, name_, condition.label);
  for (const auto& condition : conditions_.tractions) requireLabel(mesh_, name_, condition.label);
  weights_.reserve(mesh_.triangles.size());
  gradients_.reserve(4 * mesh_.triangles.size());
  for (const auto& triangle : mesh_.triangles) {
    const auto table = Element::tabulate(
        {mesh_.vertices[triangle[0]], mesh_.vertices[triangle[1]], mesh_.vertices[triangle[2]]});
    weights_.push_back(table.weight);
    largestGradient_ = std::max(largestGradient_, table.gradients.lpNorm<Eigen::Infinity>());
    for (int a = 1; a < Element::nodes; ++a)
      for (int c = 0; c < 2; ++c) gradients_.push_back(table.gradients(c, a) * (std::numbers::sqrt2 / 2));
  }
  numberEquations();
  assembly_ = TangentAssembly(triangleData(), frameOf_, material_->symmetricTangent());
}

void Body::numberEquations() {
  equations_.assign(dofs(), 0);
  for (const NodeSupport& support : supports_.nodes()) {
    const Point& d = support.directions[0];
    if (support.count == 2) equations_[2 * support.node] = equations_[2 * support.node + 1] = -1;
    // A turned node has its normal first.
    if (support.count == 1) equations_[2 * support.node + (d.x() == 0 ? 1 : 0)] = -1;
    if (!support.turned()) continue;
    if (frameOf_.empty()) frameOf_.assign(nodes(), -1);
    frameOf_[support.node] = static_cast<int>(frames_.size());
    frames_.push_back(Eigen::Matrix2d{{d.x(), d.y()}, {-d.y(), d.x()}});
  }
  int next = 0;
  for (int& equation : equations_)
    if (equation == 0) equation = next++;
}

std::array<Body::Part, 2> Body::parts(int node, const Point& vector) const {
  const int frame = frameOf_.empty() ? -1 : frameOf_[node];
  const Point turned = frame < 0 ? vector : Point(frames_[frame] * vector);
  return {Part{equations_[2 * node], turned.x()}, Part{equations_[2 * node + 1], turned.y()}};
}

Vector Body::gather(const Vector& nodal) const {
  Vector x(freeDofs());
  for (int dof = 0; dof < dofs(); ++dof)
    if (equations_[dof] >= 0) x[equations_[dof]] = nodal[dof];
  for (const NodeSupport& support : supports_.nodes()) {
    if (!support.turned()) continue;
    const Point vector = nodal.segment<2>(2 * support.node);
    for (const auto& [equation, value] : parts(support.node, vector))
      if (equation >= 0) x[equation] = value;
  }
  return x;
}

Vector Body::spread(const Vector& x) const {
  Vector nodal = Vector::Zero(dofs());
  for (int dof = 0; dof < dofs(); ++dof)
    if (equations_[dof] >= 0) nodal[dof] = x[equations_[dof]];
  for (const NodeSupport& support : supports_.nodes())
    if (support.turned())
      nodal.segment<2>(2 * support.node) =
          frames_[frameOf_[support.node]].row(1).transpose() * x[equations_[2 * support.node + 1]];
  return nodal;
}

std::array<double, 2> Body::prescribedAt(const NodeSupport& support, double t) const {
  const Point& x = mesh_.vertices[support.node];
  std::array<double, 2> values{0, 0};
  for (int i = 0; i < support.count; ++i)
    values[i] = conditions_.displacements[support.conditions[i]].value(x.x(), x.y(), t);
  return values;
}

void Body::prescribe(double t, Vector& u) const {
  for (const NodeSupport& support : supports_.nodes())
    u.segment<2>(2 * support.node) =
        prescribed(support, prescribedAt(support, t), u.segment<2>(2 * support.node));
}

void Body::prescribeIncrement(double t0, double t1, TwoPartVector& increment) const {
  auto& [high, low] = increment;
  for (const NodeSupport& support : supports_.nodes()) {
    const int dof = 2 * support.node;
    const auto [a0, b0] = prescribedAt(support, t0);
    const auto [a1, b1] = prescribedAt(support, t1);
    const Point change = prescribed(support, {a1 - a0, b1 - b0}, Point::Zero());
    if (support.count == 2) {
      high.segment<2>(dof) = change;
      low.segment<2>(dof).setZero();
    } else if (!support.turned()) {
      const int c = support.directions[0].x() == 0 ? 1 : 0;
      high[dof + c] = change[c];
      low[dof + c] = 0;
    } else {
      const Point& n = support.directions[0];
      high.segment<2>(dof) += n.dot(change - high.segment<2>(dof)) * n;
      low.segment<2>(dof) -= n.dot(low.segment<2>(dof)) * n;
    }
  }
}

Vector Body::load(double t) const {
  Vector f = Vector::Zero(dofs());
  // Simpson on each edge, and the midpoints of the edges of each triangle: exact for data up to degree 2
  // against the shape functions (edges), degree 1 (triangles).
  for (const auto& traction : conditions_.tractions)
    forEachEdge(mesh_, traction.label, [&](const std::array<int, 2>& edge) {
      const Point& a = mesh_.vertices[edge[0]];
      const Point& b = mesh_.vertices[edge[1]];
      const Point m = (a + b) / 2;
      // Its direction times the length of the edge.
      const Point along = b - a;
      const double length = along.norm();
      const Point direction = traction.component == alongX        ? Point(length, 0)
                              : traction.component == alongY      ? Point(0, length)
                              : traction.component == alongNormal ? Point(along.y(), -along.x())
                                                                  : along;
      const double middle = 2 * traction.value(m.x(), m.y(), t);
      f.segment<2>(2 * edge[0]) += (traction.value(a.x(), a.y(), t) + middle) / 6 * direction;
      f.segment<2>(2 * edge[1]) += (traction.value(b.x(), b.y(), t) + middle) / 6 * direction;
    });
  for (const auto& force : conditions_.forces)
    for (const auto& triangle : mesh_.triangles) {
      const Point& a = mesh_.vertices[triangle[0]];
      const Point& b = mesh_.vertices[triangle[1]];
      const Point& c = mesh_.vertices[triangle[2]];
      const double area = ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / 2;
      for (int i = 0; i < 3; ++i) {
        const Point m = (mesh_.vertices[triangle[i]] + mesh_.vertices[triangle[(i + 1) % 3]]) / 2;
        const double value = area / 6 * force.value(m.x(), m.y(), t);
        f[2 * triangle[i] + force.component] += value;
        f[2 * triangle[(i + 1) % 3] + force.component] += value;
      }
    }
  return f;
}

Matrix Body::initialStress() const {
  const int components = material_->components();
  // By component, those beyond the plane as far as they are given.
  Matrix given = Matrix::Zero(components, points());
  std::vector<char> beyond(points(), 0);
  for (const auto& [component, region, value] : conditions_.initialStresses)
    for (int i = 0; i < points(); ++i) {
      const auto t = static_cast<size_t>(i / Element::points);
      if (region && mesh_.regions[t] != *region) continue;
      const auto& [a, b, c] = mesh_.triangles[t];
      const Point centre = (mesh_.vertices[a] + mesh_.vertices[b] + mesh_.vertices[c]) / 3;
      given(component, i) = value(centre.x(), centre.y(), 0);
      if (component == 3) beyond[i] = 1;
    }
  Matrix stress = given;
  for (int i = 0; i < points(); ++i) {
    const Eigen::Vector3d pqr = fromCartesian(given.col(i).head<3>());
    stress.col(i).head<3>() = pqr;
    if (components > 3 && beyond[i] == 0) stress(3, i) = material_->outOfPlane(pqr, i);
  }
  return stress;
}

}  // namespace mortier
