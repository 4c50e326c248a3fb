// The guaranteed bound of the error that the meshes make in a step of bodies that flow: against an exact
// stress, and against the same step on much finer meshes.
#include "bound/energy_bound.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "material/deviatoric.h"
#include "theory/random_scene.h"
#include "theory/refined_model.h"
#include "time/step_taker.h"

namespace mortier::step_bound_test {

using namespace scenes;

struct Distances {
  double stress = 0;  ///< in the energy norm
  double strain = 0;  ///< of k G
};

/// Between two stresses of a body, by its points.
void add(const Body& body, const Matrix& stress, const Matrix& other, double weight, Distances& squares) {
  const Matrix off = stress - other;
  Matrix elastic;
  Matrix rate;
  Matrix otherRate;
  body.material().elasticStrain(off, elastic);
  body.material().viscoplasticRate(stress, rate);
  body.material().viscoplasticRate(other, otherRate);
  for (int i = 0; i < body.points(); ++i) {
    squares.stress += body.weights()[i] * off.col(i).dot(elastic.col(i));
    squares.strain += body.weights()[i] * weight * weight * (rate.col(i) - otherRate.col(i)).squaredNorm();
  }
}
Distances rootsOf(const Distances& squares) {
  return {std::sqrt(squares.stress), std::sqrt(squares.strain)};
}

// ---- an exact stress: the note's test, one step
TEST(StepBound, isAboveAndNearTheErrorOfTheNotesTest) {
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const double young : {0.5, 20.0, 1e4, 3e11})
      for (const auto& [upper, lower] : {std::array{6, 16}, std::array{16, 6}}) {
        const Elasticity elasticity{young, 0.3};
        const Viscoplasticity law = noteLaw(Projection::frobenius);
        const auto material = perzynaMaterial(elasticity, law, plane);
        const Model model = compression(upper, lower, material, CouplingKind::interpolation, upperBody);
        const auto [state, report] = run(model, 1, 1);
        ASSERT_EQ(report.status, Status::converged);
        const EnergyBound bound = energyBound(model, state, {}, 1);
        ASSERT_EQ(bound.obstacle, "");
        // The exact stress is that of matching meshes.
        const Model matching = compression(1, 1, material, CouplingKind::interpolation, upperBody);
        const auto [exact, exactReport] = run(matching, 1, 1);
        Distances squares;
        for (size_t b = 0; b < 2; ++b)
          add(model.bodies[b], state.bodies[b].stress,
              exact.bodies[b].stress.col(0).replicate(1, model.bodies[b].points()), 1, squares);
        const Distances error = rootsOf(squares);
        std::cout << (plane == Plane::strain ? "plane strain," : "plane stress,") << " E = " << young << ", "
                  << upper << ":" << lower << ": bound over error of the stress "
                  << bound.bound / error.stress << ", of the viscoplastic strain "
                  << bound.strain / error.strain << "\n";
        EXPECT_GE(bound.bound, error.stress);
        EXPECT_GE(bound.strain, error.strain);
        // One number bounds both: where bodies are soft mostly the stress, else mostly the flow.
        if (young <= 20) {
          EXPECT_LE(bound.bound, 2 * error.stress);
        }
        if (young >= 20 && (plane == Plane::stress || young <= 1e4)) {
          EXPECT_LE(bound.strain, 4 * error.strain);
        }
      }
}

TEST(StepBound, isZeroToRoundingWhereTheStressIsExact) {
  for (const double young : {20.0, 3e11})
    for (const int steps : {1, 10}) {
      const Model model = compression(6, 16, perzynaMaterial({young, 0.3}, noteLaw(Projection::frobenius)),
                                      CouplingKind::mortar, upperBody);
      const auto [state, report] = run(model, 1, steps);
      const EnergyBound bound = energyBound(model, state, {}, 1.0 / steps);
      ASSERT_EQ(bound.obstacle, "");
      EXPECT_LE(bound.bound, 1e-5 * bound.norm) << young << ", " << steps;
      EXPECT_LE(bound.strain, 1e-7 * bound.strainNorm) << young << ", " << steps;
    }
}

// ---- the same step on finer meshes
/// The bodies of a model with other materials.
Model withMaterials(const Model& model, const std::vector<std::shared_ptr<const Material>>& materials) {
  Model result;
  for (size_t b = 0; b < model.bodies.size(); ++b)
    result.bodies.emplace_back(model.bodies[b].name(), model.bodies[b].mesh(), materials[b],
                               model.bodies[b].conditions());
  for (const ContactInterface& interface : model.interfaces) addInterface(result, interface.pair());
  return result;
}

/// A state on finer meshes: the same fields.
State prolonged(const Model& model, const State& state, const Refined& fine) {
  State result = initialState(fine.model);
  result.time = state.time;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const TriangleMesh& coarse = model.bodies[b].mesh();
    const TriangleMesh& mesh = fine.model.bodies[b].mesh();
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      const int parent = fine.parents[b][t];
      const auto at = static_cast<Eigen::Index>(t);
      result.bodies[b].stress.col(at) = state.bodies[b].stress.col(parent);
      result.bodies[b].viscoplasticStrain.col(at) = state.bodies[b].viscoplasticStrain.col(parent);
      const auto& v = coarse.triangles[parent];
      Eigen::Matrix2d sides;
      sides << coarse.vertices[v[1]] - coarse.vertices[v[0]], coarse.vertices[v[2]] - coarse.vertices[v[0]];
      for (const int vertex : mesh.triangles[t]) {
        const Point c = sides.inverse() * (mesh.vertices[vertex] - coarse.vertices[v[0]]);
        const Vector& u = state.bodies[b].displacement;
        result.bodies[b].displacement.segment<2>(2 * vertex) = (1 - c.x() - c.y()) * u.segment<2>(2 * v[0]) +
                                                               c.x() * u.segment<2>(2 * v[1]) +
                                                               c.y() * u.segment<2>(2 * v[2]);
      }
    }
  }
  for (size_t k = 0; k < result.gap.size(); ++k) {
    const ContactInterface& interface = fine.model.interfaces[k];
    const auto& [nonmortar, mortar, coupling] = interface.pair();
    result.gap[k] =
        interface.gap(result.bodies[nonmortar.body].displacement, result.bodies[mortar.body].displacement);
  }
  return result;
}

bool takeStep(const Model& model, State& state, double t1) {
  MarchMemory memory;
  StepTaker taker(model, state, memory, Scheme::backwardEuler, {});
  if (!taker.attempt(t1).converged()) return false;
  taker.commit();
  return true;
}

TEST(StepBound, isAboveTheErrorOfRandomScenes) {
  const char* asked = std::getenv("MORTIER_RANDOM_BOUNDS");
  const unsigned count = asked ? static_cast<unsigned>(std::atoi(asked)) : 20;
  unsigned bounded = 0;
  unsigned flowing = 0;
  double largest = 0;
  double largestStrain = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    Randoms random(seed + 1000);
    std::vector<std::shared_ptr<const Material>> materials;
    const bool strain = random.below(2) == 0;
    const double weight = 0.5;
    for (int b = 0; b < 2; ++b) {
      const Elasticity elasticity{std::exp(random.normal()), 0.1 * random.below(5)};
      // Loads are about 0.1, moduli about 1.
      const Viscoplasticity law{weight / 2 * std::pow(10, -2.0 + random.below(5)),
                                0.03 * std::exp(random.normal()), Projection::frobenius};
      if (random.below(4) == 0)
        materials.push_back(elasticMaterial(elasticity, strain ? Plane::strain : Plane::stress));
      else
        materials.push_back(perzynaMaterial(elasticity, law, strain ? Plane::strain : Plane::stress));
    }
    const Model model = withMaterials(RandomScene(seed).model(), materials);
    State state = initialState(model);
    const bool again = random.below(2) == 0;  // from a state that has flowed
    if (again && !takeStep(model, state, 0.5)) continue;
    const Refined fine = refined(model, 2);
    State fineState = prolonged(model, state, fine);
    const double t1 = state.time + weight;
    if (!takeStep(model, state, t1) || !takeStep(fine.model, fineState, t1)) continue;
    const EnergyBound bound = energyBound(model, state, {}, weight);
    const EnergyBound fineBound = energyBound(fine.model, fineState, {}, weight);
    if (!bound.obstacle.empty() || !fineBound.obstacle.empty()) {
      std::cout << "scene " << seed << ": " << bound.obstacle << fineBound.obstacle << "\n";
      continue;
    }
    Distances squares;
    for (size_t b = 0; b < 2; ++b) {
      Matrix coarse = fineState.bodies[b].stress;
      for (Eigen::Index t = 0; t < coarse.cols(); ++t)
        coarse.col(t) = state.bodies[b].stress.col(fine.parents[b][t]);
      add(fine.model.bodies[b], coarse, fineState.bodies[b].stress, weight, squares);
    }
    const Distances error = rootsOf(squares);
    ++bounded;
    flowing += bound.strainNorm > 0;
    const double rounding = 1e-9 * (bound.norm + 1e-3);
    EXPECT_LE(error.stress, bound.bound + fineBound.bound + rounding) << "scene " << seed;
    EXPECT_LE(error.strain, bound.strain + fineBound.strain + 1e-9 * (bound.strainNorm + 1e-3))
        << "scene " << seed;
    if (error.stress > 1e-6 * bound.norm) largest = std::max(largest, bound.bound / error.stress);
    if (error.strain > 1e-6 * bound.strainNorm)
      largestStrain = std::max(largestStrain, bound.strain / error.strain);
  }
  std::cout << bounded << " scenes, " << flowing << " flow; bound over error at most " << largest
            << " (stress), " << largestStrain << " (viscoplastic strain)\n";
  EXPECT_GE(bounded, count * 3 / 4);
  EXPECT_GE(flowing, count / 2);
}

}  // namespace mortier::step_bound_test
