// The guaranteed bound of what steps and meshes do together to bodies that flow: against an exact solution,
// and against finer meshes and shorter steps.
#include "bound/total_bound.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <iostream>

#include "bound/energy_bound.h"
#include "material/deviatoric.h"
#include "theory/random_scene.h"
#include "theory/refined_model.h"

namespace mortier::total_bound_test {

using namespace scenes;

struct Bounded {
  State state;
  TotalBound bound;
};

/// \param chosen  steps whose gaps and pressures are not those of the finite elements
Bounded boundedRun(const Model& model, const TimePlan& plan, int* chosen = nullptr) {
  Bounded result{initialState(model), {}};
  FlowBoundMemory flowMemory;
  TotalBoundMemory memory;
  FlowBoundRecord flow(model, {true, plan.controlled()}, result.state, flowMemory);
  TotalBoundRecord record(model, result.state, memory);
  const RunReport report =
      march(model, result.state, plan, {}, [&](const State& state, const StepReport& step) {
        record.look(state, step.step);
        flow.add(state, step);
        record.add(flowMemory.obstacle);
        if (chosen != nullptr && !memory.earlier.gaps.empty()) ++*chosen;
      });
  EXPECT_EQ(report.status, Status::converged);
  result.bound = record.atEnd(result.state, flow.atEnd(result.state));
  return result;
}

/// ||eps_p - other||, of uniform others.
double strainBetween(const Model& model, const State& state, const Vector& other) {
  double sum = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b)
    for (int i = 0; i < model.bodies[b].points(); ++i)
      sum += model.bodies[b].weights()[i] * (state.bodies[b].viscoplasticStrain.col(i) - other).squaredNorm();
  return std::sqrt(sum);
}

/// The viscoplastic strain of a stress -10 t e_y e_y, by Simpson's rule.
Vector flownUnder10(const Material& material) {
  Vector exact = Vector::Zero(3);
  constexpr int parts = 20000;
  const auto rate = [&](double t) {
    Matrix g;
    material.viscoplasticRate(fromCartesian({0, -10 * t, 0}), g);
    return Vector(g.col(0));
  };
  for (int i = 0; i < parts; ++i) {
    const double h = 0.9 / parts;
    const double t = 0.1 + i * h;
    exact += h / 6 * (rate(t) + 4 * rate(t + h / 2) + rate(t + h));
  }
  return exact;
}

// ---- an exact solution: the note's test, where the stress is -10 t e_y e_y
TEST(TotalBound, isAboveAndNearTheErrorOfTheNotesTest) {
  struct Case {
    CouplingKind coupling;
    std::array<int, 2> cells;
    double young;
    int steps;
    double most;
  };
  std::vector<Case> cases{{CouplingKind::mortar, {2, 3}, 3e11, 10, 1.25},
                          {CouplingKind::mortar, {2, 3}, 10, 20, 1.25},
                          {CouplingKind::interpolation, {8, 3}, 3e11, 20, 1.3},
                          {CouplingKind::interpolation, {3, 8}, 3e11, 20, 2},
                          {CouplingKind::interpolation, {3, 8}, 10, 20, 6},
                          // A body of more than 1,000 triangles of which parts flow, 1e9 times as soft.
                          {CouplingKind::interpolation, {6, 16}, 3e11, 100, 1.9}};
  if (std::getenv("MORTIER_LONG_TOTALS") != nullptr) {
    cases.clear();
    for (const int steps : {10, 20, 100, 1000})
      for (const std::array<int, 2> cells : {std::array{6, 16}, std::array{16, 6}}) {
        cases.push_back({CouplingKind::mortar, cells, 3e11, steps, 1.4});
        if (steps < 1000) cases.push_back({CouplingKind::interpolation, cells, 3e11, steps, 2});
      }
  }
  for (const auto& [coupling, cells, young, steps, most] : cases) {
    const auto material = perzynaMaterial({young, 0.3}, noteLaw(Projection::frobenius));
    const Model model = compression(cells[0], cells[1], material, coupling, upperBody);
    const auto [state, bound] = boundedRun(model, {.end = 1, .steps = steps});
    ASSERT_EQ(bound.obstacle + bound.moved, "");
    const double error = strainBetween(model, state, flownUnder10(*material));
    std::cout << nameOf(coupling) << " " << cells[0] << ":" << cells[1] << ", E = " << young << ", " << steps
              << " steps: error of the viscoplastic strain " << 100 * error / bound.strainNorm
              << " %, bound over error " << bound.fixed.strain / error << ", whatever contact does "
              << bound.any.strain / error << ", the lift's part " << bound.lifted / error << "\n";
    EXPECT_GE(bound.fixed.strain, error);
    EXPECT_LE(bound.fixed.strain, most * error);
    // Forces grow from nothing: the price is sqrt(ln(10)/2)/0.9 where the rate is bounded alike at all times.
    if (coupling == CouplingKind::mortar) {
      EXPECT_EQ(bound.closes, "");
      EXPECT_GE(bound.any.strain, 1.1 * bound.fixed.strain);
      EXPECT_LE(bound.any.strain, 1.3 * bound.fixed.strain);
    }
    EXPECT_LE(bound.data, 1e-12);
    if (coupling == CouplingKind::mortar) {
      EXPECT_LE(bound.lifted, 1e-9 * error);
    }
  }
}

// ---- no flow: what is left is the bound of elastic bodies
TEST(TotalBound, addsUpStressesOutOfBalanceAndTheLift) {
  const Elasticity elasticity{20, 0.3};
  const Function load = [](double x, double, double t) { return -t * (5 + 3 * x); };
  const auto blocks = [&](const std::shared_ptr<const Material>& material, int lowerCells,
                          CouplingKind coupling) {
    Body upper("upper", square(0, 3), material, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
    Body lower("lower", square(-1, lowerCells), material,
               {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    return contactModel(std::move(upper), std::move(lower), coupling, upperBody);
  };
  const auto stiff = perzynaMaterial(elasticity, {10, 1e9, Projection::frobenius});
  const auto elastic = elasticMaterial(elasticity);
  for (const CouplingKind coupling : couplings) {
    const int lowerCells = coupling == CouplingKind::mortar ? 3 : 8;
    const Bounded total = boundedRun(blocks(stiff, lowerCells, coupling), {.end = 1, .steps = 3});
    const Model model = blocks(elastic, lowerCells, coupling);
    const EnergyBound bound = energyBound(model, run(model, 1, 1).state);
    ASSERT_EQ(total.bound.obstacle + total.bound.moved + bound.obstacle, "");
    // |s^ - s| + |s~ - s^|: where meshes match nothing is lifted, and these are one.
    const double drift = total.bound.fixed.stress - bound.stress;
    if (coupling == CouplingKind::mortar) {
      EXPECT_NEAR(drift, bound.stress, 1e-9 * bound.stress);
    } else {
      EXPECT_GE(drift, std::abs(bound.stress - bound.lift));
      EXPECT_LE(drift, 0.9 * bound.stress);  // s is not that of a displacement without penetration
    }
    EXPECT_GE(total.bound.any.stress, total.bound.fixed.stress * (1 - 1e-12));
  }
}

// ---- finer meshes and shorter steps
struct Distance {
  double strain = 0;
  double stress = 0;
};

/// Between a state and one on finer meshes.
Distance distance(const Refined& fine, const State& state, const State& other) {
  Distance squares;
  for (size_t b = 0; b < state.bodies.size(); ++b) {
    const Body& body = fine.model.bodies[b];
    Matrix stress = other.bodies[b].stress;
    Matrix strain = other.bodies[b].viscoplasticStrain;
    for (Eigen::Index t = 0; t < stress.cols(); ++t) {
      stress.col(t) -= state.bodies[b].stress.col(fine.parents[b][t]);
      strain.col(t) -= state.bodies[b].viscoplasticStrain.col(fine.parents[b][t]);
    }
    Matrix elastic;
    body.material().elasticStrain(stress, elastic);
    for (int i = 0; i < body.points(); ++i) {
      squares.stress += body.weights()[i] * stress.col(i).dot(elastic.col(i));
      squares.strain += body.weights()[i] * strain.col(i).squaredNorm();
    }
  }
  return {std::sqrt(squares.strain), std::sqrt(squares.stress)};
}

TEST(TotalBound, isAboveTheDistanceFromFinerMeshesAndShorterSteps) {
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const double young : {1e4, 20.0})
      for (const CouplingKind coupling : couplings) {
        const Elasticity elasticity{young, 0.3};
        const Viscoplasticity law = noteLaw(Projection::frobenius);
        const bool strain = plane == Plane::strain;
        const auto flows = perzynaMaterial(elasticity, law, strain ? Plane::strain : Plane::stress);
        const auto elastic = elasticMaterial(elasticity, strain ? Plane::strain : Plane::stress);
        const Function load = [](double x, double, double t) { return -t * (5 + 3 * x); };
        Body upper("upper", square(0, 2), flows, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
        Body lower("lower", square(-1, 3), elastic,
                   {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
        const Model model = contactModel(std::move(upper), std::move(lower), coupling, upperBody);
        const Refined fine = refined(model, 2);
        const Bounded coarse = boundedRun(model, {.end = 1, .steps = 8});
        const Bounded close = boundedRun(fine.model, {.end = 1, .steps = 32});
        ASSERT_EQ(coarse.bound.obstacle + close.bound.obstacle, "");
        const Distance off = distance(fine, coarse.state, close.state);
        std::cout << (strain ? "plane strain" : "plane stress") << ", E = " << young << ", "
                  << nameOf(coupling) << ": bound over distance " << coarse.bound.fixed.strain / off.strain
                  << " (viscoplastic strain), " << coarse.bound.fixed.stress / off.stress << " (stress), "
                  << coarse.bound.any.strain / off.strain << " whatever contact does" << coarse.bound.moved
                  << coarse.bound.closes << "\n";
        ASSERT_EQ(coarse.bound.moved + close.bound.moved, "");
        EXPECT_LE(off.strain, coarse.bound.fixed.strain + close.bound.fixed.strain);
        EXPECT_LE(off.stress, coarse.bound.fixed.stress + close.bound.fixed.stress);
        EXPECT_LE(coarse.bound.fixed.strain, 12 * off.strain);
      }
}

/// The upper block is pressed at its left and lifted at its right: half of the line is open, and what flows
/// moves the end of contact. From half of the time on it may be only pressed, so that contact grows.
Model tiltedBlock(CouplingKind coupling, bool grows) {
  const Elasticity elasticity{50, 0.3};
  const Function rise = [grows](double x, double, double t) {
    return grows ? -0.15 * t + 0.2 * x * std::min(t, 0.5) : t * (-0.15 + 0.2 * x);
  };
  Body upper("upper", square(0, 2), perzynaMaterial(elasticity, noteLaw(Projection::frobenius)),
             {{{top, 0, constant(0)}, {top, 1, rise}}, {}, {}});
  Body lower("lower", square(-1, 3), elasticMaterial(elasticity),
             {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return contactModel(std::move(upper), std::move(lower), coupling, upperBody);
}

// Gaps and pressures of the lifted fields are such that no gap closes and nothing is pressed anew.
TEST(TotalBound, holdsInPartialContact) {
  for (const bool grows : {false, true})
    for (const CouplingKind coupling : couplings) {
      const Model model = tiltedBlock(coupling, grows);
      const Refined fine = refined(model, 2);
      std::array<int, 2> chosen{};
      const Bounded coarse = boundedRun(model, {.end = 1, .steps = 16}, &chosen[0]);
      const Bounded close = boundedRun(fine.model, {.end = 1, .steps = 64}, &chosen[1]);
      const Distance off = distance(fine, coarse.state, close.state);
      std::cout << nameOf(coupling) << (grows ? ", contact grows" : "") << ": bound over distance "
                << coarse.bound.any.strain / off.strain << " (viscoplastic strain), "
                << coarse.bound.any.stress / off.stress << " (stress); over the norm "
                << coarse.bound.any.strain / coarse.bound.strainNorm << ", finer "
                << close.bound.any.strain / close.bound.strainNorm << "; chosen in " << chosen[0]
                << " steps, finer " << chosen[1] << "; " << coarse.bound.obstacle << coarse.bound.closes
                << close.bound.obstacle << close.bound.closes << "\n";
      ASSERT_EQ(coarse.bound.obstacle + coarse.bound.closes + close.bound.obstacle + close.bound.closes, "");
      EXPECT_NE(coarse.bound.moved, "");
      EXPECT_TRUE(!grows || std::min(chosen[0], chosen[1]) > 0);
      EXPECT_LE(off.strain, coarse.bound.any.strain + close.bound.any.strain);
      EXPECT_LE(off.stress, coarse.bound.any.stress + close.bound.any.stress);
    }
}

/// Some have no bound: contact opens there while bodies flow, or closes. Some have no load, and stresses that
/// are rounding: moduli and lengths are about 1.
TEST(TotalBound, isAboveTheDistanceInRandomScenes) {
  const char* wanted = std::getenv("MORTIER_RANDOM_TOTALS");
  const unsigned count = wanted != nullptr ? std::atoi(wanted) : 40;
  constexpr double rounding = 1e-12;
  unsigned bounded = 0;
  unsigned loaded = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    Randoms random(seed + 2000);
    RandomScene scene(seed);
    const Model elastic = scene.model();
    Model model;
    const bool strain = random.below(2) == 0;
    std::vector<std::shared_ptr<const Material>> materials;
    for (const Body& body : elastic.bodies) {
      const Elasticity elasticity{std::exp(random.normal()), 0.1 * random.below(5)};
      const Viscoplasticity law{std::pow(10, -2.0 + random.below(4)), 0.03 * std::exp(random.normal()),
                                Projection::frobenius};
      materials.push_back(perzynaMaterial(elasticity, law, strain ? Plane::strain : Plane::stress));
      model.bodies.emplace_back(body.name(), body.mesh(), materials.back(), body.conditions());
    }
    for (const ContactInterface& interface : elastic.interfaces) addInterface(model, interface.pair());
    const Refined fine = refined(model, 1);
    const auto [coarseState, coarse] = boundedRun(model, {.end = 1, .steps = 4});
    const auto unloaded = [](const BodyState& body) { return body.stress.cwiseAbs().maxCoeff() <= rounding; };
    if (std::all_of(coarseState.bodies.begin(), coarseState.bodies.end(), unloaded)) continue;
    ++loaded;
    if (!coarse.obstacle.empty() || !coarse.closes.empty()) continue;
    const auto [fineState, close] = boundedRun(fine.model, {.end = 1, .steps = 16});
    if (!close.obstacle.empty() || !close.closes.empty()) continue;
    ++bounded;
    const Distance off = distance(fine, coarseState, fineState);
    EXPECT_LE(off.strain, coarse.any.strain + close.any.strain + 1e-9 * coarse.strainNorm)
        << "scene " << seed;
    EXPECT_LE(off.stress, coarse.any.stress + close.any.stress + 1e-9 * coarse.stressNorm)
        << "scene " << seed;
  }
  std::cout << bounded << " of " << loaded << " have a bound\n";
  EXPECT_GE(4 * loaded, 3 * count);
  EXPECT_GE(3 * bounded, 2 * loaded);
}

TEST(TotalBound, tellsWhichConditionFails) {
  const auto boundUnder = [&](const Function& load, Projection projection, double lowerY, int steps) {
    const auto material = perzynaMaterial({1e3, 0.3}, noteLaw(projection));
    Body upper("upper", square(0, 1), material, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
    Body lower("lower", square(lowerY, 1), material,
               {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    return boundedRun(contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody),
                      {.end = 1, .steps = steps})
        .bound;
  };
  const Function load = [](double, double, double t) { return -10 * t; };
  EXPECT_EQ(boundUnder(load, Projection::frobenius, -1, 8).obstacle, "");
  EXPECT_EQ(boundUnder(load, Projection::elasticity, -1, 8).obstacle,
            "the flow of upper has no potential: Perzyna (elasticity)");
  EXPECT_EQ(boundUnder(constant(-5), Projection::frobenius, -1, 8).obstacle, "");
  // With a flow in the first step there is nothing whatever contact does.
  const TotalBound first = boundUnder(load, Projection::frobenius, -1, 4);
  EXPECT_EQ(first.obstacle + first.moved, "");
  EXPECT_EQ(first.closes, "bodies flow in the first step");
  // Contact that opens, or closes, while the top is moved.
  const auto movedBlocks = [&](const Function& rise) {
    const auto material = perzynaMaterial({1e3, 0.3}, noteLaw(Projection::frobenius));
    Body upper("upper", square(0, 1), material, {{{top, 0, constant(0)}, {top, 1, rise}}, {}, {}});
    Body lower("lower", square(-1, 1), material,
               {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    return contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody);
  };
  const TimePlan plan{.end = 1, .steps = 16};
  const Model parting =
      movedBlocks([](double, double, double t) { return t < 0.5 ? -0.02 * t : -0.01 + 0.2 * (t - 0.5); });
  const auto [state, opens] = boundedRun(parting, plan);
  EXPECT_EQ(opens.obstacle, "");
  EXPECT_EQ(opens.moved, "contact opens in step 9");
  EXPECT_EQ(opens.closes, "");
  // What contact does when it opens: A has half the force times the gap.
  const double force = run(parting, 0.5, 8).state.contactForce[0].sum();
  const double gap = -run(parting, 9. / 16, 9).state.gap[0].maxCoeff();
  std::cout << "opening " << std::sqrt(force * gap) << ", bound " << opens.any.stress << "\n";
  EXPECT_GE(opens.any.stress, std::sqrt(force * gap));
  const TotalBound closes =
      boundedRun(
          movedBlocks([](double, double, double t) { return t < 0.5 ? 0.02 * t : 0.01 - 0.1 * (t - 0.5); }),
          plan)
          .bound;
  EXPECT_EQ(closes.obstacle, "contact closes in step 10, a gap becomes smaller in step 9");
}

TEST(TotalBound, goesOnFromAStateAsIfItHadNotStopped) {
  for (const bool partial : {false, true}) {
    const Model model = partial
                            ? tiltedBlock(CouplingKind::mortar, true)
                            : compression(2, 3, perzynaMaterial({50, 0.3}, noteLaw(Projection::frobenius)),
                                          CouplingKind::interpolation, upperBody);
    State state = initialState(model);
    TotalBoundMemory whole;
    TotalBoundMemory parts;
    TotalBoundRecord record(model, state, whole);
    auto other = std::make_unique<TotalBoundRecord>(model, state, parts);
    (void)march(model, state, {.end = 1, .steps = 12}, {}, [&](const State& now, const StepReport& report) {
      for (TotalBoundRecord* each : {&record, other.get()}) {
        each->look(now, report.step);
        each->add("");
      }
      if (report.step == 5) other = std::make_unique<TotalBoundRecord>(model, now, parts);
    });
    EXPECT_GT(partial ? whole.any.misfit : whole.fixed.misfit, 0);
    for (const auto course : {&TotalBoundMemory::fixed, &TotalBoundMemory::any}) {
      EXPECT_EQ((whole.*course).misfit, (parts.*course).misfit);
      EXPECT_EQ((whole.*course).drift, (parts.*course).drift);
      EXPECT_EQ((whole.*course).sums, (parts.*course).sums);
    }
    EXPECT_EQ(whole.earlier.gaps, parts.earlier.gaps);
    EXPECT_EQ(whole.earlier.gaps.empty(), !partial);
  }
}

}  // namespace mortier::total_bound_test
