// The note's compression test with everything that a case may change: cells, laws, coupling, geometry, units.
#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "theory/scenes.h"

namespace mortier::hardcases {

/// Width and height in cells.
struct Cells {
  int x = 1;
  int y = 1;
};

/// The note's compression test with everything a case may change.
struct Compression {
  Cells upperCells{6, 6};
  Cells lowerCells{16, 16};
  Elasticity upper = scenes::noteElasticity;
  Elasticity lower = scenes::noteElasticity;
  Viscoplasticity upperLaw = scenes::noteLaw(Projection::elasticity);  ///< viscosity 0: elastic
  Viscoplasticity lowerLaw = scenes::noteLaw(Projection::elasticity);
  Plane plane = Plane::stress;
  CouplingKind coupling = CouplingKind::mortar;
  int nonmortar = scenes::upperBody;
  double lowerShift = 0;      ///< of the lower block to the right [m]
  double nodeShift = 0;       ///< of the inner nodes of the lower block to the right [m]
  double firstRowHeight = 1;  ///< of the cells along the contact, over that of the others before
  double length = 1;          ///< units: of length, stress and time over m, Pa, s
  double stress = 1;
  double time = 1;

  [[nodiscard]] Model model() const {
    using namespace scenes;
    const double a = length;
    const double b = stress;
    const double c = time;
    const Function load = [b, c](double, double, double t) { return -10 * b * (t / c); };
    TriangleMesh above = crissCrossMesh({{0, 0}, {a, a}, upperCells.x, upperCells.y});
    TriangleMesh below =
        crissCrossMesh({{lowerShift * a, -a}, {(1 + lowerShift) * a, 0}, lowerCells.x, lowerCells.y});
    flatten(above, a / upperCells.y);
    flatten(below, a / lowerCells.y);
    for (Point& x : below.vertices)
      if (x.x() != lowerShift * a && x.x() != (1 + lowerShift) * a) x.x() += nodeShift * a;
    Body upperBlock("upper", std::move(above), material(upper, upperLaw),
                    {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
    Body lowerBlock("lower", std::move(below), material(lower, lowerLaw),
                    {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    return contactModel(std::move(upperBlock), std::move(lowerBlock), coupling, nonmortar);
  }

 private:
  [[nodiscard]] std::shared_ptr<const Material> material(const Elasticity& elasticity,
                                                         const Viscoplasticity& law) const {
    const Elasticity scaled{elasticity.young * stress, elasticity.poisson};
    if (law.viscosity == 0) return elasticMaterial(scaled, plane);
    return perzynaMaterial(scaled, {law.viscosity * stress * time, law.yieldStress * stress, law.projection},
                           plane);
  }

  /// Makes the row of cells of height h at y = 0 flat and the others taller.
  void flatten(TriangleMesh& mesh, double h) const {
    if (firstRowHeight == 1) return;
    const double flat = firstRowHeight * h;
    for (Point& x : mesh.vertices) {
      const double y = std::abs(x.y());
      const double moved =
          y <= h ? firstRowHeight * y : length - (length - y) * (length - flat) / (length - h);
      x.y() = std::copysign(moved, x.y());
    }
    validate(mesh);
  }
};

using scenes::couplings;
using scenes::nameOf;

inline const char* nameOf(Projection projection) {
  return projection == Projection::elasticity ? "elasticity" : "frobenius";
}

constexpr Projection projections[] = {Projection::elasticity, Projection::frobenius};

}  // namespace mortier::hardcases
