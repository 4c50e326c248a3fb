#include "fem/body.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "base/error.h"
#include "fem/element_data.h"
#include "mesh/boundary_line.h"
#include "mesh/simplices.h"

namespace mortier {
namespace {

/// An element by the places of its nodes.
template <class Element, class Nodes>
auto tabulationOf(const Nodes& nodes, size_t element) {
  std::array<typename decltype(nodes.places)::value_type, Element::nodes> x;
  for (int a = 0; a < Element::nodes; ++a) x[a] = nodes.places[nodes.of(element)[a]];
  if constexpr (std::is_same_v<Nodes, SpaceNodes>)
    return tabulated<Element>(x);
  else
    return Element::tabulate(x);
}

/// Of a point of an element.
template <class Element, class Nodes>
auto placeIn(const Nodes& nodes, size_t element, int point) {
  if constexpr (std::is_same_v<Nodes, SpaceNodes>) {
    SpacePoint place = SpacePoint::Zero();
    for (int k = 0; k < 4; ++k) place += Element::interior[point][k] * nodes.places[nodes.of(element)[k]];
    return place;
  } else {
    return tabulationOf<Element>(nodes, element).places[point];
  }
}

/// Places of the points of all elements of a degree.
template <class Nodes>
auto pointsOf(const Nodes& nodes, int degree) {
  auto places = nodes.places;
  places.clear();
  withElementIn<dimensionOf<Nodes>>(degree, [&](auto element) {
    using Element = decltype(element);
    const size_t count = nodes.elements.size() / nodes.perElement();
    places.reserve(Element::points * count);
    for (size_t e = 0; e < count; ++e)
      for (int i = 0; i < Element::points; ++i) places.push_back(placeIn<Element>(nodes, e, i));
  });
  return places;
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
        throw InputError("body " + body + ": a point that is held or loaded is no vertex of " + mesh.name);
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
  tabulate(nodes_, mesh_.name);
  if (averaged)
    patches_.emplace(volumePatches(mesh_, degree), nodes_, places(), weights_, gradients_, hoops_);
  findSteadyLoads();
}

Body::Body(std::string name, TetrahedronMesh mesh, std::shared_ptr<const Material> material,
           Conditions conditions, int degree, bool averaged)
    : name_(std::move(name)),
      space_(std::make_shared<SpaceElements>(std::move(mesh), degree)),
      material_(std::move(material)),
      conditions_(std::move(conditions)),
      supports_(space_->mesh(), space_->nodes(), conditions_.displacements),
      extent_(mortier::extent(space_->mesh())) {
  requirePlaces(space_->mesh(), name_, conditions_);
  if (rigid()) {
    findMotions();
    return;
  }
  tabulate(space_->nodes(), space_->mesh().name);
  if (averaged) patches_.emplace(volumePatches(space_->mesh()), space_->nodes(), weights_, gradients_);
}

template <class Nodes>
void Body::tabulate(const Nodes& nodes, const std::string& mesh) {
  constexpr int dim = dimensionOf<Nodes>;
  withElementIn<dim>(nodes.degree, [&](auto element) {
    using Element = decltype(element);
    const size_t count = nodes.elements.size() / Element::nodes;
    weights_.reserve(Element::points * count);
    gradients_.reserve(static_cast<size_t>(dim) * (Element::nodes - 1) * Element::points * count);
    for (size_t e = 0; e < count; ++e) {
      const auto table = tabulationOf<Element>(nodes, e);
      for (int i = 0; i < Element::points; ++i) {
        double weight = table.weights[i];
        if constexpr (dim == 2) {
          const auto refuse = [&](const char* what) {
            throw InputError(mesh + ": triangle " + std::to_string(e + 1) + what +
                             " by its curved side, expected a finer mesh there");
          };
          if (axisymmetric_ && !(table.places[i].x() > 0)) refuse(" reaches over the axis");
          if (!(weight > 0)) refuse(" is turned inside out");
          weight *= depthAt(table.places[i]);
          for (const double shape : Element::shapes(Element::interior[i]))
            if (axisymmetric_) hoops_.push_back(shape / table.places[i].x());
        }
        weights_.push_back(weight);
        largestGradient_ = std::max(largestGradient_, table.gradients[i].template lpNorm<Eigen::Infinity>());
        for (size_t a = hoops_.size(); axisymmetric_ && a > hoops_.size() - Element::nodes; --a)
          largestGradient_ = std::max(largestGradient_, std::abs(hoops_[a - 1]));
        for (int a = 1; a < Element::nodes; ++a)
          for (int c = 0; c < dim; ++c)
            gradients_.push_back(dim == 2 ? table.gradients[i](c, a) * overRoot2
                                          : table.gradients[i](c, a) / std::numbers::sqrt2);
      }
    }
  });
}

double Body::largestCoordinate() const {
  return withMesh([](const auto& mesh, const auto& /*nodes*/) {
    double largest = 0;
    for (const auto& x : mesh.vertices) largest = std::max(largest, x.cwiseAbs().maxCoeff());
    return largest;
  });
}

SpacePoint Body::placeOfNode(int node) const {
  return withMesh([&](const auto& /*mesh*/, const auto& nodes) { return asSpacePoint(nodes.places[node]); });
}

SpacePoint Body::centreOf(size_t element) const {
  return withMesh([&](const auto& mesh, const auto& /*nodes*/) {
    SpacePoint centre = SpacePoint::Zero();
    const auto& corners = elementsOf(mesh)[element];
    for (const int v : corners)
      centre += asSpacePoint(mesh.vertices[v]) / static_cast<double>(corners.size());
    return centre;
  });
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
  return withMesh([&](const auto& /*mesh*/, const auto& nodes) {
    return withElementIn<dimensionOf<decltype(nodes)>>(nodes.degree, [&](auto element) {
      using Element = decltype(element);
      return asSpacePoint(placeIn<Element>(nodes, point / Element::points, point % Element::points));
    });
  });
}

int Body::pointsOfTriangle() const {
  return withMesh([](const auto& /*mesh*/, const auto& nodes) {
    return withElementIn<dimensionOf<decltype(nodes)>>(
        nodes.degree, [](auto element) { return decltype(element)::points; });
  });
}

std::vector<Point> Body::places() const {
  return pointsOf(nodes_, nodes_.degree);
}

std::vector<Point> placesOfPoints(const TriangleMesh& mesh, int degree) {
  return pointsOf(elementNodes(mesh, degree), degree);
}

std::vector<SpacePoint> placesOfPoints(const TetrahedronMesh& mesh, int degree) {
  return pointsOf(spaceNodes(mesh, 1), degree);  // sides are straight
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

void Body::holdAt(const Vector& displacement) {
  const auto still = [](auto value) {
    Datum datum(std::move(value));
    datum.inTime = false;
    return datum;
  };
  if (rigid()) {
    const Vector motion = motionOf(displacement);
    for (size_t c = 0; c < conditions_.rigid->whereItIs.size(); ++c)
      if (conditions_.rigid->whereItIs[c])
        conditions_.rigid->held[c] = still([value = motion[c]](const SpacePoint&, double) { return value; });
  }
  for (size_t c = 0; c < conditions_.displacements.size(); ++c) {
    if (!conditions_.displacements[c].whereItIs) continue;
    std::map<std::array<double, 3>, double> along;  // by places of nodes
    for (const NodeSupport& support : supports_.nodes())
      for (int i = 0; i < support.count; ++i) {
        if (support.conditions[i] != static_cast<int>(c)) continue;
        SpacePoint u = SpacePoint::Zero();
        u.head(dimension()) = displacement.segment(dimension() * support.node, dimension());
        along[{support.place.x(), support.place.y(), support.place.z()}] = u.dot(support.directions[i]);
      }
    conditions_.displacements[c].value = still([along](const SpacePoint& x, double) {
      const auto at = along.find({x.x(), x.y(), x.z()});
      return at == along.end() ? 0 : at->second;
    });
  }
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
