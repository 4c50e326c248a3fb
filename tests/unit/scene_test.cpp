#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <thread>

#include "base/error.h"
#include "material/perzyna.h"
#include "mesh/generate.h"
#include "scene/document.h"
#include "scene/keys.h"
#include "scene/load_courses.h"
#include "scene/readers.h"
#include "unit/two_blocks_scene.h"

namespace mortier::scene_test {

TEST_F(SceneFiles, readsEveryKey) {
  const SceneDescription scene = readScene(path());
  EXPECT_EQ(scene.title, "two blocks");
  ASSERT_EQ(scene.bodies.size(), 2u);
  const BodyDescription& upper = scene.bodies[0];
  EXPECT_EQ(upper.name, "upper");
  EXPECT_EQ(upper.mesh.path, folder + "/upper.mesh");
  EXPECT_EQ(upper.material.elasticity.young, 3e11);
  const auto* flow = upper.material.as<Viscoplasticity>();
  ASSERT_TRUE(flow);
  EXPECT_EQ(flow->viscosity, 10);
  EXPECT_EQ(flow->projection, Projection::elasticity);
  EXPECT_FALSE(upper.force[0]);
  EXPECT_DOUBLE_EQ(upper.force[1]->value(0, 0, 2), -19.62);
  ASSERT_EQ(upper.conditions.size(), 2u);
  EXPECT_EQ(upper.conditions[1].kind, ConditionDescription::Kind::traction);
  EXPECT_EQ(upper.conditions[1].component, 1);
  EXPECT_DOUBLE_EQ(upper.conditions[1].value.value(0, 1, 0.5), -5);
  EXPECT_FALSE(scene.bodies[1].material.flows());
  EXPECT_EQ(scene.bodies[1].conditions[1].component, 1);
  ASSERT_EQ(scene.contacts.size(), 1u);
  EXPECT_EQ(scene.contacts[0].variant, CouplingKind::mortar);
  EXPECT_EQ(scene.contacts[0].mortar().label, 3);
  EXPECT_EQ(scene.time.steps, 20);
  EXPECT_EQ(scene.every, 0);
}

TEST_F(SceneFiles, buildsTheModel) {
  const Model model = modelOf(readScene(path(), {"contact.swap=true"}));
  ASSERT_EQ(model.bodies.size(), 2u);
  ASSERT_EQ(model.interfaces.size(), 1u);
  EXPECT_EQ(model.interfaces[0].pair().nonmortar.body, 1);
  EXPECT_EQ(model.interfaces[0].pair().mortar.label, 1);
  EXPECT_EQ(model.bodies[0].mesh().triangles.size(), 16u);
}

TEST_F(SceneFiles, overridesByNameByLabelByIndexAndForAll) {
  const SceneDescription scene =
      readScene(path(), {"time.steps=5", "contact.variant=interpolation", "body.upper.boundary.3.ty=-7",
                         "body.1.material.poisson=0.1", "body.material.young=5", "output.every=2",
                         "solver.linear=suitesparse", "body.lower.force.x=2*y"});
  EXPECT_EQ(scene.time.steps, 5);
  EXPECT_EQ(scene.contacts[0].variant, CouplingKind::interpolation);
  EXPECT_EQ(scene.bodies[0].conditions[1].value.value(0, 0, 1), -7);
  EXPECT_EQ(scene.bodies[1].material.elasticity.poisson, 0.1);
  EXPECT_EQ(scene.bodies[0].material.elasticity.young, 5);
  EXPECT_EQ(scene.bodies[1].material.elasticity.young, 5);
  EXPECT_EQ(scene.every, 2);
  EXPECT_EQ(scene.solver.linear, LinearEngine::suitesparse);
  EXPECT_EQ(scene.bodies[1].force[0]->value(0, 3, 0), 6);
}

TEST_F(SceneFiles, overriddenMeshIsRelativeToTheCurrentFolder) {
  const SceneDescription scene = readScene(path(), {"body.upper.mesh=" + folder + "/lower.mesh"});
  EXPECT_EQ(scene.bodies[0].mesh.path, folder + "/lower.mesh");
  EXPECT_NE(fault({"body.upper.mesh=upper.mesh"}).find("there is none at upper.mesh"), std::string::npos);
}

TEST_F(SceneFiles, messagesNameFileLineKeyValueAndExpectation) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> faults{
      {{"body.upper.material.poisson=0.6"},
       "--set body.upper.material.poisson=0.6: body upper: poisson = 0.6, expected -1 < poisson < 0.5"},
      {{"time.steps=0"}, "--set time.steps=0: time: steps = 0, expected an integer >= 1"},
      {{"body.upper.name=lower"},
       "scene.toml:13: body lower: name = \"lower\", expected a name of its own, there is "
       "one at scene.toml:2"},
      {{"body.lower.boundary.1.uy=0", "body.lower.boundary.4.uy=1"},
       "--set body.lower.boundary.1.uy=0: body lower: uy = 0 at (0, -1), t = 0: expected the 1 that label 4 "
       "prescribes there"},
      {{"contact.mortar.label=7"},
       "--set contact.mortar.label=7: body lower: label = 7, expected one of 1, 2, 3, 4 "
       "(boundary labels of lower.mesh)"},
      {{"contact.mortar.body=upper", "contact.mortar.label=1"},
       "--set contact.mortar.label=1: contact: both sides are label 1 of body upper, expected two sides"},
      {{"time.step=3"},
       "--set time.step=3: no step in time, did you mean steps? Expected one of end, steps, scheme, "
       "tolerance, max_steps, "
       "breaks"},
  };
  for (const auto& [settings, message] : faults) {
    EXPECT_EQ(fault(settings), message);
  }
}

TEST_F(SceneFiles, stepsByTheirErrorNeedATolerance) {
  const SceneDescription scene = readScene(
      path(), {"time={end=2, scheme=\"sdirk2\", tolerance=1e-4, max_steps=50, breaks=[1.5, 0.25]}"});
  EXPECT_EQ(scene.time.tolerance, 1e-4);
  EXPECT_EQ(scene.time.steps, 0);
  EXPECT_EQ(scene.time.maxSteps, 50);
  EXPECT_EQ(scene.time.breaks, (std::vector<double>{0.25, 1.5}));
  // The jump of the lower support's datum is found beside them.
  EXPECT_EQ(loadCourses(scene, modelOf(scene)).breaks,
            (std::vector<double>{0.25, 1, std::nextafter(1.0, 2.0), 1.5}));
  const std::vector<std::pair<std::vector<std::string>, std::string>> faults = {
      {{"time.tolerance=0"}, "--set time.tolerance=0: time: tolerance = 0, expected 0 < tolerance < 1"},
      {{"time.max_steps=9"},
       "--set time.max_steps=9: time: max_steps = 9, expected it only beside tolerance: without, steps are "
       "equal"},
      {{"time.tolerance=0.1", "time.scheme=crank-nicolson"},
       "--set time.scheme=crank-nicolson: time: scheme = \"crank-nicolson\", expected sdirk2 or "
       "backward-euler "
       "beside tolerance: crank-nicolson has no error estimate"},
      {{"time.tolerance=0.1", "time.breaks=[1, 2]"},
       "--set time.breaks=[1, 2]: time: breaks has 2, expected an array of times between 0 and end = 2"},
      {{"time.tolerance=0.1", "time.breaks=[0, 1]"},
       "--set time.breaks=[0, 1]: time: breaks has 0, expected an array of times between 0 and end = 2"},
  };
  for (const auto& [settings, message] : faults) {
    EXPECT_EQ(fault(settings), message);
  }
}

TEST(Expression, evaluatesAndKnowsConstants) {
  EXPECT_DOUBLE_EQ(parseExpression("2*x + y^2 - t", "").value(1, 3, 4), 7);
  EXPECT_DOUBLE_EQ(parseExpression("x > 0.5 ? sin(pi*t/2) : 1", "").value(1, 0, 1), 1);
  EXPECT_TRUE(parseExpression("3*pi", "").constant);
  EXPECT_FALSE(parseExpression("0*t", "").constant);
}

TEST(Expression, tablesAreLinearInTimeAndConstantOutside) {
  const Expression table = tableExpression({0, 1, 3}, {2, 4, -2}, "here");
  for (const auto& [t, value] :
       {std::pair(-1.0, 2.0), {0.0, 2.0}, {0.25, 2.5}, {1.0, 4.0}, {2.0, 1.0}, {3.0, -2.0}, {9.0, -2.0}}) {
    EXPECT_DOUBLE_EQ(table.value(7, 7, t), value);
    // Its text says the same.
    EXPECT_DOUBLE_EQ(parseExpression(table.text, "").value(7, 7, t), value);
    EXPECT_DOUBLE_EQ(negated(table).value(7, 7, t), -value);
    EXPECT_DOUBLE_EQ(parseExpression(negated(table).text, "").value(7, 7, t), -value);
  }
  EXPECT_EQ(table.breaks, (std::vector<double>{0, 1, 3}));
  EXPECT_EQ(negated(table).breaks, table.breaks);
}

TEST_F(SceneFiles, readsRollersPressureAndTables) {
  const SceneDescription scene = readScene(
      path(), {"body.upper.boundary={label=3, pressure={time=[0, 0.5, 2], value=[0, 3, 1]}, ut=\"x\"}",
               "body.lower.boundary={label=4, un=0}", "body.lower.force.x={time=[0.5, 1], value=[0, 1]}"});
  const std::vector<ConditionDescription>& upper = scene.bodies[0].conditions;
  ASSERT_EQ(upper.size(), 2u);
  EXPECT_EQ(upper[0].kind, ConditionDescription::Kind::displacement);
  EXPECT_EQ(upper[0].component, alongTangent);
  EXPECT_EQ(upper[1].kind, ConditionDescription::Kind::traction);
  EXPECT_EQ(upper[1].component, alongNormal);
  EXPECT_DOUBLE_EQ(upper[1].value.value(0, 0, 0.25), -1.5);
  EXPECT_EQ(scene.bodies[1].conditions[0].component, alongNormal);
}

// Two pulses of the tables are far shorter than what is found by trying.
TEST_F(SceneFiles, breaksOfTablesAreAllKnown) {
  const SceneDescription scene = readScene(
      path(), {"time={end=2, tolerance=1e-4, scheme=\"sdirk2\"}",
               "body.upper.boundary={label=3, pressure={time=[0, 0.3001, 0.3002, 2], value=[0, 3, 1, 1]}}",
               "body.lower.boundary={label=1, un={time=[-1, 1.3, 1.3000001, 3], value=[0, 0, 1e-9, 0]}}",
               "body.lower.force.x={time=[0.5, 1], value=[0, 1]}"});
  EXPECT_EQ(loadCourses(scene, modelOf(scene)).breaks,
            (std::vector<double>{0.3001, 0.3002, 0.5, 1, 1.3, 1.3000001}));
}

// However many steps are asked for, the data are looked at where they were sampled.
TEST_F(SceneFiles, looksAtDataBetweenStepsInATimeThatDoesNotGrowWithThem) {
  const auto looks = [&](int steps) {
    SceneDescription scene = readScene(path(), {});
    scene.time.steps = steps;
    const Model model = modelOf(scene);
    const auto count = std::make_shared<int>(0);
    for (BodyDescription& body : scene.bodies)
      for (ConditionDescription& condition : body.conditions)
        condition.value.value = [count, value = condition.value.value](double x, double y, double t) {
          ++*count;
          return value(x, y, t);
        };
    EXPECT_TRUE(loadsBetweenSteps(scene, model).empty());
    return *count;
  };
  EXPECT_LT(looks(1 << 28), 3 * looks(1 << 14));
}

// The step in which a datum goes far beyond both its ends is named, in the middle of the run and at its end.
TEST_F(SceneFiles, namesTheStepInWhichALoadGoesBeyondItsEnds) {
  for (const int pulse : {0, 7, 9}) {
    std::string load =
        "body.upper.boundary={label=3, ty=\"-exp(-((t-" + std::to_string(pulse) + ".5)/0.2)^2)\"}";
    const SceneDescription scene = readScene(path(), {"time={end=10, steps=10}", load});
    const std::vector<std::string> warnings = loadsBetweenSteps(scene, modelOf(scene));
    ASSERT_EQ(warnings.size(), 1);
    const std::string step =
        "between t = " + std::to_string(pulse) + " and " + std::to_string(pulse + 1) + " s";
    EXPECT_NE(warnings[0].find(step), std::string::npos) << warnings[0];
  }
}

// A product one factor of which is t is not sampled; others that look like it are.
TEST_F(SceneFiles, onlyWhatIsProportionalToTimeIsNotLookedAt) {
  const auto warnings = [&](const std::string& datum) {
    const SceneDescription scene =
        readScene(path(), {"time={end=1, steps=1}", "body.upper.boundary={label=3, ty=\"" + datum + "\"}"});
    return loadsBetweenSteps(scene, modelOf(scene)).size();
  };
  for (const char* datum : {"t*(sin(9*t))", "sin(9*t)*t", "-t*t*sin(9*t)", "t*4^sin(9*t)", "t - sin(9*t)",
                            "t*(t < 0.9)", "t*(1 - x)/(0.02 + abs(t - 0.5))"})
    EXPECT_EQ(warnings(datum), 1) << datum;
  for (const char* datum : {"-10*t", "t*sin(9*x)", "(1 + x)*t/3", "2*-t"})
    EXPECT_EQ(warnings(datum), 0) << datum;
}

TEST(Expression, copiesAreIndependent) {
  const Function original = parseExpression("x + 10*y + 100*t", "").value;
  const auto work = [original](double shift) mutable {
    for (int i = 0; i < 20000; ++i) {
      ASSERT_EQ(original(i, shift, 1), i + 10 * shift + 100);
    }
  };
  std::thread one(work, 1);
  std::thread two(work, 2);
  one.join();
  two.join();
}

TEST(Expression, rejectsWhatIsNone) {
  for (const char* text :
       {"", "  ", "2*", "z", "1, 2", "x = 3", "sin(", "1/0", "sqrt(-1)", "1e400", "foo(x)", "\"a\""}) {
    EXPECT_THROW(parseExpression(text, "here"), InputError) << text;
  }
}

TEST_F(SceneFiles, defaultsOfKeysAreThoseOfTheTypes) {
  const SceneDescription scene = readScene(
      path(), {"solver={}", "time={end=1, tolerance=0.1}", "accuracy={energy=0.1}", "contact.swap=false"});
  const SolverOptions solver;
  EXPECT_EQ(scene.solver.method, solver.method);
  EXPECT_EQ(scene.solver.tolerance, solver.tolerance);
  EXPECT_EQ(scene.solver.maxIterations, solver.maxIterations);
  EXPECT_EQ(scene.solver.linear, solver.linear);
  EXPECT_EQ(scene.solver.reduce, solver.reduce);
  EXPECT_EQ(scene.solver.listSolutions, solver.listSolutions);
  EXPECT_EQ(scene.time.maxSteps, TimePlan().maxSteps);
  EXPECT_EQ(scene.time.scheme, TimePlan().scheme);
  EXPECT_EQ(scene.accuracy.maxUnknowns, AccuracyGoal().maxUnknowns);
  EXPECT_EQ(scene.accuracy.maxSeconds, AccuracyGoal().maxSeconds);
  EXPECT_EQ(scene.contacts[0].initial, ContactDescription().initial);
  EXPECT_EQ(scene.contacts[0].sliding, ContactDescription().sliding);
  EXPECT_EQ(Viscoplasticity().projection,
            static_cast<Projection>(TableReader(Node(), "body.material", "")
                                        .oneOf("projection", keyAt("body.material", "projection").words)));
}

TEST(Schema, everyRangeOfAMaterialIsThatOfItsType) {
  const auto refused = [](const std::string& key, double value, auto make) {
    const bool byTable = !keyAt("body.material", key).range.holds(value);
    bool byType = false;
    try {
      make(value);
    } catch (const InputError&) {
      byType = true;
    }
    EXPECT_EQ(byTable, byType) << key << " = " << value;
  };
  for (const double value : {-2.0, -1.0, 0.0, 0.4, 0.5, 1.0, 2.0}) {
    refused("young", value, [](double x) { elasticMaterial({x, 0.3}); });
    refused("poisson", value, [](double x) { elasticMaterial({1, x}); });
    refused("viscosity", value, [](double x) { perzynaMaterial({1, 0.3}, {x, 1}); });
    refused("yield_stress", value, [](double x) { perzynaMaterial({1, 0.3}, {1, x}); });
    refused("reference_stress", value, [](double x) { nortonMaterial({1, 0.3}, {x, 1, 1}, Plane::stress); });
    refused("reference_rate", value, [](double x) { nortonMaterial({1, 0.3}, {1, x, 1}, Plane::stress); });
    refused("exponent", value, [](double x) { nortonMaterial({1, 0.3}, {1, 1, x}, Plane::stress); });
    refused("relaxation_time", value, [](double x) {
      viscoelasticMaterial({1, 0.3}, {x, 0.5}, Plane::stress);
    });
  }
}

TEST(Schema, suggestsTheNearestKey) {
  EXPECT_EQ(nearest("projektion", keysOf("body.material")), "projection");
  EXPECT_EQ(nearest("yieldstress", keysOf("body.material")), "yield_stress");
  EXPECT_EQ(nearest("temperature", keysOf("time")), "");
}

TEST(Settings, areTomlWhereTheyAreToml) {
  EXPECT_EQ(parseSetting("6", "").kind, Node::Kind::integer);
  EXPECT_EQ(parseSetting("true", "").kind, Node::Kind::boolean);
  EXPECT_EQ(parseSetting("{ x = 1 }", "").kind, Node::Kind::table);
  EXPECT_EQ(parseSetting("-10*t", "").text, "-10*t");
  EXPECT_EQ(parseSetting("\"6\"", "").text, "6");
  EXPECT_EQ(parseSetting("1\nother = 2", "").kind, Node::Kind::string);
}

}  // namespace mortier::scene_test
