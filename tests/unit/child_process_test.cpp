// Foreign code in a process of its own: its crash is a message, and it changes nothing.
#include "base/child_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"
#include "unit/messages.h"

namespace mortier::child_process_test {

std::string errorOf(const std::function<std::string()>& work, double seconds = 60) {
  try {
    inChildProcess(work, "a.msh: Gmsh", seconds);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(ChildProcess, givesBackWhatTheWorkGives) {
  EXPECT_EQ(inChildProcess([] { return std::string(); }, ""), "");
  std::string all(5000000, 'x');
  all[77] = '\0';
  EXPECT_EQ(inChildProcess([&] { return all; }, ""), all);
  const pid_t self = getpid();
  EXPECT_EQ(inChildProcess([&] { return std::string(getpid() == self ? "same" : "other"); }, ""), "other");
}

TEST(ChildProcess, crashesAreMessages) {
  EXPECT_EQ(errorOf([]() -> std::string {
              std::raise(SIGSEGV);
              return "";
            }),
            "a.msh: Gmsh crashed on it (Segmentation fault)");
  EXPECT_EQ(errorOf([]() -> std::string { std::abort(); }), "a.msh: Gmsh crashed on it (Aborted)");
  EXPECT_EQ(errorOf([]() -> std::string { _exit(0); }), "a.msh: Gmsh gave up on it");
  EXPECT_EQ(errorOf([]() -> std::string { throw InputError("a.msh: no"); }), "a.msh: no");
  EXPECT_THROW(inChildProcess([]() -> std::string { throw std::bad_alloc(); }, ""), std::bad_alloc);
}

// It can write as little as our own code there, and start nothing.
TEST(ChildProcess, aProgramAnswers) {
  const auto answerOf = [](const std::string& program, const std::string& script) {
    try {
      return ChildProcess({program, "-c", script}, "a.inp: Python").answer(60);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(answerOf("/bin/sh", "printf rabc"), "abc");
  EXPECT_EQ(answerOf("/bin/sh", "printf 'e: no'"), "a.inp: Python: no");
  EXPECT_EQ(answerOf("/bin/sh", "exit 3"), "a.inp: Python gave up on it");
  EXPECT_EQ(answerOf("no/such", ""), "a.inp: Python: no/such: No such file or directory");
  const std::string file = testing::TempDir() + "child_process_" + std::to_string(getpid());
  EXPECT_EQ(answerOf("/bin/sh", "echo x > " + file + "; printf r"), "");
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(ChildProcess, thatDoesNotEndIsEnded) {
  const auto endless = []() -> std::string {
    for (;;) pause();
  };
  EXPECT_EQ(errorOf(endless, 0.125),
            "a.msh: Gmsh has not ended with it after 0.125 s, expected a file that takes less");
  EXPECT_EQ(waitpid(-1, nullptr, 0), -1);  // none is left
  EXPECT_EQ(inChildProcess([] { return std::string(1000000, 'x'); }, "", 60).size(), 1000000);
  std::thread asks([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    requestInterrupt();
  });
  EXPECT_THROW(inChildProcess(endless, "a.msh: Gmsh"), Interrupted);
  asks.join();
  interruption::requested = false;
}

TEST(ChildProcess, startsNothingAndChangesNoFile) {
  namespace fs = std::filesystem;
  const fs::path folder = testing::TempDir() + "child_process_test_" + std::to_string(getpid());
  fs::create_directories(folder);
  std::ofstream(folder / "mine") << "mine";
  const std::string mine = folder / "mine";
  const std::string done = inChildProcess(
      [&] {
        std::string result;
        const auto count = [&](bool worked) { result += worked ? 'x' : '.'; };
        count(std::system(("touch " + (folder / "new").string()).c_str()) == 0);
        count(std::fopen(mine.c_str(), "w") != nullptr);
        count(std::fopen(mine.c_str(), "a") != nullptr);
        count(std::fopen((folder / "new").c_str(), "w") != nullptr);
        count(open(mine.c_str(), O_RDONLY | O_TRUNC) >= 0);
        count(unlink(mine.c_str()) == 0);
        count(truncate(mine.c_str(), 0) == 0);
        count(rename(mine.c_str(), (folder / "new").c_str()) == 0);
        std::error_code error;
        count(fs::create_directory(folder / "new", error));
        std::ifstream in(mine);
        std::string text;
        in >> text;
        return result + text;
      },
      "");
  EXPECT_EQ(done, ".........mine");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  fs::remove_all(folder);
}

TEST(ChildServer, answersAsOftenAsItIsAsked) {
  ChildServer server(
      [] {
        return [count = 0](const std::string& request) mutable {
          if (request == "fail") throw InputError("no such thing");
          if (request == "crash") std::raise(SIGSEGV);
          return request + std::to_string(++count);
        };
      },
      "part.step: Gmsh");
  const std::string large(1 << 20, 'x');
  EXPECT_EQ(server.ask("one ", 60), "one 1");
  EXPECT_EQ(server.ask(large, 60), large + "2");
  EXPECT_EQ(messageOf([&] { server.ask("fail", 60); }), "no such thing");
  EXPECT_EQ(server.ask("", 60), "3");
  EXPECT_NE(messageOf([&] { server.ask("crash", 60); }).find("part.step: Gmsh crashed on it"),
            std::string::npos);
  EXPECT_NE(messageOf([&] { server.ask("one", 60); }), "");
}

TEST(ChildServer, whatFailsAtTheStartIsTheAnswer) {
  ChildServer server([]() -> ChildServer::Answers { throw InputError("not a file"); }, "");
  EXPECT_EQ(messageOf([&] { server.ask("one", 60); }), "not a file");
}

}  // namespace mortier::child_process_test
