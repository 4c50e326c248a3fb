#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/generate.h"
#include "plan/estimate_doubts.h"
#include "plan/plan.h"
#include "unit/scene_folder.h"

namespace mortier::plan_test {

/// Two blocks on meshes of 3 and 2 cells, one diagonal a cell.
class PlanFiles : public SceneFolder {
 protected:
  PlanFiles() : SceneFolder("plan_test") {
    grid("upper.mesh", 0, 3, Cut::rising);
    grid("lower.mesh", -1, 2, Cut::rising);
  }

  /// \param first  which corner of a triangle is named first
  void grid(const std::string& name, double y, int n, Cut cut, int first = 0) const {
    const auto at = [&](int i, int j) { return Point(double(i) / n, y + double(j) / n); };
    TriangleMesh mesh = gridMesh({.n1 = n, .n2 = n, .at = at}, cut, name);
    for (auto& triangle : mesh.triangles)
      std::rotate(triangle.begin(), triangle.begin() + first, triangle.end());
    writeMedit(mesh, folder + "/" + name);
  }
  [[nodiscard]] SceneDescription scene(const std::vector<std::string>& settings = {}) const {
    write(R"toml([[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 4, ux = 0 }, { label = 3, ty = -2 } ]
[[body]]
name = "lower"
mesh = "lower.mesh"
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 4, ux = 0 }, { label = 1, uy = "0.01*t" } ]
)toml" + std::string(contactOfTwoBlocks) +
          "steps = 4\n");
    return readScene(path(), settings);
  }
};

std::vector<SampledDatum> dataOf(const SceneDescription& scene, const Model& model) {
  return sampledData(meshedScene(scene, model));
}

TEST_F(PlanFiles, loadsAreSizedByTractionAndByStrain) {
  const SceneDescription description = scene();
  const Model blocks = modelOf(description);
  const std::vector<SampledDatum> data = dataOf(description, blocks);
  ASSERT_EQ(data.size(), 4u);
  EXPECT_EQ(nominalStress(description, data, 0), 2);  // the traction
  EXPECT_EQ(nominalStress(description, data, 2), 2);  // 100 * 0.02 / 1, the same
  EXPECT_EQ(nominalStress(description, data, 4), 4);
  // A traction on the left, where x = 0, and a force: its size over the extent, which is 1.
  const SceneDescription along = scene({"body.upper.boundary.4.ty=-3*y", "body.lower.force.x=t*(x-2*y)"});
  const std::vector<SampledDatum> varying = dataOf(along, blocks);
  EXPECT_EQ(nominalStress(along, varying, 0), 3);
  EXPECT_NEAR(nominalStress(along, varying, 4), 12, 1e-12);  // at (1, -1)
  EXPECT_EQ(std::count_if(data.begin(), data.end(),
                          [&](const SampledDatum& datum) { return changesInTime(datum, description.time); }),
            1);
}

// Whatever divides the run evenly does not hide a period.
TEST(TrialTimes, meetNoPeriod) {
  const std::vector<double> times = trialTimes({.end = 3, .steps = 1});
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  EXPECT_EQ(times.front(), 0);
  EXPECT_EQ(times.back(), 3);
  for (const int waves : {1, 2, 8, 64, 128}) {
    double largest = 0;
    for (const double t : times) largest = std::max(largest, std::abs(std::sin(M_PI * waves * t / 3)));
    EXPECT_GT(largest, 0.5) << waves;
  }
}

TEST_F(PlanFiles, stepsAtRestAndTheOnesThatAreTaken) {
  const auto says = [](const Plan& plan, bool modelled, const std::string& what) {
    return std::any_of(plan.begin(), plan.end(), [&](const PlanItem& item) {
      return item.modelled == modelled && item.what.find(what) != std::string::npos && !item.why.empty();
    });
  };
  const SceneDescription moving = scene();
  EXPECT_TRUE(says(planOf(moving, modelOf(moving)), true, "4 steps of 0.5 s"));
  EXPECT_TRUE(says(planOf(moving, modelOf(moving)), true, "linear: one Cholesky factor"));
  const SceneDescription still = scene({"body.lower.boundary.1.uy=0"});
  EXPECT_TRUE(says(planOf(still, modelOf(still)), true, "one step"));
  EXPECT_TRUE(says(planOf(still, modelOf(still)), false, "the other 3 steps"));
  const SceneDescription inSpace = scene({"body.lower.boundary.1.uy=0.01*x"});
  EXPECT_TRUE(says(planOf(inSpace, modelOf(inSpace)), true, "one step"));
  const SceneDescription firstOnly = scene({"body.lower.boundary.1.uy=0", "body.upper.boundary.4.ux=0.01*t"});
  EXPECT_TRUE(says(planOf(firstOnly, modelOf(firstOnly)), true, "4 steps of 0.5 s"));
  const SceneDescription flowing =
      scene({"body.upper.material={ young = 100, poisson = 0.3, viscosity = 1, yield_stress = 50 }"});
  EXPECT_TRUE(says(planOf(flowing, modelOf(flowing)), false, "flow, as none is expected"));
  EXPECT_NE(planText(planOf(flowing, modelOf(flowing))).find("modelled   contact 0: unilateral"),
            std::string::npos);
}

// Beside an accuracy meshes are refined in rounds; steps are the scene's own where nothing flows, and chosen
// by a part of what is asked where something does.
TEST_F(PlanFiles, stepsBesideAnAccuracy) {
  const std::string flows =
      "body.upper.material={ young = 100, poisson = 0.3, viscosity = 1, yield_stress = 50 }";
  const auto textOf = [&](std::vector<std::string> settings) {
    settings.emplace_back("accuracy.energy=0.01");
    const SceneDescription description = scene(settings);
    return planText(planOf(description, modelOf(description)));
  };
  const auto says = [](const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
  };
  const std::string still = "body.lower.boundary.1.uy=0";
  for (const std::string& text : {textOf({}), textOf({still}), textOf({flows}), textOf({flows, still})}) {
    EXPECT_TRUE(says(text, "modelled   scene: rounds on meshes that are refined")) << text;
    EXPECT_TRUE(says(text, "(accuracy.energy = 0.01)")) << text;
    EXPECT_FALSE(says(text, "for the whole run")) << text;
    EXPECT_TRUE(says(text, "one Cholesky factor for each round")) << text;
  }
  EXPECT_TRUE(says(textOf({}), "modelled   time: 4 steps of 0.5 s, backward-euler (loads change)"));
  EXPECT_FALSE(says(textOf({}), "error in time"));
  EXPECT_TRUE(says(textOf({still}), "modelled   time: one step"));
  EXPECT_TRUE(says(textOf({"time.tolerance=0.005"}), "steps chosen by an error in time of 0.005, backward"));
  // A fifth of what is asked, a quarter at degree 2; the scene's own where that is smaller.
  for (const auto& [setting, tolerance] : {std::pair<std::string, std::string>{"degree=1", "0.002"},
                                           {"degree=2", "0.0025"},
                                           {"time.tolerance=0.001", "0.001"},
                                           {"time.tolerance=0.005", "0.002"}}) {
    const std::string text = textOf({flows, setting});
    EXPECT_TRUE(says(text, "modelled   time: steps chosen by an error in time of " + tolerance +
                               " in the last round, backward-euler"))
        << text;
    EXPECT_FALSE(says(text, "modelled   time: 4 steps"));
    EXPECT_EQ(says(text, "left out   time: the scene's 4 steps of 0.5 s (beside an accuracy"),
              setting.find("time.tolerance") == std::string::npos);
  }
  const SceneDescription without = scene({flows});
  EXPECT_FALSE(says(planText(planOf(without, modelOf(without))), "round"));
}

TEST_F(PlanFiles, estimatesThatAreKnownToBeWrongAreNamed) {
  const auto doubts = [&](const std::vector<std::string>& settings) {
    const SceneDescription description = scene(settings);
    return estimateDoubts(description, modelOf(description));
  };
  EXPECT_TRUE(doubts({}).empty());
  ASSERT_EQ(doubts({"contact.variant=interpolation"}).size(), 1u);
  EXPECT_NE(doubts({"contact.variant=interpolation"})[0].find("0.34 to 0.8"), std::string::npos);
  const auto flowing = [&](const std::string& body, double young) {
    return doubts({"body." + body + ".material={ young = " + std::to_string(young) +
                   ", poisson = 0.3, viscosity = 1, yield_stress = 1 }"});
  };
  for (const std::string body : {"upper", "lower"}) {
    EXPECT_TRUE(flowing(body, 9e3).empty());
    ASSERT_EQ(flowing(body, 1.1e4).size(), 1u);
    EXPECT_NE(flowing(body, 1.1e4)[0].find("body " + body + " may flow"), std::string::npos);
  }
  EXPECT_TRUE(doubts({"body.upper.material.young=1e5"}).empty());  // elastic
  EXPECT_TRUE(doubts({"body.material.poisson=0.4999"}).empty());   // plane stress
  EXPECT_EQ(doubts({"body.material.poisson=0.4999", "plane=strain"}).size(), 2u);
  for (const int first : {0, 1, 2}) {
    grid("upper.mesh", 0, 3, Cut::both, first);
    EXPECT_EQ(doubts({"body.material.poisson=0.4999", "plane=strain"}).size(), 1u) << first;
  }
  grid("upper.mesh", 0, 2, Cut::rising);
  EXPECT_TRUE(doubts({"contact.variant=interpolation"}).empty());  // meshes that match
  EXPECT_EQ(doubts({"body.material.poisson=0.49", "plane=strain", "degree=2"}).size(), 2u);
  grid("lower.mesh", -1, 8, Cut::rising);  // every nonmortar node lies on a mortar node
  EXPECT_EQ(doubts({"contact.variant=interpolation"}).size(), 1u);
}

}  // namespace mortier::plan_test
