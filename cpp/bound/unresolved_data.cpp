#include "bound/unresolved_data.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/dense_templates.h"
#include "material/stress.h"

namespace mortier {
namespace {

double largestEigenvalue(const Eigen::Matrix3d& compliance) {
  // s : E^-1 s over s : s, s : s = s11^2 + s22^2 + 2 s12^2
  const Eigen::Vector3d root(1, 1, std::numbers::sqrt2 / 2);
  const Matrix scaled = root.asDiagonal() * compliance * root.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

/// Of |grad v| over |eps v| for displacements without mean rotation (Korn), squared: 2/beta^2 with
/// beta >= sin(least angle/4) in a triangle (Costabel and Dauge 2015).
double korn(const std::array<Point, 3>& x) {
  double least = std::numbers::pi;
  for (int i = 0; i < 3; ++i) {
    const Point a = (x[(i + 1) % 3] - x[i]).normalized();
    const Point b = (x[(i + 2) % 3] - x[i]).normalized();
    least = std::min(least, std::atan2(std::abs(cross(a, b)), a.dot(b)));
  }
  const double beta = std::sin(least / 4);
  return 2 / (beta * beta);
}
double diameter(const std::array<Point, 3>& x) {
  return std::max({(x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[0] - x[2]).norm()});
}

}  // namespace

double carriesForce(const std::array<Point, 3>& x, const Eigen::Matrix3d& compliance) {
  return diameter(x) / std::numbers::pi * std::sqrt(korn(x) * largestEigenvalue(compliance));
}
double carriesTraction(SideTriangle triangle, const Eigen::Matrix3d& compliance) {
  const Point middle = (triangle.p + triangle.q) / 2;
  double least = infinity;
  do {
    const double poincare = diameter(triangle.corners()) / std::numbers::pi;
    const double reach = std::max((triangle.p - triangle.c).norm(), (triangle.q - triangle.c).norm());
    least = std::min(least, 2 / triangle.height() * poincare * (poincare + reach) * korn(triangle.corners()));
    triangle.c = (triangle.c + middle) / 2;
  } while (4 * triangle.height() > triangle.length());
  return std::sqrt(least * largestEigenvalue(compliance));
}

double movedEnergy(const MatchedBody& place, int side, const Point& along, const SideDatum& datum) {
  const SideTriangle triangle(place.cut.mesh, place.sides.all()[side]);
  const int t = place.sides.all()[side].triangles[0];
  const Eigen::Matrix3d& E = place.moduli[t];
  const double twiceArea = triangle.length() * triangle.height();
  const auto energy = [&](const Point& g) {
    const Eigen::Vector3d strain = symmetricPart(along, g);
    return strain.dot(E * strain);
  };
  // x = c + rho (p + s (q - p) - c): grad rho = m, grad s = g(s)/rho, g linear in s.
  const Point m = triangle.outward() / triangle.height();
  const auto g = [&](const Point& end) -> Point {
    const Point d = end - triangle.c;
    return Point(-d.y(), d.x()) / twiceArea;
  };
  // The energy of g is convex along the side.
  const double bySlope =
      datum.slopeMoments[0] * energy(g(triangle.p)) + datum.slopeMoments[1] * energy(g(triangle.q));
  const double byValue = datum.off * datum.off * energy(m);
  // w = datum rho^k with the best k; the product of both parts has byValue/2.
  return std::sqrt(twiceArea * (std::sqrt(bySlope * byValue) + byValue / 2));
}

void moveSide(const MatchedBody& place, int side, const Point& along, const SideDatum& datum,
              BodyData& data) {
  const SideTriangle triangle(place.cut.mesh, place.sides.all()[side]);
  const int t = place.sides.all()[side].triangles[0];
  data.strained[t] += movedEnergy(place, side, along, datum);
  constexpr double rounding = 1e-14;
  const double integral =
      triangle.length() * (datum.moments[0] + datum.moments[1] - (datum.ends[0] + datum.ends[1]) / 2);
  data.moved.push_back({place.cut.mesh.boundaryLabels[place.sides.all()[side].boundary], integral * along,
                        triangle.length() * (2 * datum.momentError + rounding * datum.size)});
  // Integral of E eps(w): w vanishes on the other sides.
  data.meanStrained[t] += toCartesian(place.moduli[t] * symmetricPart(along, triangle.outward())) * integral;
}

}  // namespace mortier
