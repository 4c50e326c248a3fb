// What holds of every law in plane stress, plane strain and space.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "material/anisotropy.h"
#include "material/overstress.h"
#include "unit/one_point.h"
#include "unit/own_rate_laws.h"

namespace mortier::law_properties_test {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
using MaterialPointer = std::shared_ptr<const Material>;

struct Row {
  std::string name;
  Plane plane;
  std::function<MaterialPointer(double stress, double time)> make;  ///< in units of these sizes
  double flow = 1;            ///< rate over stress, at stresses of about 2 [1/(Pa s)]
  double exponent = 1;        ///< of the flow: by how much it enlarges rounding
  bool solvesItself = false;  ///< from any stress, undefined ones among them
  bool hasPowers = false;     ///< of what has a unit
  bool penalised = true;      ///< regularised as material.h says
};

std::vector<Row> rows() {
  constexpr double E = 100;
  constexpr double nu = 0.3;
  std::vector<Row> all;
  for (const Plane plane : {Plane::stress, Plane::strain, Plane::none}) {
    const std::string in = plane == Plane::stress   ? " in plane stress"
                           : plane == Plane::strain ? " in plane strain"
                                                    : " in space";
    const auto row = [&](const char* name, auto make, double flow, double exponent = 1, bool powers = false) {
      all.push_back({name + in, plane, make, flow, exponent, false, powers});
    };
    row(
        "elastic",
        [=](double s, double) {
          return elasticMaterial({s * E, nu}, plane);
        },
        1);
    for (const Projection projection : projections)
      row(
          "Perzyna",
          [=](double s, double t) {
            return perzynaMaterial({s * E, nu}, {s * t * 2, s, projection}, plane);
          },
          0.25);
    for (const double n : {1.0, 1.5, 3.0, 5.0, 20.0, 100.0})
      row(
          "Norton",
          [=](double s, double t) {
            return nortonMaterial({s * E, nu}, {s, 1 / t, n}, plane);
          },
          std::pow(2, n - 1), n, true);
    for (const Overstress& law : {Overstress{1.3, 0.7, 0.2, 1}, {1.3, 0.7, 0.2, 1, 20}, {1.3, 0.7, 0.2, 3.5}})
      row(
          "overstress",
          [=](double, double) {
            return overstressMaterial({E, nu}, law, plane);
          },
          0.3, law.exponent, true);
    for (const double g : {0.0, 0.4})
      row(
          "viscoelastic",
          [=](double s, double t) {
            return viscoelasticMaterial({s * E, nu}, {0.7 * t, g}, plane);
          },
          1 / (0.7 * E));
    const Anisotropy wood = anisotropyOf(Orthotropy{{E, 30, 20}, {nu, 0.2, 0.25}, {15, 12, 7}}, plane);
    row(
        "anisotropic",
        [=](double, double) {
          return anisotropicMaterial(wood, perzynaMaterial(stiffestOf(wood), {2, 1}, plane));
        },
        0.25, 1, true);
    all.back().penalised = false;
    const auto own = [&](const char* name, const auto& law, double exponent) {
      row(
          name,
          [=](double, double) {
            return ownMaterial({E, nu}, named(rateLaw(law)), plane);
          },
          1, exponent, true);
      all.back().solvesItself = true;
    };
    own("own Norton", OwnNorton{{1, 1, 5}}, 5);
    if (plane == Plane::stress) continue;
    own("own Perzyna", OwnPerzyna{{2, 1.2}}, 1);
    own("own solid", OwnSolid{{E, nu}, {0.7, 0.4}}, 1);
  }
  return all;
}

/// A step of some points: some elastic, others flowing up to far beyond yield.
struct Fields {
  Fields(const Material& material, int points, unsigned seed, double stressUnit = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto field = [&](double size) {
      return Matrix(
          Matrix::NullaryExpr(material.components(), points, [&] { return size * normal(random); }));
    };
    stress0 = stressUnit * field(0.5);
    strain0 = field(0.01);
    strain = field(0.03);
    stress = stressUnit * field(1);
    for (int i = 0; i < points; ++i) stress.col(i) *= i % 3 == 0 ? 0.1 : std::pow(10, i % 7);
    penalty = Vector::NullaryExpr(points, [&] { return std::abs(normal(random)); });
  }
  [[nodiscard]] MaterialStep step(double weight, bool anticipate = false) const {
    return {weight, stress0, strain, anticipate, &strain0};
  }
  Matrix stress0, strain0, strain, stress;
  Vector penalty;
};

void expectSame(const Linearisation& one, const Linearisation& other, double stress,
                const std::string& name) {
  EXPECT_TRUE(one.predictor == stress * other.predictor) << name;
  EXPECT_TRUE(one.moduli == stress * other.moduli) << name;
  EXPECT_TRUE(one.beyond == stress * other.beyond) << name;
}

// Points are computed in batches; none may use its neighbours, and the last batch is not full. A stress that
// is no number is told, or left for a law's own start, and changes no other point.
TEST(Laws, pointsOfABatchAreIndependent) {
  constexpr int points = 43;
  for (const Row& row : rows())
    for (const auto& [anticipate, regularised] :
         {std::pair{false, false}, std::pair{true, false}, std::pair{false, true}}) {
      const MaterialPointer material = row.make(1, 1);
      const Fields fields(*material, points, 3);
      const MaterialStep step = fields.step(0.1 / row.flow, anticipate);
      const auto at = [&](const Matrix& stress, Linearisation& result, int begin, int end) {
        return (regularised ? material->regularise(step, stress, fields.penalty, 1.5, result, begin, end)
                            : material->linearise(step, stress, result, begin, end))
            .change;
      };
      Linearisation all = material->room(points);
      const double change = at(fields.stress, all, 0, points);
      if (!regularised) {
        EXPECT_LE(std::abs(change - (all.predictor - fields.stress).cwiseAbs().maxCoeff()),
                  4 * epsilon * change)
            << row.name;
      }
      std::vector<std::pair<int, int>> alone;
      for (int i = 0; i < points; ++i) alone.emplace_back(i, i + 1);
      for (const auto& ranges :
           {std::vector{std::pair{0, 5}, std::pair{5, 21}, std::pair{21, points}}, alone}) {
        Linearisation parts = material->room(points);
        double largest = 0;
        for (const auto& [begin, end] : ranges)
          largest = std::max(largest, at(fields.stress, parts, begin, end));
        expectSame(all, parts, 1, row.name);
        EXPECT_EQ(change, largest) << row.name;
      }
      for (const double undefined : {std::nan(""), std::numeric_limits<double>::infinity()})
        for (const int where : {0, 4, points - 1})
          for (int component = 0; component < material->components() && !regularised; ++component) {
            Matrix stress = fields.stress;
            stress(component, where) = undefined;
            Linearisation result = material->room(points);
            const double told = at(stress, result, 0, points);
            EXPECT_TRUE(row.solvesItself ? result.predictor.allFinite() : !std::isfinite(told)) << row.name;
            for (Matrix Linearisation::*part :
                 {&Linearisation::predictor, &Linearisation::moduli, &Linearisation::beyond})
              if ((result.*part).size() > 0) (result.*part).col(where) = (all.*part).col(where);
            expectSame(all, result, 1, row.name);
          }
    }
}

TEST(Laws, unitsOfPowersOfTwoChangeNoBit) {
  constexpr int points = 14;
  for (const Row& row : rows())
    for (const double stress : {0x1p-37, 0x1p+20})
      for (const double time : {0x1p-11, 0x1p+17}) {
        if (row.hasPowers) continue;
        const MaterialPointer one = row.make(1, 1);
        const MaterialPointer scaled = row.make(stress, time);
        const Fields fields(*one, points, 13);
        const Fields others(*scaled, points, 13, stress);
        for (const bool anticipate : {false, true}) {
          const double weight = 0.01 / row.flow;
          Linearisation answer = one->room(points);
          Linearisation other = scaled->room(points);
          one->linearise(fields.step(weight, anticipate), fields.stress, answer, 0, points);
          scaled->linearise(others.step(time * weight, anticipate), others.stress, other, 0, points);
          expectSame(other, answer, stress, row.name);
        }
      }
}

// With relaxation 1 the t of the penalty-duality method is on the law at the strain + D^-1 (s - t).
TEST(Laws, regularisedStressIsOnTheLaw) {
  constexpr int points = 13;
  for (const Row& row : rows())
    for (const double stiffness : {1e-6, 1e-3, 1.0, 30.0, 1e3, 1e6}) {
      const bool smooth = row.name.starts_with("Norton") || row.name.starts_with("viscoelastic");
      if (!row.penalised || (stiffness > 30 && !smooth)) continue;
      const MaterialPointer material = row.make(1, 1);
      const int n = material->components();
      const double weight = stiffness / 100 / row.flow;
      Fields fields(*material, points, static_cast<unsigned>(n));
      for (int i = 0; i < points; ++i) fields.stress.col(i) *= 2 / fields.stress.col(i).norm();
      Linearisation law = material->room(points);
      const double change =
          material->regularise(fields.step(weight), fields.stress, fields.penalty, 1, law, 0, points).change;
      const Matrix& t = law.predictor;
      EXPECT_NEAR(change, (t - fields.stress).cwiseAbs().maxCoeff(), 1e-12) << row.name;
      Matrix elastic;
      Matrix unit;
      Matrix added(n, points);
      material->elasticStrain(t - fields.stress0, elastic);
      material->elasticStrain(Matrix::Identity(n, n), unit);
      for (int i = 0; i < points; ++i) {
        Matrix D(n, n);
        for (int k = 0; k < n; ++k) D.col(k) = stressOf(law, Vector::Unit(n, k), i);
        const Matrix inverse = D.inverse();
        added.col(i) = inverse * (fields.stress.col(i) - t.col(i));
        const bool penalised = row.plane == Plane::stress && row.name.starts_with("Perzyna");
        const double w = penalised ? fields.penalty[i] * weight / 4 : 0;  // D^-1 = E^-1 + w
        if (penalised || material->linear()) {
          EXPECT_LE((inverse - unit - w * Matrix::Identity(n, n)).norm(), 1e-12 * inverse.norm()) << row.name;
        }
      }
      // A rate by the total strain is that of the strain that is given, but beside a back stress.
      Matrix total = fields.strain0 + fields.strain;
      if (row.name.starts_with("overstress")) total += added;
      Matrix rate;
      material->viscoplasticRate(t, rate, &total);
      const double tolerance = stiffness > 30 ? 1e-9 : row.solvesItself ? 1e-10 : 1e-12;
      for (int i = 0; i < points; ++i) {
        const double size = (elastic.col(i) - added.col(i)).norm() + weight * rate.col(i).norm() +
                            (material->needsTotalStrain() ? 1 + weight : 1) * total.col(i).norm();
        EXPECT_LE((elastic + weight * rate - fields.strain - added).col(i).norm(),
                  tolerance * row.exponent * size)
            << row.name << ' ' << row.exponent << ", stiffness " << stiffness << ", point " << i;
      }
    }
}

}  // namespace mortier::law_properties_test
