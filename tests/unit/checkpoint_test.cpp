// Checkpoints: what is read is what was written; what is damaged or of another model is refused.
#include "report/checkpoint.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include "base/archive.h"
#include "base/error.h"
#include "report/checkpoint_members.h"
#include "unit/blocks_of_one_cell.h"

namespace mortier::checkpoint_test {

Checkpoint checkpointOf(const Model& model) {
  Checkpoint checkpoint;
  checkpoint.identity.text = "a scene";
  checkpoint.state = initialState(model);
  checkpoint.memory.run.rungs["newton"] = 3;
  std::vector<BodyIncrement> stage;
  for (const BodyState& body : checkpoint.state.bodies)
    stage.push_back({{body.displacement, body.displacement}, body.stress});
  checkpoint.memory.increments = {stage};
  return checkpoint;
}

std::string bytesOf(Checkpoint checkpoint) {
  ArchiveWriter writer;
  writer(checkpoint);
  return writer.bytes;
}

Checkpoint decoded(const std::string& bytes) {
  Checkpoint checkpoint;
  ArchiveReader reader(bytes);
  reader(checkpoint);
  return checkpoint;
}

TEST(Checkpoint, readsWhatWasWritten) {
  const std::string bytes = bytesOf(checkpointOf(blocksOfOneCell()));
  EXPECT_EQ(bytesOf(decoded(bytes)), bytes);
}

TEST(Checkpoint, ofAnotherModelIsRefused) {
  const Model model = blocksOfOneCell();
  requireFits(checkpointOf(model), model, "out");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(Checkpoint&)>> changes{
      [](Checkpoint& c) { c.state.bodies.pop_back(); },
      [](Checkpoint& c) { c.state.bodies.push_back(c.state.bodies.back()); },
      [](Checkpoint& c) { c.state.bodies[0].displacement.conservativeResize(3); },
      [](Checkpoint& c) { c.state.bodies[1].stress.resize(3, 0); },
      [](Checkpoint& c) { c.state.bodies[1].stress.resize(0, 0); },
      [](Checkpoint& c) { c.state.bodies[1].viscoplasticStrain.resize(4, 4); },
      [&](Checkpoint& c) { c.state.bodies[1].stress(0, 0) = nan; },
      [](Checkpoint& c) { c.state.contactForce.clear(); },
      [](Checkpoint& c) { c.state.contactForce[0].resize(7); },
      [](Checkpoint& c) { c.state.gap.clear(); },
      [&](Checkpoint& c) { c.state.gap[0][0] = nan; },
      [&](Checkpoint& c) { c.state.bodies[0].work.dissipated = nan; },
      [](Checkpoint& c) { c.memory.run.quantities.resize(1); },
      [](Checkpoint& c) { c.last.quantities.resize(1); },
      [&](Checkpoint& c) { c.state.time = nan; },
      [](Checkpoint& c) { c.last.step = -1; },
      [](Checkpoint& c) { c.last.step = 7; },
      [](Checkpoint& c) { c.last.status = static_cast<Status>(77); },
      [](Checkpoint& c) { c.memory.increments[0].pop_back(); },
      [](Checkpoint& c) { c.memory.increments[0][1].displacement.low.resize(1); },
      [](Checkpoint& c) { c.memory.solver.enginesGivenUp.resize(5); },
      [&](Checkpoint& c) { c.memory.controller.timeStep = nan; },
      [&](Checkpoint& c) { c.memory.timeStep = -1; }};
  for (size_t i = 0; i < changes.size(); ++i) {
    Checkpoint changed = checkpointOf(model);
    changes[i](changed);
    EXPECT_THROW(requireFits(changed, model, "out"), InputError) << "change " << i;
  }
}

TEST(Checkpoint, bytesThatAreNoneAreRefused) {
  // A matrix of many rows and no columns, a text longer than memory, a truth that is neither.
  for (const uint64_t rows : {uint64_t{1} << 63, ~uint64_t{0}, uint64_t{1} << 40}) {
    ArchiveWriter writer;
    uint64_t none = 0;
    uint64_t many = rows;
    writer(many, none);
    Matrix matrix;
    EXPECT_THROW(ArchiveReader reader(writer.bytes); reader(matrix), InputError);
    Vector vector;
    EXPECT_THROW(ArchiveReader reader(writer.bytes); reader(vector), InputError);
    std::vector<StepReport> reports;
    EXPECT_THROW(ArchiveReader reader(writer.bytes); reader(reports), InputError);
  }
  bool truth = false;
  EXPECT_THROW(ArchiveReader reader("\2"); reader(truth), InputError);
}

TEST(Checkpoint, changedBytesAreRefusedOrRead) {
  const Model model = blocksOfOneCell();
  const std::string sound = bytesOf(checkpointOf(model));
  std::mt19937 random(11);
  int refused = 0;
  int read = 0;
  for (int n = 0; n < 3000; ++n) {
    std::string bytes = sound.substr(0, n % 3 == 0 ? random() % sound.size() : sound.size());
    for (int k = 0; k < 3 && !bytes.empty(); ++k)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    try {
      const Checkpoint changed = decoded(bytes);
      requireFits(changed, model, "out");
      ++read;
      EXPECT_EQ(bytesOf(changed).size(), sound.size());
    } catch (const InputError&) {
      ++refused;
    }
  }
  // A third is cut short; a changed number may be one that the format allows.
  EXPECT_GE(refused, 1000);
  EXPECT_GE(read, 500);
}

TEST(Checkpoint, damagedFilesAreNamed) {
  namespace fs = std::filesystem;
  const std::string folder = testing::TempDir() + "checkpoint_test_" + std::to_string(getpid());
  fs::create_directories(folder);
  const auto put = [&](const std::string& name, const std::string& text) {
    OutputFile file(folder + "/" + name);
    return (file << text).close();
  };
  Checkpoint checkpoint = checkpointOf(blocksOfOneCell());
  checkpoint.files = {put("history.csv", "step\n1\n"),
                      put("contact.csv", "x\n"),
                      {{0, 0.0, {{"upper_000000.vtu", put("upper_000000.vtu", "field")}}}}};
  writeCheckpoint(folder, checkpoint);
  put("history.csv", "step\n1\n2\n");  // grown since
  EXPECT_EQ(bytesOf(readCheckpoint(folder)), bytesOf(checkpoint));
  const auto reason = [&] {
    try {
      readCheckpoint(folder);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Checkpoint other = checkpoint;
  for (FilesSoFar* files : {&other.empty, &other.files}) {
    files->fields = {{0,
                      0.0,
                      {{"../" + fs::path(folder).filename().string() + "/upper_000000.vtu",
                        checkpoint.files.fields[0].files["upper_000000.vtu"]}}}};
    writeCheckpoint(folder, other);
    writeCheckpoint(folder, other);
    EXPECT_NE(reason().find("checkpoint: it lists ../"), std::string::npos) << reason();
    files->fields = checkpoint.files.fields;
  }
  fs::remove(folder + "/checkpoint");  // nothing is read of what is no file
  ASSERT_EQ(mkfifo((folder + "/checkpoint").c_str(), 0600), 0);
  EXPECT_NE(reason().find("checkpoint.previous: it lists ../"), std::string::npos) << reason();
  fs::remove(folder + "/checkpoint");
  writeCheckpoint(folder, checkpoint);
  writeCheckpoint(folder, checkpoint);
  put("history.csv", "stEp\n1\n");
  EXPECT_NE(reason().find("its history.csv is damaged"), std::string::npos) << reason();
  put("history.csv", "step\n1\n");
  put("upper_000000.vtu", "fielD");
  EXPECT_NE(reason().find("its upper_000000.vtu is damaged"), std::string::npos) << reason();
  put("upper_000000.vtu", "");
  EXPECT_NE(reason().find("its upper_000000.vtu is shorter than it was"), std::string::npos) << reason();
  fs::remove(folder + "/upper_000000.vtu");
  EXPECT_NE(reason().find("its upper_000000.vtu is gone"), std::string::npos) << reason();
  // Holes at the end of a file, or nothing but holes: no more is read than the head.
  for (const bool empty : {false, true}) {
    writeCheckpoint(folder, checkpoint);
    fs::remove(folder + "/checkpoint.previous");
    if (empty) put("checkpoint", "");
    fs::resize_file(folder + "/checkpoint", uint64_t{1} << 40);
    EXPECT_NE(reason().find(empty ? "not of this version" : "checkpoint: damaged"), std::string::npos)
        << reason();
  }
  fs::remove_all(folder);
}

}  // namespace mortier::checkpoint_test
