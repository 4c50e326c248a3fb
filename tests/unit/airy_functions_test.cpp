// Stresses in equilibrium that come near to given ones: tractions in equilibrium with each triangle, Airy
// functions that keep them so.
#include "bound/relaxation.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "material/stress.h"
#include "mesh/generate.h"
#include "theory/scenes.h"

namespace mortier::airy_functions_test {

using namespace scenes;

/// S of plane stress.
Eigen::Matrix3d compliance(double young, double poisson) {
  Eigen::Matrix3d S;
  S << 1, -poisson, 0, -poisson, 1, 0, 0, 0, 2 * (1 + poisson);
  return S / young;
}

double areaOf(const std::array<Point, 3>& x) {
  const Point a = x[1] - x[0];
  const Point b = x[2] - x[0];
  return (a.x() * b.y() - a.y() * b.x()) / 2;
}

// ---- tractions
/// A square under a linear stress without divergence: finite element stresses are its means, the exact stress
/// has the linear tractions, and is one of those that are allowed.
struct LinearStress {
  TriangleMesh mesh;
  Sides sides{mesh};
  std::vector<Eigen::Matrix3d> compliances;
  std::vector<Stress> means;
  std::vector<CompositeTriangle> elements;
  std::vector<BodyLoad> forces;
  std::vector<KnownTraction> known;
  SideMoments moments;
  double best = 0;  ///< energy of the exact stress less its means

  explicit LinearStress(TriangleMesh on) : mesh(std::move(on)) {
    const Eigen::Matrix3d S = compliance(1, 0.2);
    const auto exact = [](const Point& x) {
      return Stress(0.6 * x.x() + 0.4 * x.y(), 1.2 * x.x() - 0.3 * x.y(), 0.3 * x.x() - 0.6 * x.y());
    };
    for (const auto& v : mesh.triangles) {
      const std::array<Point, 3> x{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
      means.push_back(exact((x[0] + x[1] + x[2]) / 3));
      elements.emplace_back(x, S);
      for (int k = 0; k < 3; ++k) {
        const Stress off = exact((x[k] + x[(k + 1) % 3]) / 2) - means.back();
        best += areaOf(x) / 3 * off.dot(S * off);
      }
    }
    compliances.assign(means.size(), S);
    forces.assign(means.size(), BodyLoad::Zero());
    known.resize(sides.count());
    for (int e = 0; e < sides.count(); ++e) {
      const Side& side = sides.all()[e];
      if (side.triangles[1] >= 0) continue;
      const Point a = mesh.vertices[side.vertices[0]];
      const Point b = mesh.vertices[side.vertices[1]];
      const auto traction = [&](const Point& x) -> Point {
        const Stress s = exact(x);
        const Point n(b.y() - a.y(), -(b.x() - a.x()));
        return {s[0] * n.x() + s[2] * n.y(), s[2] * n.x() + s[1] * n.y()};
      };
      known[e] = {2,
                  {Point(1, 0), Point(0, 1)},
                  {Point(traction(a) / 3 + traction(b) / 6), Point(traction(a) / 6 + traction(b) / 3)}};
    }
    moments = balancedMoments(mesh, sides, means, forces, known);
  }
  Relaxation relaxation() { return {mesh, sides, compliances, means, forces, known, moments}; }
  void expectBalance() const {
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      EXPECT_LE(elements[t].defect(momentsOf(sides, moments, t)), 1e-12);
      Point sum(0, 0);
      for (int i = 0; i < 6; ++i) sum += momentsOf(sides, moments, t).segment<2>(2 * i);
      EXPECT_LE(sum.norm(), 1e-14);
    }
  }
};

/// Triangles of many sizes, those of the lowest row a thousand times as long as high.
TriangleMesh gradedSquare(int cells) {
  TriangleMesh mesh = square(0, cells);
  const double h = 1.0 / cells;
  for (Point& x : mesh.vertices) {
    const double above = x.y() - h;
    x = {x.x() * x.x(), above <= 0 ? 1e-3 * x.y() : 1e-3 * h + above * (1 - 1e-3 * h) / (1 - h)};
  }
  return mesh;
}

TEST(Relaxation, keepsEquilibriumAndLowersTheEnergyToThatOfAnExactStress) {
  for (const TriangleMesh& mesh : {square(0, 8), gradedSquare(8)}) {
    std::array<double, 2> least{};
    for (const bool directly : {false, true}) {
      LinearStress found(mesh);
      Relaxation relaxation = found.relaxation();
      double last = relaxation.energies().sum();
      EXPECT_GT(last, 1.2 * found.best);
      found.expectBalance();
      if (directly) {
        ASSERT_TRUE(relaxation.minimise());
      } else {
        for (const double part : {0.1, 1e-2, 1e-4, 1e-8, 1e-12}) {
          EXPECT_TRUE(relaxation.iterate(part, 300));
          const double now = relaxation.energies().sum();
          // Where triangles are a thousand times as long as high, rounding is 1e-7 of the energy.
          EXPECT_LE(now, last * (1 + (part < 1e-8 ? 1e-6 : 1e-12)));
          last = now;
        }
      }
      found.expectBalance();
      least[directly ? 1 : 0] = relaxation.energies().sum();
      EXPECT_LE(least[directly ? 1 : 0], found.best);
    }
    EXPECT_NEAR(least[0], least[1], 1e-6 * least[1]);
  }
}

TEST(Relaxation, iterationsEndWhereTheySayTheyDo) {
  for (const TriangleMesh& mesh : {square(0, 16), gradedSquare(16)}) {
    LinearStress found(mesh);
    Relaxation relaxation = found.relaxation();
    ASSERT_TRUE(relaxation.iterate(0.003, 80));
    const double energy = relaxation.energies().sum();
    EXPECT_FALSE(relaxation.iterate(1e-9, 3));
    ASSERT_TRUE(relaxation.minimise());
    EXPECT_LE(energy, 1.03 * relaxation.energies().sum());
  }
}

}  // namespace mortier::airy_functions_test
