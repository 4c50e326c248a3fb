// Result folders: what they replace, keep and refuse.
#include "report/output_folder.h"

#include <limits>

#include "base/error.h"
#include "unit/result_folder.h"

namespace mortier::output_folder_test {

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

TEST_F(Output, namesInLocksAreThoseOfTheRunOrNothing) {
  const auto stopped = [&](const std::string& folder, const std::string& name) {
    result(folder, {{"summary.json", "new"}});
    put(folder + "/run.lock", "mortier run in " + name + "\n");
  };
  for (const std::string name : {".tmp-/thesis", "a.tmp-/thesis", "a.tmp-1/../thesis", "../a.tmp-1/../thesis",
                                 "thesis", "b.tmp-7", "a.tmp-7\n", ""})
    for (const char* folder : {"a.tmp-1", "a", "a.failed"}) {
      result("thesis", {{"summary.json", "years of work"}});
      result("b.tmp-7", {{"summary.json", "of another"}});
      stopped(folder, name);
      { const OutputFolder next(path + "/a"); }
      EXPECT_EQ(contentOf(path + "/thesis/summary.json"), "years of work") << name << " in " << folder;
      EXPECT_EQ(contentOf(path + "/b.tmp-7/summary.json"), "of another") << name << " in " << folder;
      for (const char* made : {"a.tmp-1", "a", "a.failed"}) fs::remove_all(path + "/" + made);
    }
  // A sibling of that name that is another folder than the one that was replaced, and that one.
  for (const std::string more : {"", "\nin place of 1", "\nin place of ", "\nin place of 7x", "NUMBER"})
    for (const char* folder : {"a", "a.failed"}) {
      result("a.tmp-7", {{"summary.json", "old"}});
      put("a.tmp-7/notes", "mine");
      const bool isOld = more == "NUMBER";
      stopped(folder,
              "a.tmp-7" + (isOld ? "\nin place of " + std::to_string(numberOf(path + "/a.tmp-7")) : more));
      { const OutputFolder next(path + "/a"); }
      EXPECT_EQ(fs::exists(path + "/a.tmp-7/summary.json"), !isOld) << more << " in " << folder;
      EXPECT_EQ(contentOf(path + "/" + (isOld ? folder : "a.tmp-7") + "/notes"), "mine") << more;
      for (const char* made : {"a.tmp-7", "a", "a.failed"}) fs::remove_all(path + "/" + made);
    }
  // A folder that was renamed since: the old result is where the new one was.
  result("a", {{"summary.json", "old"}});
  stopped("a.tmp-8", "a.tmp-3");
  { const OutputFolder next(path + "/a"); }
  EXPECT_EQ(contentOf(path + "/a/summary.json"), "new");
  EXPECT_EQ(names(), (std::set<std::string>{"a", "b.tmp-7", "thesis"}));
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

}  // namespace mortier::output_folder_test
