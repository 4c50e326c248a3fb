#include "fem/body.h"

#include <algorithm>
#include <numbers>
#include <set>

#include "base/error.h"
#include "fem/element.h"
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
           Conditions conditions, int degree, bool axisymmetric, bool averaged)
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
  if (rigid()) {
    findMotions();
    return;
  }
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
  if (averaged)
    patches_.emplace(volumePatches(mesh_, degree), nodes_, places(), weights_, gradients_, hoops_);
  numberEquations();
  findSteadyLoads();
}

Body::Body(std::string name, TetrahedronMesh mesh, std::shared_ptr<const Material> material,
           SpaceConditions conditions, int degree, bool averaged)
    : name_(std::move(name)),
      space_(
          std::make_shared<SpaceElements>(name_, std::move(mesh), std::move(conditions), degree, averaged)),
      material_(std::move(material)),
      equations_(space_->equations()),
      weights_(space_->weights()),
      largestGradient_(space_->largestGradient()),
      extent_(mortier::extent(space_->mesh())),
      freeDofs_(space_->freeDofs()) {}

double Body::largestCoordinate() const {
  double largest = 0;
  for (const Point& x : mesh_.vertices) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  if (space_)
    for (const SpacePoint& x : space_->mesh().vertices) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  return largest;
}

SpacePoint Body::placeOfNode(int node) const {
  if (space_) return space_->nodes().places[node];
  const Point& place = nodes_.places[node];
  return {place.x(), place.y(), 0};
}

SpacePoint Body::centreOf(size_t element) const {
  SpacePoint centre = SpacePoint::Zero();
  if (space_)
    for (const int v : space_->mesh().tetrahedra[element]) centre += space_->mesh().vertices[v] / 4;
  else
    for (const int v : mesh_.triangles[element]) centre.head<2>() += mesh_.vertices[v] / 3;
  return centre;
}

std::vector<int> Body::boundaryNodes(std::optional<int> label) const {
  std::set<int> nodes;
  const auto add = [&](const auto& of, int boundary) {
    if (!label || boundary == *label)
      for (const int node : of)
        if (node >= 0) nodes.insert(node);
  };
  if (space_)
    for (size_t i = 0; i < space_->nodes().faces.size(); ++i)
      add(space_->nodes().faces[i], space_->mesh().boundaryLabels[i]);
  for (const BoundaryStretch& stretch : nodes_.boundary)
    add(stretch.nodes, mesh_.boundaryLabels[stretch.edge]);
  return {nodes.begin(), nodes.end()};
}

SpacePoint Body::placeOfPoint(int point) const {
  if (space_) return space_->placeOf(point);
  return withElement(degree(), [&](auto element) -> SpacePoint {
    using Element = decltype(element);
    const auto data = Element::tabulate(placesOf<Element>(nodes_, point / Element::points));
    const Point& place = data.places[point % Element::points];
    return {place.x(), place.y(), 0};
  });
}

const TangentAssembly& Body::assembly() const {
  if (!assembly_) assembly_.emplace(triangleData(), frameOf_, freeDofs_, material_->symmetricTangent());
  return *assembly_;
}

int Body::pointsOfTriangle() const {
  if (space_) return space_->pointsOfElement();
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
  for (int& equation : equations_)
    if (equation >= 0) equation = freeDofs_++;
}

std::array<Body::Part, 2> Body::parts(int node, const Point& vector) const {
  const int frame = frameOf_.empty() ? -1 : frameOf_[node];
  const Point turned = frame < 0 ? vector : Point(frames_[frame] * vector);
  return {Part{equations_[2 * node], turned.x()}, Part{equations_[2 * node + 1], turned.y()}};
}

std::array<Body::Part, 3> Body::parts(int node, const SpacePoint& vector) const {
  if (!space_) {
    const auto [x, y] = parts(node, Point(vector.head<2>()));
    return {x, y, Part{}};
  }
  const SpacePoint turned = space_->inFrame(node, vector);
  return {Part{equations_[3 * node], turned.x()}, Part{equations_[3 * node + 1], turned.y()},
          Part{equations_[3 * node + 2], turned.z()}};
}

Vector Body::gather(const Vector& nodal) const {
  if (space_) return space_->gather(nodal);
  if (rigid()) return freeMotions_.transpose() * nodal;
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
  if (space_) return space_->spread(x);
  if (rigid()) return freeMotions_ * x;
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
  if (space_) return space_->prescribe(t, u);
  if (rigid()) u = withHeld(heldAt(t), u);
  for (const NodeSupport& support : supports_.nodes())
    u.segment<2>(2 * support.node) =
        prescribed(support, prescribedAt(support, t), u.segment<2>(2 * support.node));
}

void Body::prescribeIncrement(double t0, double t1, TwoPartVector& increment) const {
  if (space_) return space_->prescribeIncrement(t0, t1, increment);
  if (rigid()) {
    increment.high = withHeld(heldAt(t1) - heldAt(t0), increment.value());
    increment.low.setZero();
  }
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

}  // namespace mortier
