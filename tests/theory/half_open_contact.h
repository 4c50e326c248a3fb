// The contact of two half planes with an exact solution and a known end of contact.
#pragma once

#include <complex>

#include "fem/element.h"
#include "material/deviatoric.h"
#include "theory/scenes.h"

namespace mortier::scenes {

/// s : E^-1 s. In plane strain of an elastic body, where s33 = nu (s11 + s22), p counts E/((1+nu)(1-2 nu)).
inline double complementaryEnergy(const Eigen::Vector3d& s, const Elasticity& elasticity,
                                  Plane plane = Plane::stress) {
  Eigen::Array3d moduli = elasticity.moduli();
  if (plane == Plane::strain) moduli[0] = moduli[1] / (1 - 2 * elasticity.poisson);
  return (s.array().square() / moduli).sum();
}

/// A half plane y > 0 in contact with its mirror image for x > 0 under the pressure A sqrt(x), open for x <
/// 0: with z = x + i y, Z = -A sqrt(z), Zh = -(2 A/3) z^(3/2), kappa = (3 - nu)/(1 + nu) in plane stress
/// and 3 - 4 nu in plane strain,
///   2 mu u_x = (kappa - 1)/2 Re Zh - y Im Z,   2 mu u_y = (kappa + 1)/2 Im Zh - y Re Z,
///   s_xx = Re Z - y Im Z',   s_yy = Re Z + y Im Z',   s_xy = -y Re Z'.
class HalfOpenContact {
 public:
  HalfOpenContact(const Elasticity& elasticity, bool mirrored, Plane plane = Plane::stress)
      : elasticity_(elasticity), mirrored_(mirrored), plane_(plane) {}

  [[nodiscard]] Point displacement(double x, double y) const {
    const double mu = elasticity_.young / (2 * (1 + elasticity_.poisson));
    const double nu = elasticity_.poisson;
    const double kappa = plane_ == Plane::strain ? 3 - 4 * nu : (3 - nu) / (1 + nu);
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
  [[nodiscard]] Body body(int cells, int degree = 1) const {
    const double lower = mirrored_ ? -1 : 0;
    return body(
        crissCrossMesh(
            {.lower = {-0.9, lower}, .upper = {1.1, lower + 1}, .cellsX = cells, .cellsY = (cells + 1) / 2}),
        degree);
  }

  /// The same on a mesh of it.
  [[nodiscard]] Body body(TriangleMesh mesh, int degree = 1) const {
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
    return {mirrored_ ? "lower" : "upper",
            std::move(mesh),
            elasticMaterial(elasticity_, plane_),
            {{{held, 0, displacement(0)}, {held, 1, displacement(1)}},
             {{right, 0, traction(0, 1)},
              {right, 1, traction(2, 1)},
              {left, 0, traction(0, -1)},
              {left, 1, traction(2, -1)}},
             {}},
            degree};
  }

  /// Energy of the stress error and of the exact stress, by four times four midpoint triangles with the three
  /// edge midpoints of each: far finer than the error that is measured.
  void addEnergies(const Body& body, const Matrix& stress, double& error, double& norm) const {
    withElement(body.degree(), [&](auto element) {
      using Element = decltype(element);
      constexpr int cuts = 4;
      for (size_t t = 0; t < body.mesh().triangles.size(); ++t) {
        const auto first = static_cast<Eigen::Index>(t) * Element::points;
        double area = 0;
        for (int q = 0; q < Element::points; ++q) area += body.weights()[first + q];
        const auto add = [&](double s, double r) {
          const Barycentric at{1 - (s + r) / cuts, s / cuts, r / cuts};
          Point x = Point::Zero();
          for (int a = 0; a < 3; ++a) x += at[a] * body.mesh().vertices[body.mesh().triangles[t][a]];
          Eigen::Vector3d difference = -fromCartesian(this->stress(x.x(), x.y()));
          norm += area / (cuts * cuts) * complementaryEnergy(difference, elasticity_, plane_);
          const auto shapes = Element::stressShapes(at);
          for (int q = 0; q < Element::points; ++q)
            difference += shapes[q] * stress.col(first + q).template head<3>();
          error += area / (cuts * cuts) * complementaryEnergy(difference, elasticity_, plane_);
        };
        // Centroids of the pieces.
        for (int j = 0; j < cuts; ++j)
          for (int k = 0; j + k < cuts; ++k) {
            add(j + 1.0 / 3, k + 1.0 / 3);
            if (j + k + 1 < cuts) add(j + 2.0 / 3, k + 2.0 / 3);
          }
      }
    });
  }

 private:
  using Complex = std::complex<double>;
  Elasticity elasticity_;
  bool mirrored_;
  Plane plane_;
};

}  // namespace mortier::scenes
