// What is written of a run: fields, contact table, history, summary, log.
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "material/stress.h"
#include "report/fields.h"
#include "report/log.h"
#include "report/result_files.h"
#include "unit/blocks_of_one_cell.h"
#include "unit/result_folder.h"

namespace mortier::report_test {

/// Two unit squares of one cell each, stressed by (0, -2, 0), the lower one elastic.
struct Blocks {
  Model model = blocksOfOneCell();
  State state;
  RunFacts facts;

  [[nodiscard]] Accuracy accuracy() const {
    AccuracyMemory none;
    CurrentMeshError error(model);
    error.moveTo(state);
    return AccuracyRecord(model, error, none).atEnd({});
  }

  Blocks() {
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

TEST(Accuracy, ofTheRunIsThatOfAStateWhichHasItsLargestEnergy) {
  constexpr double same =
      1e-3;  // one is over the energy of the recovered stress, the other over that of the run
  Blocks blocks;
  for (BodyState& body : blocks.state.bodies)
    for (Eigen::Index i = 0; i < body.stress.cols(); ++i) body.stress(1, i) += 0.1 * static_cast<double>(i);
  double energy = 0;
  for (size_t b = 0; b < 2; ++b) {
    const Body& body = blocks.model.bodies[b];
    Matrix strain;
    body.material().elasticStrain(blocks.state.bodies[b].stress, strain);
    for (int i = 0; i < body.points(); ++i)
      energy += body.weights()[i] * strain.col(i).dot(blocks.state.bodies[b].stress.col(i)) / 2;
  }
  Peaks peaks;
  peaks.energy.raise(energy, 0.25);
  AccuracyMemory none;
  CurrentMeshError error(blocks.model);
  error.moveTo(blocks.state);
  const Accuracy accuracy = AccuracyRecord(blocks.model, error, none).atEnd(peaks);
  EXPECT_GT(accuracy.all, 0.01);
  EXPECT_NEAR(accuracy.largest, accuracy.all, same * accuracy.all);
  // A quarter of the largest energy of the run: half the error, over that.
  peaks.energy.value *= 4;
  EXPECT_NEAR(AccuracyRecord(blocks.model, error, none).atEnd(peaks).largest, accuracy.all / 2,
              same * accuracy.all);
}

TEST_F(Output, fieldsNameEveryBodyAndStep) {
  const Blocks blocks;
  CurrentMeshError error(blocks.model);
  error.moveTo(blocks.state);
  Fields fields(path, blocks.model, error);
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
  CurrentMeshError error(blocks.model);
  error.moveTo(blocks.state);
  Fields fields(path, blocks.model, error);
  EXPECT_THROW(fields.add(blocks.state, 0), OutputError);
}

TEST_F(Output, contactTableHasARowPerNonmortarNode) {
  const Blocks blocks;
  OutputFile table(path + "/contact.csv");
  writeContactHeader(table, blocks.model);
  writeContactRows(table, blocks.model, blocks.state, 3);
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
  OutputFile table(path + "/contact.csv");
  writeContactHeader(table, blocks.model);
  writeContactRows(table, blocks.model, blocks.state, 3);
  table.close();
  EXPECT_NE(contentOf(path + "/contact.csv").find(",1,0,0.5,"), std::string::npos);  // x, y, gap
}

TEST_F(Output, historyHasAsManyColumnsAsItsHeader) {
  Model model = blocksOfOneCell();
  const ContactPair pair = model.interfaces[0].pair();
  model.interfaces.clear();
  InterfaceOptions rough;
  rough.friction = {0.3, 0};
  addInterface(model, pair, rough);
  OutputFile history(path + "/history.csv");
  writeHistoryHeader(history, historyColumns(model, {Quantity{"q"}}, Units::from("mm, N, MPa")));
  StepReport report;
  report.penetration = 1.25e-18;
  report.frictionWork = {0.5};
  report.quantities = {7};
  writeHistoryRow(history, report);
  history.close();
  std::istringstream text(contentOf(path + "/history.csv"));
  std::string header;
  std::string row;
  std::getline(text, header);
  std::getline(text, row);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_NE(row.find(",1.25e-18,"), std::string::npos);
  EXPECT_NE(row.find(",0,0.5,7"), std::string::npos);
  EXPECT_NE(header.find(",ambiguous,friction_work_0[N mm/mm],"), std::string::npos);
  EXPECT_NE(header.find(",max_pressure[MPa],"), std::string::npos);
  EXPECT_NE(header.find(",q[N/mm]"), std::string::npos);
}

TEST(Summary, hasItsKeys) {
  const Blocks blocks;
  StepReport last;
  last.penetration = 1e-18;
  const auto json = nlohmann::json::parse(
      summaryText("summary", blocks.facts, blocks.model, {blocks.state, last, {}, blocks.accuracy()}));
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

TEST(Summary, hasTheStepsThatWerePlannedOrTheToleranceThatChoseThem) {
  Blocks blocks;
  blocks.facts.plannedSteps = 7;
  const auto written = [&] {
    return nlohmann::json::parse(
        summaryText("summary", blocks.facts, blocks.model, {blocks.state, {}, {}, blocks.accuracy()}));
  };
  EXPECT_EQ(written()["planned_steps"], 7);
  EXPECT_FALSE(written().contains("tolerance"));
  blocks.facts.tolerance = 1e-3;
  EXPECT_EQ(written()["tolerance"], 1e-3);
  EXPECT_FALSE(written().contains("planned_steps"));
}

TEST(Summary, thatIsNotFiniteIsRefused) {
  const Blocks blocks;
  RunReport report;
  report.worst.forceBalance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(
      summaryText("summary", blocks.facts, blocks.model, {blocks.state, {}, report, blocks.accuracy()}),
      OutputError);
}

TEST(Log, rowsStandUnderTheirHeader) {
  const Blocks blocks;
  const std::string header = logHeader(blocks.facts, blocks.model);
  const std::string titles = logStepsHeader({});
  StepReport report;
  report.step = 11;
  report.active = 18;
  const std::string row = logRow(report);
  EXPECT_EQ(row.size(), titles.size());
  EXPECT_NE(row.find("18 (+0/-0)"), std::string::npos);
  EXPECT_NE(header.find("mortar, 2 nonmortar (upper) x 2 mortar (lower) nodes, overlap 1.000"),
            std::string::npos);
  EXPECT_EQ(logRound({{100, 200, 3, 0.5, 0.1, 7}, {1000, 2000, 30, 0.05, 0.01, 7}}).size(),
            logRoundsHeader(blocks.model).size());
}

}  // namespace mortier::report_test
