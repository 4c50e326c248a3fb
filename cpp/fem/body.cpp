#include "fem/body.h"

#include <algorithm>
#include <numbers>

#include "base/error.h"
#include "fem/element.h"
#include "material/stress.h"
#include "mesh/boundary_line.h"

namespace mortier {
namespace {

/// The places of the nodes of a triangle.
template <class Element>
std::array<Point, Element::nodes> placesOf(const ElementNodes& nodes, size_t triangle) {
  std::array<Point, Element::nodes> x;
  for (int a = 0; a < Element::nodes; ++a) x[a] = nodes.places[nodes.of(triangle)[a]];
  return x;
}

template <size_t n>
Point placeOf(const std::array<double, n>& shapes, const std::array<Point, n>& x) {
  Point place = Point::Zero();
  for (size_t a = 0; a < n; ++a) place += shapes[a] * x[a];
  return place;
}

Conditions withAxisHeld(Conditions conditions) {
  conditions.displacements.push_back(heldOnAxis());
  return conditions;
}

void requireLabel(const TriangleMesh& mesh, const std::string& body, int label) {
  if (std::find(mesh.boundaryLabels.begin(), mesh.boundaryLabels.end(), label) == mesh.boundaryLabels.end())
    throw InputError("body " + body + ": label = " + std::to_string(label) +
                     ", expected a boundary label of " + mesh.name);
}

}  // namespace

Body::Body(std::string name, TriangleMesh mesh, std::shared_ptr<const Material> material,
           Conditions conditions, int degree, bool axisymmetric)
    : name_(std::move(name)),
      mesh_(axisymmetric ? meshAboutAxis(std::move(mesh)) : std::move(mesh)),
      nodes_(mortier::elementNodes(mesh_, degree)),
      material_(std::move(material)),
      conditions_(axisymmetric ? withAxisHeld(std::move(conditions)) : std::move(conditions)),
      supports_(mesh_, nodes_, conditions_.displacements),
      axisymmetric_(axisymmetric),
      extent_(mortier::extent(mesh_)) {
  for (const auto& condition : conditions_.displacements)
    if (!condition.point && !condition.onAxis)
      requireLabel(mesh_, name_, condition.label);
    else if (condition.point && vertexAt(mesh_, *condition.point) < 0)
      throw InputError("body " + name_ + ": a point that is held is no vertex of " + mesh_.name);
  for (const auto& condition : conditions_.tractions) requireLabel(mesh_, name_, condition.label);
  withElement(degree, [&](auto element) {
    using Element = decltype(element);
    const size_t count = Element::points * mesh_.triangles.size();
    weights_.reserve(count);
    gradients_.reserve(2 * (Element::nodes - 1) * count);
    for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto table = Element::tabulate(placesOf<Element>(nodes_, t));
      for (int i = 0; i < Element::points; ++i) {
        if (axisymmetric_ && !(table.places[i].x() > 0))
          throw InputError(mesh_.name + ": triangle " + std::to_string(t + 1) +
                           " reaches over the axis by its curved side, expected a finer mesh there");
        if (!(table.weights[i] > 0))
          throw InputError(mesh_.name + ": triangle " + std::to_string(t + 1) +
                           " is turned inside out by its curved side, expected a finer mesh there");
        weights_.push_back(table.weights[i] * depthAt(table.places[i]));
        if (axisymmetric_)
          for (const double shape : Element::shapes(Element::interior[i]))
            hoops_.push_back(shape / table.places[i].x());
        largestGradient_ = std::max(largestGradient_, table.gradients[i].template lpNorm<Eigen::Infinity>());
        for (size_t a = hoops_.size(); axisymmetric_ && a > hoops_.size() - Element::nodes; --a)
          largestGradient_ = std::max(largestGradient_, std::abs(hoops_[a - 1]));
        for (int a = 1; a < Element::nodes; ++a)
          for (int c = 0; c < 2; ++c)
            gradients_.push_back(table.gradients[i](c, a) * (std::numbers::sqrt2 / 2));
      }
    }
  });
  numberEquations();
}

const TangentAssembly& Body::assembly() const {
  if (!assembly_) assembly_.emplace(triangleData(), frameOf_, tangentSize_, material_->symmetricTangent());
  return *assembly_;
}

int Body::pointsOfTriangle() const {
  return withElement(degree(), [](auto element) { return decltype(element)::points; });
}

std::vector<Point> placesOfPoints(const TriangleMesh& mesh, const ElementNodes& nodes) {
  std::vector<Point> places;
  withElement(nodes.degree, [&](auto element) {
    using Element = decltype(element);
    places.reserve(Element::points * mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const Point& place : Element::tabulate(placesOf<Element>(nodes, t)).places)
        places.push_back(place);
  });
  return places;
}

void Body::numberEquations(const std::vector<char>& own) {
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
  const auto number = [&](char which) {
    for (int dof = 0; dof < dofs(); ++dof)
      if (equations_[dof] >= 0 && (own.empty() ? 1 : own[dof / 2]) == which) equations_[dof] = freeDofs_++;
  };
  number(1);
  tangentSize_ = freeDofs_;
  number(0);
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
  const Point& x = nodes_.places[support.node];
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
  for (const NodeSupport& support : supports_.nodes()) {
    const int dof = 2 * support.node;
    const auto [a0, b0] = prescribedAt(support, t0);
    const auto [a1, b1] = prescribedAt(support, t1);
    const Point change = prescribed(support, {a1 - a0, b1 - b0}, Point::Zero());
    const Point& n = support.directions[0];
    if (support.turned()) {
      increment.setAlong(dof, n, n.dot(change));
      continue;
    }
    for (const int c : {0, 1})
      if (support.count == 2 || n[c] != 0) increment.set(dof + c, change[c]);
  }
}

Vector Body::load(double t) const {
  Vector f = Vector::Zero(dofs());
  addTractions(t, f);
  addForces(t, f);
  return f;
}

void Body::addTractions(double t, Vector& f) const {
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    for (const auto& traction : conditions_.tractions)
      for (size_t e = 0; e < mesh_.boundaryEdges.size(); ++e) {
        if (mesh_.boundaryLabels[e] != traction.label || (!ownEdges_.empty() && ownEdges_[e] == 0)) continue;
        std::array<int, Element::edgeNodes> nodes;
        std::array<Point, Element::edgeNodes> x;
        for (int a = 0; a < Element::edgeNodes; ++a) {
          nodes[a] = a < 2 ? mesh_.boundaryEdges[e][a] : nodes_.middles[e];
          x[a] = nodes_.places[nodes[a]];
        }
        std::array<double, Element::edgeNodes> sums{};
        for (const auto& [s, toNode] : Element::edgeRule()) {
          const Point at = placeOf(Element::edgeShapes(s), x);
          const double value = depthAt(at) * traction.value(at.x(), at.y(), t);
          for (int a = 0; a < Element::edgeNodes; ++a) sums[a] += toNode[a] * value;
          if (Element::straight && s != Element::edgeRule().back().at) continue;
          // The direction times the length of the edge.
          const Point along = Element::edgeTangent(s, x);
          const double length = along.norm();
          const Point direction = traction.component == alongX        ? Point(length, 0)
                                  : traction.component == alongY      ? Point(0, length)
                                  : traction.component == alongNormal ? Point(along.y(), -along.x())
                                                                      : along;
          for (int a = 0; a < Element::edgeNodes; ++a)
            f.segment<2>(2 * nodes[a]) += sums[a] / Element::edgeDivisor * direction;
          sums.fill(0);
        }
      }
  });
}

void Body::addForces(double t, Vector& f) const {
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    for (const auto& force : conditions_.forces)
      for (size_t tri = 0; tri < mesh_.triangles.size(); ++tri) {
        const auto x = placesOf<Element>(nodes_, tri);
        for (const auto& [at, toNode] : Element::loadRule()) {
          const Point place = placeOf(Element::shapes(at), x);
          const double value = depthAt(place) * Element::areaAt(at, x) / Element::loadDivisor *
                               force.value(place.x(), place.y(), t);
          for (int a = 0; a < Element::nodes; ++a)
            f[2 * nodes_.of(tri)[a] + force.component] += toNode[a] * value;
        }
      }
  });
}

Matrix Body::thermalStrain(double t) const {
  const std::vector<Point> places = this->places();
  Matrix strain = Matrix::Zero(material_->components(), points());  // what a law remembers has none
  for (int i = 0; i < points(); ++i)
    strain.col(i).head(conditions_.expansion.rows()) =
        conditions_.expansion.col(i) * conditions_.temperature(places[i].x(), places[i].y(), t);
  return strain;
}

Matrix Body::initialStress() const {
  const int components = material_->components();
  const std::vector<Point> places = hasInitialStress() ? this->places() : std::vector<Point>();
  // By component, those beyond the plane as far as they are given.
  Matrix given = Matrix::Zero(components, points());
  std::vector<char> beyond(points(), 0);
  for (const auto& [component, region, value] : conditions_.initialStresses)
    for (int i = 0; i < points(); ++i) {
      const size_t triangle = i / pointsOfTriangle();
      if (region && mesh_.regions[triangle] != *region) continue;
      given(component, i) = value(places[i].x(), places[i].y(), 0);
      if (component == 3) beyond[i] = 1;
    }
  Matrix stress = given;
  for (int i = 0; i < points(); ++i) {
    const Eigen::Vector3d pqr = fromCartesian(given.col(i).head<3>());
    stress.col(i).head<3>() = pqr;
    if (material_->tensorComponents() > 3 && beyond[i] == 0 && !axisymmetric_)
      stress(3, i) = material_->outOfPlane(pqr, i);
  }
  return stress;
}

}  // namespace mortier
