#include "fem/body.h"

#include <algorithm>
#include <numbers>

#include "base/double_double.h"
#include "base/error.h"
#include "fem/element.h"

namespace mortier {
namespace {

using Element = LinearTriangle;
constexpr int elementDofs = 2 * Element::nodes;

// With G = gradient / sqrt2, a nodal displacement (ux, uy) strains p, q, r by
//   B = [Gx Gy; Gx -Gy; Gy Gx].

/// D B for one node: 3 x 2, from 3 x 3 moduli in column-major order.
Eigen::Matrix<double, 3, 2> moduliTimesB(const double* D, double gx, double gy) {
  Eigen::Matrix<double, 3, 2> result;
  for (int i = 0; i < 3; ++i) {
    result(i, 0) = (D[i] + D[3 + i]) * gx + D[6 + i] * gy;
    result(i, 1) = (D[i] - D[3 + i]) * gy + D[6 + i] * gx;
  }
  return result;
}

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
  for (const auto& triangle : mesh_.triangles) {
    const auto table = Element::tabulate(
        {mesh_.vertices[triangle[0]], mesh_.vertices[triangle[1]], mesh_.vertices[triangle[2]]});
    weights_.push_back(table.weight);
    for (int a = 0; a < Element::nodes; ++a)
      for (int c = 0; c < 2; ++c) gradients_.push_back(table.gradients(c, a) * (std::numbers::sqrt2 / 2));
  }
  numberEquations();
  buildPattern();
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
  pattern_.size = 0;
  for (int& equation : equations_)
    if (equation == 0) equation = pattern_.size++;
}

void Body::buildPattern() {
  pattern_.symmetric = material_->symmetricTangent();
  const int n = pattern_.size;

  // Columns by counting sort of the triangles' couplings, then sorted and made unique one column at a time.
  const auto forEachCoupling = [&](auto visit) {
    for (const auto& triangle : mesh_.triangles)
      for (int j = 0; j < elementDofs; ++j) {
        const int column = equations_[2 * triangle[j / 2] + j % 2];
        if (column < 0) continue;
        for (int i = 0; i < elementDofs; ++i) {
          const int row = equations_[2 * triangle[i / 2] + i % 2];
          if (row >= 0 && (row >= column || !pattern_.symmetric)) visit(row, column);
        }
      }
  };
  std::vector<int> start(n + 1, 0);
  forEachCoupling([&](int, int column) { ++start[column + 1]; });
  for (int j = 0; j < n; ++j) start[j + 1] += start[j];
  std::vector<int> rows(start[n]);
  std::vector<int> next(start.begin(), start.end() - 1);
  forEachCoupling([&](int row, int column) { rows[next[column]++] = row; });

  pattern_.columnStart.assign(n + 1, 0);
  pattern_.rows.clear();
  for (int j = 0; j < n; ++j) {
    std::sort(rows.begin() + start[j], rows.begin() + start[j + 1]);
    const auto last = std::unique(rows.begin() + start[j], rows.begin() + start[j + 1]);
    pattern_.rows.insert(pattern_.rows.end(), rows.begin() + start[j], last);
    pattern_.columnStart[j + 1] = static_cast<int>(pattern_.rows.size());
  }

  scatter_.assign(mesh_.triangles.size() * elementDofs * elementDofs, -1);
  for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const auto& triangle = mesh_.triangles[t];
    const Entries entries = entriesOf(triangle);
    const auto isTurned = [&](int v) { return !frameOf_.empty() && frameOf_[v] >= 0; };
    if (std::any_of(triangle.begin(), triangle.end(), isTurned))
      turned_.push_back({static_cast<int>(t), entries});
    else
      std::copy(entries.begin(), entries.end(), scatter_.begin() + t * elementDofs * elementDofs);
  }
}

Body::Entries Body::entriesOf(const std::array<int, 3>& triangle) const {
  Entries entries;
  entries.fill(-1);
  for (int j = 0; j < elementDofs; ++j)
    for (int i = 0; i < elementDofs; ++i) {
      const int column = equations_[2 * triangle[j / 2] + j % 2];
      const int row = equations_[2 * triangle[i / 2] + i % 2];
      if (column < 0 || row < 0 || (row < column && pattern_.symmetric)) continue;
      const auto begin = pattern_.rows.begin() + pattern_.columnStart[column];
      const auto end = pattern_.rows.begin() + pattern_.columnStart[column + 1];
      entries[elementDofs * j + i] =
          static_cast<int>(std::lower_bound(begin, end, row) - pattern_.rows.begin());
    }
  return entries;
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

Point Body::prescribedAt(const NodeSupport& support, double t, const Point& u) const {
  const Point& x = mesh_.vertices[support.node];
  std::array<double, 2> values{0, 0};
  for (int i = 0; i < support.count; ++i)
    values[i] = conditions_.displacements[support.conditions[i]].value(x.x(), x.y(), t);
  return prescribed(support, values, u);
}

void Body::prescribe(double t, Vector& u) const {
  for (const NodeSupport& support : supports_.nodes())
    u.segment<2>(2 * support.node) = prescribedAt(support, t, u.segment<2>(2 * support.node));
}

void Body::prescribeIncrement(double t, const Vector& u0, Vector& increment, Vector& small) const {
  for (const NodeSupport& support : supports_.nodes()) {
    const int dof = 2 * support.node;
    const Point before = u0.segment<2>(dof);
    const Point change = prescribedAt(support, t, before) - before;
    if (support.count == 2) {
      increment.segment<2>(dof) = change;
      small.segment<2>(dof).setZero();
    } else if (!support.turned()) {
      const int c = support.directions[0].x() == 0 ? 1 : 0;
      increment[dof + c] = change[c];
      small[dof + c] = 0;
    } else {
      const Point& n = support.directions[0];
      increment.segment<2>(dof) += n.dot(change - increment.segment<2>(dof)) * n;
      small.segment<2>(dof) -= n.dot(small.segment<2>(dof)) * n;
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

Vector Body::internalForce(const Matrix& stress) const {
  Vector f = Vector::Zero(dofs());
  for (int i = 0; i < points(); ++i) {
    const auto& triangle = mesh_.triangles[i / Element::points];
    const double p = weights_[i] * stress(0, i);
    const double q = weights_[i] * stress(1, i);
    const double r = weights_[i] * stress(2, i);
    const double* G = &gradients_[elementDofs * i];
    for (int a = 0; a < Element::nodes; ++a) {
      f[2 * triangle[a]] += (p + q) * G[2 * a] + r * G[2 * a + 1];
      f[2 * triangle[a] + 1] += (p - q) * G[2 * a + 1] + r * G[2 * a];
    }
  }
  return f;
}

void Body::strain(const Vector& u, const Vector& small, Matrix& strain) const {
  strain.resize(3, points());
  for (int i = 0; i < points(); ++i) {
    const auto& triangle = mesh_.triangles[i / Element::points];
    const double* G = &gradients_[elementDofs * i];
    DoubleDouble xx;
    DoubleDouble yy;
    DoubleDouble xy;
    const auto add = [](DoubleDouble& total, double g, const DoubleDouble& du) {
      DoubleDouble product = DoubleDouble::product(g, du.high);
      product.low += g * du.low;
      total += product;
    };
    // The gradients of one element sum to zero: differences to its first node keep rigid motions exact.
    for (int a = 1; a < Element::nodes; ++a) {
      DoubleDouble d[2];
      for (int c = 0; c < 2; ++c) {
        d[c] = DoubleDouble::sum(u[2 * triangle[a] + c], -u[2 * triangle[0] + c]);
        d[c].low += small[2 * triangle[a] + c] - small[2 * triangle[0] + c];
      }
      add(xx, G[2 * a], d[0]);
      add(yy, G[2 * a + 1], d[1]);
      add(xy, G[2 * a + 1], d[0]);
      add(xy, G[2 * a], d[1]);
    }
    DoubleDouble p = xx;
    DoubleDouble q = xx;
    p += yy;
    q += DoubleDouble{-yy.high, -yy.low};
    strain(0, i) = p.value();
    strain(1, i) = q.value();
    strain(2, i) = xy.value();
  }
}

void Body::addStressOf(const Vector& d, const Matrix& moduli, Matrix& stress) const {
  for (int i = 0; i < points(); ++i) {
    const auto& triangle = mesh_.triangles[i / Element::points];
    const double* G = &gradients_[elementDofs * i];
    double xx = 0;
    double yy = 0;
    double xy = 0;
    const double x0 = d[2 * triangle[0]];
    const double y0 = d[2 * triangle[0] + 1];
    for (int a = 1; a < Element::nodes; ++a) {
      const double dx = d[2 * triangle[a]] - x0;
      const double dy = d[2 * triangle[a] + 1] - y0;
      xx += G[2 * a] * dx;
      yy += G[2 * a + 1] * dy;
      xy += G[2 * a + 1] * dx + G[2 * a] * dy;
    }
    const double* D = &moduli(0, i);
    for (int c = 0; c < 3; ++c) stress(c, i) += D[c] * (xx + yy) + D[3 + c] * (xx - yy) + D[6 + c] * xy;
  }
}

void Body::tangent(const Matrix& moduli, std::vector<double>& values) const {
  values.assign(pattern_.entries(), 0.0);
  for (int i = 0; i < points(); ++i) {
    const int t = i / Element::points;
    const double* G = &gradients_[elementDofs * i];
    const int* scatter = &scatter_[static_cast<size_t>(t) * elementDofs * elementDofs];
    for (int b = 0; b < Element::nodes; ++b) {
      const Eigen::Matrix<double, 3, 2> DB =
          weights_[i] * moduliTimesB(&moduli(0, i), G[2 * b], G[2 * b + 1]);
      for (int c = 0; c < 2; ++c) {
        const double sum = DB(0, c) + DB(1, c);
        const double difference = DB(0, c) - DB(1, c);
        const int* column = scatter + (2 * b + c) * elementDofs;
        for (int a = 0; a < Element::nodes; ++a) {
          const double x = sum * G[2 * a] + DB(2, c) * G[2 * a + 1];
          const double y = difference * G[2 * a + 1] + DB(2, c) * G[2 * a];
          if (column[2 * a] >= 0) values[column[2 * a]] += x;
          if (column[2 * a + 1] >= 0) values[column[2 * a + 1]] += y;
        }
      }
    }
  }
  addTurned(moduli, values);
}

void Body::addTurned(const Matrix& moduli, std::vector<double>& values) const {
  for (const auto& [t, entries] : turned_) {
    // B T: strains of the motions along the frames of the nodes.
    Eigen::Matrix<double, 3, elementDofs> B;
    const double* G = &gradients_[static_cast<size_t>(elementDofs) * t];
    for (int a = 0; a < Element::nodes; ++a) {
      const double gx = G[2 * a];
      const double gy = G[2 * a + 1];
      Eigen::Matrix<double, 3, 2> Ba{{gx, gy}, {gx, -gy}, {gy, gx}};
      const int frame = frameOf_[mesh_.triangles[t][a]];
      if (frame >= 0) Ba = Ba * frames_[frame].transpose();
      B.middleCols<2>(2 * a) = Ba;
    }
    const Eigen::Map<const Eigen::Matrix3d> D(&moduli(0, t));
    const Eigen::Matrix<double, elementDofs, elementDofs> K = weights_[t] * (B.transpose() * D * B);
    for (int j = 0; j < elementDofs; ++j)
      for (int i = 0; i < elementDofs; ++i)
        if (const int entry = entries[elementDofs * j + i]; entry >= 0) values[entry] += K(i, j);
  }
}

}  // namespace mortier
