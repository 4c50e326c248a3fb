#include "fem/rigid_modes.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <sstream>

namespace mortier {
namespace {

/// A motion that moves supports by less than this part of itself is free.
constexpr double heldFraction = 1e-12;

Point centre(const TriangleMesh& mesh) {
  Point sum = Point::Zero();
  for (const Point& x : mesh.vertices) sum += x;
  return sum / static_cast<double>(mesh.vertices.size());
}

/// Translations along x and y and the rotation about the centre, rows are dofs, entries of order one.
Matrix allModes(const Body& body) {
  const Point c = centre(body.mesh());
  const double radius = extent(body.mesh()) / 2;
  Matrix modes(body.dofs(), 3);
  for (int v = 0; v < body.nodes(); ++v) {
    const Point x = (body.mesh().vertices[v] - c) / radius;
    modes.row(2 * v) << 1, 0, -x.y();
    modes.row(2 * v + 1) << 0, 1, x.x();
  }
  return modes;
}

}  // namespace

Matrix rigidModes(const Body& body) {
  const Matrix modes = allModes(body);
  Eigen::Matrix3d held = Eigen::Matrix3d::Zero();
  int prescribed = 0;
  for (const NodeSupport& support : body.supports().nodes())
    for (int i = 0; i < support.count; ++i, ++prescribed) {
      const Eigen::RowVector3d along =
          support.directions[i].transpose() * modes.middleRows<2>(2 * support.node);
      held += along.transpose() * along;
    }
  if (prescribed > 0) held /= prescribed;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(held);
  Matrix free(body.dofs(), 0);
  for (int i = 0; i < 3; ++i)
    if (eigen.eigenvalues()[i] <= heldFraction) {
      free.conservativeResize(Eigen::NoChange, free.cols() + 1);
      free.rightCols(1) = modes * eigen.eigenvectors().col(i);
    }
  // What is left along prescribed motions is rounding.
  for (Eigen::Index i = 0; i < free.cols(); ++i) free.col(i) = body.spread(body.gather(free.col(i)));
  return free;
}

std::string describeRigidMotion(const Body& body, const Vector& motion) {
  // Least squares on the three motions gives translation and rotation.
  const Matrix modes = allModes(body);
  const Eigen::Vector3d a = (modes.transpose() * modes).ldlt().solve(modes.transpose() * motion).normalized();
  const auto shown = [](double value) { return std::abs(value) < 1e-9 ? 0.0 : value; };
  std::ostringstream text;
  text.precision(4);
  if (shown(a[2]) == 0) {
    const Point direction = Point(a[0], a[1]).normalized();
    text << "translation along (" << shown(direction.x()) << ", " << shown(direction.y()) << ")";
  } else {
    const double radius = extent(body.mesh()) / 2;
    const Point c = centre(body.mesh());
    text << "rotation about (" << c.x() - shown(a[1]) / a[2] * radius << ", "
         << c.y() + shown(a[0]) / a[2] * radius << ")";
  }
  return text.str();
}

}  // namespace mortier
