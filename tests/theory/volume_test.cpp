// Bodies that hardly change their volume, with the averaged volumetric strain (fem/volume_patches.h):
// Cook's membrane, Hill's tube, Prandtl's punch, the error estimate; each also without it, where they lock.
#include <gtest/gtest.h>

#include <complex>
#include <iostream>
#include <numbers>
#include <random>

#include "fem/element.h"
#include "fem/error_estimate.h"
#include "material/deviatoric.h"
#include "material/overstress.h"
#include "theory/scenes.h"

namespace mortier::volume_test {

using namespace scenes;

constexpr Elasticity rubber{1, 0.4999};

double cook(int n, Cut cut, int degree, bool averaged) {
  Model model;
  model.bodies.emplace_back(
      "membrane", quadrilateralMesh({{Point(0, 0), {48, 44}, {48, 60}, {0, 44}}, n, n}, cut),
      elasticMaterial(rubber, Plane::strain),
      Conditions{{{4, alongX, constant(0)}, {4, alongY, constant(0)}}, {{2, alongY, constant(1.0 / 16)}}, {}},
      degree, false, averaged);
  const Result result = run(model, 1, 1);
  EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
  const auto middle = [](const Point& x) { return x.x() == 48 && std::abs(x.y() - 52) < 1e-9; };
  return displacementRange(model.bodies[0], result.state.bodies[0], 1, middle).max;
}

TEST(AveragedVolume, cooksMembrane) {
  constexpr double limit = 18.515;  // both degrees tend to it
  for (const Cut cut : {Cut::rising, Cut::falling, Cut::both}) {
    const double linear = cook(16, cut, 1, true);
    const double quadratic = cook(16, cut, 2, true);
    std::cout << "Cook, nu 0.4999, 16 cells: " << linear << " (degree 1), " << quadratic << " (degree 2)\n";
    EXPECT_NEAR(linear, limit, 0.03 * limit);
    EXPECT_NEAR(quadratic, limit, 0.005 * limit);
  }
  EXPECT_LT(cook(16, Cut::rising, 1, false), 0.3 * limit);
  EXPECT_LT(cook(16, Cut::rising, 2, false), 0.98 * limit);
}

// A tube of radii 1 and 2 under inner pressure, elastic and perfectly plastic, nearly incompressible (Hill,
// The mathematical theory of plasticity, 1950, chapter V): with c the radius of the plastic part,
// p = 2k (ln c + (1 - c^2/4)/2).
struct Errors {
  double mean = 0;    ///< of the mean stress at points [k]
  double radial = 0;  ///< of the displacement of the inner side, over itself
};

Errors tube(int degree, bool aboutAxis, bool averaged, int across, int along, Cut cut, double c,
            const Elasticity& elasticity = {1000, 0.4999}) {
  const double k = 1 / std::numbers::sqrt3;
  const double p = 2 * k * (std::log(c) + (1 - c * c / 4) / 2);
  const auto material =
      overstressMaterial(elasticity, {1, 0, 1, 1, 0, 0}, aboutAxis ? Plane::axisymmetric : Plane::strain);
  Model model;
  const Function pressure = [=](double, double, double t) { return -p * t; };
  if (aboutAxis)
    model.bodies.emplace_back(
        "tube", rectangleMesh({.lower = {1, 0}, .upper = {2, 0.5}, .cellsX = across, .cellsY = along}, cut),
        material,
        Conditions{
            {{bottom, alongY, constant(0)}, {top, alongY, constant(0)}}, {{left, alongNormal, pressure}}, {}},
        degree, true, averaged);
  else
    model.bodies.emplace_back(
        "tube",
        annulusMesh({.inner = 1, .outer = 2, .quarters = 1, .cellsAround = along, .cellsAcross = across},
                    cut),
        material,
        Conditions{{{3, alongY, constant(0)}, {4, alongX, constant(0)}}, {{1, alongNormal, pressure}}, {}},
        degree, false, averaged);
  const Result result = run(model, 1, 8);
  EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
  const Body& body = model.bodies[0];
  const std::vector<Point> places = body.places();
  Errors errors;
  for (int i = 0; i < body.points(); ++i) {
    const double r = aboutAxis ? places[i].x() : places[i].norm();
    const double exact = r < c ? -p + 2 * k * std::log(r) + k : k * c * c / 4;
    const auto stress = result.state.bodies[0].stress.col(i);
    const double mean = (std::numbers::sqrt2 * stress[0] + stress[3]) / 3;
    errors.mean = std::max(errors.mean, std::abs(mean - exact) / k);
  }
  const double shear = elasticity.young / (2 * (1 + elasticity.poisson));
  const double exact = k * c * c / (2 * shear);
  for (int v = 0; v < body.nodes(); ++v) {
    const Point& x = body.elementNodes().places[v];
    const double r = aboutAxis ? x.x() : x.norm();
    if (std::abs(r - 1) > 1e-9) continue;
    const Point u = result.state.bodies[0].displacement.segment<2>(2 * v);
    errors.radial = std::max(errors.radial, std::abs((aboutAxis ? u.x() : u.norm()) / exact - 1));
  }
  return errors;
}

TEST(AveragedVolume, hillsTube) {
  for (const bool aboutAxis : {false, true})
    for (const int degree : {1, 2}) {
      const Errors pointwise = tube(degree, aboutAxis, false, 32, 16, Cut::rising, 1.5);
      const Errors averaged = tube(degree, aboutAxis, true, 32, 16, Cut::rising, 1.5);
      std::cout << (aboutAxis ? "tube about the axis" : "tube in plane strain") << ", degree " << degree
                << ", 32 x 16 cells: mean stress off by " << averaged.mean << " k (without " << pointwise.mean
                << "), inner displacement by " << averaged.radial << " (" << pointwise.radial << ")\n";
      // About the axis linear triangles see the slope of the exact one, 2 k/r, across a patch.
      EXPECT_LE(averaged.mean, aboutAxis && degree == 1 ? 0.05 : 0.02);
      EXPECT_LE(averaged.radial, degree == 1 ? 0.03 : 0.005);
      EXPECT_GE(pointwise.mean, 0.05);
      EXPECT_GE(pointwise.mean, 10 * averaged.mean);
    }
}

/// A rigid smooth punch of half width 1 on a shaken mesh: (2 + pi) sigma_Y/sqrt3.
double punch(int cells, Cut cut, int degree, bool averaged, double shaken) {
  constexpr int under = 5;
  TriangleMesh mesh =
      rectangleMesh({.lower = {0, -2}, .upper = {4, 0}, .cellsX = 4 * cells, .cellsY = 2 * cells}, cut);
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    const auto [i, j] = mesh.boundaryEdges[e];
    const Point middle = (mesh.vertices[i] + mesh.vertices[j]) / 2;
    if (mesh.boundaryLabels[e] == top && middle.x() < 1) mesh.boundaryLabels[e] = under;
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-shaken / cells, shaken / cells);
  for (Point& x : mesh.vertices)
    if (x.x() != 0 && x.x() != 4 && x.y() != -2 && x.y() != 0) x += Point(shift(random), shift(random));
  Model model;
  model.bodies.emplace_back("ground", std::move(mesh), perzynaMaterial({1000, 0.3}, {1e-4, 1}, Plane::strain),
                            Conditions{{{left, alongX, constant(0)},
                                        {right, alongX, constant(0)},
                                        {bottom, alongX, constant(0)},
                                        {bottom, alongY, constant(0)},
                                        {under, alongY, [](double, double, double t) { return -0.1 * t; }}},
                                       {},
                                       {}},
                            degree, false, averaged);
  const Body& body = model.bodies[0];
  const Result result = run(model, 1, 8);
  EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
  const Vector f = body.internalForce(result.state.bodies[0].stress);
  double force = 0;
  for (int v = 0; v < body.nodes(); ++v) {
    const Point& x = body.elementNodes().places[v];
    if (x.y() == 0 && x.x() <= 1) force -= f[2 * v + 1];
  }
  return force / ((2 + std::numbers::pi) / std::numbers::sqrt3);
}

TEST(AveragedVolume, prandtlsPunch) {
  constexpr double shaken = 0.2;
  const double linear = punch(8, Cut::rising, 1, true, shaken);
  const double quadratic = punch(8, Cut::rising, 2, true, shaken);
  const double locked = punch(8, Cut::rising, 1, false, shaken);
  std::cout << "punch, 8 cells on the half width, over the limit load: " << linear << " (degree 1), "
            << quadratic << " (degree 2), " << locked << " (pointwise, degree 1)\n";
  EXPECT_NEAR(linear, 1, 0.02);
  EXPECT_NEAR(quadratic, 1, 0.02);
  EXPECT_GE(locked, 1.2);
}

/// A field of plane strain for any Poisson's ratio (Kolosov), phi = psi = exp z:
/// 2 G u = (3 - 4 nu) phi - z conj(phi') - conj(psi).
struct Kolosov {
  Elasticity elasticity;
  [[nodiscard]] Point displacement(double x, double y) const {
    const std::complex<double> z(x, y);
    const std::complex<double> e = std::exp(z);
    const std::complex<double> u = ((3 - 4 * elasticity.poisson) * e - z * std::conj(e) - std::conj(e)) *
                                   ((1 + elasticity.poisson) / elasticity.young);
    return {u.real(), u.imag()};
  }
  /// p, q, r and s33.
  [[nodiscard]] Eigen::Vector4d stress(const Point& x) const {
    const std::complex<double> z(x.x(), x.y());
    const std::complex<double> e = std::exp(z);
    const double sum = 4 * e.real();
    const std::complex<double> difference = 2.0 * (std::conj(z) * e + e);
    Eigen::Vector4d result;
    result << sum / std::numbers::sqrt2, -difference.real() / std::numbers::sqrt2,
        difference.imag() / std::numbers::sqrt2, elasticity.poisson * sum;
    return result;
  }
};

struct Estimated {
  double error = 0;  ///< of the energy norm, over it
  double index = 0;  ///< estimate over error
};

template <class Element>
Estimated estimated(const Body& body, const Matrix& stress, const Kolosov& exact) {
  double error = 0;
  double energy = 0;
  for (size_t t = 0; t < body.mesh().triangles.size(); ++t) {
    double area = 0;
    for (int k = 0; k < Element::points; ++k) area += body.weights()[Element::points * t + k];
    for (const auto& [at, toNode] : Element::loadRule()) {
      double weight = 0;
      for (const double part : toNode) weight += part / Element::loadDivisor;
      Point x = Point::Zero();
      for (int v = 0; v < 3; ++v) x += at[v] * body.mesh().vertices[body.mesh().triangles[t][v]];
      const Matrix there = exact.stress(x);
      Matrix off = there;
      const auto L = Element::stressShapes(at);
      for (int k = 0; k < Element::points; ++k)
        off -= L[k] * stress.col(static_cast<Eigen::Index>(Element::points * t + k));
      Matrix strain(4, 1);
      body.material().elasticStrain(off, strain, 0, 1);
      error += weight * area * off.col(0).dot(strain.col(0));
      body.material().elasticStrain(there, strain, 0, 1);
      energy += weight * area * there.col(0).dot(strain.col(0));
    }
  }
  const ErrorEstimate estimate = ErrorEstimator(body)(stress);
  return {std::sqrt(error / energy), std::sqrt(estimate.error.sum() / error)};
}

Estimated estimatedOn(int cells, int degree, bool averaged, double poisson) {
  const Kolosov exact{{1, poisson}};
  TriangleMesh mesh =
      rectangleMesh({.lower = {0, 0}, .upper = {1, 1}, .cellsX = cells, .cellsY = cells}, Cut::rising);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.2 / cells, 0.2 / cells);
  for (Point& x : mesh.vertices)
    if (x.x() != 0 && x.x() != 1 && x.y() != 0 && x.y() != 1) x += Point(shift(random), shift(random));
  Conditions conditions;
  for (const int label : {1, 2, 3, 4})
    for (const int c : {0, 1})
      conditions.displacements.push_back(
          {label, c, [=](double x, double y, double) { return exact.displacement(x, y)[c]; }});
  // One side free of supports: the mean stress is determined.
  conditions.displacements.erase(conditions.displacements.begin() + 2, conditions.displacements.begin() + 4);
  for (const int c : {0, 1})
    conditions.tractions.push_back({2, c, [=](double x, double y, double) {
                                      const Eigen::Vector4d s = exact.stress({x, y});
                                      return c == 0 ? (s[0] + s[1]) / std::numbers::sqrt2
                                                    : s[2] / std::numbers::sqrt2;
                                    }});
  Model model;
  model.bodies.emplace_back("square", std::move(mesh), elasticMaterial(exact.elasticity, Plane::strain),
                            std::move(conditions), degree, false, averaged);
  const Result result = run(model, 1, 1);
  EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
  const Matrix& stress = result.state.bodies[0].stress;
  return degree == 1 ? estimated<LinearTriangle>(model.bodies[0], stress, exact)
                     : estimated<QuadraticTriangle>(model.bodies[0], stress, exact);
}

TEST(AveragedVolume, estimateIsTheErrorAndTheErrorThatOfCompressibleBodies) {
  for (const int degree : {1, 2}) {
    const Estimated compressible = estimatedOn(16, degree, false, 0.3);
    const Estimated pointwise = estimatedOn(16, degree, false, 0.4999);
    EXPECT_GE(pointwise.error, 4 * compressible.error);
    for (const double poisson : {0.3, 0.4999, 0.49999}) {
      const Estimated averaged = estimatedOn(16, degree, true, poisson);
      std::cout << "degree " << degree << ", nu " << poisson << ": error " << averaged.error
                << ", estimate over error " << averaged.index << "\n";
      EXPECT_LE(averaged.error, 1.1 * compressible.error);
      EXPECT_GE(averaged.index, 0.8);
      EXPECT_LE(averaged.index, 1.25);
    }
  }
}

// Nonmatching blocks under uniform pressure, sliding supports: the stress is exact.
TEST(AveragedVolume, patchTestAcrossContact) {
  for (const int degree : {1, 2}) {
    const auto block = [&](const char* name, double lower, int cells, const Conditions& conditions) {
      TriangleMesh mesh = rectangleMesh(
          {.lower = {0, lower}, .upper = {1, lower + 1}, .cellsX = cells, .cellsY = cells}, Cut::rising);
      std::mt19937 random(cells);
      std::uniform_real_distribution<double> shift(-0.2 / cells, 0.2 / cells);
      for (Point& x : mesh.vertices)
        if (x.x() != 0 && x.x() != 1 && x.y() != lower && x.y() != lower + 1)
          x += Point(shift(random), shift(random));
      return Body(name, std::move(mesh), elasticMaterial(rubber, Plane::strain), conditions, degree, false,
                  true);
    };
    const Model model =
        contactModel(block("upper", 0, 5, {{{left, 0, constant(0)}}, {{top, 1, constant(-0.01)}}, {}}),
                     block("lower", -1, 7, {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}}),
                     degree == 1 ? CouplingKind::mortar : CouplingKind::weighted, upperBody);
    const Result result = run(model, 1, 1);
    ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
    Eigen::Vector4d exact;
    exact << fromCartesian({0, -0.01, 0}), -0.01 * rubber.poisson;
    for (const BodyState& body : result.state.bodies)
      EXPECT_LE((body.stress.colwise() - Vector(exact)).cwiseAbs().maxCoeff(), 1e-12) << degree;
  }
}

// In plane strain a temperature linear in space strains a free body without stress in the plane. Thermal
// strains have to be averaged as well: otherwise the bulk modulus times their difference would remain.
TEST(AveragedVolume, freeThermalStrainIsNoStress) {
  for (const int degree : {1, 2})
    for (const bool averaged : {false, true}) {
      TriangleMesh mesh =
          rectangleMesh({.lower = {0, 0}, .upper = {1, 1}, .cellsX = 6, .cellsY = 6}, Cut::rising);
      Conditions conditions;
      for (const auto& [at, component] :
           {std::pair(Point(0, 0), alongX), {Point(0, 0), alongY}, {Point(1, 0), alongY}})
        conditions.displacements.push_back({0, component, constant(0), asSpacePoint(at)});
      conditions.temperature = [](double x, double, double t) { return t * x; };
      conditions.expansion =
          Matrix::Zero(4, static_cast<Eigen::Index>(mesh.triangles.size()) * (degree == 1 ? 1 : 3));
      conditions.expansion.row(0).setConstant(std::numbers::sqrt2 * 1e-3);
      conditions.expansion.row(3).setConstant(1e-3);
      Model model;
      model.bodies.emplace_back("plate", std::move(mesh), elasticMaterial(rubber, Plane::strain), conditions,
                                degree, false, averaged);
      const Result result = run(model, 1, 1);
      ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
      // s33 = -E alpha T where s11 = s22 = s12 = 0.
      double worst = 0;
      const std::vector<Point> places = model.bodies[0].places();
      for (int i = 0; i < model.bodies[0].points(); ++i)
        worst = std::max(worst, result.state.bodies[0].stress.col(i).head<3>().norm());
      std::cout << "heated, degree " << degree << (averaged ? ", averaged" : "") << ": stress in the plane "
                << worst << " of E alpha T 1e-3\n";
      EXPECT_LE(worst, degree == 2 ? 1e-12 : averaged ? 2e-4 : 2e-3);
    }
}

}  // namespace mortier::volume_test
