#include "time/mean_pressure.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/quadrature_rules.h"
#include "mesh/boundary_line.h"
#include "mesh/triangle_mesh.h"
#include "time/nodal_forces.h"

namespace mortier {
namespace {

/// Nodes of a line in their order, those in the middle of its elements included.
std::vector<std::pair<int, Point>> nodesAlong(const BoundaryLine& line) {
  std::vector<std::pair<int, Point>> nodes;
  for (size_t i = 0; i < line.nodes.size(); ++i) {
    nodes.emplace_back(line.nodes[i], line.points[i]);
    if (i < line.middleNodes.size()) nodes.emplace_back(line.middleNodes[i], line.middlePoints[i]);
  }
  return nodes;
}

/// How much longer curved sides are than the polygon of their ends, or larger as they turn about the axis.
double stretchOfCurves(const BoundaryLine& line, bool ring) {
  double curved = 0;
  double polygon = 0;
  for (size_t i = 0; i < line.middlePoints.size(); ++i) {
    const Point& a = line.points[i];
    const Point& m = line.middlePoints[i];
    const Point& b = line.points[i + 1];
    for (const auto& [at, weight] : gaussThree) {
      const double s = 2 * at - 1;
      const Point x = s * (s - 1) / 2 * a + (1 - s * s) * m + s * (s + 1) / 2 * b;
      curved += 2 * weight * ((s - 0.5) * a - 2 * s * m + (s + 0.5) * b).norm() * (ring ? x.x() : 1);
    }
    polygon += (b - a).norm() * (ring ? (a.x() + b.x()) / 2 : 1);
  }
  return polygon > 0 ? curved / polygon : 1;
}

/// The row of a node along a normal; a corner has two. -1 where it has none.
int rowOf(const ContactInterface& interface, int node, const Point& normal) {
  int row = -1;
  double best = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < interface.rows(); ++i)
    if (const double along = interface.normals()[i].head<2>().dot(normal);
        interface.nonmortarNodes()[i] == node && along > best) {
      best = along;
      row = i;
    }
  return row;
}

}  // namespace

std::vector<Vector> meanPressureShares(const Model& model, int body, int label, const LinePart& part) {
  std::vector<Vector> shares;
  const Body& sided = model.bodies[body];
  const bool ring = sided.axisymmetric();
  // Forces are those of curved sides, the part is one of the polygon.
  const double size =
      part.size(ring) * stretchOfCurves(boundaryLine(sided.mesh(), sided.elementNodes(), label), ring);
  for (const ContactInterface& interface : model.interfaces) {
    Vector of = Vector::Zero(interface.rows());
    Vector all = of;
    if (isSide(interface.pair(), body, label)) {
      const ContactSide& side = interface.pair().nonmortar;
      const Body& nonmortar = model.bodies[side.body];
      const auto nodes = nodesAlong(boundaryLine(nonmortar.mesh(), nonmortar.elementNodes(), side.label));
      for (size_t i = 0; i + 1 < nodes.size(); ++i) {
        const Point& a = nodes[i].second;
        const Point& b = nodes[i + 1].second;
        const Point normal(b.y() - a.y(), a.x() - b.x());
        const double length = normal.norm() * (ring ? circumference((a + b) / 2) : 1);
        const std::array<double, 2> weighted = part.moments(part.along(a), part.along(b));
        std::array<int, 2> rows{rowOf(interface, nodes[i].first, normal),
                                rowOf(interface, nodes[i + 1].first, normal)};
        // Where one of them has none its row function is the other one's.
        for (int end = 0; end < 2; ++end)
          if (rows[end] < 0) rows[end] = rows[1 - end];
        for (int end = 0; end < 2 && rows[end] >= 0; ++end) {
          of[rows[end]] += length * weighted[end];
          all[rows[end]] += length / 2;
        }
      }
      for (int row = 0; row < interface.rows(); ++row)
        of[row] = all[row] > 0 && size > 0 ? of[row] / all[row] / size : 0;
    }
    shares.push_back(std::move(of));
  }
  return shares;
}

std::vector<Vector> meanPressureShares(const Model& model, int body, int label) {
  const TetrahedronMesh& mesh = model.bodies[body].space()->mesh();
  const std::vector<SpacePoint>& x = mesh.vertices;
  double area = 0;
  for (const auto& [a, b, c] : sidesWith(mesh, label)) area += (x[b] - x[a]).cross(x[c] - x[a]).norm() / 2;
  std::vector<Vector> shares;
  for (const ContactInterface& interface : model.interfaces)
    shares.emplace_back(
        Vector::Constant(interface.rows(), isSide(interface.pair(), body, label) ? 1 / area : 0));
  return shares;
}

}  // namespace mortier
