// What the data of a body are to its nodes and points. A datum of so low a degree that the rule of the
// element integrates it is taken by that; any other is resolved on every edge and triangle
// (base/adaptive_quadrature.h), once where it does not change.
#include <Eigen/LU>

#include "fem/body.h"
#include "fem/data_misfit.h"
#include "fem/element.h"
#include "fem/tetrahedron.h"
#include "material/stress.h"
#include "mesh/boundary_line.h"

namespace mortier {
namespace {

template <class Element>
std::vector<Point> placesIn(const ElementNodes& nodes, size_t triangle) {
  std::vector<Point> x;
  for (int a = 0; a < Element::nodes; ++a) x.push_back(nodes.places[nodes.of(triangle)[a]]);
  return x;
}

template <size_t n>
Point placeOf(const std::array<double, n>& shapes, const std::array<Point, n>& x) {
  Point place = Point::Zero();
  for (size_t a = 0; a < n; ++a) place += shapes[a] * x[a];
  return place;
}

template <size_t n>
bool curved(const std::array<Point, n>& x) {
  if constexpr (n == 2)
    return false;
  else
    return x[2] != (x[0] + x[1]) / 2;
}

/// A traction's direction times dx/ds.
Point directed(int component, const Point& along) {
  const double length = along.norm();
  return component == alongX        ? Point(length, 0)
         : component == alongY      ? Point(0, length)
         : component == alongNormal ? Point(along.y(), -along.x())
                                    : along;
}

}  // namespace

std::vector<SpaceRulePoint> triangleRule() {
  std::vector<SpaceRulePoint> rule;
  for (const auto& [x, ofX] : gaussFour)
    for (const auto& [y, ofY] : gaussFour) rule.push_back({{x, y * (1 - x), 0}, ofX * ofY * (1 - x)});
  return rule;
}

std::vector<SpaceRulePoint> tetrahedronRule() {
  std::vector<SpaceRulePoint> rule;
  for (const auto& [z, ofZ] : gaussFour)
    for (const SpaceRulePoint& each : triangleRule())
      rule.push_back(
          {{each.at.x() * (1 - z), each.at.y() * (1 - z), z}, ofZ * each.weight * (1 - z) * (1 - z)});
  return rule;
}

Vector Body::load(double t) const {
  if (rigid()) return rigidLoad(t);
  if (space_) return spaceLoad(t);
  Vector f = steady_.size() > 0 ? steady_ : Vector::Zero(dofs());
  addPointForces(t, f);
  addTractions(t, f, false);
  addForces(t, f, false);
  return f;
}

void Body::addPointForces(double t, Vector& f) const {
  for (const Condition& force : conditions_.tractions) {
    if (!force.point) continue;
    const SpacePoint& at = *force.point;
    const int vertex = space_ ? vertexAt(space_->mesh(), at) : vertexAt(mesh_, Point(at.head<2>()));
    f[static_cast<Eigen::Index>(dimension()) * vertex + force.component] += force.value(at, t);
  }
}

Vector Body::spaceLoad(double t) const {
  const SpaceNodes& nodes = space_->nodes();
  const TetrahedronMesh& mesh = space_->mesh();
  Vector f = Vector::Zero(dofs());
  addPointForces(t, f);
  const std::vector<SpaceRulePoint> onTriangle = triangleRule();
  for (const Condition& traction : conditions_.tractions)
    for (size_t i = 0; i < nodes.faces.size(); ++i) {
      if (mesh.boundaryLabels[i] != traction.label) continue;
      const std::array<int, 6>& face = nodes.faces[i];
      const SpacePoint& x0 = nodes.places[face[0]];
      const SpacePoint e1 = nodes.places[face[1]] - x0;
      const SpacePoint e2 = nodes.places[face[2]] - x0;
      const SpacePoint area = e1.cross(e2);
      const SpacePoint direction = traction.component == alongNormal
                                       ? area
                                       : SpacePoint(area.norm() * SpacePoint::Unit(traction.component));
      for (const auto& [at, weight] : onTriangle) {
        const double value = weight * traction.value(x0 + at.x() * e1 + at.y() * e2, t);
        const std::array<double, 6> N = traceShapes(nodes.degree, {1 - at.x() - at.y(), at.x(), at.y()});
        for (int a = 0; a < nodes.perFace(); ++a)
          f.segment<3>(3 * static_cast<Eigen::Index>(face[a])) += value * N[a] * direction;
      }
    }
  const std::vector<SpaceRulePoint> inTetrahedron = tetrahedronRule();
  for (const BodyForce& force : conditions_.forces)
    withSpaceElement(nodes.degree, [&](auto element) {
      using Element = decltype(element);
      for (size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
        const int* own = nodes.of(e);
        const SpacePoint& x0 = nodes.places[own[0]];
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) edges.col(k) = nodes.places[own[k + 1]] - x0;
        const double determinant = edges.determinant();
        for (const auto& [at, weight] : inTetrahedron) {
          const double value = weight * determinant * force.value(x0 + edges * at, t);
          const auto N = Element::shapes({1 - at.sum(), at.x(), at.y(), at.z()});
          for (int a = 0; a < Element::nodes; ++a)
            f[3 * static_cast<Eigen::Index>(own[a]) + force.component] += value * N[a];
        }
      }
    });
  return f;
}

void Body::findSteadyLoads() {
  const auto steady = [](const auto& each) { return each.value.degree > 1 && !each.value.inTime; };
  if (std::none_of(conditions_.tractions.begin(), conditions_.tractions.end(), steady) &&
      std::none_of(conditions_.forces.begin(), conditions_.forces.end(), steady))
    return;
  steady_ = Vector::Zero(dofs());
  addTractions(0, steady_, true);
  addForces(0, steady_, true);
}

void Body::addTractions(double t, Vector& f, bool steady) const {
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    for (const auto& traction : conditions_.tractions) {
      const bool isSteady = traction.value.degree > 1 && !traction.value.inTime;
      if (isSteady != steady || traction.point) continue;
      const int exact = Element::edgeExact - (axisymmetric_ ? 1 : 0);
      for (size_t e = 0; e < mesh_.boundaryEdges.size(); ++e) {
        if (mesh_.boundaryLabels[e] != traction.label) continue;
        std::array<int, Element::edgeNodes> nodes;
        std::array<Point, Element::edgeNodes> x;
        for (int a = 0; a < Element::edgeNodes; ++a) {
          nodes[a] = a < 2 ? mesh_.boundaryEdges[e][a] : nodes_.middles[e];
          x[a] = nodes_.places[nodes[a]];
        }
        if (traction.value.degree > (curved(x) ? 1 : exact)) {
          const ResolvedEdge edge = onEdge(traction.value, {x.begin(), x.end()}, t);
          for (const auto& [s, weight, value] : edge.samples) {
            const auto shapes = Element::edgeShapes(s);
            const Point density = weight * depthAt(placeOf(shapes, x)) * value *
                                  directed(traction.component, Element::edgeTangent(s, x));
            for (int a = 0; a < Element::edgeNodes; ++a) f.segment<2>(2 * nodes[a]) += shapes[a] * density;
          }
          continue;
        }
        std::array<double, Element::edgeNodes> sums{};
        for (const auto& [s, toNode] : Element::edgeRule()) {
          const Point at = placeOf(Element::edgeShapes(s), x);
          const double value = depthAt(at) * traction.value(at.x(), at.y(), t);
          for (int a = 0; a < Element::edgeNodes; ++a) sums[a] += toNode[a] * value;
          if (Element::straight && s != Element::edgeRule().back().at) continue;
          const Point direction = directed(traction.component, Element::edgeTangent(s, x));
          for (int a = 0; a < Element::edgeNodes; ++a)
            f.segment<2>(2 * nodes[a]) += sums[a] / Element::edgeDivisor * direction;
          sums.fill(0);
        }
      }
    }
  });
}

void Body::addForces(double t, Vector& f, bool steady) const {
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    for (const auto& force : conditions_.forces) {
      const bool isSteady = force.value.degree > 1 && !force.value.inTime;
      if (isSteady != steady) continue;
      const bool exact = force.value.degree <= std::max(1, Element::loadExact - (axisymmetric_ ? 1 : 0));
      for (size_t tri = 0; tri < mesh_.triangles.size(); ++tri) {
        const std::vector<Point> places = placesIn<Element>(nodes_, tri);
        std::array<Point, Element::nodes> x;
        std::copy(places.begin(), places.end(), x.begin());
        const auto add = [&](const Barycentric& at, const auto& toNode, auto density) {
          const double value = density(placeOf(Element::shapes(at), x), Element::areaAt(at, x));
          for (int a = 0; a < Element::nodes; ++a)
            f[2 * nodes_.of(tri)[a] + force.component] += toNode[a] * value;
        };
        if (exact) {
          for (const auto& point : Element::loadRule())
            add(point.at, point.toNode, [&](const Point& place, double area) {
              return depthAt(place) * area / Element::loadDivisor * force.value(place.x(), place.y(), t);
            });
        } else {
          for (const auto& sample : onTriangle(force.value, places, t).samples)
            add(sample.at, Element::shapes(sample.at), [&](const Point& place, double area) {
              return depthAt(place) * area * sample.weight * sample.value;
            });
        }
      }
    }
  });
}

Vector Body::atPoints(const Datum& datum, double t) const {
  Vector values(points());
  if (space_ || datum.degree <= 1) {
    for (int i = 0; i < points(); ++i) values[i] = datum(placeOfPoint(i), t);
    return values;
  }
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    for (size_t tri = 0; tri < mesh_.triangles.size(); ++tri) {
      const ResolvedTriangle triangle = onTriangle(datum, placesIn<Element>(nodes_, tri), t);
      const std::vector<double> projected =
          projection(triangle, degree() - 1, {Element::interior.begin(), Element::interior.end()});
      for (int i = 0; i < Element::points; ++i)
        values[static_cast<Eigen::Index>(Element::points * tri + i)] = projected[i];
    }
  });
  return values;
}

Matrix Body::thermalStrain(double t) const {
  Matrix strain = Matrix::Zero(material_->components(), points());  // what a law remembers has none
  Vector kelvin(points());
  for (int i = 0; i < points(); ++i) kelvin[i] = conditions_.temperature(placeOfPoint(i), t);
  strain.topRows(conditions_.expansion.rows()) = conditions_.expansion * kelvin.asDiagonal();
  // Averaged as the strain of the displacements is: otherwise their difference would be a stress.
  if (patches_ && space_) {
    strain.row(5) = patches_->averaged(strain.row(5), weights_);
  } else if (patches_) {
    Vector theta = std::numbers::sqrt2 * strain.row(0);
    if (conditions_.expansion.rows() > 3) theta += strain.row(3).transpose();
    strain.row(0) += (patches_->averaged(theta, weights_) - theta).transpose() / std::numbers::sqrt2;
  }
  return strain;
}

Matrix Body::initialStress() const {
  // By component, those beyond the plane as far as they are given.
  Matrix given = Matrix::Zero(std::max(material_->components(), 4), points());
  std::vector<char> beyond(points(), 0);
  const std::vector<int>& regions = Body::regions();
  for (const auto& [component, region, value] : conditions_.initialStresses) {
    const Vector values = atPoints(value, 0);
    for (int i = 0; i < points(); ++i) {
      if (region && regions[i / pointsOfTriangle()] != *region) continue;
      given(component, i) = values[i];
      if (component == 3) beyond[i] = 1;
    }
  }
  Matrix stress = Matrix::Zero(material_->components(), points());
  if (space_) {
    if (!hasInitialStress()) return stress;
    for (int i = 0; i < points(); ++i)
      stress.col(i).head<6>() = fromSpaceCartesian(SpaceStress(given.col(i)(std::array{0, 1, 3, 2, 4, 5})));
    return stress;
  }
  const int tensor = material_->tensorComponents();
  for (int i = 0; i < points(); ++i) {
    const Eigen::Vector3d pqr = fromCartesian(given.col(i).head<3>());
    stress.col(i).head<3>() = pqr;
    if (tensor > 3)
      stress(3, i) = beyond[i] != 0 || axisymmetric_ ? given(3, i) : material_->outOfPlane(pqr, i);
  }
  return stress;
}

}  // namespace mortier
