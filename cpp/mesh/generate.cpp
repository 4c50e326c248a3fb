#include "mesh/generate.h"

#include <cmath>
#include <numbers>
#include <sstream>

#include "base/error.h"

namespace mortier {
namespace {

std::string text(const Point& p) {
  std::ostringstream out;
  out << '(' << p.x() << ", " << p.y() << ')';
  return out.str();
}

std::string describe(const std::string& kind, const Rectangle& r) {
  std::ostringstream out;
  out << kind << ' ' << r.cellsX << 'x' << r.cellsY << " of " << text(r.lower) << " to " << text(r.upper);
  return out.str();
}

TriangleMesh rectangle(const Rectangle& r, Cut cut, const std::string& name) {
  checkCells(name, r.cellsX, r.cellsY, cut);
  const bool finite = r.lower.allFinite() && r.upper.allFinite();
  if (!finite || !(r.lower.x() < r.upper.x()) || !(r.lower.y() < r.upper.y()))
    throw InputError(name + ": corners, expected finite numbers with lower < upper in x and y");
  const Point focus = r.focus.value_or(r.lower);
  if (!((focus - r.lower).minCoeff() >= 0 && (r.upper - focus).minCoeff() >= 0))
    throw InputError(name + ": focus " + text(focus) + ", expected a point of the rectangle");
  if (!(r.grading.minCoeff() >= 1 && r.grading.maxCoeff() <= 1e6))
    throw InputError(name + ": grading " + text(r.grading) + ", expected 1 to 1e6 each way");
  for (const int c : {0, 1})
    if (r.grading[c] != 1 && focus[c] > r.lower[c] && focus[c] < r.upper[c] &&
        (c == 0 ? r.cellsX : r.cellsY) < 2)
      throw InputError(name + ": one cell with a focus inside, expected 2 or more");
  const std::vector<double> x = gradedNodes(r.lower.x(), r.upper.x(), r.cellsX, focus.x(), r.grading.x());
  const std::vector<double> y = gradedNodes(r.lower.y(), r.upper.y(), r.cellsY, focus.y(), r.grading.y());
  return gridMesh({r.cellsX, r.cellsY, [&](int i, int j) { return Point(x[i], y[j]); }}, cut, name);
}

}  // namespace

TriangleMesh rectangleMesh(const Rectangle& r, Cut cut) {
  return rectangle(r, cut, describe("rectangle", r));
}

TriangleMesh crissCrossMesh(const Rectangle& r) {
  return rectangle(r, Cut::both, describe("criss-cross", r));
}

TriangleMesh quadrilateralMesh(const Quadrilateral& q, Cut cut) {
  std::string name = "quadrilateral";
  for (const Point& corner : q.corners) name += ' ' + text(corner);
  for (int k = 0; k < 4; ++k) {
    const Point along = q.corners[(k + 1) % 4] - q.corners[k];
    const Point next = q.corners[(k + 2) % 4] - q.corners[(k + 1) % 4];
    if (!(cross(along, next) > 0))
      throw InputError(name + ": corner " + std::to_string((k + 1) % 4 + 1) +
                       ", expected finite corners of a convex quadrilateral, counterclockwise");
  }
  const auto at = [&](int i, int j) -> Point {
    const double s = static_cast<double>(i) / q.cells1;
    const double t = static_cast<double>(j) / q.cells2;
    const auto& [a, b, c, d] = q.corners;
    return (1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * d + s * c);
  };
  return gridMesh({q.cells1, q.cells2, at}, cut, name);
}

TriangleMesh annulusMesh(const Annulus& a, Cut cut) {
  std::ostringstream name;
  name << "annulus of radii " << a.inner << " and " << a.outer << " about " << text(a.centre);
  if (!(a.inner > 0 && a.outer > a.inner && std::isfinite(a.outer) && a.centre.allFinite()))
    throw InputError(name.str() + ", expected finite numbers with 0 < inner < outer");
  if (a.quarters != 1 && a.quarters != 2 && a.quarters != 4)
    throw InputError(name.str() + ": " + std::to_string(a.quarters) + " quarters, expected 1, 2 or 4");
  if (a.quarters == 4 && a.cellsAround < 3)
    throw InputError(name.str() + ": cell counts, expected 3 or more around");
  const bool closed = a.quarters == 4;
  // From the end of the sector to its beginning and outwards, so that cells are counterclockwise.
  const auto at = [&](int i, int j) -> Point {
    const int k = closed ? (a.cellsAround - i) % a.cellsAround : a.cellsAround - i;
    const double angle = std::numbers::pi / 2 * a.quarters * k / a.cellsAround;
    const double r =
        j == a.cellsAcross ? a.outer : a.inner * std::pow(a.outer / a.inner, double(j) / a.cellsAcross);
    Point direction(std::cos(angle), std::sin(angle));
    // On the axes to the last bit.
    if (static_cast<long long>(k) * a.quarters % a.cellsAround == 0) direction = direction.array().round();
    return a.centre + r * direction;
  };
  return gridMesh({a.cellsAround, a.cellsAcross, at, closed, {1, 3, 2, 4}}, cut, name.str());
}

}  // namespace mortier
