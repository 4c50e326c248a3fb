#include "material/overstress.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <iostream>
#include <random>

#include "base/error.h"
#include "unit/plane_strain_point.h"

namespace mortier::overstress_test {

constexpr Elasticity elasticity{200, 0.3};

/// The step under a given strain in extended precision, on three directions: with t = s0 + E strain,
///   z = (t - H eps_v0/a)/(1 + kappa (e a + H)),  dp = kappa vM(z),  s = t - kappa e a z,
///   vM(z) = sigma_Y + K (p0 + dp) + sigma0 (dp/(weight rate0))^(1/m),   kappa by bisection.
struct Direct {
  LongArray e;
  LongArray a;
  Overstress law;
  double weight = 0;
  LongArray s0 = LongArray::Zero();
  LongArray flowed0 = LongArray::Zero();
  Long p0 = 0;

  struct End {
    LongArray stress;
    Long p;
  };
  [[nodiscard]] End end(const LongArray& strain) const {
    const Long H = law.kinematicHardening;
    const LongArray trial = s0 + e * strain;
    const LongArray y = trial - H * flowed0 / a;
    const auto z = [&](Long kappa) { return LongArray(y / (1 + kappa * (e * a + H))); };
    const auto mises = [&](Long kappa) { return std::sqrt((a * z(kappa).square()).sum()); };
    const auto beyond = [&](Long kappa) {
      const Long dp = kappa * mises(kappa);
      const Long over = law.viscous() ? law.referenceStress * std::pow(dp / (weight * law.referenceRate),
                                                                       1 / Long(law.exponent))
                                      : 0;
      return mises(kappa) > law.yieldStress + law.isotropicHardening * (p0 + dp) + over;
    };
    if (!(mises(0) > law.yieldStress + law.isotropicHardening * p0)) return {trial, p0};
    Long low = -200;  // of log(kappa E)
    Long high = 200;
    for (int k = 0; k < 120; ++k) (beyond(std::exp((low + high) / 2) / e[1]) ? low : high) = (low + high) / 2;
    const Long kappa = std::exp(low) / e[1];
    return {trial - kappa * e * a * z(kappa), p0 + kappa * mises(kappa)};
  }
};

Direct directOf(const Overstress& law, Plane plane, double weight) {
  const LongArray e = elasticity.moduli().cast<Long>();
  if (plane == Plane::stress) return {e, {0.5L, 1.5L, 1.5L}, law, weight};
  return {{e[1], e[1], e[1]}, {1.5L, 1.5L, 1.5L}, law, weight};
}

/// A vector on the directions of the law, and what a law remembers, as the material has them.
Matrix onComponents(const LongArray& own, double pressure, double rho, const Material& material) {
  Matrix all(material.components(), 1);
  const Eigen::Array3d s = own.cast<double>();
  if (material.tensorComponents() == 4) {
    const auto four = joined(Split<double>{{s[0], s[1], s[2]}, pressure});
    all.topRows(4) = Eigen::Map<const Vector4d>(four.data());
  } else {
    all.topRows(3) = s.matrix();
  }
  if (material.components() > material.tensorComponents()) all(all.rows() - 1, 0) = rho;
  return all;
}

const Overstress laws[] = {{1.3, 0.7, 0.2, 1},           {1.3, 0.7, 0.2, 1, 20},
                           {1.3, 0.7, 0.2, 1, 0, 30},    {1.3, 0.7, 0.2, 1, 20, 30},
                           {1.3, 0.7, 0.2, 3.5, 0, 0},   {1.3, 0.7, 0.2, 20, 20, 30},
                           {1.3, 0.7, 0.2, 5, 0.01, 30}, {1.3, 0, 1, 1},
                           {1.3, 0, 1, 1, 20},           {1.3, 0, 1, 1, 0, 30},
                           {1.3, 0, 1, 1, 20, 30}};

// Steps and strains from a part of the elastic ones to far beyond them: the stress of the step, and H^-1 as
// its derivative with respect to the strain, by central differences of fourth order.
TEST(Overstress, stepAndTangentAreThoseOfTheLaw) {
  std::mt19937 random(5);
  double worst = 0;
  double worstTangent = 0;
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const Overstress& law : laws)
      for (const double weight : {1e-4, 1e-2, 1.0, 1e2, 1e6})
        for (const double size : {1e-2, 1.0, 3.0, 1e3}) {
          const auto material = overstressMaterial(elasticity, law, plane);
          Direct direct = directOf(law, plane, weight);
          direct.flowed0 = 1e-2 * randomStress(random, 1).array().cast<Long>();
          direct.s0 = randomStress(random, 0.5).array().cast<Long>() +
                      law.kinematicHardening * direct.flowed0 / direct.a;
          direct.p0 = law.isotropicHardening > 0 ? 0.02L : 0;
          const LongArray strain = size * randomStress(random, 1.3 / 200).array().cast<Long>();
          const auto exact = direct.end(strain);
          const double rho0 = static_cast<double>(-law.isotropicHardening * direct.p0);
          const Matrix stress0 = onComponents(direct.s0, 0.4, rho0, *material);
          const Matrix strains = onComponents(strain, 0, 0, *material);
          const Matrix total0 = onComponents(direct.s0 / direct.e + direct.flowed0, 0, 0, *material);
          Matrix s = stress0;
          Linearisation at = material->room(1);
          LawReport report;
          int iterations = 0;
          do {
            report = material->linearise({weight, stress0, strains, false, &total0}, s, at, 0, 1);
            s = at.predictor;
          } while (report.change > 1e-11 && ++iterations < 30);
          EXPECT_LE(iterations, 20);
          const auto expected = [&](const Direct::End& end) {
            return onComponents(end.stress, 0.4, static_cast<double>(-law.isotropicHardening * end.p),
                                *material);
          };
          const double scale = expected(exact).cwiseAbs().maxCoeff();
          const double error = (s - expected(exact)).cwiseAbs().maxCoeff() / scale;
          worst = std::max(worst, error);
          EXPECT_LE(error, 1e-9) << static_cast<int>(plane) << ' ' << (&law - laws) << ' ' << weight << ' '
                                 << size;
          // The tangent of plasticity without hardening keeps 1e-10 of elasticity.
          const bool perfect = !law.viscous() && law.kinematicHardening + law.isotropicHardening == 0;
          const double trace = perfect ? 2e-10 : 0;
          material->linearise({weight, stress0, strains, false, &total0}, s, at, 0, 1);
          for (int j = 0; j < 3; ++j) {
            const Long h = 1e-4L * strain.abs().maxCoeff();
            const auto moved = [&](int k) {
              LongArray other = strain;
              other[j] += k * h;
              const auto end = direct.end(other);
              return onComponents(end.stress, 0, static_cast<double>(-law.isotropicHardening * end.p),
                                  *material);
            };
            const Matrix difference =
                (8 * (moved(1) - moved(-1)) - (moved(2) - moved(-2))) / (12 * static_cast<double>(h));
            const Matrix unit =
                onComponents(LongArray(Eigen::Matrix<Long, 3, 1>::Unit(j).array()), 0, 0, *material);
            const Vector column = stressOf(at, unit.col(0), 0);
            const double off =
                (column - difference.col(0)).cwiseAbs().maxCoeff() / 200 / std::min(1.0, 1.0 / size);
            worstTangent = std::max(worstTangent, off);
            EXPECT_LE(off, std::max(1e-7, trace * size))
                << static_cast<int>(plane) << ' ' << (&law - laws) << ' ' << weight << ' ' << size;
          }
        }
  std::cout << "stress " << worst << ", tangent against differences " << worstTangent << "\n";
}

// As textbooks have it, in three-dimensional tensors.
TEST(Overstress, flowIsThatOfThreeDimensions) {
  std::mt19937 random(6);
  for (const Overstress& law : laws) {
    if (!law.viscous()) continue;
    const Vector4d flowed4 =
        Tensors::vector(Tensors::deviator(Tensors::tensor(1e-2 * randomStress4(random, 1, 0))));
    for (const Plane plane : {Plane::stress, Plane::strain}) {
      const auto material = overstressMaterial(elasticity, law, plane);
      Vector4d s = randomStress4(random, 4, 2);
      if (plane == Plane::stress) s[3] = 0;
      Tensors::Tensor flowed = Tensors::tensor(flowed4);
      if (plane == Plane::stress) flowed(2, 2) = -flowed(0, 0) - flowed(1, 1);
      const Tensors::Tensor relative =
          Tensors::deviator(Tensors::tensor(s)) - 2 * Long(law.kinematicHardening) / 3 * flowed;
      const Long mises = std::sqrt(1.5L) * relative.norm();
      const Long over = mises - law.yieldStress - 0.03L * law.isotropicHardening;
      const Long p =
          over > 0 ? law.referenceRate * std::pow(over / law.referenceStress, Long(law.exponent)) : 0;
      const Vector4d exact = Tensors::vector(1.5L * p / mises * relative);
      const int n = material->tensorComponents();
      Matrix stress(material->components(), 1);
      stress.topRows(n) = s.head(n);
      if (material->components() > n) stress(n, 0) = -0.03 * law.isotropicHardening;
      Matrix total;
      material->elasticStrain(stress, total);
      total.topRows(n) += flowed4.head(n);
      Matrix rate;
      material->viscoplasticRate(stress, rate, &total);
      EXPECT_LE((rate.col(0).head(n) - exact.head(n)).norm(), 1e-12 * (1 + law.exponent) * exact.norm());
      if (material->components() > n) {
        EXPECT_NEAR(rate(n, 0), static_cast<double>(p), 1e-12 * (1 + law.exponent) * static_cast<double>(p));
      }
      EXPECT_EQ(material->flows(stress, 0, &total), over > 0);
    }
  }
}

// With a viscosity it is the note's law in plane strain, whose projections are one there.
TEST(Overstress, isPerzynasLawInPlaneStrain) {
  Overstress law{1.3};
  law.setViscosity(4);
  const auto one = overstressMaterial(elasticity, law, Plane::strain);
  const auto other = perzynaMaterial(elasticity, {4, 1.3}, Plane::strain);
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    const Vector4d s = randomStress4(random, 2, 1);
    const Vector4d s0 = randomStress4(random, 1, 1);
    const Vector4d strain = randomStress4(random, 0.01, 0.01);
    const Vector4d a = solveAt(*one, 0.8, s0, strain, s);
    const Vector4d b = solveAt(*other, 0.8, s0, strain, s, true);
    EXPECT_LE((a - b).norm(), 1e-12 * b.norm());
    EXPECT_LE((lineariseAt(*one, 0.8, s0, strain, a).moduli - lineariseAt(*other, 0.8, s0, strain, a).moduli)
                  .norm(),
              1e-9 * 200);
  }
}

TEST(Overstress, yieldsWhereItsStressAndItsStrainSay) {
  const Matrix stress = Eigen::Vector3d(0, 0, 1.5);
  const auto flows = [&](const Overstress& law, const Matrix* total) {
    return overstressMaterial(elasticity, law, Plane::stress)->flows(stress, 0, total);
  };
  EXPECT_TRUE(flows({1.3, 1}, nullptr));
  EXPECT_FALSE(flows({2, 1}, nullptr));
  const double elastic = 1.5 / elasticity.moduli()[2];
  const Matrix behind = Eigen::Vector3d(0, 0, elastic + 0.1);
  const Matrix fresh = Eigen::Vector3d(0, 0, elastic);
  EXPECT_FALSE(flows({1.3, 1, 1, 1, 10}, &behind));  // |1.5 - 10 0.1 2/3| sqrt(3/2) < 1.3
  EXPECT_TRUE(flows({1.3, 1, 1, 1, 10}, &fresh));
  EXPECT_TRUE(flows({9, 1, 1, 1, 10}, nullptr));  // it is not known
}

TEST(Overstress, rejectsWhatIsNoLaw) {
  const auto make = [](const Overstress& law) { return overstressMaterial(elasticity, law, Plane::stress); };
  EXPECT_EQ(make({1, 1})->laws().front().text(), "viscoplastic");
  EXPECT_EQ(make({1})->laws().front().text(), "plastic");
  EXPECT_EQ(make({1, 1, 1, 1, 0, 2})->components(), 4);
  EXPECT_EQ(make({1, 1, 1, 1, 0, 2})->tensorComponents(), 3);
  for (const Overstress& law : {Overstress{0, 1},
                                {-1, 1},
                                {1, -1},
                                {1, 1, 0},
                                {1, 1, 1, 0.9},
                                {1, 1, 1, 1, -1},
                                {1, 1, 1, 1, 0, -1},
                                {NAN, 1},
                                {1, INFINITY}})
    EXPECT_THROW(make(law), InputError);
}

}  // namespace mortier::overstress_test
