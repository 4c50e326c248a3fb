// Single bodies that turn about the axis x = 0: uniform states, Lame's sphere, a tube that flows.
#include "theory/axisymmetric.h"

#include <gtest/gtest.h>

#include <iostream>

#include "base/error.h"
#include "fem/rigid_modes.h"

namespace mortier::axisymmetric_test {

using namespace scenes;

constexpr double young = 100;
constexpr double poisson = 0.3;
constexpr double reproduced = 1e-12;

/// u = (c r, d z) with the stresses of that on the sides of a section.
struct Uniform {
  double c;
  double d;
  [[nodiscard]] double sum() const {
    return young / (1 + poisson) / (1 - 2 * poisson) * poisson * (2 * c + d);
  }
  [[nodiscard]] double across() const { return sum() + young / (1 + poisson) * c; }
  [[nodiscard]] double along() const { return sum() + young / (1 + poisson) * d; }
};

Model section(const Uniform& state, double inner, int degree) {
  constexpr double outer = 2;
  const auto growing = [](double value) { return [value](double, double, double t) { return value * t; }; };
  Model model;
  model.bodies.emplace_back(
      "ring", shakenSection(inner, outer, -1, 2, 5, 7), elasticMaterial({young, poisson}, Plane::strain),
      Conditions{{{bottom, alongY, [state](double, double y, double t) { return state.d * y * t; }}},
                 {{right, alongX, growing(state.across())},
                  {left, alongX, growing(-state.across())},
                  {top, alongY, growing(state.along())}},
                 {}},
      degree, true);
  return model;
}

TEST(Axisymmetric, uniformStatesAreExact) {
  double worst = 0;
  for (const int degree : {1, 2})
    for (const double inner : {0.0, 1e-3, 1.0})
      for (const Uniform& uniform : {Uniform{1e-3, 0}, Uniform{0, 1e-3}, Uniform{2e-3, -3e-3}}) {
        const Model model = section(uniform, inner, degree);
        const auto [state, report] = run(model, 1, 1);
        ASSERT_EQ(report.status, Status::converged) << report.reason;
        EXPECT_LE(report.iterations, 1);
        worst = std::max(worst,
                         errorOfUniform(state.bodies[0].stress,
                                        ringStress(uniform.across(), uniform.along(), 0, uniform.across())));
        const Body& body = model.bodies[0];
        for (int v = 0; v < body.nodes(); ++v) {
          const Point& x = body.elementNodes().places[v];
          worst = std::max(worst, (state.bodies[0].displacement.segment<2>(2 * v) -
                                   Point(uniform.c * x.x(), uniform.d * x.y()))
                                          .norm() /
                                      1e-3);
        }
        // The whole ring: volume, energy, and what its supports exert.
        double volume = 0;
        for (const double weight : body.weights()) volume += weight;
        const double exact = pi * (4 - inner * inner) * 2;
        EXPECT_NEAR(volume, exact, 1e-13 * exact);
        Quantity reaction{"", Quantity::Kind::reaction, 0, bottom, Quantity::Component::y};
        const double force = evaluate({reaction}, model, state)[0];
        EXPECT_NEAR(force, -uniform.along() * exact / 2, 1e-11 * exact);
        Quantity energy{"", Quantity::Kind::storedEnergy, 0};
        const double stored = (2 * uniform.across() * uniform.c + uniform.along() * uniform.d) / 2 * exact;
        EXPECT_NEAR(evaluate({energy}, model, state)[0], stored, 1e-11 * stored);
      }
  std::cout << "uniform states: error at most " << worst << "\n";
  EXPECT_LE(worst, reproduced);
}

TEST(Axisymmetric, nothingButTheMotionAlongTheAxisIsFree) {
  for (const double inner : {0.0, 1.0})
    for (const int degree : {1, 2}) {
      const Body body("ring", shakenSection(inner, 2, 0, 1, 2, 3), elasticMaterial({1, 0.3}, Plane::strain),
                      {}, degree, true);
      const Matrix modes = rigidModes(body);
      ASSERT_EQ(modes.cols(), 1);
      EXPECT_EQ(describeRigidMotion(body, modes.col(0)), "translation along (0, 1)");
    }
}

TEST(Axisymmetric, meshesBeyondTheAxisAreRefused) {
  TriangleMesh mesh = square(0, 2);
  for (Point& x : mesh.vertices) x.x() -= 1e-15;  // rounding
  const auto material = elasticMaterial({1, 0.3}, Plane::strain);
  EXPECT_NO_THROW(Body("ring", mesh, material, {}, 1, true));
  for (Point& x : mesh.vertices) x.x() -= 0.5;
  EXPECT_THROW(Body("ring", mesh, material, {}, 1, true), InputError);
}

/// The mean error of the displacement over the volume, by its values at the vertices, over the mean
/// displacement.
template <class Exact>
double displacementError(const Body& body, const Vector& u, Exact exact) {
  double error = 0;
  double size = 0;
  for (size_t i = 0; i < body.weights().size(); ++i)
    for (const int v : body.mesh().triangles[i * body.mesh().triangles.size() / body.weights().size()]) {
      const Point there = exact(body.mesh().vertices[v]);
      error += body.weights()[i] * (u.segment<2>(2 * v) - there).squaredNorm();
      size += body.weights()[i] * there.squaredNorm();
    }
  return std::sqrt(error / size);
}

struct Orders {
  int degree;
  double least;
  double last;  ///< error of the finest mesh, at most
};

// u = p a^3/(b^3 - a^3) ((1 - 2 nu)/E R + (1 + nu)/(2 E) b^3/R^2): a quarter of the section, whose side on
// the axis is held by itself.
TEST(Axisymmetric, lamesSphere) {
  const auto exact = [](const Point& x) {
    const double R = x.norm();
    return Point(((1 - 2 * poisson) * R + (1 + poisson) / 2 * 8 / (R * R)) / young / 7 * x / R);
  };
  for (const Orders& orders : {Orders{1, 1.9, 2e-3}, Orders{2, 2.9, 1e-5}}) {
    std::vector<double> h;
    std::vector<double> errors;
    for (const int cells : {4, 8, 16}) {
      TriangleMesh mesh =
          annulusMesh({.quarters = 1, .cellsAround = 2 * cells, .cellsAcross = cells}, Cut::both);
      if (orders.degree == 2)
        for (const auto& [a, b] : mesh.boundaryEdges) {
          const Point& x = mesh.vertices[a];
          const Point& y = mesh.vertices[b];
          const bool circle = std::abs(x.norm() - y.norm()) < 1e-9 * x.norm();
          mesh.edgeMiddles.emplace_back(circle ? Point((x + y).normalized() * x.norm())
                                               : Point::Constant(NAN));
        }
      Model model;
      model.bodies.emplace_back("sphere", std::move(mesh), elasticMaterial({young, poisson}, Plane::strain),
                                Conditions{{{3, alongY, constant(0)}}, {{1, alongNormal, constant(-1)}}, {}},
                                orders.degree, true);
      const auto [state, report] = run(model, 1, 1);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      h.push_back(1.0 / cells);
      errors.push_back(displacementError(model.bodies[0], state.bodies[0].displacement, exact));
    }
    std::cout << "Lame's sphere, degree " << orders.degree << ": errors " << errors[0] << " " << errors[1]
              << " " << errors[2] << ", order " << fittedOrder(h, errors) << "\n";
    EXPECT_GE(fittedOrder(h, errors), orders.least);
    EXPECT_LE(errors.back(), orders.last);
  }
}

// Steady flow of a tube under inner pressure, between plates, as in plane strain.
TEST(Axisymmetric, tubeCreepsAtTheKnownRate) {
  constexpr double viscosity = 10;
  constexpr double yieldStress = 1;
  constexpr double pressure = 1.2;
  const double limit = 2 / std::numbers::sqrt3 * yieldStress * std::log(2);
  const double exact = (pressure - limit) / (2 * viscosity * (1 - 0.25));
  const double time = 1e5 * 2 * viscosity / young;
  std::vector<double> h;
  std::vector<double> errors;
  for (const int cells : {4, 8, 16}) {
    Model model;
    model.bodies.emplace_back(
        "tube",
        rectangleMesh({.lower = {1, 0}, .upper = {2, 0.25}, .cellsX = cells, .cellsY = cells / 4}, Cut::both),
        perzynaMaterial({young, poisson}, {viscosity, yieldStress}, Plane::strain),
        Conditions{{{bottom, alongY, constant(0)}, {top, alongY, constant(0)}},
                   {{left, alongNormal, constant(-pressure)}},
                   {}},
        1, true);
    const Result half = run(model, time / 2, 2);
    const Result whole = run(model, time, 4);
    ASSERT_EQ(whole.report.status, Status::converged) << whole.report.reason;
    const Vector rate = (whole.state.bodies[0].displacement - half.state.bodies[0].displacement) / (time / 2);
    double inner = 0;
    for (int v = 0; v < model.bodies[0].nodes(); ++v)
      if (model.bodies[0].mesh().vertices[v].x() == 1) inner = std::max(inner, rate[2 * v]);
    h.push_back(1.0 / cells);
    errors.push_back(std::abs(inner / exact - 1));
  }
  std::cout << "a tube that creeps: errors of the rate " << errors[0] << " " << errors[1] << " " << errors[2]
            << ", order " << fittedOrder(h, errors) << "\n";
  EXPECT_GE(fittedOrder(h, errors), 1.8);
  EXPECT_LE(errors.back(), 5e-3);
}

}  // namespace mortier::axisymmetric_test
