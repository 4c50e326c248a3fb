#include "base/child_process.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <mutex>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

#include "base/digits.h"
#include "base/error.h"
#include "base/interrupt.h"

namespace mortier {

namespace {

#if defined(__x86_64__)
#define MORTIER_ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined(__aarch64__)
#define MORTIER_ARCHITECTURE AUDIT_ARCH_AARCH64
#endif

#ifdef MORTIER_ARCHITECTURE

/// From here on this process can neither start others, nor change files, nor reach other processes.
/// \param becomes  whether it may become a program
bool confine(bool becomes) {
  static constexpr int refused[] = {
#ifdef __NR_open
      __NR_creat,     __NR_unlink,    __NR_rename,   __NR_mkdir,     __NR_rmdir,    __NR_link,
      __NR_symlink,   __NR_mknod,     __NR_chmod,    __NR_chown,     __NR_lchown,   __NR_utime,
      __NR_utimes,    __NR_futimesat,
#endif
#ifdef __NR_renameat
      __NR_renameat,
#endif
      __NR_execveat,  __NR_openat2,   __NR_unlinkat, __NR_renameat2, __NR_mkdirat,  __NR_linkat,
      __NR_symlinkat, __NR_mknodat,   __NR_truncate, __NR_fchmod,    __NR_fchmodat, __NR_fchown,
      __NR_fchownat,  __NR_utimensat, __NR_socket,   __NR_kill,      __NR_ptrace,   __NR_process_vm_writev};
  const auto load = [](size_t offset) -> sock_filter {
    return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<uint32_t>(offset));
  };
  constexpr sock_filter allow = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  constexpr sock_filter refuse = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);
  std::vector<sock_filter> filter{load(offsetof(seccomp_data, arch)),
                                  BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, MORTIER_ARCHITECTURE, 1, 0), refuse,
                                  load(offsetof(seccomp_data, nr))};
  constexpr uint32_t otherNumbers = 0x40000000;  // of the x32 interface
  filter.insert(filter.end(), {BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, otherNumbers, 0, 1), refuse});
  const auto refuseCall = [&](int number) {
    filter.insert(filter.end(),
                  {BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<uint32_t>(number), 0, 1), refuse});
  };
  for (const int number : refused) refuseCall(number);
  if (!becomes) refuseCall(__NR_execve);
  const auto readOnly = [&](int number, int flags) {
    filter.insert(
        filter.end(),
        {BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<uint32_t>(number), 0, 4),
         load(offsetof(seccomp_data, args) + flags * sizeof(uint64_t)),
         BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, O_WRONLY | O_RDWR | O_CREAT | O_TRUNC, 0, 1), refuse, allow});
  };
#ifdef __NR_open
  readOnly(__NR_open, 1);
#endif
  readOnly(__NR_openat, 2);
  filter.push_back(allow);
  sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

#else

bool confine(bool /*becomes*/) {
  return true;
}

#endif

constexpr char isResult = 'r';
constexpr char isError = 'e';
constexpr char isMemory = 'm';

/// The answer of the child: what it is, and the bytes.
std::string answerOf(const std::function<std::string()>& work) {
  try {
    if (!confine(false)) return isError + std::string(": cannot be confined: ") + std::strerror(errno);
    return isResult + work();
  } catch (const std::bad_alloc&) {
    return {isMemory};
  } catch (const std::exception& error) {
    return isError + std::string(error.what());
  }
}

void writeAnswer(int pipe, const std::string& answer) {
  for (std::string_view left = answer; !left.empty();) {
    const ssize_t n = write(pipe, left.data(), left.size());
    if (n < 0 && errno != EINTR) break;
    left.remove_prefix(n < 0 ? 0 : static_cast<size_t>(n));
  }
}

[[noreturn]] void runChild(int pipe, const std::function<void(int)>& child) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, file);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  child(pipe);
  _exit(0);
}

}  // namespace

ChildProcess::ChildProcess(const std::function<std::string()>& work, std::string subject)
    : subject_(std::move(subject)) {
  begin([&](int pipe) { writeAnswer(pipe, answerOf(work)); });
}

ChildProcess::ChildProcess(const std::vector<std::string>& program, std::string subject)
    : subject_(std::move(subject)) {
  std::vector<std::string> words = program;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  begin([&](int pipe) {
    dup2(pipe, STDOUT_FILENO);
    if (confine(true)) execvp(arguments.front(), arguments.data());
    writeAnswer(pipe, isError + (": " + program.front()) + ": " + std::strerror(errno));
  });
}

void ChildProcess::begin(const std::function<void(int)>& child) {
  // What another one writes into would stay open in this one.
  static std::mutex oneAtATime;
  const std::scoped_lock alone(oneAtATime);
  int ends[2];
  const auto cannot = [&] { throw OutputError(subject_ + ": no process for it: " + std::strerror(errno)); };
  if (pipe2(ends, O_CLOEXEC) != 0) cannot();
  child_ = fork();
  if (child_ == 0) runChild(ends[1], child);
  close(ends[1]);
  pipe_ = ends[0];
  if (child_ > 0) return;
  close(pipe_);
  cannot();
}

ChildProcess::~ChildProcess() {
  if (child_ < 0) return;
  kill(child_, SIGKILL);
  end();
}

/// \returns the status of the child
int ChildProcess::end() {
  close(pipe_);
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  return status;
}

std::string ChildProcess::answer(double seconds) {
  using Clock = std::chrono::steady_clock;
  constexpr int pause = 50;  // in milliseconds
  const auto begin = Clock::now();
  std::string answer;
  std::array<char, 65536> block{};
  for (ssize_t n = 1; n != 0;) {
    pollfd ready{pipe_, POLLIN, 0};
    const int any = poll(&ready, 1, pause);
    stopIfInterrupted();
    if (std::chrono::duration<double>(Clock::now() - begin).count() > seconds)
      throw InputError(subject_ + " has not ended with it after " + digits(seconds, 4) +
                       " s, expected a file that takes less");
    if (any <= 0) continue;
    n = read(pipe_, block.data(), block.size());
    if (n < 0 && errno != EINTR) break;
    if (n > 0) answer.append(block.data(), static_cast<size_t>(n));
  }
  const int status = end();
  if (WIFSIGNALED(status))
    throw InputError(subject_ + " crashed on it (" + strsignal(WTERMSIG(status)) + ")");
  if (answer.empty() || WEXITSTATUS(status) != 0) throw InputError(subject_ + " gave up on it");
  std::string bytes = answer.substr(1);
  if (answer.front() == isMemory) throw std::bad_alloc();
  if (answer.front() == isError) throw InputError(bytes.front() == ':' ? subject_ + bytes : bytes);
  return bytes;
}

}  // namespace mortier
