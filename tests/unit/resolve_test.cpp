// What a scene leaves open is decided by its meshes: sides, couplings, numbers of labels, distances.
#include "scene/resolve.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/two_blocks_scene.h"

namespace mortier::resolve_test {

class ResolvedScenes : public SceneFiles {};

// Decided once: the model and the description that reports read name the same side, swapped or not.
TEST_F(ResolvedScenes, sidesAreDecidedInOnePlace) {
  const std::string text = twoBlocks;
  const size_t begin = text.find("nonmortar");
  const size_t end = text.find("[time]");
  const std::string upper = "{ body = \"upper\", label = 1 }";
  const std::string lower = "{ body = \"lower\", label = 3 }";
  for (const std::string& sides : {upper + ", " + lower, lower + ", " + upper})
    for (const bool swapped : {false, true}) {
      write(text.substr(0, begin) + "sides = [" + sides + "]\nswap = " + (swapped ? "true" : "false") + "\n" +
            text.substr(end));
      ResolvedScene resolved = resolveScene(readScene(path()));
      const SceneDescription& scene = resolved.description;
      const int nonmortar = swapped ? 0 : 1;
      EXPECT_EQ(scene.contacts[0].nonmortar().body, nonmortar == 0 ? "upper" : "lower");
      EXPECT_EQ(scene.contacts[0].choice,
                swapped ? "nonmortar is the coarser mesh (swap)" : "nonmortar is the finer mesh");
      EXPECT_EQ(buildModel(resolved).interfaces[0].pair().nonmortar.body, nonmortar);
      ResolvedScene again = resolveScene(scene);
      EXPECT_EQ(again.description.contacts[0].nonmortar().body, nonmortar == 0 ? "upper" : "lower");
      EXPECT_EQ(buildModel(again).interfaces[0].pair().nonmortar.body, nonmortar);
    }
}

// The lower mesh is the finer one, the upper body the stiffer one as it stands.
TEST_F(ResolvedScenes, rowsAreTheSameWhateverTheMeshes) {
  const auto contact = [&](const std::vector<std::string>& settings) {
    return resolveScene(readScene(path(), settings)).description.contacts[0];
  };
  const auto compliance = [&](const std::vector<std::string>& settings) {
    const ResolvedScene resolved = resolveScene(readScene(path(), settings));
    return surfaceCompliance(resolved.description, resolved.description.contacts[0].mortar(),
                             {&resolved.meshes[0], &resolved.meshes[1]});
  };
  const std::string stiff = "body.lower.material.young=1e12";
  EXPECT_EQ(contact({"contact.swap=true", stiff}).variant, CouplingKind::mortar);
  EXPECT_GT(compliance({"contact.swap=true", stiff}), 0);
  // A prescribed side is a wall: it yields to no pressure.
  EXPECT_EQ(compliance({"contact.swap=true", "body.upper.boundary=[{label=1, uy=\"-t\"}]"}), 0);
  EXPECT_GT(compliance({"contact.swap=true", "body.upper.boundary=[{label=1, ux=0}]"}), 0);
  const std::vector<std::string> free{"contact.nonmortar=", "contact.mortar=",
                                      "contact.sides=[{body=\"upper\", label=1}, {body=\"lower\", label=3}]"};
  const auto nonmortar = [&](std::vector<std::string> more) {
    more.insert(more.begin(), free.begin(), free.end());
    return contact(more).nonmortar().body;
  };
  EXPECT_EQ(nonmortar({}), "lower");
  EXPECT_EQ(nonmortar({"body.lower.material.young=1e14"}), "upper");
  EXPECT_EQ(nonmortar({"body.lower.boundary=[{label=3, uy=0}]"}), "upper");
  EXPECT_EQ(nonmortar({stiff, "contact.variant=interpolation"}), "lower");
}

// Names of conditions, regions and sides become the numbers of the mesh; what it does not have,
// one that no mesh has.
TEST_F(ResolvedScenes, labelsAreNumbersOnceResolved) {
  SceneDescription scene = readScene(path());
  TriangleMesh mesh = crissCrossMesh({{0, 0}, {1, 1}, 2, 2});
  mesh.labelNames = {{"base", 1}, {"top", 3}};
  mesh.regionNames = {{"core", 7}};
  scene.bodies[0].conditions[1].labelName = "top";
  scene.bodies[0].conditions[0].labelName = "topp";
  scene.bodies[0].regions = {RegionDescription{0, "core", {}, {}, ""}};
  scene.contacts[0].sides[0].labelName = "base";
  resolveWhatCanBe(scene, {&mesh, nullptr});
  EXPECT_EQ(scene.bodies[0].conditions[1].label, 3);
  EXPECT_LT(scene.bodies[0].conditions[0].label, 0);
  EXPECT_EQ(scene.bodies[0].regions[0].label, 7);
  EXPECT_EQ(scene.contacts[0].nonmortar().label, 1);
}

TEST_F(ResolvedScenes, sidesAreLeftAsTheyAreWhereAMeshOrALabelIsMissing) {
  SceneDescription open = readScene(path());
  open.contacts[0].nonmortarSide.reset();
  TriangleMesh mesh = crissCrossMesh({{0, 0}, {1, 1}, 2, 2});
  const auto choice = [&](SceneDescription scene, const std::vector<TriangleMesh*>& meshes) {
    resolveWhatCanBe(scene, meshes);
    return scene.contacts[0].choice;
  };
  EXPECT_NE(choice(open, {&mesh, &mesh}), "");
  EXPECT_EQ(choice(open, {&mesh, nullptr}), "");
  EXPECT_EQ(choice(open, {nullptr, &mesh}), "");
  open.contacts[0].sides[1].label = 9;
  EXPECT_EQ(choice(open, {&mesh, &mesh}), "");
}

// Four triangles about a centre, whichever corner of each it is.
TEST(CrossedPart, isThatOfQuartersOfCells) {
  TriangleMesh mesh = crissCrossMesh({{0, 0}, {1, 1}, 1, 1});
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_EQ(crossedPart(mesh), 1);
    for (auto& triangle : mesh.triangles) std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
  }
  EXPECT_EQ(crossedPart(rectangleMesh({{0, 0}, {1, 1}, 1, 1}, Cut::rising)), 0);
}

// The upper mesh is the coarser one.
TEST_F(ResolvedScenes, sidesInAnyOrderAndInitialDistances) {
  const auto model = [&](const std::string& contact) {
    const std::string text = twoBlocks;
    const size_t begin = text.find("nonmortar");
    const size_t end = text.find("[time]");
    write(text.substr(0, begin) + contact + "\n" + text.substr(end));
    return modelOf(readScene(path()));
  };
  const std::string upper = "{ body = \"upper\", label = 1 }";
  const std::string lower = "{ body = \"lower\", label = 3 }";
  for (const std::string& sides : {upper + ", " + lower, lower + ", " + upper})
    EXPECT_EQ(model("sides = [" + sides + "]").interfaces[0].pair().nonmortar.body, 1);
  const std::string both = "nonmortar = " + upper + "\nmortar = " + lower + "\n";
  const ContactInterface given = model(both + "gap = \"0.25*x^2\"").interfaces[0];
  EXPECT_LE((given.initialDistance() - Vector{{0, 0.0625, 0.25}}).cwiseAbs().maxCoeff(), 1e-16);
  const ContactInterface alongY = model(both + "gap = \"0.5 + y\"").interfaces[0];  // the line is y = 0
  EXPECT_LE((alongY.initialDistance() - Vector::Constant(3, 0.5)).cwiseAbs().maxCoeff(), 1e-15);
  const ContactInterface opening = model(both + "gap = \"(0.5 + y)*t\"").interfaces[0];
  const Vector g = opening.gap(Vector::Zero(2 * 13), Vector::Zero(2 * 25), 2);
  EXPECT_LE((g + Vector::Ones(3)).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(model(both + "initial = \"close\"").interfaces[0].initialDistance().cwiseAbs().maxCoeff(), 0);
  const auto refused = [&](const std::string& contact) { return messageOf([&] { return model(contact); }); };
  EXPECT_NE(refused(both + "sides = [" + upper + ", " + lower + "]").find("beside sides"), std::string::npos);
  EXPECT_NE(refused("sides = [" + upper + "]").find("expected two tables"), std::string::npos);
  EXPECT_NE(refused(both + "gap = 1\ninitial = \"close\"").find("gap beside initial"), std::string::npos);
  EXPECT_NE(refused(both + "gap = \"1/x\"").find("gap = "), std::string::npos);
  for (const std::string inTime : {"\"0.05*t\"", "\"x + 0*t\"", "{ time = [0, 1], value = [0, 1] }"})
    EXPECT_TRUE(model(both + "gap = " + inTime).interfaces[0].distanceMoves()) << inTime;
  EXPECT_NE(refused(both + "initial = \"open\"").find("as-meshed, close, reject"), std::string::npos);
}

}  // namespace mortier::resolve_test
