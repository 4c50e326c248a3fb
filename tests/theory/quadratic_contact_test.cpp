// Contact of bodies whose displacements are quadratic: patch tests, linear pressures, the note's test, a
// known end of contact, curves.
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "material/perzyna.h"
#include "theory/half_open_contact.h"
#include "theory/shaken_square.h"

namespace mortier::quadratic_contact_test {

using namespace scenes;

constexpr int quadratic = 2;
constexpr CouplingKind kinds[] = {CouplingKind::mortar, CouplingKind::weighted};

/// The stress s22 = -(1 + slope x) and nothing else, turned by an angle: pressure on y = 0 that is linear
/// along it, where u2 = 0 whatever the stiffness.
struct LinearPressure {
  double slope = 0;
  double degrees = 0;
  int degree = quadratic;

  [[nodiscard]] Eigen::Matrix2d turn() const {
    const double angle = degrees * std::numbers::pi / 180;
    return Eigen::Matrix2d{{std::cos(angle), -std::sin(angle)}, {std::sin(angle), std::cos(angle)}};
  }
  [[nodiscard]] Point displacement(const Point& x, const Elasticity& elasticity) const {
    const Point local = turn().transpose() * x;
    const double along = local.x();
    const double y = local.y();
    const double u1 = elasticity.poisson * (along + slope * along * along / 2) + slope * y * y / 2;
    return turn() * Point(u1, -(1 + slope * along) * y) / elasticity.young;
  }
  [[nodiscard]] Eigen::Vector3d stress(const Point& x) const {
    const double pressure = 1 + slope * (turn().transpose() * x).x();
    const Eigen::Matrix2d s = turn() * Eigen::Vector2d(0, -pressure).asDiagonal() * turn().transpose();
    return fromCartesian({s(0, 0), s(1, 1), s(0, 1)});
  }
  [[nodiscard]] Body body(const char* name, TriangleMesh mesh, const Elasticity& elasticity, int held) const {
    for (Point& x : mesh.vertices) x = turn() * x;
    Conditions conditions;
    for (const int c : {0, 1})
      conditions.displacements.push_back({held, c, [*this, elasticity, c](double x, double y, double t) {
                                            return t * displacement({x, y}, elasticity)[c];
                                          }});
    return {name, std::move(mesh), elasticMaterial(elasticity), std::move(conditions), degree};
  }
  /// The largest error of a stress component at any point, and of a nodal pressure,
  /// over the largest pressure.
  [[nodiscard]] double error(int upperCells, int lowerCells, double contrast, const Rows& coupling,
                             int nonmortar) const {
    InterfaceOptions options;
    coupling.set(options, 1);
    const Model model = contactModel(body("upper", shakenSquare(0, upperCells, 1), {1, 0.3}, top),
                                     body("lower", shakenSquare(-1, lowerCells, 2), {contrast, 0.2}, bottom),
                                     coupling, nonmortar, options);
    const auto [state, report] = run(model, 1, 1);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    double largest = 0;
    for (size_t b = 0; b < 2; ++b) {
      const std::vector<Point> places = model.bodies[b].places();
      for (size_t i = 0; i < places.size(); ++i)
        largest =
            std::max(largest, (state.bodies[b].stress.col(static_cast<Eigen::Index>(i)) - stress(places[i]))
                                  .cwiseAbs()
                                  .maxCoeff());
    }
    const ContactInterface& interface = model.interfaces[0];
    const Vector pressure = interface.contactPressure(state.contactForce[0]);
    for (int i = 0; i < interface.rows(); ++i) {
      const Point& x = model.bodies[nonmortar].elementNodes().places[interface.nonmortarNodes()[i]];
      largest = std::max(largest, std::abs(pressure[i] - 1 - slope * (turn().transpose() * x).x()));
    }
    return largest / (1 + slope);
  }
};

constexpr std::array<std::array<int, 2>, 4> counts{{{5, 7}, {7, 5}, {4, 13}, {1, 3}}};

TEST(QuadraticContact, constantPressureIsExact) {
  constexpr double reproduced = 1e-12;
  for (const Rows& kind : meanRows)
    for (const int degree : {1, quadratic}) {
      double worst = 0;
      for (const auto& [upper, lower] : counts)
        for (const int nonmortar : {upperBody, lowerBody})
          for (const double turned : {0.0, 37.0}) {
            const LinearPressure patch{0, turned, degree};
            worst = std::max(worst, patch.error(upper, lower, 1, kind, nonmortar));
          }
      std::cout << wordOf(kind) << ", degree " << degree << ": constant stress, error at most " << worst
                << "\n";
      EXPECT_LE(worst, reproduced) << wordOf(kind) << ", degree " << degree;
    }
}

TEST(QuadraticContact, linearPressureIsExact) {
  constexpr double reproduced = 1e-11;
  for (const CouplingKind kind : kinds) {  // of stabilised ones uniform pressures are exact
    double worst = 0;
    for (const auto& [upper, lower] : counts)
      for (const int nonmortar : {upperBody, lowerBody})
        for (const double turned : {0.0, 37.0})
          for (const double contrast : {1.0, 100.0})
            worst = std::max(worst, LinearPressure{2, turned}.error(upper, lower, contrast, kind, nonmortar));
    std::cout << wordOf(kind) << ": linear stress, error at most " << worst << "\n";
    EXPECT_LE(worst, reproduced) << wordOf(kind);
  }
  // Interpolation has no such stress, as with linear traces.
  EXPECT_GE(LinearPressure({2, 0}).error(5, 7, 1, CouplingKind::interpolation, upperBody), 1e-3);
}

// The stress stays uniform, whatever flows.
TEST(QuadraticContact, notesTestIsExact) {
  constexpr double reproduced = 1e-9;
  const Function load = [](double, double, double t) { return -10 * t; };
  for (const CouplingKind kind : kinds)
    for (const Projection projection : {Projection::elasticity, Projection::frobenius}) {
      const auto material = perzynaMaterial(noteElasticity, noteLaw(projection));
      Body upper("upper", square(0, 4), material, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}},
                 quadratic);
      Body lower("lower", square(-1, 6), material,
                 {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}}, quadratic);
      const Model model = contactModel(std::move(upper), std::move(lower), kind, upperBody);
      const auto [state, report] = run(model, 1, 10);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      EXPECT_LE(vonMisesRange(state).distance(10), 10 * reproduced) << wordOf(kind);
      EXPECT_LE(interpenetration(model, state),
                reproduced * state.bodies[0].displacement.cwiseAbs().maxCoeff());
    }
}

/// Energy errors of the contact with a known end, of both bodies together.
struct KnownEnd {
  double error = 0;
  double unknowns = 0;
  double leastPressure = 0;
};

KnownEnd knownEnd(int cells, int degree, CouplingKind kind, int nonmortar, double contrast) {
  const HalfOpenContact above({1, 0.3}, false);
  const HalfOpenContact below({contrast, 0.2}, true);
  const Model model =
      contactModel(above.body(cells, degree), below.body(3 * cells / 2 + 1, degree), kind, nonmortar);
  const auto [state, report] = run(model, 1, 1);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  KnownEnd result;
  double error = 0;
  double norm = 0;
  above.addEnergies(model.bodies[0], state.bodies[0].stress, error, norm);
  below.addEnergies(model.bodies[1], state.bodies[1].stress, error, norm);
  result.error = std::sqrt(error / norm);
  for (const Body& body : model.bodies) result.unknowns += body.freeDofs();
  const Vector pressure = model.interfaces[0].contactPressure(state.contactForce[0]);
  result.leastPressure = pressure.minCoeff() / pressure.maxCoeff();
  return result;
}

TEST(QuadraticContact, knownEndIsOfHigherOrder) {
  constexpr double leastOrder = 0.6;  // in unknowns; 3/4 by theory
  for (const CouplingKind kind : kinds)
    for (const int nonmortar : {upperBody, lowerBody})
      for (const double contrast : {1.0, 1e3}) {
        std::vector<double> size;
        std::vector<double> error;
        for (const int cells : {8, 12, 16, 24, 32}) {
          const KnownEnd solved = knownEnd(cells, quadratic, kind, nonmortar, contrast);
          size.push_back(1 / solved.unknowns);
          error.push_back(solved.error);
          EXPECT_GE(solved.leastPressure, kind == CouplingKind::weighted ? 0 : -1);
        }
        std::cout << wordOf(kind) << ", nonmortar " << (nonmortar == upperBody ? "coarse" : "fine")
                  << ", contrast " << contrast << ": order in unknowns " << fittedOrder(size, error) << ", "
                  << 1 / size.back() << " unknowns, error " << error.back() << "\n";
        EXPECT_GE(fittedOrder(size, error), leastOrder)
            << wordOf(kind) << " " << nonmortar << " " << contrast;
      }
}

// ---- Shrink fit of two rings whose edges do not match, after Lame

enum class Edges { straight, bent };

/// Middles of the edges on circles about the origin.
void bend(TriangleMesh& mesh) {
  for (const auto& [a, b] : mesh.boundaryEdges) {
    const Point& x = mesh.vertices[a];
    const Point& y = mesh.vertices[b];
    const bool circle = std::abs(x.norm() - y.norm()) < 1e-9 * x.norm();
    mesh.edgeMiddles.emplace_back(circle ? Point((x + y).normalized() * x.norm()) : Point::Constant(NAN));
  }
}

struct Fit {
  double pressure = 0;  ///< largest error of a nodal pressure, over Lame's
  double balance = 0;   ///< forces and moments of contact on both bodies, over the resultant
};

/// A quarter of a ring of radii 10 and 20 in one of radii 20 and 40; the interference is small beside them.
Fit shrinkFit(int cells, int degree, Edges edges, const Rows& kind, bool shaftNonmortar) {
  constexpr int innerCircle = 1;
  constexpr int outerCircle = 2;
  constexpr Elasticity steel{2.1e5, 0.3};
  constexpr double interference = 5e-6;
  const Conditions symmetry{{{3, 1, constant(0)}, {4, 0, constant(0)}}, {}, {}};
  const auto ring = [&](const char* name, double inner, double outer, int around, int across) {
    TriangleMesh mesh = annulusMesh(
        {.inner = inner, .outer = outer, .quarters = 1, .cellsAround = around, .cellsAcross = across},
        Cut::both);
    if (edges == Edges::bent) bend(mesh);
    return Body(name, std::move(mesh), elasticMaterial(steel), symmetry, degree);
  };
  Model model;
  model.bodies.push_back(ring("shaft", 10, 20 + interference, cells, (cells + 1) / 2));
  model.bodies.push_back(ring("hub", 20, 40, (4 * cells + 2) / 5, (cells + 1) / 2));
  const ContactSide shaft{0, outerCircle};
  const ContactSide hub{1, innerCircle};
  InterfaceOptions options;
  kind.set(options, 1 / steel.young);
  addInterface(model, {shaftNonmortar ? shaft : hub, shaftNonmortar ? hub : shaft, kind}, options);
  const auto [state, report] = run(model, 1, 1);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  const double lame =
      interference * steel.young / 20 / ((1600.0 + 400) / (1600 - 400) + (400.0 + 100) / (400 - 100));
  const ContactInterface& interface = model.interfaces[0];
  const Vector& p = state.contactForce[0];
  Fit fit;
  fit.pressure = (interface.contactPressure(p).array() / lame - 1).abs().maxCoeff();
  std::array<Vector, 2> forces{Vector::Zero(model.bodies[0].dofs()), Vector::Zero(model.bodies[1].dofs())};
  interface.subtractForces(p, forces[shaftNonmortar ? 0 : 1], forces[shaftNonmortar ? 1 : 0]);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int b = 0; b < 2; ++b)
    for (int node = 0; node < model.bodies[b].nodes(); ++node) {
      const Point& x = model.bodies[b].elementNodes().places[node];
      const Point f = forces[b].segment<2>(2 * node);
      sum += Eigen::Vector3d(f.x(), f.y(), (x.x() * f.y() - x.y() * f.x()) / 20);
    }
  fit.balance = sum.norm() / p.sum();
  return fit;
}

// Straight edges stand for the arcs in their distances, but not in what they do:
// quadratic conditions see that.
TEST(QuadraticContact, curvedLines) {
  constexpr double balanced = 1e-13;
  struct Case {
    const char* name;
    int degree;
    Edges edges;
    Rows kind;
    double order;  ///< of the largest error of a pressure, at least
    double last;   ///< error of 32 cells at most
  };
  for (const Case& each :
       {Case{"weighted, linear", 1, Edges::straight, CouplingKind::weighted, 1.8, 1e-3},
        Case{"weighted, straight edges", 2, Edges::straight, CouplingKind::weighted, 1.8, 4e-4},
        Case{"weighted, bent edges", 2, Edges::bent, CouplingKind::weighted, 2.5, 5e-6},
        Case{"stabilised, linear", 1, Edges::straight, {CouplingKind::weighted, true}, 1.8, 1e-3},
        Case{"stabilised, straight edges", 2, Edges::straight, {CouplingKind::weighted, true}, 1.8, 4e-4},
        Case{"mortar, straight edges", 2, Edges::straight, CouplingKind::mortar, 0.9, 5e-2},
        Case{"mortar, bent edges", 2, Edges::bent, CouplingKind::mortar, 2, 5e-4}})
    for (const bool shaftNonmortar : {true, false}) {
      std::vector<double> h;
      std::vector<double> errors;
      for (const int cells : {8, 16, 32}) {
        const Fit fit = shrinkFit(cells, each.degree, each.edges, each.kind, shaftNonmortar);
        h.push_back(1.0 / cells);
        errors.push_back(fit.pressure);
        EXPECT_LE(fit.balance, balanced) << each.name;
      }
      std::cout << each.name << ", nonmortar " << (shaftNonmortar ? "shaft" : "hub")
                << ": largest error of a pressure " << errors.front() << " to " << errors.back() << ", order "
                << fittedOrder(h, errors) << "\n";
      EXPECT_GE(fittedOrder(h, errors), each.order) << each.name;
      EXPECT_LE(errors.back(), each.last) << each.name;
    }
}

}  // namespace mortier::quadratic_contact_test
