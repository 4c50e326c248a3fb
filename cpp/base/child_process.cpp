#include "base/child_process.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
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
    return isResult + work();
  } catch (const std::bad_alloc&) {
    return {isMemory};
  } catch (const std::exception& error) {
    return isError + std::string(error.what());
  }
}

void confineOrThrow() {
  if (!confine(false)) throw InputError(std::string(": cannot be confined: ") + std::strerror(errno));
}

/// The bytes of an answer. \throws InputError, std::bad_alloc
std::string resultIn(const std::string& answer, const std::string& subject) {
  if (answer.empty()) throw InputError(subject + " gave up on it");
  std::string bytes = answer.substr(1);
  if (answer.front() == isMemory) throw std::bad_alloc();
  if (answer.front() == isError) throw InputError(bytes.front() == ':' ? subject + bytes : bytes);
  return bytes;
}

/// \returns false where nobody reads it
bool writeTo(int end, std::string_view left) {
  while (!left.empty()) {
    const ssize_t n = send(end, left.data(), left.size(), MSG_NOSIGNAL);
    if (n < 0 && errno != EINTR) return false;
    left.remove_prefix(n < 0 ? 0 : static_cast<size_t>(n));
  }
  return true;
}

/// Of messages, which begin with it.
std::string lengthOf(const std::string& message) {
  const uint64_t size = message.size();
  return {reinterpret_cast<const char*>(&size), sizeof size};
}

bool readFrom(int end, char* data, size_t size) {
  while (size > 0) {
    const ssize_t n = read(end, data, size);
    if (n == 0 || (n < 0 && errno != EINTR)) return false;
    if (n > 0) data += n;
    if (n > 0) size -= static_cast<size_t>(n);
  }
  return true;
}

bool readMessage(int end, std::string& message) {
  uint64_t size = 0;
  if (!readFrom(end, reinterpret_cast<char*>(&size), sizeof size)) return false;
  message.resize(size);
  return readFrom(end, message.data(), size);
}

[[noreturn]] void runChild(int end, const std::function<void(int)>& child) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, file);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  child(end);
  _exit(0);
}

}  // namespace

ForkedProcess::ForkedProcess(const std::function<void(int)>& child, std::string subject)
    : subject_(std::move(subject)) {
  // What another one writes into would stay open in this one.
  static std::mutex oneAtATime;
  const std::scoped_lock alone(oneAtATime);
  int ends[2];
  const auto cannot = [&] { throw OutputError(subject_ + ": no process for it: " + std::strerror(errno)); };
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) cannot();
  child_ = fork();
  if (child_ == 0) {
    close(ends[0]);
    runChild(ends[1], child);
  }
  close(ends[1]);
  socket_ = ends[0];
  if (child_ > 0) return;
  close(socket_);
  cannot();
}

ForkedProcess::~ForkedProcess() {
  if (child_ < 0) return;
  kill(child_, SIGKILL);
  end();
}

/// \returns the status of the child
int ForkedProcess::end() {
  close(socket_);
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  return status;
}

void ForkedProcess::join() {
  if (child_ < 0) throw InputError(subject_ + " gave up on it");
  const int status = end();
  if (WIFSIGNALED(status))
    throw InputError(subject_ + " crashed on it (" + strsignal(WTERMSIG(status)) + ")");
  if (WEXITSTATUS(status) != 0) throw InputError(subject_ + " gave up on it");
}

bool ForkedProcess::receive(std::string& answer, std::chrono::steady_clock::time_point begin,
                            double seconds) const {
  constexpr int pause = 50;  // in milliseconds
  pollfd ready{socket_, POLLIN, 0};
  const int any = poll(&ready, 1, pause);
  stopIfInterrupted();
  if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > seconds)
    throw InputError(subject_ + " has not ended with it after " + digits(seconds, 4) +
                     " s, expected a file that takes less");
  if (any <= 0) return true;
  std::array<char, 65536> block{};
  const ssize_t n = read(socket_, block.data(), block.size());
  if (n > 0) answer.append(block.data(), static_cast<size_t>(n));
  return n > 0 || (n < 0 && errno == EINTR);
}

ChildProcess::ChildProcess(const std::function<std::string()>& work, std::string subject)
    : ForkedProcess(
          [&](int end) {
            writeTo(end, answerOf([&] {
                      confineOrThrow();
                      return work();
                    }));
          },
          std::move(subject)) {}

namespace {

void becomeProgram(int end, const std::vector<std::string>& program) {
  std::vector<std::string> words = program;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  dup2(end, STDOUT_FILENO);
  if (confine(true)) execvp(arguments.front(), arguments.data());
  writeTo(end, isError + (": " + program.front()) + ": " + std::strerror(errno));
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& program, std::string subject)
    : ForkedProcess([&](int end) { becomeProgram(end, program); }, std::move(subject)) {}

std::string ChildProcess::answer(double seconds) {
  const auto begin = std::chrono::steady_clock::now();
  std::string answer;
  while (receive(answer, begin, seconds)) {
  }
  join();
  return resultIn(answer, subject());
}

ChildServer::ChildServer(const std::function<Answers()>& start, std::string subject)
    : ForkedProcess(
          [&](int end) {
            Answers answers;
            const std::string begun = answerOf([&] {
              confineOrThrow();
              answers = start();
              return std::string();
            });
            for (std::string request; readMessage(end, request);) {
              const std::string answer = answers ? answerOf([&] { return answers(request); }) : begun;
              if (!writeTo(end, lengthOf(answer) + answer)) break;
            }
          },
          std::move(subject)) {}

std::string ChildServer::ask(const std::string& request, double seconds) {
  const auto begin = std::chrono::steady_clock::now();
  const size_t head = sizeof(uint64_t);
  std::string answer;
  const auto isWhole = [&] {
    uint64_t size = 0;
    if (answer.size() >= head) std::memcpy(&size, answer.data(), head);
    return answer.size() >= head && answer.size() >= head + size;
  };
  if (writeTo(socket(), lengthOf(request) + request))
    while (!isWhole() && receive(answer, begin, seconds)) {
    }
  if (!isWhole()) {
    join();
    throw InputError(subject() + " gave up on it");
  }
  return resultIn(answer.substr(head), subject());
}

}  // namespace mortier
