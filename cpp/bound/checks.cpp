#include "bound/checks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bound/pressures.h"

namespace mortier {
namespace {

/// What may be left of forces that balance, over the largest: rounding, also of thin triangles.
constexpr double strict = 1e-9;

}  // namespace

Imbalance imbalanceOf(const TriangleMesh& mesh, const Sides& sides, const SideMoments& moments,
                      const std::vector<BodyLoad>& forces, const std::vector<KnownTraction>& known) {
  Imbalance result;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& v = mesh.triangles[t];
    const std::array<Point, 3> x{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
    const Moments m = momentsOf(sides, moments, t);
    Point force(0, 0);
    const Point centre = (x[0] + x[1] + x[2]) / 3;
    double couple = 0;
    double size = 0;
    const CompositeTriangle element(x, Eigen::Matrix3d::Identity());
    const bool loaded = !forces[t].isZero(0);
    const Eigen::Matrix<double, 2, 3> load = element.nodalForces(forces[t]);
    for (int k = 0; k < 3; ++k)
      for (int end = 0; end < 2; ++end) {
        const int corner = (k + end) % 3;
        const Point b = m.segment<2>(4 * k + 2 * end) + load.col(corner) / 2;
        const Point arm = x[corner] - centre;
        force += b;
        couple += cross(arm, b);
        size = std::max(size, arm.norm());
      }
    result.worst = std::max({result.worst, force.norm(), std::abs(couple) / size,
                             element.defect(loaded ? Moments(m - element.momentsOfLoad(forces[t])) : m)});
    result.largest = std::max(result.largest, m.cwiseAbs().maxCoeff());
  }
  for (int e = 0; e < sides.count(); ++e)
    for (int i = 0; sides.all()[e].triangles[1] < 0 && i < known[e].count; ++i)
      for (int end = 0; end < 2; ++end)
        result.worst =
            std::max(result.worst, std::abs(known[e].known[i].dot(moments[e][end] - known[e].moments[end])));
  return result;
}

double mismatchOf(const MatchedPiece& piece, const std::array<double, 2>& pressure,
                  const std::array<Point, 2>& above, const std::array<Point, 2>& below) {
  const auto moments = momentsOfLinear(pressure, piece.length);
  double worst = 0;
  for (int end = 0; end < 2; ++end) {
    const Point pressed = moments[end] * piece.normal;
    worst = std::max({worst, (above[end] + pressed).norm(), (below[end] - pressed).norm()});
  }
  return worst;
}

double leastGapOf(const Model& model, const std::vector<MatchedPiece>& pieces,
                  const std::vector<Vector>& displacements) {
  double least = std::numeric_limits<double>::max();
  double largest = 0;
  for (const MatchedPiece& piece : pieces) {
    const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
    for (int end = 0; end < 2; ++end) {
      const Point above = displacements[nonmortar.body].segment<2>(2 * piece.vertices[0][end]);
      const Point below = displacements[mortar.body].segment<2>(2 * piece.vertices[1][end]);
      least = std::min(least, piece.distance[end] - (above - below).dot(piece.normal));
      largest = std::max({largest, above.norm(), below.norm(), std::abs(piece.distance[end])});
    }
  }
  return largest > 0 ? least / largest : 0;
}

std::string Strictness::broken() const {
  if (!(imbalance <= strict)) return "stresses are not in equilibrium to rounding";
  if (!(mismatch <= strict)) return "tractions on both sides of a contact line are not those of a pressure";
  if (!(leastPressure >= 0)) return "a contact pressure is negative";
  if (!(leastGap >= -strict)) return "the lifted displacement penetrates";
  return "";
}

}  // namespace mortier
