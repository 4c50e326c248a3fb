// Ties: bodies that are cut and tied are one. Patch tests, rigid motions, a cut body against the whole one.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <iostream>
#include <numbers>

#include "base/error.h"
#include "material/deviatoric.h"
#include "mesh/shape.h"
#include "theory/shaken_square.h"
#include "time/mesh_error.h"

namespace mortier::tie_test {

using namespace scenes;

/// Over the stress; rounding times the condition of some hundred, for degree 2 some thousand unknowns.
constexpr double reproduced(int degree) {
  return degree == 1 ? 1e-13 : 2.5e-13;
}

using Map = std::function<Point(const Point&)>;

/// A linear displacement in the plane, in proportion to time.
struct Linear {
  Eigen::Matrix2d gradient{{0.3, -0.2}, {0.7, 0.1}};
  Elasticity elasticity{1, 0.3};

  [[nodiscard]] Function component(int c) const {
    return [row = Eigen::RowVector2d(gradient.row(c)), c](double x, double y, double t) {
      return t * (row.dot(Point(x, y)) + 0.1 * (c + 1));
    };
  }
  [[nodiscard]] Eigen::Vector3d stress() const {
    const Eigen::Matrix2d strain = (gradient + gradient.transpose()) / 2;
    const double modulus = elasticity.young / (1 - elasticity.poisson * elasticity.poisson);
    const Eigen::Matrix2d all = modulus * ((1 - elasticity.poisson) * strain +
                                           elasticity.poisson * strain.trace() * Eigen::Matrix2d::Identity());
    return fromCartesian({all(0, 0), all(1, 1), all(0, 1)});
  }
};

struct Cells {
  int upper, lower;
};

/// Two squares tied along y = 0, mapped. The displacement is prescribed on the outer sides, or on the top and
/// the bottom alone beside tractions on the sides.
struct Patch {
  Cells cells{5, 7};
  int nonmortar = upperBody;
  CouplingKind coupling = CouplingKind::mortar;
  int degree = 1;
  bool held = true;
  Map map = [](const Point& x) { return x; };
  double gap = 0;

  [[nodiscard]] Body body(const char* name, TriangleMesh mesh, int outer) const {
    const Linear field;
    for (Point& x : mesh.vertices) x = map(x);
    Conditions conditions;
    for (const int label : held ? std::vector{outer, left, right} : std::vector{outer})
      for (const int c : {0, 1}) conditions.displacements.push_back({label, c, field.component(c)});
    const Eigen::Vector3d s = toCartesian(field.stress());
    for (const int label : held ? std::vector<int>{} : std::vector{left, right})
      for (const int c : {0, 1}) {
        const Eigen::Matrix2d stress{{s[0], s[2]}, {s[2], s[1]}};
        const Point along = (map({1, 1}) - map({0, 1})).normalized();
        const double value = stress.row(c).dot(along) * (label == right ? 1 : -1);
        conditions.tractions.push_back({label, c, [=](double, double, double t) { return t * value; }});
      }
    return {name, std::move(mesh), elasticMaterial(field.elasticity), std::move(conditions), degree};
  }
  [[nodiscard]] Model model() const {
    TriangleMesh upper = shakenSquare(0, cells.upper, 1);
    for (Point& x : upper.vertices) x.y() += gap;
    Model model;
    model.bodies.push_back(body("upper", std::move(upper), top));
    model.bodies.push_back(body("lower", shakenSquare(-1, cells.lower, 2), bottom));
    const ContactSide sides[] = {{upperBody, bottom}, {lowerBody, top}};
    addTie(model, {sides[nonmortar == upperBody ? 0 : 1], sides[nonmortar == upperBody ? 1 : 0], coupling});
    return model;
  }
  [[nodiscard]] double error() const {
    const Model tied = model();
    const auto [state, report] = run(tied, 1, 1);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    double largest = 0;
    for (const BodyState& result : state.bodies)
      largest = std::max(largest, (result.stress.colwise() - Linear().stress()).cwiseAbs().maxCoeff());
    return largest / Linear().stress().norm();
  }
};

Map turned(double degrees) {
  const Eigen::Rotation2Dd turn(degrees * std::numbers::pi / 180);
  return [turn](const Point& x) { return Point(turn * x); };
}

TEST(Tie, passesThePatchTestOnLevelAndTiltedSides) {
  for (const int degree : {1, 2})
    for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::weighted})
      for (const bool held : {true, false})
        for (const int nonmortar : {upperBody, lowerBody})
          for (const double degrees : {0.0, 29.0, 90.0})
            for (const Cells& cells : {Cells{5, 7}, Cells{1, 3}, Cells{13, 4}})
              EXPECT_LE(Patch({cells, nonmortar, coupling, degree, held, turned(degrees)}).error(),
                        reproduced(degree))
                  << cells.upper << " on " << cells.lower << ", degree " << degree << ", held " << held
                  << ", nonmortar " << nonmortar << ", " << degrees << " degrees";
}

// A bent side of straight stretches on both bodies, its corners at nodes of both.
TEST(Tie, passesThePatchTestOnBrokenSides) {
  const Map broken = [](const Point& x) {
    const double lift = 0.4 * std::max(0.0, 1 - 2 * std::abs(x.x() - 0.5));
    return Point(x.x(), x.y() + lift * (1 - std::abs(x.y())));
  };
  const auto error = [&](Cells cells, int nonmortar, int degree) {
    Patch patch{cells, nonmortar, degree == 1 ? CouplingKind::mortar : CouplingKind::weighted, degree, true};
    Model model;
    const auto mesh = [&](double lowerY, int count) {
      TriangleMesh of = square(lowerY, count);
      for (Point& x : of.vertices) x = broken(x);
      validate(of);
      return of;
    };
    model.bodies.push_back(patch.body("upper", mesh(0, cells.upper), top));
    model.bodies.push_back(patch.body("lower", mesh(-1, cells.lower), bottom));
    const ContactSide sides[] = {{upperBody, bottom}, {lowerBody, top}};
    addTie(model, {sides[nonmortar], sides[1 - nonmortar], patch.coupling});
    const auto [state, report] = run(model, 1, 1);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    double largest = 0;
    for (const BodyState& result : state.bodies)
      largest = std::max(largest, (result.stress.colwise() - Linear().stress()).cwiseAbs().maxCoeff());
    return largest / Linear().stress().norm();
  };
  for (const int degree : {1, 2})
    for (const int nonmortar : {upperBody, lowerBody})
      for (const Cells& cells : {Cells{4, 6}, Cells{2, 8}})
        EXPECT_LE(error(cells, nonmortar, degree), reproduced(degree))
            << cells.upper << " on " << cells.lower << ", degree " << degree << ", nonmortar " << nonmortar;
}

// Sides that are apart, and turn: no distance strains a body that nothing loads.
TEST(Tie, turnsAsOneBodyHoweverFarApartSidesAre) {
  for (const double gap : {0.0, 1e-3, 0.2})
    for (const int degree : {1, 2})
      for (const CouplingKind coupling :
           {CouplingKind::mortar, CouplingKind::weighted, CouplingKind::interpolation}) {
        Model model;
        TriangleMesh upper = shakenSquare(0, 5, 1);
        for (Point& x : upper.vertices) x.y() += gap;
        model.bodies.emplace_back("upper", std::move(upper), elasticMaterial(Linear().elasticity),
                                  Conditions{}, degree);
        const Function alongX = [](double, double y, double t) { return -0.3 * t * y; };
        const Function alongY = [](double x, double, double t) { return 0.3 * t * x; };
        model.bodies.emplace_back("lower", shakenSquare(-1, 7, 2), elasticMaterial(Linear().elasticity),
                                  Conditions{{{bottom, 0, alongX}, {bottom, 1, alongY}}}, degree);
        addTie(model, {{upperBody, bottom}, {lowerBody, top}, coupling});
        const auto [state, report] = run(model, 1, 1);
        ASSERT_EQ(report.status, Status::converged) << report.reason;
        for (size_t b = 0; b < 2; ++b) {
          EXPECT_LE(state.bodies[b].stress.cwiseAbs().maxCoeff(), 1e-13) << gap << ", degree " << degree;
          for (int node = 0; node < model.bodies[b].nodes(); ++node) {
            const SpacePoint at = model.bodies[b].placeOfNode(node);
            EXPECT_NEAR(state.bodies[b].displacement[2 * node], -0.3 * at.y(), 1e-13);
            EXPECT_NEAR(state.bodies[b].displacement[2 * node + 1], 0.3 * at.x(), 1e-13);
          }
        }
      }
}

/// A beam from x = 0 to 4, held on the left and sheared on the right, whole or cut at some abscissae.
struct Beam {
  int cells = 8;  ///< over the height
  int degree = 1;
  std::vector<double> cuts = {};

  [[nodiscard]] Model model() const {
    Model model;
    std::vector<double> ends{0};
    ends.insert(ends.end(), cuts.begin(), cuts.end());
    ends.push_back(4);
    for (size_t k = 0; k + 1 < ends.size(); ++k) {
      Conditions conditions;
      if (k == 0)
        for (const int c : {0, 1}) conditions.displacements.push_back({left, c, constant(0)});
      if (k + 2 == ends.size()) conditions.tractions.push_back({right, 1, constant(-1)});
      const int own = k % 2 == 0 ? cells : cells + 3;
      const double length = ends[k + 1] - ends[k];
      model.bodies.emplace_back(
          "part" + std::to_string(k),
          crissCrossMesh({.lower = {ends[k], 0},
                          .upper = {ends[k + 1], 1},
                          .cellsX = std::max(2, static_cast<int>(std::lround(length * own))),
                          .cellsY = own}),
          elasticMaterial({1000, 0.3}), std::move(conditions), degree);
      if (k > 0)
        addTie(model, {{static_cast<int>(k) - 1, right},
                       {static_cast<int>(k), left},
                       degree == 1 ? CouplingKind::mortar : CouplingKind::weighted});
    }
    return model;
  }
  struct Found {
    double energy = 0, error = 0;  ///< error: estimated, squared norm
  };
  [[nodiscard]] Found found() const {
    const Model of = model();
    const auto [state, report] = run(of, 1, 1);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    Found result;
    for (const ErrorEstimate& each : MeshErrorEstimator(of)(state)) {
      result.error += each.error.sum();
      result.energy += each.energy;
    }
    for (size_t b = 0; b < of.bodies.size(); ++b) {
      Matrix strain;
      of.bodies[b].material().elasticStrain(state.bodies[b].stress, strain);
      double own = 0;
      for (int i = 0; i < of.bodies[b].points(); ++i)
        own += of.bodies[b].weights()[i] * strain.col(i).dot(state.bodies[b].stress.col(i));
      result.energy = b == 0 ? own : result.energy + own;
    }
    return result;
  }
};

// The energy of a beam under a given load differs from that of the exact solution by the square of the error.
TEST(Tie, cutBodiesEqualTheWholeOneWithinTheirEstimate) {
  for (const int degree : {1, 2}) {
    const double exact = Beam{degree == 1 ? 96 : 24, degree}.found().energy;
    const Beam::Found whole = Beam{8, degree}.found();
    for (const std::vector<double>& cuts : {std::vector{2.0}, std::vector{1.3}, std::vector{1.0, 2.5, 3.2}}) {
      const Beam::Found cut = Beam{8, degree, cuts}.found();
      std::cout << "degree " << degree << ", " << cuts.size() << " cuts: energy off by "
                << (cut.energy - exact) / exact << ", whole " << (whole.energy - exact) / exact
                << ", estimate " << cut.error / exact << "\n";
      EXPECT_LE(std::abs(cut.energy - whole.energy), cut.error);
      EXPECT_LE(std::abs(cut.energy - exact), 1.1 * std::abs(whole.energy - exact));
    }
  }
}

// Four squares around a point, each tied to its neighbours: one of the ties follows from the others there.
TEST(Tie, fourBodiesMeetInAPoint) {
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation}) {
    const Linear field;
    Model model;
    const std::array<Point, 4> corners{Point(-1, -1), Point(0, -1), Point(0, 0), Point(-1, 0)};
    const std::array<int, 4> cells{4, 4, 4, 4};
    const std::array<std::array<int, 2>, 4> outer{
        {{bottom, left}, {bottom, right}, {top, right}, {top, left}}};
    for (size_t k = 0; k < 4; ++k) {
      Conditions conditions;
      for (const int label : outer[k])
        for (const int c : {0, 1}) conditions.displacements.push_back({label, c, field.component(c)});
      model.bodies.emplace_back("quarter" + std::to_string(k),
                                crissCrossMesh({.lower = corners[k],
                                                .upper = corners[k] + Point(1, 1),
                                                .cellsX = cells[k],
                                                .cellsY = cells[k]}),
                                elasticMaterial(field.elasticity), std::move(conditions));
    }
    addTie(model, {{0, right}, {1, left}, coupling});
    addTie(model, {{1, top}, {2, bottom}, coupling});
    addTie(model, {{2, left}, {3, right}, coupling});
    addTie(model, {{3, bottom}, {0, top}, coupling});
    const auto [state, report] = run(model, 1, 1);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    for (const BodyState& body : state.bodies)
      EXPECT_LE((body.stress.colwise() - field.stress()).cwiseAbs().maxCoeff(),
                1e-12 * field.stress().norm());
  }
}

// Two squares that are tied side by side and rest on a third one by contact: no support holds them.
TEST(Tie, tiedBodiesRestOnContact) {
  Model model;
  const auto elastic = elasticMaterial({1000, 0.3});
  const auto mesh = [](Point lower, Point upper, int cells) {
    return crissCrossMesh({.lower = lower, .upper = upper, .cellsX = cells, .cellsY = cells});
  };
  const auto load = [](double value) { return [value](double, double, double t) { return value * t; }; };
  model.bodies.emplace_back("left", mesh({0, 0}, {1, 1}, 5), elastic, Conditions{{}, {{top, 1, load(-1)}}});
  model.bodies.emplace_back("right", mesh({1, 0}, {2, 1}, 7), elastic, Conditions{{}, {{top, 1, load(-1)}}});
  model.bodies.emplace_back("base", mesh({0, -1}, {2, 0}, 6), elastic,
                            Conditions{{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}});
  // Friction holds them along the base.
  InterfaceOptions rough;
  rough.friction.coefficient = 0.5;
  addInterface(model, {{0, bottom}, {2, top}}, rough);
  addInterface(model, {{1, bottom}, {2, top}}, rough);
  addTie(model, {{0, right}, {1, left}});
  const auto [state, report] = run(model, 1, 2);
  ASSERT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_NEAR(state.contactForce[0].sum() + state.contactForce[1].sum(), 2, 1e-12);
  EXPECT_NEAR(state.contactForce[0].sum(), state.contactForce[1].sum(), 0.02);
  EXPECT_LE(report.worst.forceBalance, balanceTolerance);
}

// In space.

enum : int { below = 1, toRight, above, toLeft, front, behind };

struct SpacePatch {
  int degree = 1;
  CouplingKind coupling = CouplingKind::weighted;
  bool upperNonmortar = true;
  bool held = true;
  double degrees = 0;
  double gap = 0;

  [[nodiscard]] double error() const {
    const Elasticity elasticity{1, 0.3};
    Eigen::Matrix3d gradient{{0.3, -0.2, 0.1}, {0.7, 0.1, 0.4}, {-0.3, 0.2, -0.2}};
    const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
    const double twice = elasticity.young / (1 + elasticity.poisson);
    const double lame = twice * elasticity.poisson / (1 - 2 * elasticity.poisson);
    const Eigen::Matrix3d stress = twice * strain + lame * strain.trace() * Eigen::Matrix3d::Identity();
    const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180, SpacePoint(1, 2, 3).normalized());
    Model model;
    const auto add = [&](const char* name, SpacePoint lower, std::array<int, 3> cells, int outer) {
      TetrahedronMesh mesh = cuboidMesh({lower, lower + SpacePoint(1, 1, 1), cells});
      for (SpacePoint& x : mesh.vertices) x = turn * x;
      Conditions conditions;
      const std::vector<int> sides{toLeft, toRight, front, behind};
      std::vector<int> fixed{outer};
      if (held) fixed.insert(fixed.end(), sides.begin(), sides.end());
      for (const int label : fixed)
        for (const int c : {0, 1, 2})
          conditions.displacements.push_back({label, c, [=](const SpacePoint& x, double t) {
                                                return t * (gradient.row(c).dot(x) + 0.1 * c);
                                              }});
      for (const int label : held ? std::vector<int>{} : sides) {
        const SpacePoint n = turn * (label == toLeft    ? SpacePoint(-1, 0, 0)
                                     : label == toRight ? SpacePoint(1, 0, 0)
                                     : label == front   ? SpacePoint(0, -1, 0)
                                                        : SpacePoint(0, 1, 0));
        for (const int c : {0, 1, 2})
          conditions.tractions.push_back(
              {label, c, [value = stress.row(c).dot(n)](const SpacePoint&, double t) { return t * value; }});
      }
      model.bodies.emplace_back(name, std::move(mesh), elasticMaterial(elasticity, Plane::none),
                                std::move(conditions), degree);
    };
    add("upper", {0, 0, gap}, {4, 3, 2}, above);
    add("lower", {0, 0, -1}, {5, 4, 3}, below);
    const ContactSide sides[] = {{0, below}, {1, above}};
    addTie(model, {sides[upperNonmortar ? 0 : 1], sides[upperNonmortar ? 1 : 0], coupling});
    const auto [state, report] = run(model, 1, 1);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    double largest = 0;
    const Vector exact = fromSpaceCartesian(
        {stress(0, 0), stress(1, 1), stress(2, 2), stress(0, 1), stress(0, 2), stress(1, 2)});
    for (const BodyState& body : state.bodies)
      largest = std::max(largest, (body.stress.colwise() - exact).cwiseAbs().maxCoeff());
    return largest / exact.norm();
  }
};

TEST(Tie, passesThePatchTestInSpace) {
  for (const int degree : {1, 2})
    for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::weighted})
      for (const bool held : {true, false})
        for (const bool upper : {true, false})
          for (const double degrees : {0.0, 29.0})
            EXPECT_LE(SpacePatch({degree, coupling, upper, held, degrees}).error(), reproduced(2))
                << "degree " << degree << ", held " << held << ", upper " << upper << ", " << degrees;
}

}  // namespace mortier::tie_test
