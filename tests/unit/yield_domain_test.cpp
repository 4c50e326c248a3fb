#include "material/yield_domain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace mortier::yield_domain_test {

using Eigen::Array3d;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
const Array3d a(0.5, 1.5, 1.5);

/// The projection of one stress.
struct Projected {
  Array3d overstress;
  Array3d softening;
  Array3d x;
  Array3d y;
  double z = 0;
};

/// The domain at one stress.
class OneStress {
 public:
  OneStress(double yieldStress, const Array3d& w)
      : domain_(yieldStress, {a[0], a[1]}, {a[0] / w[0], a[1] / w[1]}) {}

  [[nodiscard]] bool yields(const Array3d& s) const {
    return domain_.yields(std::array<double, 3>{s[0], s[1], s[2]});
  }
  [[nodiscard]] Projected project(const Array3d& s, double kappa = 1) const {
    const ProjectionOnYield<3> P = domain_.project(LaneVector{s[0], s[1], s[2]}, kappa, LaneMask(true));
    const auto of = [](const LaneVector& x) { return Array3d(x[0][5], x[1][5], x[2][5]); };
    return {of(P.overstress), Array3d(P.softening[0][5], P.softening[1][5], P.softening[1][5]), of(P.x),
            of(P.y), P.z[5]};
  }

 private:
  YieldDomain<double> domain_;
};

OneStress yieldDomain(double yieldStress, const Array3d& w) {
  return {yieldStress, w};
}

struct Norm {
  std::string name;
  Array3d w;
};

/// The three norms of the projection at Poisson's ratios up to the ends of its range.
std::vector<Norm> norms() {
  std::vector<Norm> result{{"frobenius", Array3d::Ones()}};
  for (const double nu : {0.3, 0.49, -0.9}) {
    const Array3d e(1 / (1 - nu), 1 / (1 + nu), 1 / (1 + nu));
    result.push_back({"elasticity " + std::to_string(nu), e / e[1]});
    result.push_back({"compliance " + std::to_string(nu), e[1] / e});
  }
  return result;
}

double size(const Array3d& s) {
  return std::sqrt((a * s * s).sum());
}

/// P_B s = s c without the cancellation of s - overstress, from y = a s c^2.
Array3d projected(const Array3d& s, const Projected& P) {
  return s * (P.y / (a * s)).sqrt();
}

class Stresses {
 public:
  /// A stress of the given von Mises size in a random direction.
  Array3d ofSize(double target) {
    const Array3d s(normal_(random_), normal_(random_), normal_(random_));
    return s * (target / size(s));
  }

 private:
  std::mt19937 random_{20260101};
  std::normal_distribution<double> normal_;
};

TEST(YieldDomain, projectionLandsOnTheSurface) {
  constexpr double tolerance = 8 * epsilon;  // a handful of roundings in a sum of three squares
  for (const Norm& norm : norms()) {
    const OneStress B = yieldDomain(1, norm.w);
    Stresses stresses;
    for (const double beyond : {1e-12, 1e-6, 1e-2, 1.0, 10.0, 1e3, 1e6, 1e12})
      for (int k = 0; k < 50; ++k) {
        const Array3d s = stresses.ofSize(1 + beyond);
        ASSERT_TRUE(B.yields(s));
        const Projected P = B.project(s);
        ASSERT_NEAR(size(projected(s, P)), 1, tolerance) << norm.name << ", beyond by " << beyond;
        ASSERT_TRUE((P.overstress - (s - projected(s, P))).abs().maxCoeff() <=
                    tolerance * s.abs().maxCoeff());
      }
  }
}

TEST(YieldDomain, projectionIsIdempotent) {
  for (const Norm& norm : norms()) {
    const OneStress B = yieldDomain(1, norm.w);
    Stresses stresses;
    for (int k = 0; k < 200; ++k) {
      const Array3d s = stresses.ofSize(k % 2 == 0 ? 3 : 300);
      const Array3d once = projected(s, B.project(s));
      if (B.yields(once)) {
        ASSERT_LE(B.project(once).overstress.abs().maxCoeff(), 16 * epsilon) << norm.name;
      }
    }
  }
}

// P is the projection in the norm w exactly when (s - P) . w (t - P) <= 0 for every t in B. Points t near P
// see a normal that is off by an angle; points far away see a P inside B.
TEST(YieldDomain, projectionIsOrthogonalInItsNorm) {
  constexpr double tolerance = 32 * epsilon;
  for (const Norm& norm : norms()) {
    const OneStress B = yieldDomain(1, norm.w);
    Stresses stresses;
    for (const double beyond : {1e-2, 1.0, 1e4})
      for (int k = 0; k < 50; ++k) {
        const Array3d s = stresses.ofSize(1 + beyond);
        const Projected result = B.project(s);
        const Array3d P = projected(s, result);
        const Array3d normal = norm.w * result.overstress;
        for (const double radius : {1e-3, 1e-1, 1.0})
          for (int j = 0; j < 20; ++j) {
            Array3d t = P + stresses.ofSize(radius);
            if (size(t) > 1) t /= size(t);
            ASSERT_LE((normal * (t - P)).sum(), tolerance * normal.matrix().norm())
                << norm.name << ", beyond by " << beyond;
          }
      }
  }
}

TEST(YieldDomain, derivativeMatchesFiniteDifference) {
  constexpr double tolerance = 1e-8;  // central differences: h^2 = 1e-10 and epsilon/h = 2e-11 of the stress
  constexpr double h = 1e-5;
  for (const Norm& norm : norms()) {
    const OneStress B = yieldDomain(1, norm.w);
    Stresses stresses;
    for (const double beyond : {1e-2, 1.0, 1e3})
      for (int k = 0; k < 20; ++k) {
        const Array3d s = stresses.ofSize(1 + beyond);
        const Projected P = B.project(s);
        for (int j = 0; j < 3; ++j) {
          const Array3d unit = Eigen::Vector3d::Unit(j).array();
          const Array3d step = h * (1 + beyond) * unit;
          const Array3d difference = B.project(s + step).overstress - B.project(s - step).overstress;
          const Array3d derivative = P.softening * unit + P.x * (P.y[j] / P.z);
          // Just beyond yield the curvature of the surface is seen from h = 1e-5 away as well.
          ASSERT_LE((difference / (2 * step[j]) - derivative).abs().maxCoeff(), tolerance)
              << norm.name << " " << beyond;
        }
      }
  }
}

// t = s + c theta (s - P_B s) lies on the normal through s: the same projection, the same flow, the same
// tangent.
TEST(YieldDomain, flowIsTheSameFromFurtherOut) {
  constexpr double tolerance = 64 * epsilon;
  for (const Norm& norm : norms()) {
    const OneStress B = yieldDomain(1, norm.w);
    Stresses stresses;
    for (const double beyond : {1.0, 1e3})
      for (const double kappa : {1.0, 0.5, 1e-3}) {
        const Array3d s = stresses.ofSize(1 + beyond);
        const Projected P = B.project(s);
        const Projected Q = B.project(s + (1 / kappa - 1) * P.overstress, kappa);
        const double size = P.overstress.abs().maxCoeff();
        EXPECT_LE((kappa * Q.overstress - P.overstress).abs().maxCoeff(), tolerance * size) << norm.name;
        EXPECT_LE((kappa * Q.softening - P.softening).abs().maxCoeff(), tolerance) << norm.name;
        const Eigen::Matrix3d p = P.x.matrix() * P.y.matrix().transpose() / P.z;
        const Eigen::Matrix3d q = Q.x.matrix() * Q.y.matrix().transpose() / Q.z;
        EXPECT_LE((q - p).cwiseAbs().maxCoeff(), tolerance) << norm.name;
      }
  }
}

TEST(YieldDomain, stressOnTheSurfaceCountsAsBeyondIt) {
  Stresses stresses;
  int exact = 0;
  for (int k = 0; k < 2000; ++k) {
    const Array3d s = stresses.ofSize(1);
    if ((a * s.square()).sum() != 1) continue;
    ++exact;
    for (const Norm& norm : norms()) {
      const OneStress B = yieldDomain(1, norm.w);
      ASSERT_TRUE(B.yields(s));
      const Projected P = B.project(s);
      ASSERT_LE(P.overstress.abs().maxCoeff(), 4 * epsilon);
      ASSERT_TRUE(P.z > 0 && P.x.isFinite().all());
    }
  }
  EXPECT_GT(exact, 100);
  EXPECT_FALSE(yieldDomain(1, Array3d::Ones()).yields(Array3d(0, 0, 0.81)));  // 3/2 0.81^2 = 0.984
  EXPECT_TRUE(yieldDomain(1, Array3d::Ones()).yields(Array3d(0, 0, 0.82)));   // 1.009
}

TEST(YieldDomain, unitsOfPowersOfTwoChangeNoBit) {
  for (const Norm& norm : norms()) {
    Stresses stresses;
    for (const double beyond : {1e-9, 1.0, 1e6})
      for (const double unit : {0x1p-40, 0x1p+31}) {
        const Array3d s = stresses.ofSize(1 + beyond);
        const Projected P = yieldDomain(1, norm.w).project(s);
        const Projected Q = yieldDomain(unit, norm.w).project(unit * s);
        EXPECT_TRUE((Q.overstress == unit * P.overstress).all() && (Q.softening == P.softening).all())
            << norm.name;
      }
  }
}

}  // namespace mortier::yield_domain_test
