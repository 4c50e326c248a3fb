// Laws of one's own against the built-in ones, which they repeat, and against differences.
#include "material/own_material.h"

#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "material/interior_path.h"
#include "material/norton.h"
#include "material/rate_law.h"
#include "material/viscoelastic.h"

namespace mortier::own_material_test {

template <class Number>
Number mises(const Components<Number>& s) {
  using std::sqrt;
  return sqrt(s.c11 * s.c11 + s.c22 * s.c22 + s.c33 * s.c33 - s.c11 * s.c22 - s.c22 * s.c33 - s.c33 * s.c11 +
              3 * (s.c12 * s.c12));
}

/// factor times the deviator.
template <class Number>
Components<Number> alongDeviator(const Components<Number>& s, const Number& factor) {
  const Number mean = (s.c11 + s.c22 + s.c33) / 3;
  return {factor * (s.c11 - mean), factor * (s.c22 - mean), factor * s.c12, factor * (s.c33 - mean)};
}

struct OwnNorton {
  static constexpr bool needsTotalStrain = false;
  NortonCreep creep;
  template <class Number>
  Components<Number> rateOf(const Components<Number>& s, const Components<Number>&) const {
    using std::pow;
    const Number relative = mises(s) / creep.referenceStress;
    return alongDeviator(
        s, Number(pow(relative, creep.exponent - 1) * (1.5 * creep.referenceRate / creep.referenceStress)));
  }
};

struct OwnPerzyna {
  static constexpr bool needsTotalStrain = false;
  Viscoplasticity law;
  template <class Number>
  Components<Number> rateOf(const Components<Number>& s, const Components<Number>&) const {
    using std::max;
    return alongDeviator(
        s, Number(max(Number(1 - law.yieldStress / mises(s)), Number(0)) / (2 * law.viscosity)));
  }
};

/// In plane strain, where eps33 = 0.
struct OwnSolid {
  static constexpr bool needsTotalStrain = true;
  Elasticity elasticity;
  Viscoelasticity law;
  template <class Number>
  Components<Number> rateOf(const Components<Number>& s, const Components<Number>& e) const {
    const double g = law.relaxedFraction;
    const double shear = elasticity.young / (1 + elasticity.poisson);
    Components<Number> rate = alongDeviator(s, Number(1 / (shear * law.relaxationTime)));
    const Components<Number> still = alongDeviator(e, Number(g / law.relaxationTime));
    return {rate.c11 - still.c11, rate.c22 - still.c22, rate.c12 - still.c12, rate.c33 - still.c33};
  }
};

OwnLaw named(std::shared_ptr<const RateLaw> law) {
  OwnLaw own;
  own.name = "own";
  own.law = std::move(law);
  own.where = "here: law = \"own\"";
  return own;
}

constexpr Elasticity elasticity{200, 0.3};

struct Case {
  std::string name;
  Plane plane;
  std::shared_ptr<const Material> own;
  std::shared_ptr<const Material> builtIn;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Plane plane : {Plane::stress, Plane::strain}) {
    const std::string in = plane == Plane::stress ? " in plane stress" : " in plane strain";
    for (const double n : {1.0, 3.0, 4.7}) {
      const NortonCreep creep{1.5, 0.2, n};
      all.push_back({"Norton" + in, plane, ownMaterial(elasticity, named(rateLaw(OwnNorton{creep})), plane),
                     nortonMaterial(elasticity, creep, plane)});
    }
  }
  const Viscoelasticity maxwell{0.7, 0};
  all.push_back({"Maxwell in plane strain", Plane::strain,
                 ownMaterial(elasticity, named(rateLaw(OwnSolid{elasticity, maxwell})), Plane::strain),
                 viscoelasticMaterial(elasticity, maxwell, Plane::strain)});
  const Viscoplasticity perzyna{10, 1.2, Projection::frobenius};
  all.push_back({"Perzyna in plane strain", Plane::strain,
                 ownMaterial(elasticity, named(rateLaw(OwnPerzyna{perzyna})), Plane::strain),
                 planeStrainPerzynaMaterial(elasticity, perzyna)});
  const Viscoelasticity solid{0.7, 0.4};
  all.push_back({"standard linear solid in plane strain", Plane::strain,
                 ownMaterial(elasticity, named(rateLaw(OwnSolid{elasticity, solid})), Plane::strain),
                 viscoelasticMaterial(elasticity, solid, Plane::strain)});
  return all;
}

/// The stress of a step whose strain is given, from `stress`, and ds/dstrain as 4 x 3 or 3 x 3.
std::pair<Matrix, Matrix> solved(const Material& material, const MaterialStep& step, Matrix stress) {
  Linearisation law = material.room(1);
  for (int k = 0; k < 80; ++k) {
    material.linearise(step, stress, law, 0, 1);
    stress = law.predictor;
  }
  material.linearise(step, stress, law, 0, 1);
  Matrix moduli(material.components(), 3);
  for (int k = 0; k < 3; ++k) moduli.col(k) = stressOf(law, Vector::Unit(material.components(), k), 0);
  return {stress, moduli};
}

TEST(OwnMaterial, equalsTheBuiltInLaw) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const auto& [name, plane, own, builtIn] : cases()) {
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
        EXPECT_NEAR(own->outOfPlane({1, 2, 3}, 0), builtIn->outOfPlane({1, 2, 3}, 0), 1e-15);
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
  for (const auto& [name, plane, own, builtIn] : cases()) {
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
    Matrix rate;
    Matrix elastic;
    Matrix back;
    const Matrix total = strain0 + strain;
    own->viscoplasticRate(ours.predictor, rate, &total);
    own->elasticStrain(ours.predictor - stress0, elastic);
    own->elasticStrain(stress - ours.predictor, back);
    EXPECT_LE((elastic + 2 * rate - strain - back).norm(), 1e-10 * (strain.norm() + rate.norm())) << name;
  }
}

// Without stress von Mises' has no slope, nor the creep: the law is met there as anywhere.
TEST(OwnMaterial, aRateWithoutSlopesAtRestIsSolvedFromThere) {
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const double exponent : {1.5, 4.0, 7.3}) {
      const NortonCreep creep{1.5, 0.2, exponent};
      const auto material = ownMaterial(elasticity, named(rateLaw(OwnNorton{creep})), plane);
      const int n = material->components();
      const Matrix zero = Matrix::Zero(n, 1);
      const MaterialStep atRest{2, zero, zero, false};
      Linearisation law = material->room(1);
      EXPECT_EQ(material->linearise(atRest, zero, law, 0, 1).change, 0);
      EXPECT_EQ(law.predictor.norm(), 0);
      Matrix moduli(n, 3);
      for (int k = 0; k < 3; ++k) moduli.col(k) = stressOf(law, Vector::Unit(n, k), 0);
      const auto elastic = nortonMaterial(elasticity, creep, plane);
      Linearisation expected = elastic->room(1);
      elastic->linearise(atRest, zero, expected, 0, 1);
      for (int k = 0; k < 3; ++k)
        EXPECT_LE((moduli.col(k) - stressOf(expected, Vector::Unit(n, k), 0)).norm(), 1e-6 * moduli.norm())
            << exponent;
    }
}

// A point's answer does not depend on its neighbours, nor does anything but NaN follow from NaN.
TEST(OwnMaterial, pointsAreIndependent) {
  const auto material = ownMaterial(elasticity, named(rateLaw(OwnNorton{{1, 1, 5}})), Plane::strain);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  constexpr int points = 19;
  const auto field = [&](double size) {
    return Matrix(Matrix::NullaryExpr(4, points, [&] { return size * normal(random); }));
  };
  const Matrix stress0 = field(1);
  const Matrix strain = field(0.01);
  Matrix stress = field(3);
  stress(1, 4) = NAN;
  Linearisation together = material->room(points);
  Linearisation alone = material->room(points);
  const MaterialStep step{0.3, stress0, strain, false};
  material->linearise(step, stress, together, 0, points);
  for (int i = 0; i < points; ++i) material->linearise(step, stress, alone, i, i + 1);
  for (int i = 0; i < points; ++i) {
    EXPECT_EQ((together.predictor.col(i) - alone.predictor.col(i)).norm(), 0) << i;
    EXPECT_EQ((together.moduli.col(i) - alone.moduli.col(i)).norm(), 0) << i;
  }
  EXPECT_TRUE(together.predictor.allFinite());  // from the stress at the start of the step
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

}  // namespace mortier::own_material_test
