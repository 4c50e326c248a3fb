// Meshes that are refined until an accuracy is reached, against exact solutions: elastic bodies, one step.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "adapt/rounds.h"
#include "fem/element.h"
#include "mesh/regions.h"
#include "theory/extruded_contact.h"

namespace mortier::scenes {

/// A problem that is known on any meshes.
struct KnownProblem {
  std::vector<TriangleMesh> meshes;  ///< the first ones
  int degree = 1;
  std::function<Model(std::vector<TriangleMesh>)> model;
  std::vector<std::function<Eigen::Vector3d(const Point&)>> stress;  ///< (s11, s22, s12), exact, by bodies
  std::vector<Elasticity> elasticity;
  // The same in space.
  std::vector<TetrahedronMesh> spaceMeshes = {};
  std::function<Model(std::vector<TetrahedronMesh>)> spaceModel = {};
  std::vector<std::function<SpaceStress(const SpacePoint&)>> spaceStress = {};

  [[nodiscard]] bool inSpace() const { return !spaceMeshes.empty(); }
};

/// Adds the energy of the error, squared, and that of the exact stress: by pieces of each triangle that are
/// far finer than what is measured. Sides are straight; plane stress.
inline void addEnergies(const Body& body, const Matrix& stress,
                        const std::function<Eigen::Vector3d(const Point&)>& exact,
                        const Elasticity& elasticity, double& error, double& norm) {
  withElement(body.degree(), [&](auto element) {
    using Element = decltype(element);
    constexpr int cuts = 4;
    const TriangleMesh& mesh = body.mesh();
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::array<int, 3>& v = mesh.triangles[t];
      const double weight = doubleArea(mesh, static_cast<int>(t)) / 2 / (cuts * cuts);
      const auto add = [&](double r, double s) {
        const Barycentric b{1 - (r + s) / cuts, r / cuts, s / cuts};
        const Point x = b[0] * mesh.vertices[v[0]] + b[1] * mesh.vertices[v[1]] + b[2] * mesh.vertices[v[2]];
        const auto L = Element::stressShapes(b);
        Eigen::Vector3d own = Eigen::Vector3d::Zero();
        for (int q = 0; q < Element::points; ++q)
          own += L[q] * stress.col(Element::points * static_cast<Eigen::Index>(t) + q).template head<3>();
        const Eigen::Vector3d known = fromCartesian(exact(x));
        error += weight * complementaryEnergy(own - known, elasticity);
        norm += weight * complementaryEnergy(known, elasticity);
      };
      for (int a = 0; a < cuts; ++a)
        for (int c = 0; a + c < cuts; ++c) {
          add(a + 1.0 / 3, c + 1.0 / 3);
          if (a + c + 1 < cuts) add(a + 2.0 / 3, c + 2.0 / 3);
        }
    }
  });
}

struct Adapted {
  struct Round {
    int unknowns = 0;
    double estimated = 0;
    double error = 0;  ///< true
  };
  std::vector<Round> rounds;
  Rounds::Verdict verdict = Rounds::Verdict::goOn;

  [[nodiscard]] const Round& last() const { return rounds.back(); }
  [[nodiscard]] double effectivity() const { return last().estimated / last().error; }
  /// Work of all rounds over that of the last one, as unknowns to the power 1.2.
  [[nodiscard]] double overhead() const {
    double work = 0;
    for (const Round& round : rounds) work += std::pow(round.unknowns, 1.2);
    return work / std::pow(last().unknowns, 1.2);
  }
};

/// Goes on until `accuracy` is reached or given up.
inline Adapted adapt(const KnownProblem& problem, double accuracy) {
  ResolvedScene scene;
  for (size_t b = 0; b < problem.meshes.size() + problem.spaceMeshes.size(); ++b)
    scene.description.bodies.emplace_back();
  scene.description.dimension = problem.inSpace() ? 3 : 2;
  scene.spaceMeshes = problem.spaceMeshes;
  scene.description.degree = problem.degree;
  scene.description.accuracy.energy = accuracy;
  scene.meshes = problem.meshes;
  Rounds rounds(std::move(scene));
  Adapted result;
  while (result.verdict == Rounds::Verdict::goOn) {
    const Model model = problem.inSpace() ? problem.spaceModel(rounds.scene().spaceMeshes)
                                          : problem.model(rounds.scene().meshes);
    CurrentMeshError current(model);
    ErrorHistory errors(model, current);
    State state = initialState(model);
    static_cast<void>(
        march(model, state, {.end = 1, .steps = 1}, {}, [&](const State& at, const StepReport& report) {
          current.moveTo(at);
          errors.add(report);
        }));
    Adapted::Round round;
    double error = 0;
    double norm = 0;
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      if (problem.inSpace())
        addSpaceEnergies(model.bodies[b], state.bodies[b].stress, problem.spaceStress[b], error, norm);
      else
        addEnergies(model.bodies[b], state.bodies[b].stress, problem.stress[b], problem.elasticity[b], error,
                    norm);
      round.unknowns += model.bodies[b].freeDofs();
    }
    result.verdict = rounds.judge({errors.errors(), errors.energy(), 0, 0}, 0);
    round.error = std::sqrt(error / norm);
    round.estimated = rounds.meshError();
    result.rounds.push_back(round);
  }
  return result;
}

/// The contact with a known end; `cells` of the upper and the lower body.
inline KnownProblem halfOpen(std::pair<int, int> cells, double contrast, int nonmortar, int degree = 1) {
  const HalfOpenContact upper({1, 0.3}, false);
  const HalfOpenContact lower({contrast, 0.2}, true);
  KnownProblem problem;
  problem.degree = degree;
  problem.meshes = {upper.body(cells.first).mesh(), lower.body(cells.second).mesh()};
  problem.model = [=](std::vector<TriangleMesh> meshes) {
    return contactModel(upper.body(std::move(meshes[0]), degree), lower.body(std::move(meshes[1]), degree),
                        degree == 1 ? CouplingKind::mortar : CouplingKind::weighted, nonmortar);
  };
  problem.stress = {[=](const Point& x) { return upper.stress(x.x(), x.y()); },
                    [=](const Point& x) { return lower.stress(x.x(), x.y()); }};
  problem.elasticity = {{1, 0.3}, {contrast, 0.2}};
  return problem;
}

/// The same contact, extruded.
inline KnownProblem halfOpenInSpace(int cells, int degree) {
  const std::array<Extruded, 2> sides{Extruded{{1, 0.3}, false}, Extruded{{1, 0.3}, true}};
  KnownProblem problem;
  problem.degree = degree;
  problem.spaceMeshes = {sides[0].mesh(cells), sides[1].mesh(cells * 3 / 2)};
  for (const Extruded& side : sides)
    problem.spaceStress.emplace_back([side](const SpacePoint& x) { return side.stress(x); });
  problem.spaceModel = [sides, degree](std::vector<TetrahedronMesh> meshes) {
    Model model;
    for (size_t b = 0; b < 2; ++b) model.bodies.push_back(sides[b].body(std::move(meshes[b]), degree));
    addInterface(model, {{1, top}, {0, bottom}, CouplingKind::weighted});
    return model;
  };
  return problem;
}

/// The corner of an L with free sides, where the stress is unbounded like r^(a - 1), a = 0.5445 (Williams
/// 1952): in polar coordinates about it, from the middle of the L,
///   2 mu u_r = r^a ((C2 - a - 1) C1 cos((a-1) phi) - (a+1) cos((a+1) phi)),
///   2 mu u_phi = r^a ((C2 + a - 1) C1 sin((a-1) phi) + (a+1) sin((a+1) phi)).
class LShape {
 public:
  [[nodiscard]] Point displacement(const Point& x) const {
    const double r = x.norm();
    if (r == 0) return Point::Zero();
    const double phi = std::atan2(x.y(), x.x()) - middle;
    return std::pow(r, a) / (2 * mu) * (turned(phi) * polar(std::remainder(phi, 2 * M_PI)));
  }

  [[nodiscard]] Eigen::Vector3d stress(const Point& x) const {
    const double r = x.norm();
    const double phi = std::atan2(x.y(), x.x()) - middle;
    const Point u = polar(std::remainder(phi, 2 * M_PI));
    const Point du = slope(std::remainder(phi, 2 * M_PI));
    Eigen::Matrix2d strain;
    strain(0, 0) = a * u[0];
    strain(1, 1) = u[0] + du[1];
    strain(0, 1) = strain(1, 0) = (du[0] + (a - 1) * u[1]) / 2;
    strain *= std::pow(r, a - 1) / (2 * mu);
    const Eigen::Matrix2d s = lambda * strain.trace() * Eigen::Matrix2d::Identity() + 2 * mu * strain;
    const Eigen::Matrix2d R = turned(phi);
    const Eigen::Matrix2d there = R * s * R.transpose();
    return {there(0, 0), there(1, 1), there(0, 1)};
  }

  static constexpr Elasticity elasticity{1, 0.3};

 private:
  static constexpr double a = 0.544483736782464;
  static constexpr double middle = M_PI / 4;
  static constexpr double mu = 1 / 2.6;
  static constexpr double lambda = 0.3 / (1 - 0.3 * 0.3);  // of plane stress
  static constexpr double C2 = 2 * (lambda + 2 * mu) / (lambda + mu);

  static double C1() {
    constexpr double omega = 3 * M_PI / 4;
    return -std::cos((a + 1) * omega) / std::cos((a - 1) * omega);
  }
  /// To the directions along and across the radius.
  static Eigen::Matrix2d turned(double phi) { return Eigen::Rotation2Dd(phi + middle).toRotationMatrix(); }
  static Point polar(double phi) {
    return {(C2 - a - 1) * C1() * std::cos((a - 1) * phi) - (a + 1) * std::cos((a + 1) * phi),
            (C2 + a - 1) * C1() * std::sin((a - 1) * phi) + (a + 1) * std::sin((a + 1) * phi)};
  }
  static Point slope(double phi) {
    return {-(C2 - a - 1) * C1() * (a - 1) * std::sin((a - 1) * phi) +
                (a + 1) * (a + 1) * std::sin((a + 1) * phi),
            (C2 + a - 1) * C1() * (a - 1) * std::cos((a - 1) * phi) +
                (a + 1) * (a + 1) * std::cos((a + 1) * phi)};
  }
};

inline KnownProblem lShape(int cells, int degree) {
  TriangleMesh mesh =
      rectangleMesh({.lower = {-1, -1}, .upper = {1, 1}, .cellsX = 2 * cells, .cellsY = 2 * cells});
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    Point centre = Point::Zero();
    for (const int v : mesh.triangles[t]) centre += mesh.vertices[v] / 3;
    mesh.regions[t] = centre.x() < 0 && centre.y() < 0 ? 2 : 1;
  }
  keepRegions(mesh, {"1"});
  KnownProblem problem;
  problem.degree = degree;
  problem.meshes = {std::move(mesh)};
  problem.model = [degree](std::vector<TriangleMesh> meshes) {
    Conditions conditions;
    for (const int side : {bottom, right, top, left})
      for (const int c : {0, 1})
        conditions.displacements.push_back({side, c, [c](double x, double y, double t) {
                                              return t * LShape().displacement({x, y})[c];
                                            }});
    Model model;
    model.bodies.emplace_back("L", std::move(meshes[0]), elasticMaterial(LShape::elasticity), conditions,
                              degree);
    return model;
  };
  problem.stress = {[](const Point& x) { return LShape().stress(x); }};
  problem.elasticity = {LShape::elasticity};
  return problem;
}

/// The same L, extruded: in plane strain with the same moduli.
inline KnownProblem lShapeInSpace(int cells, int degree) {
  constexpr double poisson = 0.3 / 1.3;
  constexpr Elasticity elasticity{(1 + poisson) / 1.3, poisson};
  TetrahedronMesh mesh = cuboidMesh({{-1, 0, -1}, {1, 0.5, 1}, {2 * cells, (cells + 1) / 2, 2 * cells}});
  for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    SpacePoint centre = SpacePoint::Zero();
    for (const int v : mesh.tetrahedra[t]) centre += mesh.vertices[v] / 4;
    mesh.regions[t] = centre.x() < 0 && centre.z() < 0 ? 2 : 1;
  }
  keepRegions(mesh, {"1"});
  KnownProblem problem;
  problem.degree = degree;
  problem.spaceMeshes = {std::move(mesh)};
  problem.spaceModel = [=](std::vector<TetrahedronMesh> meshes) {
    Conditions conditions;
    for (const int side : {bottom, right, top, left})
      for (const int c : {0, 1})
        conditions.displacements.push_back({side, 2 * c, [c](const SpacePoint& x, double t) {
                                              return t * LShape().displacement({x.x(), x.z()})[c];
                                            }});
    for (const int side : {5, 6}) conditions.displacements.push_back({side, alongY, steady(0)});
    Model model;
    model.bodies.emplace_back("L", std::move(meshes[0]), elasticMaterial(elasticity, Plane::none), conditions,
                              degree);
    return model;
  };
  problem.spaceStress = {[=](const SpacePoint& x) {
    return extruded(LShape().stress({x.x(), x.z()}), poisson);
  }};
  return problem;
}

}  // namespace mortier::scenes
