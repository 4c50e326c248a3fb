// Orders of convergence, fitted by least squares over sequences of meshes and steps, and printed.
#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <iostream>

#include "theory/scenes.h"

namespace mortier {
namespace {

using namespace scenes;

/// A fitted order may be off by this much: the sequences are not asymptotic yet.
constexpr double orderTolerance = 0.05;

void print(const char* what, const std::vector<double>& h, const std::vector<double>& errors) {
  std::cout << what << ": order " << fittedOrder(h, errors) << ", errors";
  for (const double error : errors) std::cout << " " << error;
  std::cout << "\n";
}

/// s : E^-1 s
double complementaryEnergy(const Eigen::Vector3d& s, const Elasticity& elasticity) {
  return (s.array().square() / elasticity.moduli()).sum();
}

// 6 x 6 on 16 x 16 and its uniform refinements, nonmortar upper, elastic, stress (0, -10, 0): the stress
// error is of order one in the row of triangles along the interface whatever h is, so its energy norm falls
// as the square root of h.
TEST(Rates, interpolationLosesHalfAnOrderOnAConstantStress) {
  const Eigen::Vector3d exact = fromCartesian({0, -10, 0});
  const double known[] = {0.17202, 0.12075, 0.09835, 0.08507};
  std::vector<double> h;
  std::vector<double> errors;
  for (int refinement = 1; refinement <= 4; ++refinement) {
    const Model model = compression(6 * refinement, 16 * refinement, elasticMaterial(noteElasticity),
                                    CouplingKind::interpolation, upperBody);
    const auto [state, report] = run(model, 1, 1);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    double error = 0;
    double norm = 0;
    for (size_t b = 0; b < 2; ++b)
      for (int i = 0; i < model.bodies[b].points(); ++i) {
        error += model.bodies[b].weights()[i] *
                 complementaryEnergy(state.bodies[b].stress.col(i) - exact, noteElasticity);
        norm += model.bodies[b].weights()[i] * complementaryEnergy(exact, noteElasticity);
      }
    h.push_back(1.0 / (6 * refinement));
    errors.push_back(std::sqrt(error / norm));
    EXPECT_NEAR(errors.back(), known[refinement - 1], 0.51e-5);
  }
  print("interpolation, energy error on the elastic patch", h, errors);
  EXPECT_NEAR(fittedOrder(h, errors), 0.5, orderTolerance);
}

// Against the exact eps_22 at time 1; u2 on the top is twice that.
TEST(Rates, backwardEulerIsOfFirstOrder) {
  const std::pair<Projection, double> cases[] = {{Projection::elasticity, -0.19625029208256},
                                                 {Projection::frobenius, -0.19635531966083},
                                                 {Projection::compliance, -0.19892570562176}};
  for (const auto& [projection, eps22] : cases) {
    const Model model = compression(2, 3, perzynaMaterial(noteElasticity, noteLaw(projection)),
                                    CouplingKind::mortar, upperBody);
    std::vector<double> k;
    std::vector<double> errors;
    for (const int steps : {20, 40, 80, 160}) {
      const auto [state, report] = run(model, 1, steps);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      const Range u2 =
          displacementRange(model.bodies[0], state.bodies[0], 1, [](const Point& x) { return x.y() == 1; });
      k.push_back(1.0 / steps);
      errors.push_back(u2.distance(2 * eps22));
    }
    print("backward Euler, u2 on top", k, errors);
    EXPECT_NEAR(fittedOrder(k, errors), 1, orderTolerance);
  }
}

/// A half plane y > 0 in contact with its mirror image for x > 0 under the pressure A sqrt(x), open for x <
/// 0: with z = x + i y, Z = -A sqrt(z), Zh = -(2 A/3) z^(3/2), kappa = (3 - nu)/(1 + nu) in plane stress,
///   2 mu u_x = (kappa - 1)/2 Re Zh - y Im Z,   2 mu u_y = (kappa + 1)/2 Im Zh - y Re Z,
///   s_xx = Re Z - y Im Z',   s_yy = Re Z + y Im Z',   s_xy = -y Re Z'.
class HalfOpenContact {
 public:
  HalfOpenContact(const Elasticity& elasticity, bool mirrored)
      : elasticity_(elasticity), mirrored_(mirrored) {}

  [[nodiscard]] Point displacement(double x, double y) const {
    const double mu = elasticity_.young / (2 * (1 + elasticity_.poisson));
    const double kappa = (3 - elasticity_.poisson) / (1 + elasticity_.poisson);
    const double above = mirrored_ ? -y : y;
    const Complex z(x, above);
    const Complex Z = -std::sqrt(z);
    const Complex Zh = 2.0 / 3 * z * Z;
    const double ux = ((kappa - 1) / 2 * Zh.real() - above * Z.imag()) / (2 * mu);
    const double uy = ((kappa + 1) / 2 * Zh.imag() - above * Z.real()) / (2 * mu);
    return {ux, mirrored_ ? -uy : uy};
  }

  /// (s11, s22, s12)
  [[nodiscard]] Eigen::Vector3d stress(double x, double y) const {
    const double above = mirrored_ ? -y : y;
    const Complex z(x, above);
    const Complex Z = -std::sqrt(z);
    const Complex slope = Z / (2.0 * z);
    const double shear = -above * slope.real();
    return {Z.real() - above * slope.imag(), Z.real() + above * slope.imag(), mirrored_ ? -shear : shear};
  }

  /// The part of it that is modelled, [-0.9, 1.1] x [0, 1], loaded in proportion to time.
  [[nodiscard]] Body body(int cells) const {
    const double lower = mirrored_ ? -1 : 0;
    const auto self = *this;
    const auto traction = [self](int component, double sign) {
      return [self, component, sign](double x, double y, double t) {
        return sign * t * self.stress(x, y)[component];
      };
    };
    const auto displacement = [self](int component) {
      return
          [self, component](double x, double y, double t) { return t * self.displacement(x, y)[component]; };
    };
    const int held = mirrored_ ? bottom : top;
    return {
        mirrored_ ? "lower" : "upper",
        crissCrossMesh(
            {.lower = {-0.9, lower}, .upper = {1.1, lower + 1}, .cellsX = cells, .cellsY = (cells + 1) / 2}),
        elasticMaterial(elasticity_),
        {{{held, 0, displacement(0)}, {held, 1, displacement(1)}},
         {{right, 0, traction(0, 1)},
          {right, 1, traction(2, 1)},
          {left, 0, traction(0, -1)},
          {left, 1, traction(2, -1)}},
         {}}};
  }

  /// Energy of the stress error and of the exact stress, by four times four midpoint triangles with the three
  /// edge midpoints of each: far finer than the error that is measured.
  void addEnergies(const Body& body, const Matrix& stress, double& error, double& norm) const {
    constexpr int cuts = 4;
    for (int i = 0; i < body.points(); ++i) {
      const auto& t = body.mesh().triangles[i];
      const Point& a = body.mesh().vertices[t[0]];
      const Point u = (body.mesh().vertices[t[1]] - a) / cuts;
      const Point v = (body.mesh().vertices[t[2]] - a) / cuts;
      const double weight = body.weights()[i] / (cuts * cuts);
      const auto add = [&](double s, double r) {
        const Point x = a + s * u + r * v;
        const Eigen::Vector3d exact = fromCartesian(this->stress(x.x(), x.y()));
        error += weight * complementaryEnergy(stress.col(i) - exact, elasticity_);
        norm += weight * complementaryEnergy(exact, elasticity_);
      };
      // Centroids of the pieces.
      for (int j = 0; j < cuts; ++j)
        for (int k = 0; j + k < cuts; ++k) {
          add(j + 1.0 / 3, k + 1.0 / 3);
          if (j + k + 1 < cuts) add(j + 2.0 / 3, k + 2.0 / 3);
        }
    }
  }

 private:
  using Complex = std::complex<double>;
  Elasticity elasticity_;
  bool mirrored_;
};

TEST(Rates, mortarIsOfFirstOrderWhereContactEnds) {
  constexpr double leastOrder = 0.95;              // tends to 1
  constexpr double forceTolerance = 1e-4;          // of order h^2
  constexpr double contactForce = 0.769126488659;  // 2/3 1.1^(3/2)
  const std::array<std::pair<int, int>, 4> meshes{{{8, 12}, {16, 24}, {32, 49}, {64, 97}}};
  for (const double contrast : {1.0, 20.0})
    for (const int nonmortar : {upperBody, lowerBody}) {
      const HalfOpenContact upper({1, 0.3}, false);
      const HalfOpenContact lower({contrast, 0.2}, true);
      std::vector<double> h;
      std::vector<double> errors;
      double force = 0;
      for (const auto& [upperCells, lowerCells] : meshes) {
        const Model model =
            contactModel(upper.body(upperCells), lower.body(lowerCells), CouplingKind::mortar, nonmortar);
        const auto [state, report] = run(model, 1, 1);
        ASSERT_EQ(report.status, Status::converged) << report.reason;
        double error = 0;
        double norm = 0;
        upper.addEnergies(model.bodies[0], state.bodies[0].stress, error, norm);
        lower.addEnergies(model.bodies[1], state.bodies[1].stress, error, norm);
        h.push_back(1.0 / upperCells);
        errors.push_back(std::sqrt(error / norm));
        force = state.contactForce[0].sum();
      }
      print(nonmortar == upperBody ? "mortar, nonmortar coarse, energy error"
                                   : "mortar, nonmortar fine, energy error",
            h, errors);
      std::cout << "  contact force on the finest meshes " << force << ", exact " << contactForce << "\n";
      EXPECT_GE(fittedOrder(h, errors), leastOrder);
      EXPECT_NEAR(force, contactForce, forceTolerance);
    }
}

}  // namespace
}  // namespace mortier
