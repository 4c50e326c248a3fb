// Rigid motions in space: three translations and three rotations of each part of a body that its supports
// leave free.
#include <Eigen/Geometry>
#include <sstream>

#include "base/dense_templates.h"
#include "base/disjoint_sets.h"
#include "base/error.h"
#include "fem/rigid_modes.h"

namespace mortier {
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
  std::vector<const SpaceSupport*> supportAt(body.nodes(), nullptr);
  for (const SpaceSupport& support : space.supports()) supportAt[support.node] = &support;
  std::vector<Vector> free;
  for (const SpacePart& part : partsOf(space)) {
    Eigen::Matrix<double, 6, 6> held = Eigen::Matrix<double, 6, 6>::Zero();
    int prescribed = 0;
    for (const int node : part.nodes)
      if (const SpaceSupport* support = supportAt[node]; support != nullptr)
        for (int k = 0; k < support->count; ++k, ++prescribed) {
          const Eigen::Matrix<double, 1, 6> along =
              support->directions.row(k) * part.motionsAt(space.nodes().places[node]);
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
  Matrix modes(body.dofs(), static_cast<Eigen::Index>(free.size()));
  for (size_t i = 0; i < free.size(); ++i) modes.col(static_cast<Eigen::Index>(i)) = free[i];
  return modes;
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
    std::ostringstream text;
    text.precision(4);
    const auto number = [](double value) { return std::abs(value) < nothing ? 0.0 : value; };
    text << "(" << number(x.x()) << ", " << number(x.y()) << ", " << number(x.z()) << ")";
    return text.str();
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
