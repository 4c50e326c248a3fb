// Bodies whose displacements are quadratic: patch tests, fitted orders, curved sides, flow.
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>
#include <random>

#include "fem/element.h"
#include "fem/error_estimate.h"
#include "material/deviatoric.h"
#include "theory/scenes.h"

namespace mortier::quadratic_test {

using namespace scenes;

constexpr int quadratic = 2;
constexpr Elasticity unit{1, 0.3};

/// u and its gradient, and the body force that holds it in equilibrium in plane stress.
struct Exact {
  std::function<Point(const Point&)> displacement;
  std::function<Eigen::Matrix2d(const Point&)> gradient;  ///< d u_i/d x_j
  std::function<Point(const Point&)> force;
};

Eigen::Vector3d stressOf(const Elasticity& elasticity, const Eigen::Matrix2d& gradient) {
  const Eigen::Vector3d strain =
      fromCartesian({gradient(0, 0), gradient(1, 1), (gradient(0, 1) + gradient(1, 0)) / 2});
  return elasticity.moduli().matrix().cwiseProduct(strain);
}

/// A square with its nodes moved at random, those of its sides along them.
TriangleMesh shaken(int cells) {
  TriangleMesh mesh = square(0, cells);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.15 / cells, 0.15 / cells);
  for (Point& x : mesh.vertices) {
    if (x.x() != 0 && x.x() != 1) x.x() += shift(random);
    if (x.y() != 0 && x.y() != 1) x.y() += shift(random);
  }
  validate(mesh);
  return mesh;
}

/// Displacements given on `sides`, in proportion to time, the force inside.
Body bodyOf(TriangleMesh mesh, const Exact& exact, const std::vector<int>& sides, int degree = quadratic) {
  Conditions conditions;
  for (const int side : sides)
    for (const int c : {0, 1})
      conditions.displacements.push_back({side, c, [exact, c](double x, double y, double t) {
                                            return t * exact.displacement({x, y})[c];
                                          }});
  for (const int c : {0, 1})
    conditions.forces.push_back({c, [exact, c](double x, double y, double) {
                                   return exact.force({x, y})[c];
                                 }});
  return {"body", std::move(mesh), elasticMaterial(unit), std::move(conditions), degree};
}

struct Errors {
  double displacement = 0;  ///< L2
  double energy = 0;        ///< energy norm of the stress
};

/// Against the exact fields, by a rule of degree 4 on every triangle; straight sides.
template <class Element>
Errors errorsOf(const Body& body, const BodyState& state, const Exact& exact) {
  const ElementNodes& nodes = body.elementNodes();
  double displacement = 0;
  double energy = 0;
  for (size_t t = 0; t < body.mesh().triangles.size(); ++t) {
    std::array<Point, Element::nodes> x;
    std::array<Point, Element::nodes> u;
    for (int a = 0; a < Element::nodes; ++a) {
      x[a] = nodes.places[nodes.of(t)[a]];
      u[a] = state.displacement.segment<2>(2 * nodes.of(t)[a]);
    }
    for (const auto& [at, toNode] : QuadraticTriangle::loadRule()) {
      double weight = 0;
      for (const double part : toNode) weight += part;
      weight *= doubleArea(body.mesh(), static_cast<int>(t)) / 2;
      const auto N = Element::shapes(at);
      const auto L = Element::stressShapes(at);
      Point place = Point::Zero();
      Point found = Point::Zero();
      for (int a = 0; a < Element::nodes; ++a) {
        place += N[a] * x[a];
        found += N[a] * u[a];
      }
      Eigen::Vector3d stress = Eigen::Vector3d::Zero();
      for (int i = 0; i < Element::points; ++i)
        stress += L[i] * state.stress.col(static_cast<Eigen::Index>(Element::points * t + i));
      displacement += weight * (found - exact.displacement(place)).squaredNorm();
      const Eigen::Vector3d e = stress - stressOf(unit, exact.gradient(place));
      energy += weight * (e.array().square() / unit.moduli()).sum();
    }
  }
  return {std::sqrt(displacement), std::sqrt(energy)};
}

Exact polynomial(const Eigen::Matrix<double, 2, 5>& c) {
  Exact exact;
  exact.displacement = [c](const Point& x) {
    Eigen::Matrix<double, 5, 1> terms;
    terms << x.x(), x.y(), x.x() * x.x(), x.x() * x.y(), x.y() * x.y();
    return Point(c * terms);
  };
  exact.gradient = [c](const Point& x) {
    Eigen::Matrix<double, 5, 2> terms;
    terms << 1, 0, 0, 1, 2 * x.x(), 0, x.y(), x.x(), 0, 2 * x.y();
    return Eigen::Matrix2d(c * terms);
  };
  // Of E/(1 - nu^2) [u_xx + nu v_xy + (1 - nu)/2 (u_yy + v_xy), ...], constant.
  exact.force = [c](const Point&) {
    const double nu = unit.poisson;
    const double k = unit.young / (1 - nu * nu);
    const double uxx = 2 * c(0, 2), uxy = c(0, 3), uyy = 2 * c(0, 4);
    const double vxx = 2 * c(1, 2), vxy = c(1, 3), vyy = 2 * c(1, 4);
    return Point(-k * (uxx + nu * vxy + (1 - nu) / 2 * (uyy + vxy)),
                 -k * (vyy + nu * uxy + (1 - nu) / 2 * (vxx + uxy)));
  };
  return exact;
}

// Linear and quadratic displacements are reproduced to rounding on any mesh.
TEST(Quadratic, patchTest) {
  constexpr double reproduced = 1e-12;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const bool linear : {true, false})
    for (const std::vector<int>& sides : {std::vector<int>{1, 2, 3, 4}}) {
      Eigen::Matrix<double, 2, 5> c =
          Eigen::Matrix<double, 2, 5>::NullaryExpr([&] { return normal(random); });
      if (linear) c.rightCols<3>().setZero();
      const Exact exact = polynomial(c);
      Model model;
      model.bodies.push_back(bodyOf(shaken(4), exact, sides));
      const auto [state, report] = run(model, 1, 1);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      const Errors errors = errorsOf<QuadraticTriangle>(model.bodies[0], state.bodies[0], exact);
      EXPECT_LE(errors.displacement, reproduced);
      EXPECT_LE(errors.energy, reproduced);
      const ErrorEstimate estimate = ErrorEstimator(model.bodies[0])(state.bodies[0].stress);
      EXPECT_LE(estimate.relative(), reproduced);
    }
}

// Constant stress from tractions on sides and rollers, viscoplastic flow included: that of one point.
TEST(Quadratic, uniformFlowIsThatOfAPoint) {
  const auto material = perzynaMaterial({100, 0.3}, {1, 1, Projection::elasticity});
  State states[2];
  for (const int degree : {1, 2}) {
    Model model;
    model.bodies.emplace_back("body", shaken(3), material,
                              Conditions{{{left, 0, constant(0)}, {bottom, 1, constant(0)}},
                                         {{top, 1, [](double, double, double t) { return -3 * t; }}},
                                         {}},
                              degree);
    const auto [state, report] = run(model, 1, 5);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    states[degree - 1] = state;
  }
  for (Eigen::Index i = 0; i < states[1].bodies[0].stress.cols(); ++i) {
    EXPECT_LE((states[1].bodies[0].stress.col(i) - states[0].bodies[0].stress.col(0)).norm(), 1e-11);
    EXPECT_LE((states[1].bodies[0].viscoplasticStrain.col(i) - states[0].bodies[0].viscoplasticStrain.col(0))
                  .norm(),
              1e-11);
  }
}

Exact smooth() {
  const double nu = unit.poisson;
  const double k = unit.young / (1 - nu * nu);
  constexpr double w = 2;
  Exact exact;
  exact.displacement = [](const Point& x) {
    return Point(std::sin(w * x.x()) * std::cos(w * x.y()), std::cos(w * x.x() + x.y()));
  };
  exact.gradient = [](const Point& x) {
    const double s = std::sin(w * x.x() + x.y());
    return Eigen::Matrix2d{
        {w * std::cos(w * x.x()) * std::cos(w * x.y()), -w * std::sin(w * x.x()) * std::sin(w * x.y())},
        {-w * s, -s}};
  };
  exact.force = [k, nu](const Point& x) {
    const double u = -w * w * std::sin(w * x.x()) * std::cos(w * x.y());  // u_xx = u_yy
    const double uxy = -w * w * std::cos(w * x.x()) * std::sin(w * x.y());
    const double c = -std::cos(w * x.x() + x.y());
    const double vxx = w * w * c, vxy = w * c, vyy = c;
    return Point(-k * (u + nu * vxy + (1 - nu) / 2 * (u + vxy)),
                 -k * (vyy + nu * uxy + (1 - nu) / 2 * (vxx + uxy)));
  };
  return exact;
}

double slope(const std::vector<double>& sizes, const std::vector<double>& errors) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]);
    const double y = std::log(errors[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const auto n = static_cast<double>(sizes.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

// A smooth solution: order degree + 1 in the displacement, degree in the energy; the recovered stress shows
// the error.
TEST(Quadratic, ordersOfASmoothSolution) {
  constexpr double scatter = 0.15;  // of fits over meshes that are not nested
  const Exact exact = smooth();
  for (const int degree : {1, 2}) {
    std::vector<double> sizes;
    std::vector<double> displacement;
    std::vector<double> energy;
    for (const int cells : {4, 8, 16}) {
      Model model;
      model.bodies.push_back(bodyOf(shaken(cells), exact, {1, 2, 3, 4}, degree));
      const auto [state, report] = run(model, 1, 1);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      const Body& body = model.bodies[0];
      const Errors errors = degree == 1 ? errorsOf<LinearTriangle>(body, state.bodies[0], exact)
                                        : errorsOf<QuadraticTriangle>(body, state.bodies[0], exact);
      const double estimate = std::sqrt(ErrorEstimator(body)(state.bodies[0].stress).error.sum());
      std::cout << "degree " << degree << ", " << cells << " cells: displacement " << errors.displacement
                << ", energy " << errors.energy << ", estimate over error " << estimate / errors.energy
                << "\n";
      EXPECT_NEAR(estimate / errors.energy, 1, 0.15);
      sizes.push_back(1.0 / cells);
      displacement.push_back(errors.displacement);
      energy.push_back(errors.energy);
    }
    std::cout << "orders " << slope(sizes, displacement) << ", " << slope(sizes, energy) << "\n";
    EXPECT_NEAR(slope(sizes, displacement), degree + 1, scatter);
    EXPECT_NEAR(slope(sizes, energy), degree, scatter);
  }
}

/// A quarter ring in plane strain under a pressure inside, rollers on its ends; its arcs known or not.
Model ring(int cells, bool curved) {
  TriangleMesh mesh = annulusMesh({.quarters = 1, .cellsAround = 2 * cells, .cellsAcross = cells}, Cut::both);
  if (curved)
    for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
      const auto& [a, b] = mesh.boundaryEdges[e];
      Point middle = (mesh.vertices[a] + mesh.vertices[b]) / 2;
      if (mesh.boundaryLabels[e] <= 2) middle *= mesh.vertices[a].norm() / middle.norm();
      mesh.edgeMiddles.push_back(middle);
    }
  Model model;
  model.bodies.emplace_back("ring", std::move(mesh), elasticMaterial({1, 0.3}, Plane::strain),
                            Conditions{{{3, alongNormal, constant(0)}, {4, alongNormal, constant(0)}},
                                       {{1, alongNormal, constant(-1)}},
                                       {}},
                            quadratic);
  return model;
}

// Lame's ring: with sides on the circles the radial displacement at the nodes is right to the third order at
// least, on polygons to the second.
TEST(Quadratic, curvedSidesCarryTheOrder) {
  const double nu = 0.3;
  const double a = 1, b = 2;
  const auto exact = [&](double r) {
    return (1 + nu) * a * a / (b * b - a * a) * ((1 - 2 * nu) * r + b * b / r);
  };
  for (const bool curved : {true, false}) {
    std::vector<double> sizes;
    std::vector<double> errors;
    for (const int cells : {2, 4, 8}) {
      const Model model = ring(cells, curved);
      const auto [state, report] = run(model, 1, 1);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      double worst = 0;
      for (int v = 0; v < static_cast<int>(model.bodies[0].mesh().vertices.size()); ++v) {
        const Point& x = model.bodies[0].mesh().vertices[v];
        const Point u = state.bodies[0].displacement.segment<2>(2 * v);
        worst = std::max(worst, (u - exact(x.norm()) * x.normalized()).norm());
      }
      sizes.push_back(1.0 / cells);
      errors.push_back(worst);
      std::cout << (curved ? "arcs, " : "polygons, ") << cells << " cells: " << worst << "\n";
    }
    if (curved)
      EXPECT_GE(slope(sizes, errors), 3);
    else
      EXPECT_NEAR(slope(sizes, errors), 2, 0.2);
  }
}

}  // namespace mortier::quadratic_test
