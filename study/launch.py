"""launch.py FD COMMAND...: runs a command and writes `code wall processor memory` to the file descriptor.

A process counts the memory of the one that started it, before it becomes a program of its own, into its peak; this
one is small.
"""
import os
import sys
import time

report, command = int(sys.argv[1]), sys.argv[2:]
begin = time.perf_counter()
try:
    pid = os.posix_spawnp(command[0], command, os.environ, file_actions=[(os.POSIX_SPAWN_CLOSE, report)])
except OSError as error:
    sys.exit(f"{command[0]}: {error.strerror}")
_, status, usage = os.wait4(pid, 0)
seconds = time.perf_counter() - begin
code = os.waitstatus_to_exitcode(status)
os.write(report, f"{code} {seconds!r} {usage.ru_utime + usage.ru_stime!r} {usage.ru_maxrss / 1024!r}".encode())
sys.exit(code if 0 <= code < 256 else 1)
