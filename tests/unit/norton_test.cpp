#include "material/norton.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "base/error.h"
#include "material/interior_path.h"
#include "unit/plane_strain_point.h"

namespace mortier::norton_test {

/// The step in extended precision on three directions:
///   s = given/(1/e + theta a),  given = E^-1 s0 + strain,  log theta by bisection.
struct Direct {
  LongArray e;
  LongArray a;
  NortonCreep creep;
  double weight = 0;

  [[nodiscard]] Long logTheta(const LongArray& s) const {
    return std::log(Long(weight) * Long(creep.referenceRate) / Long(creep.referenceStress)) +
           (Long(creep.exponent) - 1) / 2 * std::log((a * (s / Long(creep.referenceStress)).square()).sum());
  }
  [[nodiscard]] LongArray given(const LongArray& s) const { return s * (1 / e + std::exp(logTheta(s)) * a); }
  [[nodiscard]] LongArray stress(const LongArray& given) const {
    const auto at = [&](Long y) { return LongArray(given / (1 / e + std::exp(y) * a)); };
    Long high = logTheta(given * e);
    Long low = high - 1;
    while (low > logTheta(at(low))) low -= 2 * (high - low);
    for (int k = 0; k < 120; ++k) {
      const Long middle = (low + high) / 2;
      (middle > logTheta(at(middle)) ? high : low) = middle;
    }
    return at((low + high) / 2);
  }
};

constexpr double exponents[] = {1, 1.5, 3, 5, 20, 100};

Direct directOf(const Elasticity& elasticity, const NortonCreep& creep, Plane plane, double weight) {
  const LongArray e = elasticity.moduli().cast<Long>();
  if (plane == Plane::stress) return {e, {0.5L, 1.5L, 1.5L}, creep, weight};
  return {{e[1], e[1], e[1]}, {1.5L, 1.5L, 1.5L}, creep, weight};
}

/// The weight for which creep is `ratio` times the elastic strain at a von Mises stress.
double weightFor(double ratio, double stress, const Elasticity& elasticity, const NortonCreep& creep) {
  return ratio / elasticity.young * creep.referenceStress / creep.referenceRate *
         std::pow(stress / creep.referenceStress, 1 - creep.exponent);
}

// H^-1 is the derivative of the step's stress with respect to the strain: central differences of fourth
// order.
TEST(Norton, tangentMatchesFiniteDifference) {
  constexpr Long h = 1e-4L;
  constexpr double differences = 1e-11;
  constexpr double e3[] = {1e-6, 1e-3, 1e-1, 1, 10, 1e3, 1e6, 1e9, 1e12};
  double worst = 0;
  std::mt19937 random(3);
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const double nu : {0.3, -0.4, 0.49})
      for (const double n : exponents)
        for (const double ratio : e3) {
          const Elasticity elasticity{2e11, nu};
          const NortonCreep creep{1e8, 1e-9, n};
          const Vector3d s = randomStress(random, 3e8);
          const Direct direct = directOf(elasticity, creep, plane, weightFor(ratio, 3e8, elasticity, creep));
          const auto material = nortonMaterial(elasticity, creep, plane);
          const LongArray given = direct.given(s.array().cast<Long>());
          const Vector3d strain = (given - s.array().cast<Long>() / direct.e).cast<double>().matrix();
          Eigen::Matrix<Long, 3, 3> exact;
          for (int j = 0; j < 3; ++j) {
            const Long step = h * given.abs().maxCoeff();
            const auto at = [&](int k) {
              LongArray moved = given;
              moved[j] += k * step;
              return direct.stress(moved);
            };
            exact.col(j) = ((8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step)).matrix();
          }
          double error = 0;
          if (plane == Plane::stress) {
            const Eigen::Matrix3d H = linearise(*material, direct.weight, s, strain, s).moduli;
            error = (H - exact.cast<double>()).cwiseAbs().maxCoeff() / H.cwiseAbs().maxCoeff();
          } else {
            const auto four = [](const Vector3d& k) {
              return Vector4d(joined(Split<double>{{k[0], k[1], k[2]}, 0}).data());
            };
            const Eigen::Matrix4d H =
                lineariseAt(*material, direct.weight, four(s), four(strain), four(s)).moduli;
            std::array<double, 9> D;
            Eigen::Map<Eigen::Matrix3d>(D.data()) = exact.cast<double>();
            const std::array<double, 16> whole = joinedModuli(D, 2e11 / (1 - 2 * nu));
            // Of the deviator: the modulus of the pressure would hide it.
            for (int j = 0; j < 3; ++j) {
              const Vector4d k = four(Vector3d::Unit(j));
              const Vector4d difference = (H - Eigen::Map<const Eigen::Matrix4d>(whole.data())) * k;
              error = std::max(error, difference.norm() / exact.cast<double>().cwiseAbs().maxCoeff());
            }
          }
          // H has s to the power n - 1 of what a double knows, and the pressure takes digits of the deviator.
          const double tolerance =
              differences * n * n + (plane == Plane::strain ? 64 * epsilon * (1 + ratio) / (1 - 2 * nu) : 0);
          ASSERT_LE(error, tolerance) << "n " << n << ", nu " << nu << ", creep over elastic strain " << ratio
                                      << (plane == Plane::strain ? ", plane strain" : "");
          worst = std::max(worst, error / tolerance);
        }
  std::cout << "tangent against differences: at most " << worst << " of the tolerance\n";
}

// The law as textbooks have it, in three-dimensional tensors.
TEST(Norton, creepIsThatOfThreeDimensions) {
  constexpr double rounding = 1e-13;
  std::mt19937 random(5);
  for (const double n : exponents) {
    const NortonCreep creep{2, 0.3, n};
    const Vector4d s = randomStress4(random, 2.5, 4);
    Vector4d inPlane = s;
    inPlane[3] = 0;
    const Tensors::Tensor I = Tensors::Tensor::Identity();
    const auto exact = [&](const Tensors::Tensor& t) {
      const Tensors::Tensor deviator = t - t.trace() / 3 * I;
      const Long mises = std::sqrt(1.5L * deviator.squaredNorm());
      return Tensors::vector(0.3L * std::pow(mises / 2, Long(n)) * 1.5L / mises * deviator);
    };
    Matrix rate;
    nortonMaterial({1, 0.3}, creep, Plane::strain)->viscoplasticRate(s, rate);
    EXPECT_LE((rate - exact(Tensors::tensor(s))).norm(), n * rounding * rate.norm());
    nortonMaterial({1, 0.3}, creep, Plane::stress)->viscoplasticRate(Matrix(inPlane.head<3>()), rate);
    EXPECT_LE((rate - exact(Tensors::tensor(inPlane)).head<3>()).norm(), n * rounding * rate.norm());
  }
}

/// Iterations of a step whose strain is given, from a stress on.
int iterationsTo(const LongArray& solution, const Material& material, double weight, const Vector3d& strain,
                 Vector3d s) {
  for (int k = 0; k < 200; ++k) {
    if ((s - solution.cast<double>().matrix()).norm() <= 1e-9 * s.norm()) return k;
    s = linearise(material, weight, Vector3d::Zero(), strain, s).predictor;
  }
  return 200;
}

// From elasticity, up to 1e3 times the stress of the law, and from below it.
TEST(Norton, pointsUnderAGivenStrainAreSolvedInAFewIterations) {
  constexpr int few = 12;
  int most = 0;
  std::mt19937 random(9);
  for (const double n : exponents)
    for (const double ratio : {1e-3, 1.0, 1e3, 1e6, 1e12})
      for (const double from : {0.0, 0.1, 0.7, 3.0}) {
        const Elasticity elasticity{1, 0.3};
        const NortonCreep creep{1, 1, n};
        const Vector3d s = randomStress(random, 2);
        const Direct direct =
            directOf(elasticity, creep, Plane::stress, weightFor(ratio, 2, elasticity, creep));
        const LongArray exact = s.array().cast<Long>();
        const Vector3d strain = direct.given(exact).cast<double>().matrix();
        const int iterations = iterationsTo(exact, *nortonMaterial(elasticity, creep, Plane::stress),
                                            direct.weight, strain, from * s);
        EXPECT_LE(iterations, few) << "n " << n << ", creep over elastic strain " << ratio << ", from "
                                   << from << " s";
        most = std::max(most, iterations);
      }
  std::cout << "at most " << most << " iterations\n";
}

// The same law by another stress and its rate.
TEST(Norton, referencesAreArbitrary) {
  const NortonCreep creep{2, 3, 4};
  const auto one = nortonMaterial({1, 0.3}, creep, Plane::stress);
  const auto same = nortonMaterial({1, 0.3}, {2e3, 3e12, 4}, Plane::stress);
  const Vector3d s(0.3, -2, 1);
  const Vector3d strain(1, 2, -3);
  const Answer a = linearise(*one, 0.7, Vector3d::Zero(), strain, s);
  const Answer b = linearise(*same, 0.7, Vector3d::Zero(), strain, s);
  EXPECT_LE((a.predictor - b.predictor).norm(), 1e-13 * a.predictor.norm());
  EXPECT_LE((a.moduli - b.moduli).norm(), 1e-13 * a.moduli.norm());
}

TEST(Norton, rejectsWhatIsNoCreep) {
  const auto make = [](const NortonCreep& creep) { return nortonMaterial({1, 0.3}, creep, Plane::stress); };
  EXPECT_NO_THROW(make({1, 1, 1}));
  for (const NortonCreep& creep :
       {NortonCreep{0, 1, 3}, {-1, 1, 3}, {1, 0, 3}, {1, 1, 0.99}, {1, 1, NAN}, {INFINITY, 1, 3}})
    EXPECT_THROW(make(creep), InputError);
  const LawDescription law = make({1, 2, 3})->laws().front();
  EXPECT_EQ(law.text(), "Norton");
  EXPECT_EQ(law.parameters.size(), 5u);
}

TEST(Norton, stressesOfZeroAndOfAnySizeAreNumbers) {
  for (const double n : {1.0, 5.0, 1000.0})
    for (const double size : {0.0, 1e-200, 1e-20, 1.0, 1e20})
      for (const double weight : {0.0, 1e-20, 1.0}) {
        const auto material = nortonMaterial({1, 0.3}, {1, 1, n}, Plane::stress);
        const Vector3d s = size * Vector3d(1, -1, 2);
        if (n > 5 && size > 1 && weight > 0) continue;  // a rate that no double holds
        EXPECT_TRUE(linearise(*material, weight, s, Vector3d(0.1, 0, 0), s).predictor.allFinite())
            << n << ' ' << size << ' ' << weight;
      }
}

}  // namespace mortier::norton_test
