// Loaded before a program (LD_PRELOAD), makes one of its calls to the file system fail, or kills it there.
//   FAULT_AT=n     the n-th call counts (from 1); without it all are counted only
//   FAULT_HOW      kill: the process ends before the call; ENOSPC, EIO or EACCES: the call fails; all-ENOSPC:
//                  so do all that change something after it
//   FAULT_COUNT    file descriptor to which the number of calls is written in the end
//   FAULT_SHARED   file in which a process and those that it starts count together; without it those it
//                  starts do not count
//   FAULT_FOLDER   only calls about files in this folder count, and those about folders above it (the current
//                  one); empty: none
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define FILES 4096

static atomic_int own, *calls = &own;
static int at, kills, all, reason;
static char folder[PATH_MAX];
static char counted[FILES];  // whether calls with this file descriptor count

// For a program that wants its calls to count from here on; at = 0 counts them only.
void faults_begin(int n, const char* how, const char* where, const char* shared) {
  at = n;
  kills = how && strcmp(how, "kill") == 0;
  all = how && strncmp(how, "all-", 4) == 0;
  reason = !how ? 0 : strstr(how, "EIO") ? EIO : strstr(how, "EACCES") ? EACCES : ENOSPC;
  if (shared) {
    const int file = REAL(open)(shared, O_RDWR);
    void* place = mmap(0, sizeof *calls, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (file < 0 || place == MAP_FAILED) abort();
    REAL(close)(file);
    calls = place;
  }
  snprintf(folder, sizeof folder, "%s", where ? where : "");
}

__attribute__((constructor)) static void begin(void) {
  char here[PATH_MAX];
  const char* n = getenv("FAULT_AT");
  const char* where = getenv("FAULT_FOLDER");
  const char* shared = getenv("FAULT_SHARED");
  faults_begin(n ? atoi(n) : 0, getenv("FAULT_HOW"), where ? where : getcwd(here, sizeof here), shared);
  if (!shared) unsetenv("LD_PRELOAD");
}

__attribute__((destructor)) static void end(void) {
  const char* where = getenv("FAULT_COUNT");
  if (where) dprintf(atoi(where), "%d\n", *calls);
}

// Whether this call is the one. changes: it writes, so that it fails again and again on a full disk.
static int strikes(int changes) {
  const int n = 1 + atomic_fetch_add(calls, 1);
  if (at == 0 || (n != at && !(all && changes && n > at))) return 0;
  if (kills) kill(getpid(), SIGKILL);
  errno = reason;
  return 1;
}

static int counts(const char* path) {
  if (folder[0] != '/') return 0;
  if (!path || path[0] != '/') return 1;
  const size_t size = strlen(path), whole = strlen(folder);
  const size_t both = size < whole ? size : whole;
  return strncmp(path, folder, both) == 0 && (path[both] == '/' || path[both] == '\0') &&
         (folder[both] == '/' || folder[both] == '\0' || both == 1);
}
static int opened(int file, const char* path) {
  if (file >= 0 && file < FILES) counted[file] = (char)counts(path);
  return file;
}
static int isCounted(int file) { return file > 2 && file < FILES && counted[file]; }

// A call with a path, or with an open file.
#define WITH_PATH(result, name, parameters, arguments, path, changes, failure)        \
  result name parameters {                                                            \
    return counts(path) && strikes(changes) ? failure : REAL(name) arguments;         \
  }
#define WITH_FILE(result, name, parameters, arguments, file, changes, failure)        \
  result name parameters {                                                            \
    return isCounted(file) && strikes(changes) ? failure : REAL(name) arguments;      \
  }

WITH_PATH(int, mkdir, (const char* p, mode_t m), (p, m), p, 1, -1)
WITH_PATH(int, rmdir, (const char* p), (p), p, 0, -1)
WITH_PATH(int, unlink, (const char* p), (p), p, 0, -1)
WITH_PATH(int, unlinkat, (int d, const char* p, int f), (d, p, f), p, 0, -1)
WITH_PATH(int, remove, (const char* p), (p), p, 0, -1)
WITH_PATH(int, rename, (const char* a, const char* b), (a, b), a, 1, -1)
WITH_PATH(int, renameat2, (int d, const char* a, int e, const char* b, unsigned f), (d, a, e, b, f), a, 1, -1)
WITH_PATH(int, link, (const char* a, const char* b), (a, b), a, 1, -1)
WITH_PATH(int, chdir, (const char* p), (p), p, 0, -1)
WITH_PATH(int, chmod, (const char* p, mode_t m), (p, m), p, 0, -1)
WITH_PATH(int, stat, (const char* restrict p, struct stat* restrict s), (p, s), p, 0, -1)
WITH_PATH(int, lstat, (const char* restrict p, struct stat* restrict s), (p, s), p, 0, -1)
WITH_PATH(int, stat64, (const char* restrict p, struct stat64* restrict s), (p, s), p, 0, -1)
WITH_PATH(int, lstat64, (const char* restrict p, struct stat64* restrict s), (p, s), p, 0, -1)
WITH_PATH(int, fstatat64, (int d, const char* restrict p, struct stat64* restrict s, int f), (d, p, s, f),
          p, 0, -1)
WITH_PATH(int, access, (const char* p, int m), (p, m), p, 0, -1)
WITH_PATH(int, faccessat, (int d, const char* p, int m, int f), (d, p, m, f), p, 0, -1)
WITH_PATH(char*, realpath, (const char* restrict p, char* restrict b), (p, b), p, 0, 0)
WITH_PATH(ssize_t, readlink, (const char* restrict p, char* restrict b, size_t n), (p, b, n), p, 0, -1)

WITH_FILE(int, flock, (int f, int o), (f, o), f, 0, -1)
WITH_FILE(int, fstat, (int f, struct stat* s), (f, s), f, 0, -1)
WITH_FILE(int, fstat64, (int f, struct stat64* s), (f, s), f, 0, -1)
WITH_FILE(int, ftruncate, (int f, off_t n), (f, n), f, 1, -1)
WITH_FILE(int, ftruncate64, (int f, off64_t n), (f, n), f, 1, -1)
WITH_FILE(ssize_t, read, (int f, void* b, size_t n), (f, b, n), f, 0, -1)
WITH_FILE(ssize_t, pread, (int f, void* b, size_t n, off_t o), (f, b, n, o), f, 0, -1)
WITH_FILE(ssize_t, write, (int f, const void* b, size_t n), (f, b, n), f, 1, -1)
WITH_FILE(ssize_t, writev, (int f, const struct iovec* b, int n), (f, b, n), f, 1, -1)
WITH_FILE(off_t, lseek, (int f, off_t o, int w), (f, o, w), f, 0, -1)
WITH_FILE(off64_t, lseek64, (int f, off64_t o, int w), (f, o, w), f, 0, -1)
WITH_FILE(DIR*, fdopendir, (int f), (f), f, 0, 0)
WITH_FILE(struct dirent*, readdir, (DIR * d), (d), dirfd(d), 0, 0)
WITH_FILE(struct dirent64*, readdir64, (DIR * d), (d), dirfd(d), 0, 0)
WITH_FILE(size_t, fwrite, (const void* restrict b, size_t s, size_t n, FILE* restrict f), (b, s, n, f),
          fileno(f), 1, 0)
WITH_FILE(int, fflush, (FILE * f), (f), f ? fileno(f) : -1, 1, EOF)
WITH_FILE(int, fseeko, (FILE * f, off_t o, int w), (f, o, w), fileno(f), 0, -1)

int fsync(int f) {  // no test takes the power away, and disks are slow
  return isCounted(f) && strikes(1) ? -1 : 0;
}

// What is closed is closed, whatever the call says.
int close(int f) {
  const int struck = isCounted(f) && strikes(0), error = errno;
  if (f >= 0 && f < FILES) counted[f] = 0;
  const int result = REAL(close)(f);
  if (struck) errno = error;
  return struck ? -1 : result;
}
int fclose(FILE* f) {
  const int file = fileno(f), struck = isCounted(file) && strikes(0), error = errno;
  if (file >= 0 && file < FILES) counted[file] = 0;
  const int result = REAL(fclose)(f);
  if (struck) errno = error;
  return struck ? EOF : result;
}
int closedir(DIR* d) {
  const int file = dirfd(d);
  if (file >= 0 && file < FILES) counted[file] = 0;
  return REAL(closedir)(d);
}

DIR* opendir(const char* p) {
  if (counts(p) && strikes(0)) return 0;
  DIR* d = REAL(opendir)(p);
  if (d) opened(dirfd(d), p);
  return d;
}

#define FOPEN(name)                                                   \
  FILE* name(const char* restrict p, const char* restrict m) {        \
    if (counts(p) && strikes(*m == 'w')) return 0;                    \
    FILE* f = REAL(name)(p, m);                                       \
    if (f) opened(fileno(f), p);                                      \
    return f;                                                         \
  }
FOPEN(fopen)
FOPEN(fopen64)

#define OPEN(name, parameters, arguments)                             \
  int name parameters {                                               \
    va_list rest;                                                     \
    va_start(rest, flags);                                            \
    const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;   \
    va_end(rest);                                                     \
    if (counts(p) && strikes((flags & O_CREAT) != 0)) return -1;      \
    return opened(REAL(name) arguments, p);                           \
  }
OPEN(open, (const char* p, int flags, ...), (p, flags, mode))
OPEN(open64, (const char* p, int flags, ...), (p, flags, mode))
OPEN(openat, (int d, const char* p, int flags, ...), (d, p, flags, mode))
OPEN(openat64, (int d, const char* p, int flags, ...), (d, p, flags, mode))
