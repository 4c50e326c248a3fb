// Loaded before a program (LD_PRELOAD), makes one of its calls to the file system fail, or kills it there.
//   FAULT_AT=n     the n-th call counts (from 1); without it all are counted only
//   FAULT_HOW      kill: the process ends before the call; ENOSPC or EIO: the call fails; all-ENOSPC, all-EIO: so do
//                  all that change something after it
//   FAULT_COUNT    file descriptor to which the number of calls is written in the end
// Calls about files of the system (/proc, /usr, ...) do not count.
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static int calls, at, kills, all, reason;

__attribute__((constructor)) static void begin(void) {
  const char* how = getenv("FAULT_HOW");
  const char* n = getenv("FAULT_AT");
  at = n ? atoi(n) : 0;
  if (how) {
    kills = strcmp(how, "kill") == 0;
    all = strncmp(how, "all-", 4) == 0;
    reason = strstr(how, "EIO") ? EIO : ENOSPC;
  }
  unsetenv("LD_PRELOAD");
}

__attribute__((destructor)) static void end(void) {
  const char* where = getenv("FAULT_COUNT");
  if (where) dprintf(atoi(where), "%d\n", calls);
}

// Whether this call is the one. changes: it writes, so that it fails again and again on a full disk.
static int strikes(const char* path, int changes) {
  static const char* const system[] = {"/proc", "/sys", "/usr", "/etc", "/lib", "/dev"};
  for (size_t i = 0; path && i < sizeof system / sizeof *system; ++i)
    if (strncmp(path, system[i], strlen(system[i])) == 0) return 0;
  const int n = ++calls;
  if (at == 0 || (n != at && !(all && changes && n > at))) return 0;
  if (kills) kill(getpid(), SIGKILL);
  errno = reason;
  return 1;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define WRAP(result, name, parameters, arguments, path, changes, failure) \
  result name parameters {                                                \
    return strikes(path, changes) ? failure : REAL(name) arguments;       \
  }

WRAP(int, mkdir, (const char* p, mode_t m), (p, m), p, 1, -1)
WRAP(int, rmdir, (const char* p), (p), p, 0, -1)
WRAP(int, unlink, (const char* p), (p), p, 0, -1)
WRAP(int, unlinkat, (int d, const char* p, int f), (d, p, f), 0, 0, -1)
WRAP(int, remove, (const char* p), (p), p, 0, -1)
WRAP(int, rename, (const char* a, const char* b), (a, b), a, 1, -1)
WRAP(int, renameat2, (int d, const char* a, int e, const char* b, unsigned f), (d, a, e, b, f), a, 1, -1)
WRAP(int, ftruncate, (int f, off_t n), (f, n), 0, 1, -1)
WRAP(int, flock, (int f, int o), (f, o), 0, 0, -1)
WRAP(int, stat, (const char* p, struct stat* s), (p, s), p, 0, -1)
WRAP(int, lstat, (const char* p, struct stat* s), (p, s), p, 0, -1)
WRAP(int, fstat, (int f, struct stat* s), (f, s), 0, 0, -1)
WRAP(int, faccessat, (int d, const char* p, int m, int f), (d, p, m, f), p, 0, -1)
WRAP(char*, realpath, (const char* restrict p, char* restrict b), (p, b), p, 0, 0)
WRAP(DIR*, opendir, (const char* p), (p), p, 0, 0)
WRAP(struct dirent*, readdir, (DIR * d), (d), 0, 0, 0)
WRAP(struct dirent64*, readdir64, (DIR * d), (d), 0, 0, 0)
WRAP(int, stat64, (const char* p, struct stat64* s), (p, s), p, 0, -1)
WRAP(int, lstat64, (const char* p, struct stat64* s), (p, s), p, 0, -1)
WRAP(int, fstat64, (int f, struct stat64* s), (f, s), 0, 0, -1)
WRAP(int, ftruncate64, (int f, off64_t n), (f, n), 0, 1, -1)
WRAP(ssize_t, pread, (int f, void* b, size_t n, off_t o), (f, b, n, o), 0, 0, -1)
WRAP(size_t, fwrite, (const void* restrict b, size_t s, size_t n, FILE* restrict f), (b, s, n, f), 0, 1, 0)

int fsync(int f) {  // no test takes the power away, and disks are slow
  (void)f;
  return strikes(0, 1) ? -1 : 0;
}
ssize_t read(int f, void* b, size_t n) {
  return f > 2 && strikes(0, 0) ? -1 : REAL(read)(f, b, n);
}
ssize_t write(int f, const void* b, size_t n) {
  return f > 2 && strikes(0, 1) ? -1 : REAL(write)(f, b, n);
}

FILE* fopen(const char* restrict p, const char* restrict m) {
  return strikes(p, *m == 'w') ? 0 : REAL(fopen)(p, m);
}
FILE* fopen64(const char* restrict p, const char* restrict m) {
  return strikes(p, *m == 'w') ? 0 : REAL(fopen64)(p, m);
}
int fclose(FILE* f) {
  const int struck = strikes(0, 0);  // what it holds may be lost, the file is closed all the same
  const int error = errno;
  const int result = REAL(fclose)(f);
  if (struck) errno = error;
  return struck ? EOF : result;
}

#define OPEN(name)                                                               \
  int name(const char* p, int flags, ...) {                                      \
    va_list rest;                                                                \
    va_start(rest, flags);                                                       \
    const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;              \
    va_end(rest);                                                                \
    return strikes(p, (flags & O_CREAT) != 0) ? -1 : REAL(name)(p, flags, mode); \
  }
OPEN(open)
OPEN(open64)

int openat(int d, const char* p, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return strikes(p, (flags & O_CREAT) != 0) ? -1 : REAL(openat)(d, p, flags, mode);
}
