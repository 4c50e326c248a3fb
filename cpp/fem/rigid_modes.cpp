#include "fem/rigid_modes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>

#include "base/dense_templates.h"
#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/formatted.h"
#include "fem/element_data.h"
#include "mesh/element_sides.h"

namespace mortier {
namespace {

Matrix columnsOf(const std::vector<Vector>& vectors, Eigen::Index rows) {
  Matrix columns(rows, static_cast<Eigen::Index>(vectors.size()));
  for (size_t i = 0; i < vectors.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = vectors[i];
  return columns;
}

/// A motion that moves supports and opens hinges by less than this part of itself is free.
constexpr double heldFraction = 1e-12;

/// Translations and rotations about the centre, entries of order one on the vertices.
template <int dim>
struct Frame {
  static constexpr int count = dim == 2 ? 3 : 6;  ///< of motions
  using Place = Eigen::Vector<double, dim>;
  using Motions = Eigen::Matrix<double, dim, count>;
  Place centre = Place::Zero();
  double radius = 1;

  Frame(const std::vector<Place>& places, const std::vector<int>& vertices) {
    Eigen::AlignedBox<double, dim> box;
    for (const int v : vertices) {
      centre += places[v];
      box.extend(places[v]);
    }
    centre /= static_cast<double>(vertices.size());
    radius = box.sizes().maxCoeff() / 2;
  }
  [[nodiscard]] Motions motionsAt(const Place& vertex) const {
    const Place x = (vertex - centre) / radius;
    Motions motions;
    if constexpr (dim == 2)
      motions << 1, 0, -x.y(), 0, 1, x.x();
    else
      motions << 1, 0, 0, 0, x.z(), -x.y(),  //
          0, 1, 0, -x.z(), 0, x.x(),         //
          0, 0, 1, x.y(), -x.x(), 0;
    return motions;
  }
};

/// Of elements, those of what is rigid in itself.
EdgeComponents componentsOf(const TriangleMesh& mesh, const ElementNodes& /*nodes*/) {
  return edgeComponents(mesh);
}

/// Parts that share no vertex.
EdgeComponents componentsOf(const TetrahedronMesh& mesh, const SpaceNodes& nodes) {
  DisjointSets sets(nodes.count());
  for (const auto& vertices : mesh.tetrahedra)
    for (const int v : vertices) sets.join(vertices[0], v);
  EdgeComponents components;
  std::map<int, int> numbers;
  for (const auto& vertices : mesh.tetrahedra)
    components.of.push_back(numbers.try_emplace(sets.of(vertices[0]), numbers.size()).first->second);
  components.count = static_cast<int>(numbers.size());
  return components;
}

/// The components of a mesh that are rigid in themselves.
template <class Mesh, class Nodes>
struct RigidComponents {
  static constexpr int dim = dimensionOf<Nodes>;
  static constexpr int count = Frame<dim>::count;

  RigidComponents(const Mesh& mesh, const Nodes& nodes) : places(nodes.places), home(nodes.count(), -1) {
    const EdgeComponents components = componentsOf(mesh, nodes);
    vertices.resize(components.count);
    DisjointSets joined(vertices.size());
    std::set<std::pair<int, int>> hinges;
    for (size_t t = 0; t < components.of.size(); ++t)
      for (int a = 0; a < nodes.perElement(); ++a) {
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
    for (const std::vector<int>& each : vertices) frames.emplace_back(places, each);
    std::map<int, std::vector<int>> sets;
    for (int c = 0; c < static_cast<int>(vertices.size()); ++c) sets[joined.of(c)].push_back(c);
    for (auto& [first, group] : sets) groups.push_back(std::move(group));
  }
  [[nodiscard]] typename Frame<dim>::Motions motionsAt(int component, int node) const {
    return frames[component].motionsAt(places[node]);
  }

  /// The free motions of a group: as many numbers a component in each column as it has motions.
  [[nodiscard]] Matrix freeMotions(const Body& body, const std::vector<int>& group,
                                   const std::vector<const NodeSupport*>& supportAt) const {
    const auto size = static_cast<Eigen::Index>(count * group.size());
    std::map<int, Eigen::Index> place;
    for (const int component : group)
      place.emplace(component, count * static_cast<Eigen::Index>(place.size()));
    Matrix held = Matrix::Zero(size, size);
    for (const int component : group) {
      const Eigen::Index at = place[component];
      Eigen::Matrix<double, count, count> ofSupports = Eigen::Matrix<double, count, count>::Zero();
      int prescribed = 0;
      for (const int v : vertices[component]) {
        const auto motions = motionsAt(component, v);
        if (home[v] != component) {
          Matrix opening = Matrix::Zero(dim, size);
          opening.middleCols<count>(at) = motions;
          opening.middleCols<count>(place[home[v]]) = -motionsAt(home[v], v);
          held += opening.transpose() * opening;
        } else if (const NodeSupport* support = supportAt[v]; support != nullptr) {
          for (int k = 0; k < support->count; ++k, ++prescribed) {
            const Eigen::RowVector<double, count> along =
                support->directions[k].template head<dim>().transpose() * motions;
            ofSupports += along.transpose() * along;
          }
        }
      }
      if (prescribed > 0) held.block<count, count>(at, at) += ofSupports / prescribed;
      // A ring strains under all but the motion along its axis.
      if (body.axisymmetric()) held.diagonal().segment<3>(at) += Eigen::Vector3d(1, 0, 1);
    }
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(held);
    return eigen.eigenvectors().leftCols((eigen.eigenvalues().array() <= heldFraction).count());
  }

  /// The rigid motion nearest to that of a component.
  [[nodiscard]] Vector motionOf(int component, const Vector& motion) const {
    Matrix normal = Matrix::Zero(count, count);
    Vector right = Vector::Zero(count);
    for (const int v : vertices[component]) {
      const auto motions = motionsAt(component, v);
      normal += motions.transpose() * motions;
      right += motions.transpose() * motion.segment<dim>(Eigen::Index{dim} * v);
    }
    return normal.partialPivLu().solve(right);
  }

  const std::vector<typename Frame<dim>::Place>& places;
  std::vector<int> home;                   ///< of each node, its first component; in the others it is a hinge
  std::vector<std::vector<int>> vertices;  ///< nodes of each component
  std::vector<Frame<dim>> frames;
  std::vector<std::vector<int>> groups;  ///< components that hang together at hinges
};

double shown(double value) {
  return std::abs(value) < 1e-9 ? 0.0 : value;
}

/// Of a motion of unit size.
std::string wordsOf(const Frame<2>& frame, const Vector& a) {
  const Point direction = Point(a[0], a[1]).normalized();
  if (shown(a[2]) == 0)
    return "translation along " + placeText(Point(shown(direction.x()), shown(direction.y())));
  return "rotation about " + placeText(frame.centre + frame.radius / a[2] * Point(-shown(a[1]), shown(a[0])));
}

std::string wordsOf(const Frame<3>& frame, const Vector& a) {
  const auto text = [](const SpacePoint& x) { return placeText(x.unaryExpr(&shown), 3); };
  const auto axis = [&](const SpacePoint& direction) {
    for (int c = 0; c < 3; ++c)
      if (shown(1 - std::abs(direction[c])) == 0) return std::string(1, "xyz"[c]);
    return text(direction);
  };
  const SpacePoint translation = a.head<3>();
  const SpacePoint rotation = a.tail<3>() / frame.radius;
  if (shown(a.tail<3>().norm()) == 0) return "translation along " + axis(translation.normalized());
  // The axis is where the motion is along the rotation.
  const SpacePoint at = frame.centre + rotation.cross(translation) / rotation.squaredNorm();
  return "rotation about the line through " + text(at) + " along " + axis(rotation.normalized());
}

}  // namespace

Matrix rigidModes(const Body& body) {
  if (body.rigid()) return body.freeMotions();
  constexpr size_t most = 300;  // they are dense
  std::vector<const NodeSupport*> supportAt(body.nodes(), nullptr);
  for (const NodeSupport& support : body.supports().nodes()) supportAt[support.node] = &support;
  std::vector<Vector> free;
  body.withMesh([&](const auto& mesh, const auto& nodes) {
    const RigidComponents components(mesh, nodes);
    constexpr int dim = decltype(components)::dim;
    constexpr int count = decltype(components)::count;
    for (const std::vector<int>& group : components.groups) {
      if (group.size() > most)
        throw InputError("mesh " + mesh.name + ": " + std::to_string(group.size()) +
                         " parts hang together at single vertices, expected at most " + std::to_string(most));
      const Matrix motions = components.freeMotions(body, group, supportAt);
      for (Eigen::Index i = 0; i < motions.cols(); ++i) {
        Vector mode(Vector::Zero(body.dofs()));
        for (size_t k = 0; k < group.size(); ++k)
          for (const int v : components.vertices[group[k]])
            mode.segment<dim>(Eigen::Index{dim} * v) =
                components.motionsAt(group[k], v) *
                motions.col(i).segment<count>(count * static_cast<Eigen::Index>(k));
        free.push_back(body.spread(body.gather(mode)));  // along prescribed motions there is rounding
      }
      if (free.size() > most)
        throw UnheldBodyError("body " + body.name() + ": nothing holds its " +
                              describeRigidMotion(body, free.front()) + ", and hundreds of other parts");
    }
  });
  return columnsOf(free, body.dofs());
}

std::string describeRigidMotion(const Body& body, const Vector& motion) {
  constexpr double negligible = 1e-6;
  return body.withMesh([&](const auto& mesh, const auto& nodes) {
    const RigidComponents components(mesh, nodes);
    constexpr int dim = decltype(components)::dim;
    const auto motionAt = [&](int v) { return motion.segment<dim>(Eigen::Index{dim} * v); };
    // What moves most is named, and where it is unless the whole body moves with it.
    int mover = 0;
    double largest = 0;
    for (size_t c = 0; c < components.vertices.size(); ++c)
      for (const int v : components.vertices[c])
        if (const double size = motionAt(v).norm(); size > largest) {
          largest = size;
          mover = static_cast<int>(c);
        }
    const Vector fitted = components.motionOf(mover, motion);
    bool whole = true;
    for (int v = 0; v < body.nodes(); ++v)
      whole = whole && (motionAt(v) - components.motionsAt(mover, v) * fitted).norm() <= negligible * largest;
    const std::string text = wordsOf(components.frames[mover], fitted.normalized());
    if (components.vertices.size() == 1 || whole) return text;
    return text + ", of its part around " + placeText(asSpacePoint(components.frames[mover].centre), dim);
  });
}

}  // namespace mortier
