// Elasticity by any symmetric tensor: against isotropic elasticity, and laws of flow against differences.
#include "material/anisotropy.h"

#include <gtest/gtest.h>

#include <random>

#include <Eigen/Geometry>

#include "base/error.h"
#include "material/norton.h"
#include "material/perzyna.h"

namespace mortier::anisotropy_test {

constexpr double rounding = 1e-12;

/// One point of a material.
struct Answer {
  Vector predictor;
  Matrix moduli;  ///< components x the three strains of the plane, or the six of space
};

int strainsOf(Eigen::Index components) {
  return components == 6 ? 6 : 3;
}

Answer linearise(const Material& material, double weight, const Vector& s0, const Vector& strain,
                 const Vector& s) {
  Linearisation room = material.room(1);
  const Matrix stress0 = s0;
  const Matrix strains = strain;
  material.linearise({weight, stress0, strains}, Matrix(s), room, 0, 1);
  Answer answer{room.predictor.col(0), Matrix(s.size(), strainsOf(s.size()))};
  for (int j = 0; j < strainsOf(s.size()); ++j)
    answer.moduli.col(j) = stressOf(room, Vector::Unit(s.size(), j), 0);
  return answer;
}

Vector solve(const Material& material, double weight, const Vector& s0, const Vector& strain) {
  Vector s = s0;
  for (int k = 0; k < 80; ++k) s = linearise(material, weight, s0, strain, s).predictor;
  return s;
}

Vector random(std::mt19937& generator, Eigen::Index n) {
  std::normal_distribution<double> normal;
  return Vector::NullaryExpr(n, [&] { return normal(generator); });
}

const Orthotropy wood{{10, 3, 2}, {0.3, 0.2, 0.25}, {1.5, 1.2, 0.7}};
constexpr Plane planes[] = {Plane::stress, Plane::strain, Plane::none};

Eigen::Index componentsIn(Plane plane) {
  return plane == Plane::stress ? 3 : plane == Plane::none ? 6 : 4;
}

/// Axes turned in any way that the plane allows.
Eigen::Matrix3d axesIn(Plane plane, double angle) {
  if (plane != Plane::none) return axesAt(angle);
  return Eigen::AngleAxisd(angle, SpacePoint(1, 2, 3).normalized()).toRotationMatrix();
}

std::shared_ptr<const Material> elastic(const Anisotropy& anisotropy, Plane plane) {
  return anisotropicMaterial(anisotropy, elasticMaterial(stiffestOf(anisotropy), plane));
}

TEST(Anisotropy, isotropicConstantsAreIsotropicElasticity) {
  const double e = 7;
  const double nu = 0.3;
  std::mt19937 generator(1);
  for (const Plane plane : planes) {
    const auto isotropic = elasticMaterial({e, nu}, plane);
    const double shear = e / 2 / (1 + nu);
    const Orthotropy same{{e, e, e}, {nu, nu, nu}, {shear, shear, shear}};
    const auto material = elastic(turned(anisotropyOf(same, plane), axesIn(plane, 0.4)), plane);
    ASSERT_TRUE(material->linear());
    const Vector s0 = random(generator, componentsIn(plane));
    Vector strain = random(generator, componentsIn(plane));
    if (strain.size() == 4) strain[3] = 0;
    const Vector s = random(generator, componentsIn(plane));
    const Answer expected = linearise(*isotropic, 0, s0, strain, s);
    const Answer answer = linearise(*material, 0, s0, strain, s);
    EXPECT_LE((answer.predictor - expected.predictor).norm(), rounding * expected.predictor.norm());
    EXPECT_LE((answer.moduli - expected.moduli).norm(), rounding * expected.moduli.norm());
    Matrix one;
    Matrix other;
    isotropic->elasticStrain(s, one);
    material->elasticStrain(s, other);
    EXPECT_LE((one - other).norm(), rounding * one.norm());
    if (plane == Plane::strain) {
      EXPECT_NEAR(material->outOfPlane(s.head<3>(), 0), isotropic->outOfPlane(s.head<3>(), 0), rounding);
    }
  }
}

/// Under a uniaxial stress along an axis the strains are those of the constants.
TEST(Anisotropy, strainsOfOneStressAreTheConstants) {
  const auto material = elastic(anisotropyOf(wood, Plane::strain), Plane::strain);
  Matrix stress = Matrix::Zero(4, 3);
  const double h = std::numbers::sqrt2 / 2;
  stress.col(0) << h, h, 0, 0;                    // s11 = 1
  stress.col(1) << h, -h, 0, 0;                   // s22 = 1
  stress.col(2) << 0, 0, std::numbers::sqrt2, 0;  // s12 = 1
  Matrix strain;
  material->elasticStrain(stress, strain);
  const auto e11 = [&](int j) { return h * (strain(0, j) + strain(1, j)); };
  const auto e22 = [&](int j) { return h * (strain(0, j) - strain(1, j)); };
  EXPECT_NEAR(e11(0), 1.0 / 10, rounding);
  EXPECT_NEAR(e22(0), -0.3 / 10, rounding);
  EXPECT_NEAR(strain(3, 0), -0.2 / 10, rounding);
  EXPECT_NEAR(e11(1), -0.3 / 10, rounding);
  EXPECT_NEAR(e22(1), 1.0 / 3, rounding);
  EXPECT_NEAR(strain(3, 1), -0.25 / 3, rounding);
  EXPECT_NEAR(2 * h * strain(2, 2), 1 / 1.5, rounding);
}

/// In space the constants of the third axis, and tensors that turn with the axes.
TEST(Anisotropy, bodiesInSpaceHaveNineConstantsInAnyAxes) {
  const auto strainOf = [](const Anisotropy& own, const Eigen::Matrix3d& s) {
    Matrix strain;
    const Vector stress =
        fromSpaceCartesian(SpaceStress{s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2)});
    elastic(own, Plane::none)->elasticStrain(stress, strain);
    const SpaceStress e = toSpaceCartesian(SpaceStress(strain));
    return Eigen::Matrix3d{{e[0], e[3], e[4]}, {e[3], e[1], e[5]}, {e[4], e[5], e[2]}};
  };
  const Anisotropy own = anisotropyOf(wood, Plane::none);
  const auto unit = [](int i, int j) {
    Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
    s(i, j) = s(j, i) = 1;
    return s;
  };
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(strainOf(own, unit(k, k))(k, k), 1 / wood.young[k], rounding);
  EXPECT_NEAR(strainOf(own, unit(0, 0))(1, 1), -0.3 / 10, rounding);
  EXPECT_NEAR(strainOf(own, unit(0, 0))(2, 2), -0.2 / 10, rounding);
  EXPECT_NEAR(strainOf(own, unit(1, 1))(2, 2), -0.25 / 3, rounding);
  EXPECT_NEAR(2 * strainOf(own, unit(0, 1))(0, 1), 1 / 1.5, rounding);
  EXPECT_NEAR(2 * strainOf(own, unit(0, 2))(0, 2), 1 / 1.2, rounding);
  EXPECT_NEAR(2 * strainOf(own, unit(1, 2))(1, 2), 1 / 0.7, rounding);

  std::mt19937 generator(5);
  const Eigen::Matrix3d axes = axesIn(Plane::none, 1.1);
  const Vector r = random(generator, 9);
  const Eigen::Matrix3d any = Eigen::Map<const Eigen::Matrix3d>(r.data());
  const Eigen::Matrix3d s = any + any.transpose();
  const Eigen::Matrix3d expected = axes * strainOf(own, axes.transpose() * s * axes) * axes.transpose();
  EXPECT_LE((strainOf(turned(own, axes), s) - expected).norm(), rounding);

  // The same by its matrix, and what expands along the axes.
  Matrix compliance = Matrix::Zero(6, 6);  // of s11, s22, s12, s33, s13, s23
  compliance.diagonal() << 1 / 10.0, 1 / 3.0, 1 / 1.5, 1 / 2.0, 1 / 1.2, 1 / 0.7;
  compliance(0, 1) = compliance(1, 0) = -0.3 / 10;
  compliance(0, 3) = compliance(3, 0) = -0.2 / 10;
  compliance(1, 3) = compliance(3, 1) = -0.25 / 3;
  EXPECT_LE((anisotropyOf(compliance.inverse(), Plane::none).stiffness - own.stiffness).norm(),
            rounding * own.stiffness.norm());
  const SpaceStress along = toSpaceCartesian(SpaceStress(alongAxes({1, 2, 4}, axes, Plane::none)));
  const Eigen::Matrix3d tensor = axes * Eigen::Vector3d(1, 2, 4).asDiagonal() * axes.transpose();
  EXPECT_NEAR(along[2], tensor(2, 2), rounding);
  EXPECT_NEAR(along[4], tensor(0, 2), rounding);
  EXPECT_NEAR(along[5], tensor(1, 2), rounding);
}

/// E^-1 (s - s0) + weight G(s) = strain, and the moduli are ds/dstrain, elastic, at yield and far beyond.
TEST(Anisotropy, lawsOfFlowAreSolvedAndTheirTangentIsThatOfDifferences) {
  std::mt19937 generator(2);
  for (const Plane plane : planes)
    for (const bool creeps : {false, true})
      for (const double weight : {1e-6, 1e-2, 1.0, 1e4})
        for (const double size : {0.05, 0.5, 5.0}) {
          const Anisotropy own = turned(anisotropyOf(wood, plane), axesIn(plane, 0.7));
          const Elasticity stiffest = stiffestOf(own);
          const auto material = anisotropicMaterial(own, creeps ? nortonMaterial(stiffest, {1, 1, 4}, plane)
                                                                : perzynaMaterial(stiffest, {0.5, 1}, plane));
          const Vector s0 = 0.1 * random(generator, componentsIn(plane));
          Vector strain = size * random(generator, componentsIn(plane));
          if (strain.size() == 4) strain[3] = 0;
          const Vector s = solve(*material, weight, s0, strain);
          Matrix elastic;
          Matrix rate;
          material->elasticStrain(s - s0, elastic);
          material->viscoplasticRate(Matrix(s), rate);
          EXPECT_LE((elastic + weight * rate - strain).norm(), 1e-10 * (strain.norm() + elastic.norm()));
          const Matrix moduli = linearise(*material, weight, s0, strain, s).moduli;
          for (int j = 0; j < moduli.cols(); ++j) {
            const double step = 1e-6 * strain.norm();
            const Vector more = solve(*material, weight, s0, strain + step * Vector::Unit(strain.size(), j));
            const Vector less = solve(*material, weight, s0, strain - step * Vector::Unit(strain.size(), j));
            EXPECT_LE(((more - less) / (2 * step) - moduli.col(j)).norm(), 1e-5 * moduli.norm())
                << weight << ' ' << size << ' ' << j;
          }
        }
}

TEST(Anisotropy, axesTurnedAtEveryPointAreTurnedElasticity) {
  std::mt19937 generator(3);
  const std::vector<double> angles{0.3, -1.2, 2};
  for (const Plane plane : planes) {
    const Anisotropy own = anisotropyOf(wood, plane);
    const auto isotropic = perzynaMaterial(stiffestOf(own), {0.5, 1}, plane);
    const auto material = anisotropicMaterial(own, isotropic, angles);
    const Eigen::Index n = componentsIn(plane);
    Matrix s0(n, 3);
    Matrix strain(n, 3);
    Matrix s(n, 3);
    for (int i = 0; i < 3; ++i) {
      s0.col(i) = random(generator, n);
      strain.col(i) = random(generator, n);
      s.col(i) = 2 * random(generator, n);
    }
    Linearisation all = material->room(3);
    material->linearise({0.1, s0, strain}, s, all, 0, 3);
    Matrix rates;
    material->viscoplasticRate(s, rates);
    for (int i = 0; i < 3; ++i) {
      const auto one = anisotropicMaterial(turned(own, axesAt(angles[i])), isotropic);
      const Answer expected = linearise(*one, 0.1, s0.col(i), strain.col(i), s.col(i));
      EXPECT_LE((all.predictor.col(i) - expected.predictor).norm(), 1e-11 * expected.predictor.norm());
      for (int j = 0; j < strainsOf(n); ++j)
        EXPECT_LE((stressOf(all, Vector::Unit(n, j), i) - expected.moduli.col(j)).norm(),
                  rounding * expected.moduli.norm());
      Matrix rate;
      one->viscoplasticRate(Matrix(s.col(i)), rate);
      EXPECT_LE((rates.col(i) - rate).norm(), rounding * rate.norm());
      EXPECT_NEAR(material->outOfPlane(s.col(i).head<3>(), i), one->outOfPlane(s.col(i).head<3>(), 0),
                  plane == Plane::stress ? 0 : rounding * s.norm());
    }
  }
}

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Anisotropy, whatIsNotEllipticIsRefusedWithItsEigenvalue) {
  Orthotropy wrong = wood;
  wrong.poisson[0] = 2;  // nu12^2 > E1/E2
  EXPECT_NE(messageOf([&] { anisotropyOf(wrong, Plane::stress); }).find("smallest eigenvalue"),
            std::string::npos);
  // Elliptic in the plane, not across it.
  wrong = wood;
  wrong.poisson[2] = 1.3;
  EXPECT_EQ(messageOf([&] { anisotropyOf(wrong, Plane::stress); }), "");
  EXPECT_NE(messageOf([&] { anisotropyOf(wrong, Plane::strain); }).find("expected > 0 (elliptic)"),
            std::string::npos);
  Matrix stiffness{{2, 3, 0}, {3, 2, 0}, {0, 0, 1}};
  EXPECT_EQ(messageOf([&] { anisotropyOf(stiffness, Plane::stress); }),
            "the smallest eigenvalue of the stiffness is -1 Pa, expected > 0 (elliptic)");
  stiffness(0, 1) = 0;
  EXPECT_EQ(messageOf([&] { anisotropyOf(stiffness, Plane::stress); }), "expected a symmetric matrix");
}

}  // namespace mortier::anisotropy_test
