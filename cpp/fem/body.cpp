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
  conditions.displacements.insert(conditions.displacements.begin(), heldOnAxis());
  return conditions;
}

template <class Mesh>
void requirePlaces(const Mesh& mesh, const std::string& body, const Conditions& conditions) {
  for (const auto* each : {&conditions.displacements, &conditions.tractions})
    for (const Condition& condition : *each) {
      const auto place = [&] {
        if constexpr (std::is_same_v<Mesh, TriangleMesh>)
          return Point(condition.point->template head<2>());
        else
          return *condition.point;
      };
      if (condition.point && vertexAt(mesh, place()) < 0)
        throw InputError("body " + body + ": a point that is held is no vertex of " + mesh.name);
      if (!condition.point && !condition.onAxis &&
          std::find(mesh.boundaryLabels.begin(), mesh.boundaryLabels.end(), condition.label) ==
              mesh.boundaryLabels.end())
        throw InputError("body " + body + ": label = " + std::to_string(condition.label) +
                         ", expected a boundary label of " + mesh.name);
    }
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
  requirePlaces(mesh_, name_, conditions_);
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
  findSteadyLoads();
}

Body::Body(std::string name, TetrahedronMesh mesh, std::shared_ptr<const Material> material,
           Conditions conditions, int degree, bool averaged)
    : name_(std::move(name)),
      space_(std::make_shared<SpaceElements>(std::move(mesh), degree, averaged)),
      material_(std::move(material)),
      conditions_(std::move(conditions)),
      supports_(space_->mesh(), space_->nodes(), conditions_.displacements),
      weights_(space_->weights()),
      largestGradient_(space_->largestGradient()),
      extent_(mortier::extent(space_->mesh())) {
  requirePlaces(space_->mesh(), name_, conditions_);
  if (!rigid()) return;
  weights_.clear();
  findMotions();
}

double Body::largestCoordinate() const {
  double largest = 0;
  for (const Point& x : mesh_.vertices) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  if (space_)
    for (const SpacePoint& x : space_->mesh().vertices) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  return largest;
}

SpacePoint Body::placeOfNode(int node) const {
  if (space_) return space_->nodes().places[node];
  return asSpacePoint(nodes_.places[node]);
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
    return asSpacePoint(data.places[point % Element::points]);
  });
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

std::array<Body::Part, 2> Body::parts(int node, const Point& vector) const {
  const auto [x, y, z] = parts(node, asSpacePoint(vector));
  return {x, y};
}

std::array<Body::Part, 3> Body::parts(int node, const SpacePoint& vector) const {
  const Eigen::Matrix3d* frame = supports_.frameOf(node);
  const SpacePoint own = frame == nullptr ? vector : SpacePoint(*frame * vector);
  std::array<Part, 3> parts;
  for (int c = 0; c < dimension(); ++c) parts[c] = {equations()[dimension() * node + c], own[c]};
  return parts;
}

void Body::prescribe(double t, Vector& u) const {
  if (rigid()) u = withHeld(heldAt(t), u);
  supports_.prescribe(conditions_.displacements, t, u);
}

void Body::prescribeIncrement(double t0, double t1, TwoPartVector& increment) const {
  if (rigid()) {
    increment.high = withHeld(heldAt(t1) - heldAt(t0), increment.value());
    increment.low.setZero();
  }
  supports_.prescribeIncrement(conditions_.displacements, t0, t1, increment);
}

}  // namespace mortier
