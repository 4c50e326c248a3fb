#include "fem/rigid_modes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>

#include "base/dense_templates.h"
#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/formatted.h"
#include "mesh/triangle_sides.h"

namespace mortier {
namespace {

Matrix columnsOf(const std::vector<Vector>& vectors, Eigen::Index rows) {
  Matrix columns(rows, static_cast<Eigen::Index>(vectors.size()));
  for (size_t i = 0; i < vectors.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = vectors[i];
  return columns;
}

/// A motion that moves supports and opens hinges by less than this part of itself is free.
constexpr double heldFraction = 1e-12;

/// Translations along x and y and the rotation about the centre, entries of order one on the vertices.
struct Frame {
  Point centre{0, 0};
  double radius = 1;
  [[nodiscard]] Eigen::Matrix<double, 2, 3> motionsAt(const Point& vertex) const {
    const Point x = (vertex - centre) / radius;
    Eigen::Matrix<double, 2, 3> motions;
    motions << 1, 0, -x.y(), 0, 1, x.x();
    return motions;
  }
};

Frame frameOf(const std::vector<Point>& places, const std::vector<int>& vertices) {
  Eigen::AlignedBox2d box;
  Point sum = Point::Zero();
  for (const int v : vertices) {
    sum += places[v];
    box.extend(places[v]);
  }
  return {sum / static_cast<double>(vertices.size()), box.sizes().maxCoeff() / 2};
}

/// The components of a mesh that are rigid in themselves (mesh/triangle_sides.h).
struct RigidComponents {
  explicit RigidComponents(const Body& body) : home(body.nodes(), -1) {
    const ElementNodes& nodes = body.elementNodes();
    const EdgeComponents components = edgeComponents(body.mesh());
    vertices.resize(components.count);
    DisjointSets joined(vertices.size());
    std::set<std::pair<int, int>> hinges;
    for (size_t t = 0; t < components.of.size(); ++t)
      for (int a = 0; a < nodes.perTriangle(); ++a) {
        const int v = nodes.of(t)[a];
        const int component = components.of[t];
        if (home[v] == component) continue;
        if (home[v] < 0)
          home[v] = component;
        else if (!hinges.insert({v, component}).second)
          continue;
        joined.join(home[v], component);
        vertices[component].push_back(v);
      }
    for (const std::vector<int>& each : vertices) frames.push_back(frameOf(nodes.places, each));
    std::map<int, std::vector<int>> sets;
    for (int c = 0; c < static_cast<int>(vertices.size()); ++c) sets[joined.of(c)].push_back(c);
    for (auto& [first, group] : sets) groups.push_back(std::move(group));
  }

  std::vector<int> home;                   ///< of each node, its first component; in the others it is a hinge
  std::vector<std::vector<int>> vertices;  ///< nodes of each component
  std::vector<Frame> frames;
  std::vector<std::vector<int>> groups;  ///< components that hang together at hinges
};

/// The free motions of a group: three numbers a component in each column.
Matrix freeMotions(const Body& body, const RigidComponents& components, const std::vector<int>& group,
                   const std::vector<const NodeSupport*>& supportAt) {
  const auto& points = body.elementNodes().places;
  const auto size = static_cast<Eigen::Index>(3 * group.size());
  std::map<int, Eigen::Index> place;
  for (const int component : group) place.emplace(component, 3 * static_cast<Eigen::Index>(place.size()));
  Matrix held = Matrix::Zero(size, size);
  for (const int component : group) {
    const Eigen::Index at = place[component];
    Eigen::Matrix3d ofSupports = Eigen::Matrix3d::Zero();
    int prescribed = 0;
    for (const int v : components.vertices[component]) {
      const auto motions = components.frames[component].motionsAt(points[v]);
      if (const int home = components.home[v]; home != component) {
        Matrix opening = Matrix::Zero(2, size);
        opening.middleCols<3>(at) = motions;
        opening.middleCols<3>(place[home]) = -components.frames[home].motionsAt(points[v]);
        held += opening.transpose() * opening;
      } else if (const NodeSupport* support = supportAt[v]; support != nullptr) {
        for (int k = 0; k < support->count; ++k, ++prescribed) {
          const Eigen::RowVector3d along = support->directions[k].head<2>().transpose() * motions;
          ofSupports += along.transpose() * along;
        }
      }
    }
    if (prescribed > 0) held.block<3, 3>(at, at) += ofSupports / prescribed;
    // A ring strains under all but the motion along its axis.
    if (body.axisymmetric()) held.diagonal().segment<3>(at) += Eigen::Vector3d(1, 0, 1);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(held);
  return eigen.eigenvectors().leftCols((eigen.eigenvalues().array() <= heldFraction).count());
}

/// The rigid motion nearest to that of a component.
Eigen::Vector3d motionOf(const Body& body, const RigidComponents& components, int component,
                         const Vector& motion) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const int v : components.vertices[component]) {
    const auto motions = components.frames[component].motionsAt(body.elementNodes().places[v]);
    normal += motions.transpose() * motions;
    right += motions.transpose() * motion.segment<2>(2 * v);
  }
  return normal.inverse() * right;
}

}  // namespace

Matrix rigidModes(const Body& body) {
  if (body.rigid()) return body.freeMotions();
  if (body.space() != nullptr) return spaceRigidModes(body);
  constexpr size_t most = 300;  // they are dense
  const RigidComponents components(body);
  std::vector<const NodeSupport*> supportAt(body.nodes(), nullptr);
  for (const NodeSupport& support : body.supports().nodes()) supportAt[support.node] = &support;
  std::vector<Vector> free;
  for (const std::vector<int>& group : components.groups) {
    if (group.size() > most)
      throw InputError("mesh " + body.mesh().name + ": " + std::to_string(group.size()) +
                       " parts hang together at single vertices, expected at most " + std::to_string(most));
    const Matrix motions = freeMotions(body, components, group, supportAt);
    for (Eigen::Index i = 0; i < motions.cols(); ++i) {
      Vector mode(Vector::Zero(body.dofs()));
      for (size_t k = 0; k < group.size(); ++k)
        for (const int v : components.vertices[group[k]])
          mode.segment<2>(2 * v) = components.frames[group[k]].motionsAt(body.elementNodes().places[v]) *
                                   motions.col(i).segment<3>(3 * static_cast<Eigen::Index>(k));
      free.push_back(body.spread(body.gather(mode)));  // along prescribed motions there is rounding
    }
    if (free.size() > most)
      throw UnheldBodyError("body " + body.name() + ": nothing holds its " +
                            describeRigidMotion(body, free.front()) + ", and hundreds of other parts");
  }
  return columnsOf(free, body.dofs());
}

std::string describeRigidMotion(const Body& body, const Vector& motion) {
  constexpr double negligible = 1e-6;
  if (body.space() != nullptr) return describeSpaceMotion(body, motion);
  const RigidComponents components(body);
  // What moves most is named, and where it is unless the whole body moves with it.
  int mover = 0;
  double largest = 0;
  for (size_t c = 0; c < components.vertices.size(); ++c)
    for (const int v : components.vertices[c])
      if (const double size = motion.segment<2>(2 * v).norm(); size > largest) {
        largest = size;
        mover = static_cast<int>(c);
      }
  const Frame& frame = components.frames[mover];
  const Eigen::Vector3d fitted = motionOf(body, components, mover, motion);
  bool whole = true;
  for (int v = 0; v < body.nodes(); ++v)
    whole = whole &&
            (motion.segment<2>(2 * v) - frame.motionsAt(body.elementNodes().places[v]) * fitted).norm() <=
                negligible * largest;
  const Eigen::Vector3d a = fitted.normalized();
  const auto shown = [](double value) { return std::abs(value) < 1e-9 ? 0.0 : value; };
  const Point direction = Point(a[0], a[1]).normalized();
  const std::string text =
      shown(a[2]) == 0 ? "translation along " + placeText(Point(shown(direction.x()), shown(direction.y())))
                       : "rotation about " +
                             placeText(frame.centre + frame.radius / a[2] * Point(-shown(a[1]), shown(a[0])));
  if (components.vertices.size() == 1 || whole) return text;
  return text + ", of its part around " + placeText(frame.centre);
}

namespace {

/// A motion that moves supports by less than this part of itself is free.
constexpr double freeFraction = 1e-12;

using Motions = Eigen::Matrix<double, 3, 6>;

/// Nodes that hang together, with their centre and size.
struct SpacePart {
  std::vector<int> nodes;
  SpacePoint centre = SpacePoint::Zero();
  double radius = 1;

  [[nodiscard]] Motions motionsAt(const SpacePoint& place) const {
    const SpacePoint x = (place - centre) / radius;
    Motions motions;
    motions << 1, 0, 0, 0, x.z(), -x.y(),  //
        0, 1, 0, -x.z(), 0, x.x(),         //
        0, 0, 1, x.y(), -x.x(), 0;
    return motions;
  }
};

/// Parts that share no vertex.
std::vector<SpacePart> partsOf(const SpaceElements& space) {
  const SpaceNodes& nodes = space.nodes();
  DisjointSets sets(nodes.count());
  for (size_t e = 0; e < space.mesh().tetrahedra.size(); ++e)
    for (int a = 1; a < nodes.perElement(); ++a) sets.join(nodes.of(e)[0], nodes.of(e)[a]);
  std::vector<int> numbers(nodes.count(), -1);
  std::vector<SpacePart> parts;
  for (int node = 0; node < nodes.count(); ++node) {
    int& number = numbers[sets.of(node)];
    if (number < 0) {
      number = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    parts[number].nodes.push_back(node);
  }
  for (SpacePart& part : parts) {
    Eigen::AlignedBox3d box;
    for (const int node : part.nodes) {
      box.extend(nodes.places[node]);
      part.centre += nodes.places[node] / static_cast<double>(part.nodes.size());
    }
    part.radius = box.sizes().maxCoeff() / 2;
  }
  return parts;
}

}  // namespace

Matrix spaceRigidModes(const Body& body) {
  const SpaceElements& space = *body.space();
  std::vector<const NodeSupport*> supportAt(body.nodes(), nullptr);
  for (const NodeSupport& support : body.supports().nodes()) supportAt[support.node] = &support;
  std::vector<Vector> free;
  for (const SpacePart& part : partsOf(space)) {
    Eigen::Matrix<double, 6, 6> held = Eigen::Matrix<double, 6, 6>::Zero();
    int prescribed = 0;
    for (const int node : part.nodes)
      if (const NodeSupport* support = supportAt[node]; support != nullptr)
        for (int k = 0; k < support->count; ++k, ++prescribed) {
          const Eigen::Matrix<double, 1, 6> along =
              support->directions[k].transpose() * part.motionsAt(space.nodes().places[node]);
          held += along.transpose() * along;
        }
    if (prescribed > 0) held /= prescribed;
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen{Matrix(held)};
    for (int i = 0; i < 6 && eigen.eigenvalues()[i] <= freeFraction; ++i) {
      Vector mode(Vector::Zero(body.dofs()));
      for (const int node : part.nodes)
        mode.segment<3>(3 * static_cast<Eigen::Index>(node)) =
            part.motionsAt(space.nodes().places[node]) * eigen.eigenvectors().col(i);
      free.push_back(body.spread(body.gather(mode)));  // what is along prescribed motions is rounding
    }
  }
  return columnsOf(free, body.dofs());
}

std::string describeSpaceMotion(const Body& body, const Vector& motion) {
  constexpr double nothing = 1e-9;
  const std::vector<SpacePart> parts = partsOf(*body.space());
  const std::vector<SpacePoint>& places = body.space()->nodes().places;
  // The part that moves most.
  const SpacePart* mover = &parts.front();
  double largest = 0;
  for (const SpacePart& part : parts)
    for (const int node : part.nodes)
      if (const double size = motion.segment<3>(3 * static_cast<Eigen::Index>(node)).norm(); size > largest) {
        largest = size;
        mover = &part;
      }
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  for (const int node : mover->nodes) {
    const Motions motions = mover->motionsAt(places[node]);
    normal += motions.transpose() * motions;
    right += motions.transpose() * motion.segment<3>(3 * static_cast<Eigen::Index>(node));
  }
  const Vector fitted = Matrix(normal).partialPivLu().solve(Vector(right)).normalized();
  const auto shown = [](const SpacePoint& x) {
    return placeText(x.unaryExpr([](double value) { return std::abs(value) < nothing ? 0.0 : value; }), 3);
  };
  const auto axis = [&](const SpacePoint& direction) {
    for (int c = 0; c < 3; ++c)
      if (std::abs(direction[c]) > 1 - nothing) return std::string(1, "xyz"[c]);
    return shown(direction);
  };
  const SpacePoint translation = fitted.head<3>();
  const SpacePoint rotation = fitted.tail<3>() / mover->radius;
  if (fitted.tail<3>().norm() < nothing) return "translation along " + axis(translation.normalized());
  // The axis is where the motion is along the rotation.
  const SpacePoint at = mover->centre + rotation.cross(translation) / rotation.squaredNorm();
  return "rotation about the line through " + shown(at) + " along " + axis(rotation.normalized());
}

}  // namespace mortier
