#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/error.h"
#include "material/perzyna.h"
#include "material/stress.h"
#include "mesh/generate.h"
#include "report/contact_table.h"
#include "report/fields.h"
#include "report/history.h"
#include "report/log.h"
#include "report/output_folder.h"
#include "report/summary.h"

namespace mortier {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

class Folder : public testing::Test {
 protected:
  Folder() : path(testing::TempDir() + "report_test_" + std::to_string(getpid())) {
    fs::create_directories(path);
  }
  ~Folder() override { fs::remove_all(path); }

  void put(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(path + "/" + name).parent_path());
    std::ofstream(path + "/" + name) << text;
  }
  /// Writes files into a folder as a run does.
  using Texts = std::map<std::string, std::string>;
  static Manifest fill(const std::string& folder, const Texts& texts) {
    Manifest manifest;
    for (const auto& [name, text] : texts)
      manifest.files[name] = (OutputFile(folder + "/" + name) << text).close();
    return manifest;
  }
  /// A result that was complete.
  void result(const std::string& name, const Texts& texts) const {
    fs::create_directories(path + "/" + name);
    writeManifest(path + "/" + name, fill(path + "/" + name, texts));
  }
  /// Names in the folder, so that nothing temporary is left behind.
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(path)) {
      found.insert(entry.path().filename().string());
    }
    return found;
  }

  std::string path;
};

using Output = Folder;

TEST_F(Output, numbersReadBackBitByBit) {
  const std::vector<double> values{0.1, -1.0 / 3, 1e-300, 5e-324, 3e11, 0};
  OutputFile file(path + "/a");
  for (const double value : values) {
    file << value << '\n';
  }
  file.close();
  std::ifstream in(path + "/a");
  for (const double value : values) {
    std::string text;
    in >> text;
    EXPECT_EQ(std::strtod(text.c_str(), nullptr), value);
  }
}

TEST_F(Output, refusesNumbersThatAreNotFinite) {
  OutputFile file(path + "/a");
  EXPECT_THROW(file << std::numeric_limits<double>::quiet_NaN(), OutputError);
  EXPECT_THROW(file << std::numeric_limits<double>::infinity(), OutputError);
}

TEST_F(Output, fullDiskIsAnError) {
  const auto fill = [](size_t bytes) {
    OutputFile file("/dev/full");
    file << std::string(bytes, 'x');
    file.close();
  };
  EXPECT_THROW(fill(10), OutputError);
  EXPECT_THROW(fill(1000000), OutputError);
}

TEST_F(Output, commitReplacesTheOldResultAndKeepsOtherFiles) {
  result("out", {{"summary.json", "old"}, {"upper_000007.vtu", "old"}});
  result("out.failed", {{"summary.json", "older"}});
  const std::map<std::string, std::string> mine{
      {"picture.png", "mine"}, {"upper_000007.vtu.bak", "mine"}, {"other_000001.vtu", "mine"},
      {"checkpoint", "mine"},  {"checkpoint.txt", "mine"},       {"folder/a", "mine"}};
  for (const auto& [name, text] : mine) put("out/" + name, text);
  put("out/run.lock", "mine");
  {
    OutputFolder folder(path + "/out/");
    const Manifest manifest = fill(folder.temporary(), {{"summary.json", "new"}});
    EXPECT_EQ(contentOf(path + "/out/summary.json"), "old");
    EXPECT_EQ(folder.commit(manifest), path + "/out");
  }
  EXPECT_EQ(contentOf(path + "/out/summary.json"), "new");
  for (const auto& [name, text] : mine) EXPECT_EQ(contentOf(path + "/out/" + name), text) << name;
  EXPECT_EQ(contentOf(path + "/out/run.lock.kept"), "mine");
  EXPECT_FALSE(fs::exists(path + "/out/upper_000007.vtu"));
  EXPECT_EQ(names(), std::set<std::string>{"out"});
}

TEST_F(Output, filesOfAResultThatWereChangedAreKept) {
  result("out", {{"summary.json", "old"}, {"contact.csv", "old"}, {"history.csv", "old"}});
  put("out/contact.csv", "mine");
  put("out/history.csv", "oLd");
  {
    OutputFolder folder(path + "/out");
    folder.commit(fill(folder.temporary(), {{"summary.json", "new"}, {"contact.csv", "new"}}));
  }
  EXPECT_EQ(contentOf(path + "/out/contact.csv"), "new");
  EXPECT_EQ(contentOf(path + "/out/contact.csv.kept"), "mine");
  EXPECT_EQ(contentOf(path + "/out/history.csv"), "oLd");
}

TEST_F(Output, failedRunLeavesTheOldResult) {
  result("out", {{"summary.json", "old"}});
  {
    OutputFolder folder(path + "/out");
    Manifest manifest = fill(folder.temporary(), {{"summary.json", "new"}});
    manifest.failed = true;
    EXPECT_EQ(folder.commit(manifest), path + "/out.failed");
  }
  EXPECT_EQ(contentOf(path + "/out/summary.json"), "old");
  EXPECT_EQ(contentOf(path + "/out.failed/summary.json"), "new");
  EXPECT_EQ(names(), (std::set<std::string>{"out", "out.failed"}));
}

TEST_F(Output, failedResultsThatSomebodyAddedToStay) {
  result("out.failed", {{"summary.json", "failed"}});
  put("out.failed/notes", "mine");
  {
    OutputFolder folder(path + "/out");
    folder.commit(fill(folder.temporary(), {{"summary.json", "new"}}));
  }
  EXPECT_EQ(contentOf(path + "/out.failed/summary.json"), "failed");
  EXPECT_EQ(contentOf(path + "/out.failed/notes"), "mine");
}

TEST_F(Output, exceptionLeavesNothing) {
  result("out", {{"summary.json", "old"}});
  { const OutputFolder folder(path + "/out"); }
  EXPECT_EQ(names(), std::set<std::string>{"out"});
}

TEST_F(Output, foldersOfOthersAreNeverEntered) {
  put("thesis/chapter.tex", "years of work");
  put("of-another-program/summary.json", "{}");
  put("of-another-program/manifest.json", "{\"files\": {}}");
  put("a/manifest.json", R"({"format": "mortier result 1", "status": "complete",
      "files": {"../file": {"bytes": 4, "fnv1a": "0"}}})");
  put("file", "mine");
  for (const char* name : {"thesis", "of-another-program", "a", "file"})
    EXPECT_THROW(OutputFolder(path + "/" + name), InputError) << name;
  put("new.failed/summary.json", "{}");
  EXPECT_THROW(OutputFolder(path + "/new"), InputError);
  EXPECT_EQ(names(), (std::set<std::string>{"a", "file", "new.failed", "of-another-program", "thesis"}));
}

TEST_F(Output, foldersNamedLikeOursAreNotEntered) {
  for (const char* name : {"out.tmp-2024/summary.json", "out.tmp-7/checkpoint", "out.mortier-5/history.csv",
                           "out.tmp-9/run.lock", "out.replaced/history.csv"})
    put(name, "mine");
  {
    OutputFolder folder(path + "/out");
    folder.commit(fill(folder.temporary(), {{"summary.json", "new"}}));
  }
  EXPECT_EQ(names(), (std::set<std::string>{"out", "out.mortier-5", "out.replaced", "out.tmp-2024",
                                            "out.tmp-7", "out.tmp-9"}));
  for (const char* name : {"out.tmp-2024/summary.json", "out.tmp-7/checkpoint", "out.mortier-5/history.csv",
                           "out.tmp-9/run.lock", "out.replaced/history.csv"})
    EXPECT_EQ(contentOf(path + "/" + name), "mine") << name;
}

TEST_F(Output, twoRunsForOneFolderAreNotPossible) {
  const OutputFolder living(path + "/out");
  EXPECT_THROW(OutputFolder(path + "/out"), InputError);
  EXPECT_TRUE(fs::exists(living.temporary()));
}

TEST_F(Output, placesThatCannotBeReplacedAreRefusedAtOnce) {
  fs::create_directory_symlink(path + "/nothing", path + "/link");
  EXPECT_THROW(OutputFolder(path + "/link"), InputError);
  EXPECT_THROW(OutputFolder("."), InputError);
  EXPECT_THROW(OutputFolder("/proc"), std::runtime_error);
  EXPECT_EQ(names(), std::set<std::string>{"link"});
}

TEST_F(Output, linksToAResultAreFollowed) {
  result("far/out", {{"summary.json", "old"}});
  fs::create_directory_symlink(path + "/far/out", path + "/link");
  {
    OutputFolder folder(path + "/link");
    folder.commit(fill(folder.temporary(), {{"summary.json", "new"}}));
  }
  EXPECT_TRUE(fs::is_symlink(path + "/link"));
  EXPECT_EQ(contentOf(path + "/far/out/summary.json"), "new");
}

/// Two unit squares of one cell each, stressed by (0, -2, 0), the lower one elastic.
struct Blocks {
  Model model;
  State state;
  RunFacts facts;

  [[nodiscard]] Accuracy accuracy() const {
    AccuracyMemory none;
    return AccuracyRecord(model, none).atEnd(state, {});
  }

  Blocks() {
    const Elasticity elasticity{100, 0.3};
    model.bodies.emplace_back("upper", crissCrossMesh({{0, 0}, {1, 1}, 1, 1}),
                              perzynaMaterial(elasticity, {1, 1}), Conditions{});
    model.bodies.emplace_back("lower", crissCrossMesh({{0, -1}, {1, 0}, 1, 1}), elasticMaterial(elasticity),
                              Conditions{});
    model.interfaces.emplace_back(ContactPair{{0, 1}, {1, 3}, CouplingKind::mortar}, model.bodies[0].mesh(),
                                  model.bodies[1].mesh());
    for (const Body& body : model.bodies) {
      const Eigen::Vector3d stress = fromCartesian({0, -2, 0});
      state.bodies.push_back({Vector::LinSpaced(body.dofs(), 0, 1), stress.replicate(1, body.points()),
                              Matrix::Zero(3, body.points())});
    }
    state.time = 0.25;
    state.contactForce.push_back(Vector::Constant(2, 1.0));
    facts.variants = {"mortar"};
    facts.contact = "mortar";
    facts.nonmortar = "upper";
    facts.projection = "frobenius";
  }
};

TEST(Fields, cellsShowCartesianComponentsAndFlow) {
  const Blocks blocks;
  const CellFields upper = cellFields(blocks.model.bodies[0], blocks.state.bodies[0]);
  EXPECT_EQ(upper.stress.cols(), 4);
  EXPECT_NEAR(upper.stress(0, 2), 0, 1e-15);
  EXPECT_NEAR(upper.stress(1, 2), -2, 1e-15);
  EXPECT_NEAR(upper.vonMises[3], 2, 1e-15);
  EXPECT_EQ(upper.viscoplastic, std::vector<int>(4, 1));
  EXPECT_EQ(cellFields(blocks.model.bodies[1], blocks.state.bodies[1]).viscoplastic, std::vector<int>(4, 0));
}

TEST_F(Output, fieldsNameEveryBodyAndStep) {
  const Blocks blocks;
  Fields fields(path, blocks.model);
  fields.add(blocks.state, 0);
  fields.add(blocks.state, 1234567);
  fields.close();
  EXPECT_EQ(names(), (std::set<std::string>{"fields.pvd", "lower_000000.vtu", "lower_1234567.vtu",
                                            "upper_000000.vtu", "upper_1234567.vtu"}));
  EXPECT_NE(contentOf(path + "/fields.pvd").find("timestep=\"0.25\""), std::string::npos);
}

TEST_F(Output, fieldsThatAreNotFiniteAreNotWritten) {
  Blocks blocks;
  blocks.state.bodies[1].stress(0, 0) = std::numeric_limits<double>::quiet_NaN();
  Fields fields(path, blocks.model);
  EXPECT_THROW(fields.add(blocks.state, 0), OutputError);
}

TEST_F(Output, contactTableHasARowPerNonmortarNode) {
  const Blocks blocks;
  ContactTable table(path, blocks.model);
  table.add(blocks.state, 3);
  table.close();
  std::istringstream text(contentOf(path + "/contact.csv"));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "step,time,interface,vertex,x,y,gap,force,pressure,active");
  std::getline(text, line);
  EXPECT_EQ(line.rfind("3,0.25,0,", 0), 0u) << line;
  std::getline(text, line);
  EXPECT_FALSE(std::getline(text, line));
}

TEST_F(Output, gapIsPositiveApart) {
  Blocks blocks;
  for (BodyState& body : blocks.state.bodies) body.displacement.setZero();
  for (int v = 0; v < blocks.model.bodies[0].nodes(); ++v)
    blocks.state.bodies[0].displacement[2 * v + 1] = 0.5;
  ContactTable table(path, blocks.model);
  table.add(blocks.state, 3);
  table.close();
  EXPECT_NE(contentOf(path + "/contact.csv").find(",1,0,0.5,"), std::string::npos);  // x, y, gap
}

TEST_F(Output, historyHasAsManyColumnsAsItsHeader) {
  History history(path, std::vector<Quantity>());
  StepReport report;
  report.penetration = 1.25e-18;
  history.add(report, {});
  history.close();
  std::istringstream text(contentOf(path + "/history.csv"));
  std::string header;
  std::string row;
  std::getline(text, header);
  std::getline(text, row);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_NE(row.find(",1.25e-18,"), std::string::npos);
}

TEST_F(Output, summaryHasItsKeys) {
  const Blocks blocks;
  StepReport last;
  last.penetration = 1e-18;
  writeSummary(path, blocks.facts, blocks.model, blocks.state, last, {}, blocks.accuracy());
  const auto json = nlohmann::json::parse(contentOf(path + "/summary.json"));
  for (const char* key :
       {"scene", "status", "contact", "nonmortar", "projection", "triangles", "nodes", "dofs", "steps",
        "newton_iterations", "max_iterations_in_a_step", "factorisations", "wall_time_s", "solve_time_s",
        "peak_memory_mib", "final", "verification", "accuracy"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  for (const char* key : {"time", "von_mises_min", "von_mises_max", "interpenetration", "displacement_min",
                          "displacement_max", "contact_force", "active_nodes"}) {
    EXPECT_TRUE(json["final"].contains(key)) << key;
  }
  EXPECT_EQ(json["accuracy"]["bodies"].size(), 2);
  for (const char* key : {"force_balance", "material_residual", "gap_on_active", "open_penetration", "sign",
                          "complementarity", "rounding"}) {
    EXPECT_TRUE(json["verification"].contains(key)) << key;
  }
  EXPECT_EQ(json["final"]["displacement_max"][1], 1.0);
  EXPECT_EQ(json["status"], "converged");
  EXPECT_EQ(json["triangles"], 8);
}

TEST_F(Output, summaryThatIsNotFiniteIsNotWritten) {
  const Blocks blocks;
  RunReport report;
  report.worst.forceBalance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(writeSummary(path, blocks.facts, blocks.model, blocks.state, {}, report, blocks.accuracy()),
               OutputError);
  EXPECT_TRUE(names().empty());
}

TEST(Log, rowsStandUnderTheirHeader) {
  const Blocks blocks;
  const std::string header = logHeader(blocks.facts, blocks.model);
  const std::string titles = logStepsHeader();
  StepReport report;
  report.step = 11;
  report.active = 18;
  const std::string row = logRow(report);
  EXPECT_EQ(row.size(), titles.size());
  EXPECT_NE(row.find("18 (+0/-0)"), std::string::npos);
  EXPECT_NE(header.find("mortar, 2 nonmortar (upper) x 2 mortar (lower) nodes, overlap 1.000"),
            std::string::npos);
  EXPECT_EQ(logRound({{100, 200, 3, 0.5, 0.1, 7}, {1000, 2000, 30, 0.05, 0.01, 7}}).size(),
            logRoundsHeader().size());
}

}  // namespace
}  // namespace mortier
