// The method on its layers: two elastic blocks, one on the other, on meshes that do not match, pressed by a
// uniform traction. One static step is the problem
//   K u + C' p = F,   g = C u <= 0,   p >= 0,   p.g = 0,
// K the stiffness of both bodies, C the rows of the coupling, p nodal contact forces. The exact stress is
// s22 = -1 everywhere: the L2 projection (mortar) finds it to rounding, interpolation does not. Prints both.
#include <Eigen/Sparse>
#include <cmath>
#include <cstdio>
#include <vector>

#include "contact/interface.h"
#include "fem/body.h"
#include "material/elasticity.h"
#include "mesh/generate.h"

namespace {

using namespace mortier;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr Elasticity elasticity{1000, 0.3};
constexpr int bottom = 1, top = 3, left = 4;  // labels of a rectangle

Function constant(double value) {
  return [value](double, double, double) { return value; };
}

Body block(const char* name, int cells, const Point& lower, Conditions conditions) {
  const Rectangle rectangle{lower, lower + Point(1, 1), cells, cells};
  return {name, rectangleMesh(rectangle, Cut::both), elasticMaterial(elasticity), std::move(conditions)};
}

/// Adds sum |T| B' D B, in the equations of the body from `first` on.
void addStiffness(const Body& body, int first, Triplets& entries) {
  const Eigen::Array3d e = elasticity.moduli();  // of (s11 + s22, s11 - s22, 2 s12)/sqrt2
  const Eigen::Vector<double, 6> lowerTriangle(e[0], 0, 0, e[1], 0, e[2]);
  std::vector<double> values;
  body.tangent(lowerTriangle.replicate(1, body.points()), values);
  const SparsePattern& pattern = body.pattern();
  for (int column = 0; column < pattern.size; ++column)
    for (int k = pattern.columnStart[column]; k < pattern.columnStart[column + 1]; ++k) {
      const int row = pattern.rows[k];
      entries.emplace_back(first + row, first + column, values[k]);
      if (row != column) entries.emplace_back(first + column, first + row, values[k]);
    }
}

/// Adds the rows of C on one body, and C'.
void addRows(const ConstraintRows& C, const Body& body, int first, int conditions,
             const std::vector<char>& active, Triplets& entries) {
  for (int k = 0; k < C.outerSize(); ++k)
    for (ConstraintRows::InnerIterator entry(C, k); entry; ++entry) {
      const int equation = body.equations()[entry.col()];
      if (equation < 0 || active[entry.row()] == 0) continue;
      const int row = conditions + static_cast<int>(entry.row());
      entries.emplace_back(row, first + equation, entry.value());
      entries.emplace_back(first + equation, row, entry.value());
    }
}

/// The largest and smallest s22 of a body.
std::pair<double, double> verticalStress(const Body& body, const Vector& u) {
  Matrix strain(3, body.points());
  body.strain({u, Vector::Zero(u.size())}, nullptr, strain, 0, body.points());
  const Eigen::Array3d e = elasticity.moduli();
  const Vector s22 = (e[0] * strain.row(0) - e[1] * strain.row(1)) / std::sqrt(2.0);
  return {s22.minCoeff(), s22.maxCoeff()};
}

void solve(const char* name, CouplingKind kind, const Body& upper, const Body& lower) {
  const ContactInterface contact({{0, bottom}, {1, top}, kind}, upper.mesh(), lower.mesh());
  const int rows = contact.rows();
  const int conditions = upper.freeDofs() + lower.freeDofs();
  Vector load = Vector::Zero(conditions + rows);
  load.head(upper.freeDofs()) = upper.gather(upper.load(1));
  std::vector<char> active(rows, 1);
  Vector u1, u2, p;
  for (bool changed = true; changed;) {  // active nodes press, the others have a gap
    Triplets entries;
    addStiffness(upper, 0, entries);
    addStiffness(lower, upper.freeDofs(), entries);
    addRows(contact.C1(), upper, 0, conditions, active, entries);
    addRows(contact.C2(), lower, upper.freeDofs(), conditions, active, entries);
    for (int i = 0; i < rows; ++i)
      if (active[i] == 0) entries.emplace_back(conditions + i, conditions + i, 1);
    Eigen::SparseMatrix<double> system(conditions + rows, conditions + rows);
    system.setFromTriplets(entries.begin(), entries.end());
    const Vector solution = Eigen::SparseLU<Eigen::SparseMatrix<double>>(system).solve(load);
    u1 = upper.spread(solution.head(upper.freeDofs()));
    u2 = lower.spread(solution.segment(upper.freeDofs(), lower.freeDofs()));
    p = solution.tail(rows);
    const Vector g = contact.gap(u1, u2);
    changed = false;
    for (int i = 0; i < rows; ++i) {
      const char now = active[i] != 0 ? p[i] >= 0 : g[i] > 1e-14;
      changed = changed || now != active[i];
      active[i] = now;
    }
  }
  const auto [least1, largest1] = verticalStress(upper, u1);
  const auto [least2, largest2] = verticalStress(lower, u2);
  std::printf("%-13s s22 upper %.12g to %.12g, lower %.12g to %.12g, force %.12g\n", name, least1, largest1,
              least2, largest2, p.sum());
}

}  // namespace

int main() {
  const Condition roller{left, alongX, constant(0)};
  const Body upper = block("upper", 3, {0, 0}, {{roller}, {{top, alongY, constant(-1)}}, {}});
  const Body lower = block("lower", 4, {0, -1}, {{roller, {bottom, alongY, constant(0)}}, {}, {}});
  solve("mortar", CouplingKind::mortar, upper, lower);
  solve("interpolation", CouplingKind::interpolation, upper, lower);
}
