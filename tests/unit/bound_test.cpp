// The parts of the guaranteed bound: stresses that are determined by their tractions, meshes that match,
// tractions in equilibrium, sweeps that keep them so.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <random>

#include "bound/matched_meshes.h"
#include "bound/pressures.h"
#include "bound/relaxation.h"
#include "bound/strip_balance.h"
#include "material/stress.h"
#include "mesh/generate.h"
#include "theory/half_open_contact.h"
#include "theory/scenes.h"

namespace mortier {
namespace {

using namespace scenes;

/// S of plane stress.
Eigen::Matrix3d compliance(double young, double poisson) {
  Eigen::Matrix3d S;
  S << 1, -poisson, 0, -poisson, 1, 0, 0, 0, 2 * (1 + poisson);
  return S / young;
}

const std::array<Point, 3> corners{Point(0.3, -0.2), Point(1.7, 0.1), Point(0.6, 0.9)};

double areaOf(const std::array<Point, 3>& x) {
  const Point a = x[1] - x[0];
  const Point b = x[2] - x[0];
  return (a.x() * b.y() - a.y() * b.x()) / 2;
}

/// Random moments whose forces and couple vanish.
Moments balanced(std::mt19937& random, const std::array<Point, 3>& x, const Point& force = {0, 0}) {
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, 3, 12> sums = Eigen::Matrix<double, 3, 12>::Zero();
  for (int e = 0; e < 3; ++e)
    for (int end = 0; end < 2; ++end) {
      const Point& at = x[(e + end) % 3];
      sums.block<3, 2>(0, 4 * e + 2 * end) << 1, 0, 0, 1, -at.y(), at.x();
    }
  Moments m;
  for (double& each : m) each = normal(random);
  const Point centre = (x[0] + x[1] + x[2]) / 3;
  const Eigen::Vector3d wanted(-force.x(), -force.y(), -(centre.x() * force.y() - centre.y() * force.x()));
  return m + sums.transpose() * (sums * sums.transpose()).inverse() * (wanted - sums * m);
}

TEST(CompositeTriangle, hasConstantStresses) {
  const CompositeTriangle element(corners, compliance(2, 0.3));
  const Stress s(0.7, -1.1, 0.4);
  const Moments m = element.momentsOf(s);
  EXPECT_NEAR(m.dot(element.energy() * m), areaOf(corners) * s.dot(compliance(2, 0.3) * s), 1e-14);
  EXPECT_LE(element.defect(m), 1e-14);
}

// Linear on the parts: its square is known by its values at their vertices.
TEST(CompositeTriangle, hasTheStressOfItsEnergyAndItsLoad) {
  std::mt19937 random(11);
  const Eigen::Matrix3d S = compliance(2, 0.3);
  const CompositeTriangle element(corners, S);
  const Point f(0.4, -0.9);
  const Moments m = balanced(random, corners);
  const std::array<Stress, 9> values = element.stressOf(m, f);
  double energy = 0;
  for (int part = 0; part < 3; ++part) {
    const Stress* v = &values[3 * part];
    const Stress sum = v[0] + v[1] + v[2];
    for (int k = 0; k < 3; ++k) energy += areaOf(corners) / 36 * v[k].dot(S * v[k]);
    energy += areaOf(corners) / 36 * sum.dot(S * sum);
  }
  const double expected =
      m.dot(element.energy() * m) + 2 * m.dot(element.loadProduct(f)) + element.loadEnergy(f);
  EXPECT_NEAR(energy, expected, 1e-12 * expected);
  for (const Stress& value : element.stressOf(element.momentsOf({0.7, -1.1, 0.4}), {0, 0}))
    EXPECT_LE((value - Stress(0.7, -1.1, 0.4)).norm(), 1e-13);
}

TEST(CompositeTriangle, hasTheSameEnergyByAiryFunctions) {
  std::mt19937 random(5);
  const CompositeTriangle element(corners, compliance(2, 0.3));
  const Point f(0.4, -0.9);
  const MomentMatrix toMoments = momentsOfAiry(corners);
  for (int i = 0; i < 20; ++i) {
    const Moments m = balanced(random, corners);
    const AiryModes modes = element.airyOf(m);
    EXPECT_LE((toMoments * modes - m).norm(), 1e-13);
    const double energy = m.dot(element.energy() * m);
    EXPECT_NEAR(modes.dot(element.airyEnergy() * modes), energy, 1e-12 * energy);
    EXPECT_NEAR(element.airyLoadProduct(f).dot(modes), element.loadProduct(f).dot(m), 1e-12);
    const double loaded = energy + 2 * m.dot(element.loadProduct(f)) + element.loadEnergy(f);
    EXPECT_NEAR(element.energyOf(m, f), loaded, 1e-12 * loaded);
    EXPECT_NEAR(element.energyOf(m, {0, 0}), energy, 1e-12 * energy);
  }
}

TEST(CompositeTriangle, balancedTractionsDetermineAStressWithoutDivergence) {
  std::mt19937 random(1);
  const CompositeTriangle element(corners, compliance(2, 0.3));
  for (int i = 0; i < 20; ++i) EXPECT_LE(element.defect(balanced(random, corners)), 1e-13);
  Moments unbalanced = balanced(random, corners);
  unbalanced[0] += 1;
  EXPECT_GE(element.defect(unbalanced), 1e-3);
}

// s11 = 6 a x + 2 b y, s22 = 2 c x + 6 d y, s12 = -2 b x - 2 c y of an Airy function of degree three.
TEST(CompositeTriangle, hasLinearStressesWithoutDivergence) {
  const auto stress = [](const Point& x) {
    return Stress(0.6 * x.x() + 0.4 * x.y(), 1.2 * x.x() - 0.3 * x.y(), 0.3 * x.x() - 0.6 * x.y());
  };
  const Eigen::Matrix3d S = compliance(1, 0.2);
  Moments m;
  double energy = 0;
  for (int e = 0; e < 3; ++e) {
    const Point a = corners[e];
    const Point b = corners[(e + 1) % 3];
    const auto traction = [&](const Point& x) -> Point {
      const Stress s = stress(x);
      const Point n(b.y() - a.y(), -(b.x() - a.x()));
      return {s[0] * n.x() + s[2] * n.y(), s[2] * n.x() + s[1] * n.y()};
    };
    m.segment<2>(4 * e) = traction(a) / 3 + traction(b) / 6;
    m.segment<2>(4 * e + 2) = traction(a) / 6 + traction(b) / 3;
    const Stress middle = stress((a + b) / 2);
    energy += areaOf(corners) / 3 * middle.dot(S * middle);
  }
  EXPECT_NEAR(m.dot(CompositeTriangle(corners, S).energy() * m), energy, 1e-13 * energy);
}

TEST(CompositeTriangle, knowsTheStressOfABodyForce) {
  const Point f(0.3, -2);
  const Eigen::Matrix3d S = compliance(1, 0.2);
  const CompositeTriangle element(corners, S);
  // Its forces balance f, and its energy is that of the stress without shear.
  const Moments m = element.momentsOfLoad(f);
  Point sum(0, 0);
  for (int i = 0; i < 6; ++i) sum += m.segment<2>(2 * i);
  EXPECT_LE((sum + areaOf(corners) * f).norm(), 1e-14);
  const Point centre = (corners[0] + corners[1] + corners[2]) / 3;
  double energy = 0;
  double product = 0;
  const Stress constant(0.2, 0.5, -0.3);
  for (int e = 0; e < 3; ++e) {
    const Point y = (corners[e] + corners[(e + 1) % 3]) / 2 - centre;
    const Stress s(-f.x() * y.x(), -f.y() * y.y(), 0);
    energy += areaOf(corners) / 3 * s.dot(S * s);
    product += areaOf(corners) / 3 * s.dot(S * constant);
  }
  EXPECT_NEAR(element.loadEnergy(f), energy, 1e-13 * energy);
  EXPECT_NEAR(element.loadProduct(f).dot(element.momentsOf(constant)), product, 1e-14);
}

// ---- meshes
TEST(MatchedMeshes, haveTheSameVerticesOnTheLineAndTheSameArea) {
  const Model model = compression(3, 5, elasticMaterial({1, 0.3}), CouplingKind::mortar, upperBody);
  const MatchedMeshes meshes = matchedMeshes(model);
  ASSERT_EQ(meshes.obstacle, "");
  EXPECT_EQ(meshes.pieces.size(), 7U);  // 0, 1/5, 1/3, 2/5, 3/5, 2/3, 4/5, 1
  double length = 0;
  for (const MatchedPiece& piece : meshes.pieces) {
    length += piece.length;
    for (int end = 0; end < 2; ++end)
      EXPECT_LE((meshes.bodies[0].mesh.vertices[piece.vertices[0][end]] -
                 meshes.bodies[1].mesh.vertices[piece.vertices[1][end]])
                    .norm(),
                1e-15);
  }
  EXPECT_NEAR(length, 1, 1e-15);
  for (size_t b = 0; b < 2; ++b) {
    TriangleMesh mesh = meshes.bodies[b].mesh;
    EXPECT_NO_THROW(validate(mesh));
    double area = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) area += doubleArea(mesh, static_cast<int>(t)) / 2;
    EXPECT_NEAR(area, 1, 1e-14);
    // A linear field is the same on it.
    const auto linear = [](const Point& x) { return Point(1 + 2 * x.x() - x.y(), 3 * x.y()); };
    Vector u(2 * static_cast<Eigen::Index>(model.bodies[b].mesh().vertices.size()));
    for (size_t v = 0; v < model.bodies[b].mesh().vertices.size(); ++v)
      u.segment<2>(2 * static_cast<Eigen::Index>(v)) = linear(model.bodies[b].mesh().vertices[v]);
    const Vector cut = meshes.bodies[b].displacement(u);
    for (size_t v = 0; v < mesh.vertices.size(); ++v)
      EXPECT_LE((cut.segment<2>(2 * static_cast<Eigen::Index>(v)) - linear(mesh.vertices[v])).norm(), 1e-14);
  }
}

TEST(MatchedMeshes, twoContactSidesOfOneTriangleAreBothCut) {
  // The corner of the upper body is one triangle with both of its sides on the line.
  TriangleMesh wedge;
  wedge.vertices = {{0, 0}, {1, 1}, {-1, 1}};
  wedge.triangles = {{0, 1, 2}};
  wedge.regions = {1};
  wedge.boundaryEdges = {{2, 0}, {0, 1}, {1, 2}};
  wedge.boundaryLabels = {1, 1, 2};
  TriangleMesh notch;
  notch.vertices = {{-1, 1}, {-0.5, 0.5}, {0, 0}, {0.4, 0.4}, {1, 1}, {0, -2}};
  notch.triangles = {{5, 1, 0}, {5, 2, 1}, {5, 3, 2}, {5, 4, 3}};
  notch.regions = {1, 1, 1, 1};
  notch.boundaryEdges = {{1, 0}, {2, 1}, {3, 2}, {4, 3}, {0, 5}, {5, 4}};
  notch.boundaryLabels = {1, 1, 1, 1, 2, 2};
  Model model;
  model.bodies.emplace_back("wedge", wedge, elasticMaterial({1, 0.3}),
                            Conditions{{{2, 0, constant(0)}, {2, 1, constant(0)}}, {}, {}});
  model.bodies.emplace_back("notch", notch, elasticMaterial({1, 0.3}),
                            Conditions{{{2, 0, constant(0)}, {2, 1, constant(0)}}, {}, {}});
  addInterface(model, {{0, 1}, {1, 1}, CouplingKind::mortar});
  const MatchedMeshes meshes = matchedMeshes(model);
  ASSERT_EQ(meshes.obstacle, "");
  EXPECT_EQ(meshes.pieces.size(), 4U);
  EXPECT_EQ(meshes.bodies[0].mesh.triangles.size(), 3U);
  TriangleMesh mesh = meshes.bodies[0].mesh;
  EXPECT_NO_THROW(validate(mesh));
}

// ---- tractions
/// A square under a linear stress without divergence: finite element stresses are its means, the exact stress
/// has the linear tractions, and is one of those that are allowed.
struct LinearStress {
  TriangleMesh mesh;
  Sides sides{mesh};
  std::vector<Eigen::Matrix3d> compliances;
  std::vector<Stress> means;
  std::vector<CompositeTriangle> elements;
  std::vector<Point> forces;
  std::vector<KnownTraction> known;
  SideMoments moments;
  double best = 0;  ///< energy of the exact stress less its means

  explicit LinearStress(int cells) : mesh(square(0, cells)) {
    const Eigen::Matrix3d S = compliance(1, 0.2);
    const auto exact = [](const Point& x) {
      return Stress(0.6 * x.x() + 0.4 * x.y(), 1.2 * x.x() - 0.3 * x.y(), 0.3 * x.x() - 0.6 * x.y());
    };
    for (const auto& v : mesh.triangles) {
      const std::array<Point, 3> x{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
      means.push_back(exact((x[0] + x[1] + x[2]) / 3));
      elements.emplace_back(x, S);
      for (int k = 0; k < 3; ++k) {
        const Stress off = exact((x[k] + x[(k + 1) % 3]) / 2) - means.back();
        best += areaOf(x) / 3 * off.dot(S * off);
      }
    }
    compliances.assign(means.size(), S);
    forces.assign(means.size(), Point(0, 0));
    known.resize(sides.count());
    for (int e = 0; e < sides.count(); ++e) {
      const Side& side = sides.all()[e];
      if (side.triangles[1] >= 0) continue;
      const Point a = mesh.vertices[side.vertices[0]];
      const Point b = mesh.vertices[side.vertices[1]];
      const auto traction = [&](const Point& x) -> Point {
        const Stress s = exact(x);
        const Point n(b.y() - a.y(), -(b.x() - a.x()));
        return {s[0] * n.x() + s[2] * n.y(), s[2] * n.x() + s[1] * n.y()};
      };
      known[e] = {2,
                  {Point(1, 0), Point(0, 1)},
                  {Point(traction(a) / 3 + traction(b) / 6), Point(traction(a) / 6 + traction(b) / 3)}};
    }
    moments = balancedMoments(mesh, sides, means, forces, known);
  }
  Relaxation relaxation() { return {mesh, sides, compliances, means, forces, known, moments}; }
  void expectBalance() const {
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      EXPECT_LE(elements[t].defect(momentsOf(sides, moments, t)), 1e-12);
      Point sum(0, 0);
      for (int i = 0; i < 6; ++i) sum += momentsOf(sides, moments, t).segment<2>(2 * i);
      EXPECT_LE(sum.norm(), 1e-14);
    }
  }
};

TEST(Relaxation, keepsEquilibriumAndLowersTheEnergyToThatOfAnExactStress) {
  std::array<double, 2> least{};
  for (const bool directly : {false, true}) {
    LinearStress found(8);
    Relaxation relaxation = found.relaxation();
    double last = relaxation.energies().sum();
    EXPECT_GT(last, 1.2 * found.best);
    found.expectBalance();
    if (directly) {
      ASSERT_TRUE(relaxation.minimise());
    } else {
      for (const double worthwhile : {0.1, 1e-2, 1e-4, 1e-8, 1e-12}) {
        EXPECT_LT(relaxation.iterate(worthwhile), 100);
        const double now = relaxation.energies().sum();
        EXPECT_LE(now, last * (1 + 1e-12));
        last = now;
      }
    }
    found.expectBalance();
    least[directly ? 1 : 0] = relaxation.energies().sum();
    EXPECT_LE(least[directly ? 1 : 0], found.best);
  }
  EXPECT_NEAR(least[0], least[1], 1e-9 * least[1]);
}

// ---- pressures
TEST(SpreadPressures, haveTheForceAndTheMomentOfTheNodalForces) {
  const std::array<HalfOpenContact, 2> exact{{{{1, 0.3}, false}, {{1, 0.3}, true}}};
  for (const CouplingKind coupling : couplings) {
    const Model model = contactModel(exact[0].body(6), exact[1].body(10), coupling, upperBody);
    const State state = run(model, 1, 1).state;
    const MatchedMeshes meshes = matchedMeshes(model);
    const std::vector<Vector> spread = spreadPressures(model, state, meshes);
    double force = state.contactForce[0].sum();
    const double all = force;
    double moment = 0;
    for (int row = 0; row < model.interfaces[0].rows(); ++row)
      moment += model.bodies[0].mesh().vertices[model.interfaces[0].nonmortarNodes()[row]].x() *
                state.contactForce[0][row];
    for (const MatchedPiece& piece : meshes.pieces) {
      const auto m = momentsOfLinear(pressureOn(piece, spread), piece.length);
      force -= m[0] + m[1];
      for (int end = 0; end < 2; ++end)
        moment -= m[end] * meshes.bodies[0].mesh.vertices[piece.vertices[0][end]].x();
    }
    EXPECT_NEAR(force, 0, 1e-13 * all);
    EXPECT_NEAR(moment, 0, 1e-13 * all);
  }
}

// ---- forces that are out of balance
struct Pressed {
  Body body;
  Sides sides{body.mesh()};
  std::vector<Eigen::Matrix3d> moduli;
  std::vector<Stress> stress;

  explicit Pressed(std::vector<PrescribedDisplacement> held)
      : body("block", square(0, 24), elasticMaterial({1, 0.3}), Conditions{std::move(held), {}, {}}),
        moduli(body.points(), Eigen::Vector3d(1 / 0.7, 1 / 1.3, 1 / 1.3).asDiagonal()),
        stress(moduli.size(), Stress::Zero()) {}
  /// Of the stresses of the triangles.
  [[nodiscard]] Vector forces() const {
    Matrix all(3, body.points());
    for (int t = 0; t < body.points(); ++t) all.col(t) = fromCartesian(stress[t]);
    return body.internalForce(all);
  }
  /// Nodal forces on the lower side.
  [[nodiscard]] Vector load(const std::function<double(double)>& at) const {
    Vector result = Vector::Zero(body.dofs());
    for (int v = 0; v < body.nodes(); ++v)
      if (body.mesh().vertices[v].y() < 1e-9) result[2 * v + 1] = at(body.mesh().vertices[v].x());
    return result;
  }
};

TEST(StripBalance, takesUpForcesThatBalanceEachOtherInAFewRings) {
  Pressed found({{top, 0, constant(0)}, {top, 1, constant(0)}});
  const Vector load = found.load([](double x) { return std::cos(8 * std::numbers::pi * (x + 1.0 / 48)); });
  Vector ends = found.load([](double x) { return x < 1e-9 || x > 1 - 1e-9 ? 1 : 0; });
  Vector balanced = load - (load.sum() / 2) * ends;  // symmetric about the middle but for a couple
  double couple = 0;
  for (int v = 0; v < found.body.nodes(); ++v)
    couple += (found.body.mesh().vertices[v].x() - 0.5) * balanced[2 * v + 1];
  balanced += found.load([&](double x) { return x < 1e-9 ? couple : x > 1 - 1e-9 ? -couple : 0; });
  Vector left = balanced;
  ASSERT_TRUE(balanceStrip(found.body, found.sides, found.moduli, 1, left, found.stress));
  EXPECT_LE((found.forces() - balanced).cwiseAbs().maxCoeff(), 1e-12);
  for (size_t t = 0; t < found.stress.size(); ++t) {
    const bool far = found.body.mesh().vertices[found.body.mesh().triangles[t][0]].y() > 0.2;
    EXPECT_TRUE(!far || found.stress[t].isZero(0));
  }
}

TEST(StripBalance, leavesForcesThatTheRestOfTheBodyHasToHold) {
  Pressed found({{top, 0, constant(0)}, {top, 1, constant(0)}});
  const Vector load = found.load([](double x) { return x; });
  Vector left = load;
  EXPECT_FALSE(balanceStrip(found.body, found.sides, found.moduli, 1, left, found.stress));
  EXPECT_EQ(left, load);
  EXPECT_TRUE(found.stress[0].isZero(0));
}

}  // namespace
}  // namespace mortier
