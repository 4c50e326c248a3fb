// Files as a whole: written or not, read or refused.
#include "base/whole_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"
#include "unit/messages.h"
#include "unit/result_folder.h"

namespace mortier::whole_file_test {

using WholeFile = Folder;

TEST_F(WholeFile, signalsLeaveTheOldFileAndNothingElse) {
  put("a", "old");
  sigset_t interrupt;
  sigset_t before;
  sigemptyset(&interrupt);
  sigaddset(&interrupt, SIGINT);
  pthread_sigmask(SIG_BLOCK, &interrupt, &before);
  raise(SIGINT);
  EXPECT_THROW(writeWhole(path + "/a", "new"), Interrupted);
  EXPECT_EQ(contentOf(path + "/a"), "old");
  writeWhole(path + "/a", "new", true);  // a checkpoint is written to its end
  EXPECT_EQ(contentOf(path + "/a"), "new");
  int taken = 0;
  sigwait(&interrupt, &taken);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(WholeFile, aProcessThatIsInterruptedLeavesNothing) {
  const std::string text(size_t{1} << 27, 'x');
  put("a", "old");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    for (const int milliseconds : {5, 20, 60}) {
      const pid_t child = fork();
      if (child == 0) {
        std::signal(signal, SIG_DFL);
        for (;;) writeWhole(path + "/b", text);
      }
      while (names().size() < 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      kill(child, signal);
      int status = 0;
      waitpid(child, &status, 0);
      EXPECT_EQ(WTERMSIG(status), signal);
      fs::remove(path + "/b");
      EXPECT_EQ(names(), std::set<std::string>{"a"});
    }
}

TEST_F(WholeFile, whatIsNoFileOrTooLargeIsRefused) {
  put("a", "text");
  EXPECT_EQ(readWhole(path + "/a", "a mesh"), "text");
  EXPECT_EQ(readWhole("/dev/null", "a scene", mostBytes, true), "");
  ASSERT_EQ(mkfifo((path + "/pipe").c_str(), 0600), 0);
  for (const std::string& each : {path + "/pipe", path, path + "/none", std::string("/dev/zero")})
    EXPECT_EQ(messageOf([&] { readWhole(each, "a mesh"); }), each + ": not a file, expected a mesh");
  for (const std::string& each : {path, path + "/none"})
    EXPECT_EQ(messageOf([&] { readWhole(each, "a scene", mostBytes, true); }),
              each + ": cannot be read, expected a scene");
  constexpr uint64_t few = uint64_t{3} << 20;
  put("large", "");
  fs::resize_file(path + "/large", few + 1);
  for (const std::string& each : {path + "/large", std::string("/dev/zero")})
    EXPECT_EQ(messageOf([&] { readWhole(each, "a scene", few, true); }),
              each + ": larger than 3 MiB, expected a scene");
}

}  // namespace mortier::whole_file_test
