// The tangent of bodies that turn about the axis x = 0 against differences of their forces, whatever the law.
#include <gtest/gtest.h>

#include <iostream>

#include "material/anisotropy.h"
#include "material/overstress.h"
#include "theory/axisymmetric.h"

namespace mortier::axisymmetric_tangent_test {

using namespace scenes;

constexpr Elasticity elasticity{200, 0.3};

/// The law at strains from rest, iterated to its stress, and its linearisation there.
struct OnLaw {
  Matrix stress;
  Linearisation law;
};

OnLaw onLaw(const Body& body, const Vector& u, double weight) {
  constexpr double rounding = 1e-14;
  const Material& material = body.material();
  TwoPartVector displacement = TwoPartVector::zero(body.dofs());
  displacement.high = u;
  const Matrix nothing = Matrix::Zero(material.components(), body.points());
  Matrix strain = nothing;
  body.strain(displacement, nullptr, strain, 0, body.points());
  OnLaw result{nothing, material.room(body.points())};
  for (int k = 0; k < 60; ++k) {
    const LawReport report = material.linearise({weight, nothing, strain, false, &nothing}, result.stress,
                                                result.law, 0, body.points());
    if (report.change <= rounding * result.stress.cwiseAbs().maxCoeff()) break;
    result.stress = result.law.predictor;
  }
  return result;
}

/// K d over equations, K symmetric and given by its lower triangle.
Vector times(const SparsePattern& K, const std::vector<double>& values, const Vector& d) {
  Vector result = Vector::Zero(K.size);
  for (int column = 0; column < K.size; ++column)
    for (int i = K.columnStart[column]; i < K.columnStart[column + 1]; ++i) {
      const int row = K.rows[i];
      result[row] += values[i] * d[column];
      if (K.symmetric && row != column) result[column] += values[i] * d[row];
    }
  return result;
}

TEST(AxisymmetricTangent, isThatOfDifferences) {
  const Anisotropy wood = turned(
      anisotropyOf(Orthotropy{{100, 30, 60}, {0.2, 0.1, 0.15}, {20}}, Plane::axisymmetric), axesAt(0.4));
  const std::shared_ptr<const Material> materials[] = {
      overstressMaterial(elasticity, {1.3, 0.7, 0.2, 1}, Plane::axisymmetric),
      overstressMaterial(elasticity, {1.3, 0.7, 0.2, 3.5, 20, 0}, Plane::axisymmetric),
      overstressMaterial(elasticity, {1.3, 0.7, 0.2, 3.5, 0, 30}, Plane::axisymmetric),
      overstressMaterial(elasticity, {1.3, 0, 1, 1, 20, 30}, Plane::axisymmetric),
      anisotropicMaterial(wood, nortonMaterial(stiffestOf(wood), {1, 0.1, 4}, Plane::axisymmetric))};
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (const auto& material : materials)
    for (const auto& [degree, averaged] : {std::pair(1, false), {2, false}, {1, true}, {2, true}}) {
      const Body body("ring", shakenSection(0, 2, 0, 1, 2, 4), material, {}, degree, true, averaged);
      Vector u(body.freeDofs());
      Vector d(body.freeDofs());
      for (double& x : u) x = 0.02 * normal(random);
      for (double& x : d) x = normal(random);
      u = body.spread(u);
      for (int decade = -5; decade <= 5; ++decade) {
        const double weight = std::pow(10.0, decade);
        std::vector<double> values;
        const OnLaw here = onLaw(body, u, weight);
        body.tangent(here.law, values);
        const Vector tangent = times(body.pattern(), values, d);
        // What the law remembers answers to strains as its stress does.
        Matrix response = Matrix::Zero(here.stress.rows(), here.stress.cols());
        body.addStressOf(body.spread(d), here.law, response, 0, body.points());
        constexpr double h = 1e-6;
        const OnLaw before = onLaw(body, u - h * body.spread(d), weight);
        const OnLaw after = onLaw(body, u + h * body.spread(d), weight);
        const Matrix change = (after.stress - before.stress) / (2 * h);
        const Vector force = body.gather(body.internalForce(change));
        worst = std::max(
            {worst, (tangent - force).norm() / force.norm(), (response - change).norm() / change.norm()});
      }
    }
  std::cout << "tangent around an axis: off differences by " << worst << "\n";
  EXPECT_LE(worst, 1e-7);
}

}  // namespace mortier::axisymmetric_tangent_test
