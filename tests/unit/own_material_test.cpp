// Laws of one's own against the built-in ones, which they repeat, and against differences.
#include "material/own_material.h"

#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "material/deviatoric.h"
#include "material/interior_path.h"
#include "unit/own_rate_laws.h"

namespace mortier::own_material_test {

constexpr Elasticity elasticity{200, 0.3};

std::shared_ptr<const Material> builtInNorton(const NortonCreep& creep, Plane plane) {
  return plane == Plane::none ? nortonMaterial(elasticity, creep, Plane::none)
                              : nortonMaterial(elasticity, creep, plane);
}

struct Case {
  std::string name;
  std::shared_ptr<const Material> own;
  std::shared_ptr<const Material> builtIn;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Plane plane : {Plane::stress, Plane::strain, Plane::none}) {
    const std::string in = plane == Plane::stress   ? " in plane stress"
                           : plane == Plane::strain ? " in plane strain"
                                                    : " in space";
    for (const double n : {1.0, 3.0, 4.7}) {
      const NortonCreep creep{1.5, 0.2, n};
      all.push_back({"Norton" + in, ownMaterial(elasticity, named(rateLaw(OwnNorton{creep})), plane),
                     builtInNorton(creep, plane)});
    }
  }
  const Viscoplasticity perzyna{10, 1.2, Projection::frobenius};
  for (const Plane plane : {Plane::strain, Plane::none}) {
    const bool space = plane == Plane::none;
    const std::string in = space ? " in space" : " in plane strain";
    all.push_back({"Perzyna" + in, ownMaterial(elasticity, named(rateLaw(OwnPerzyna{perzyna})), plane),
                   space ? perzynaMaterial(elasticity, perzyna, Plane::none)
                         : perzynaMaterial(elasticity, perzyna, Plane::strain)});
    for (const double fraction : {0.0, 0.4}) {
      const Viscoelasticity law{0.7, fraction};
      all.push_back({"solid" + in, ownMaterial(elasticity, named(rateLaw(OwnSolid{elasticity, law})), plane),
                     space ? viscoelasticMaterial(elasticity, law, Plane::none)
                           : viscoelasticMaterial(elasticity, law, plane)});
    }
  }
  return all;
}

/// By how many strains of a body the stress is differentiated.
int strainsOf(const Material& material) {
  return material.components() == 6 ? 6 : 3;
}

/// The stress of a step whose strain is given, from `stress`, and ds/dstrain, rows as of the stress.
std::pair<Matrix, Matrix> solved(const Material& material, const MaterialStep& step, Matrix stress) {
  Linearisation law = material.room(1);
  for (int k = 0; k < 80; ++k) {
    material.linearise(step, stress, law, 0, 1);
    stress = law.predictor;
  }
  material.linearise(step, stress, law, 0, 1);
  Matrix moduli(material.components(), strainsOf(material));
  for (int k = 0; k < moduli.cols(); ++k)
    moduli.col(k) = stressOf(law, Vector::Unit(material.components(), k), 0);
  return {stress, moduli};
}

TEST(OwnMaterial, equalsTheBuiltInLaw) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const auto& [name, own, builtIn] : cases()) {
    const int n = own->components();
    ASSERT_EQ(n, builtIn->components());
    const auto field = [&] { return Matrix(Matrix::NullaryExpr(n, 1, [&] { return normal(random); })); };
    for (double weight = 1e-5; weight < 2e5; weight *= 10)
      for (int trial = 0; trial < 4; ++trial) {
        const double rounding = 2e-14 * weight;  // flow beside elastic strain
        const Matrix stress0 = 2 * field();
        const Matrix strain0 = 0.02 * field();
        const Matrix strain = 0.02 * field();
        const MaterialStep step{weight, stress0, strain, false, &strain0};
        const auto [stress, moduli] = solved(*own, step, 5 * field());
        const auto [expected, expectedModuli] = solved(*builtIn, step, stress0);
        EXPECT_LE((stress - expected).norm(), (1e-11 + rounding) * expected.norm())
            << name << ", weight " << weight;
        EXPECT_LE((moduli - expectedModuli).norm(), (1e-9 + rounding) * expectedModuli.norm())
            << name << ", weight " << weight;
        Matrix rate;
        Matrix expectedRate;
        const Matrix total = strain0 + strain;
        own->viscoplasticRate(stress, rate, &total);
        builtIn->viscoplasticRate(stress, expectedRate, &total);
        EXPECT_LE((rate - expectedRate).norm(), 1e-12 * (expectedRate.norm() + stress.norm() / 200)) << name;
        if (n < 6) {
          EXPECT_NEAR(own->outOfPlane({1, 2, 3}, 0), builtIn->outOfPlane({1, 2, 3}, 0), 1e-15);
        }
      }
  }
}

// From stresses far above and below the law, for one iteration: the local solve does not depend on them.
TEST(OwnMaterial, oneIterationIsOnTheLawFromAnywhere) {
  const NortonCreep creep{1, 1, 5};
  const auto material = ownMaterial(elasticity, named(rateLaw(OwnNorton{creep})), Plane::stress);
  for (const double weight : {1e-6, 1.0, 1e6})
    for (const double size : {1e-8, 1e-3, 1.0, 1e3, 1e8})
      for (const double start : {1e-12, 1.0, 1e12}) {
        const Matrix zero = Matrix::Zero(3, 1);
        const Matrix strain = size * Eigen::Vector3d(0.3, -0.5, 0.2);
        const Matrix stress = start * Eigen::Vector3d(-0.2, 0.4, 0.9);
        Linearisation law = material->room(1);
        material->linearise({weight, zero, strain, false}, stress, law, 0, 1);
        Matrix rate;
        Matrix elastic;
        material->viscoplasticRate(law.predictor, rate);
        material->elasticStrain(law.predictor, elastic);
        EXPECT_LE((elastic + weight * rate - strain).norm(), 1e-9 * strain.norm())
            << weight << " " << size << " " << start;
      }
}

// t of the penalty-duality method is on the law at the strain + E^-1 (s - t).
TEST(OwnMaterial, regularisedLawIsMet) {
  for (const auto& [name, own, builtIn] : cases()) {
    const int n = own->components();
    const Matrix stress0 = Matrix::Constant(n, 1, 0.3);
    const Matrix strain = Vector::LinSpaced(n, -0.01, 0.02);
    const Matrix strain0 = Matrix::Constant(n, 1, 0.01);
    const Matrix stress = Vector::LinSpaced(n, 1, 3);
    const MaterialStep step{2, stress0, strain, false, &strain0};
    Linearisation ours = own->room(1);
    Linearisation theirs = builtIn->room(1);
    own->regularise(step, stress, Vector::Zero(1), 1, ours, 0, 1);
    builtIn->regularise(step, stress, Vector::Zero(1), 1, theirs, 0, 1);
    if (name.find("Perzyna") == std::string::npos) {
      EXPECT_LE((ours.predictor - theirs.predictor).norm(), 1e-11 * theirs.predictor.norm()) << name;
    }
  }
}

// Without stress von Mises' has no slope, nor the creep: the law is met there as anywhere.
TEST(OwnMaterial, aRateWithoutSlopesAtRestIsSolvedFromThere) {
  for (const Plane plane : {Plane::stress, Plane::strain, Plane::none})
    for (const double exponent : {1.5, 4.0, 7.3}) {
      const NortonCreep creep{1.5, 0.2, exponent};
      const auto material = ownMaterial(elasticity, named(rateLaw(OwnNorton{creep})), plane);
      const int n = material->components();
      const Matrix zero = Matrix::Zero(n, 1);
      const MaterialStep atRest{2, zero, zero, false};
      Linearisation law = material->room(1);
      EXPECT_EQ(material->linearise(atRest, zero, law, 0, 1).change, 0);
      EXPECT_EQ(law.predictor.norm(), 0);
      Matrix moduli(n, strainsOf(*material));
      for (int k = 0; k < moduli.cols(); ++k) moduli.col(k) = stressOf(law, Vector::Unit(n, k), 0);
      const auto elastic = builtInNorton(creep, plane);
      Linearisation expected = elastic->room(1);
      elastic->linearise(atRest, zero, expected, 0, 1);
      for (int k = 0; k < moduli.cols(); ++k)
        EXPECT_LE((moduli.col(k) - stressOf(expected, Vector::Unit(n, k), 0)).norm(), 1e-6 * moduli.norm())
            << exponent;
    }
}

/// The rate grows with one shear across the plane faster than with the other.
struct Skew {
  static constexpr bool needsTotalStrain = true;
  template <class Number>
  SpaceComponents<Number> rateOf(const SpaceComponents<Number>& s, const SpaceComponents<Number>& e) const {
    const Number size = s.c13 * s.c13 + 2 * s.c23 * s.c23 + s.c11 * s.c11 + s.c12 * s.c33;
    return {size * s.c11 - e.c13, size * s.c22 + s.c23,         size * s.c12 * 2,
            size * s.c33 - e.c22, size * s.c13 + e.c12 * s.c23, 3 * size * s.c23 - e.c33};
  }
};

// No symmetry of any kind: every component of the tangent is that of differences.
TEST(OwnMaterial, theTangentOfSixComponentsIsTheirDerivative) {
  const auto material = ownMaterial(elasticity, named(rateLaw(Skew())), Plane::none);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto field = [&](double size) {
    return Matrix(Matrix::NullaryExpr(6, 1, [&] { return size * normal(random); }));
  };
  for (const double weight : {1e-4, 1e-3, 1e-2})
    for (int trial = 0; trial < 5; ++trial) {
      const Matrix stress0 = field(1);
      const Matrix strain0 = field(0.01);
      const Matrix strain = field(0.005);
      const auto at = [&](const Matrix& of) {
        return solved(*material, {weight, stress0, of, false, &strain0}, stress0);
      };
      const auto [stress, moduli] = at(strain);
      for (int k = 0; k < 6; ++k) {
        const double h = 1e-6 * strain.norm();
        const Matrix d = h * Vector::Unit(6, k);
        const Vector difference = (at(strain + d).first - at(strain - d).first) / (2 * h);
        EXPECT_LE((difference - moduli.col(k)).norm(), 1e-6 * moduli.norm()) << weight << " " << k;
      }
    }
}

/// Flows where the stress is more than 1.
struct Jump {
  static constexpr bool needsTotalStrain = false;
  template <class Number>
  Components<Number> rateOf(const Components<Number>& s, const Components<Number>&) const {
    return alongDeviator(s, Number(mises(s) > 1 ? 1e3 : 0.0));
  }
};

// No stress is on the law: none is taken for one that is, the elastic one least of all.
TEST(OwnMaterial, aJumpIsNotTakenForASolution) {
  const auto material = ownMaterial(elasticity, named(rateLaw(Jump())), Plane::strain);
  const Matrix zero = Matrix::Zero(4, 1);
  const Matrix strain = Eigen::Vector4d(0, 0.02, 0, 0);
  Matrix stress = zero;
  Linearisation law = material->room(1);
  for (int k = 0; k < 20; ++k) {
    EXPECT_GT(material->linearise({1, zero, strain, false}, stress, law, 0, 1).change, 1e-3);
    EXPECT_GT(material->regularise({1, zero, strain, false}, stress, Vector::Zero(1), 1, law, 0, 1).change,
              1e-3);
    material->linearise({1, zero, strain, false}, stress, law, 0, 1);
    stress = law.predictor;
  }
}

struct Sinh {
  static constexpr bool needsTotalStrain = false;
  template <class Number>
  Components<Number> rateOf(const Components<Number>& s, const Components<Number>&) const {
    using std::max;
    using std::sinh;
    const Number size = mises(s);
    return alongDeviator(s, Number(sinh(size) / max(size, Number(1e-9))));
  }
};

// Stresses at which the rate is a number without a norm, at which its slopes overflow, and beyond.
TEST(OwnMaterial, oneIterationIsOnTheLawFromStressesAtWhichItsRateOverflows) {
  const auto material = ownMaterial(elasticity, named(rateLaw(Sinh())), Plane::stress);
  for (const double weight : {1e-6, 1.0, 1e6})
    for (const double size : {1e-3, 1.0, 1e3, 1e6})
      for (const double start : {300.0, 360.0, 400.0, 500.0, 700.0, 705.0, 710.0, 1e3, 1e200}) {
        const Matrix zero = Matrix::Zero(3, 1);
        const Matrix strain = size * Eigen::Vector3d(0.3, -0.5, 0.2);
        const Matrix stress = start * Eigen::Vector3d(0.1, 0.4, 0.7);
        Linearisation law = material->room(1);
        material->linearise({weight, zero, strain, false}, stress, law, 0, 1);
        Matrix rate;
        Matrix elastic;
        material->viscoplasticRate(law.predictor, rate);
        material->elasticStrain(law.predictor, elastic);
        EXPECT_LE((elastic + weight * rate - strain).norm(), 1e-9 * strain.norm())
            << weight << " " << size << " " << start;
      }
}

struct Broken {
  static constexpr bool needsTotalStrain = true;
  template <class Number>
  Components<Number> rateOf(const Components<Number>& s, const Components<Number>& e) const {
    return {s.c11 + e.c33, s.c22, s.c12, s.c33};
  }
};

TEST(OwnMaterial, rejectsARateThatIsNoNumberAtRest) {
  EXPECT_NO_THROW(ownMaterial(elasticity, named(rateLaw(Broken())), Plane::strain));
  try {
    ownMaterial(elasticity, named(rateLaw(Broken())), Plane::stress);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "here: law = \"own\", expected a rate that is a number without stress and strain, is not one "
        "in component 11 (e33 is not known in plane stress)");
  }
  OwnLaw half = named(rateLaw(Broken()));
  half.inPlaneStrain = false;
  EXPECT_THROW(ownMaterial(elasticity, half, Plane::strain), InputError);
  EXPECT_THROW(ownMaterial({-1, 0.3}, named(rateLaw(Broken())), Plane::strain), InputError);
}

TEST(OwnMaterial, aLawOfThePlaneIsNoneOfSpace) {
  EXPECT_THROW(ownMaterial(elasticity, named(rateLaw(Broken())), Plane::none), InputError);
  EXPECT_TRUE(rateLaw(OwnNorton{})->takes(6));
  EXPECT_FALSE(rateLaw(Jump())->takes(6));
  EXPECT_FALSE(rateLaw(Skew())->takes(4));
  EXPECT_THROW(ownMaterial(elasticity, named(rateLaw(Skew())), Plane::strain), InputError);
}

}  // namespace mortier::own_material_test
