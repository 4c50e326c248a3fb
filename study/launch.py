"""launch.py FD COMMAND...: runs a command and writes `code wall processor memory` to the file descriptor.

A process counts the memory of the one that started it, before it becomes a program of its own, into its peak;
this one is small. Standard input is a pipe of the study: when it ends, the study was killed,
and so is the command.
"""
import os
import select
import sys
import time

report, command = int(sys.argv[1]), sys.argv[2:]
begin = time.perf_counter()
try:
    pid = os.posix_spawnp(command[0], command, os.environ, file_actions=[
        (os.POSIX_SPAWN_CLOSE, report), (os.POSIX_SPAWN_OPEN, 0, os.devnull, os.O_RDONLY, 0)])
except OSError as error:
    sys.exit(f"{command[0]}: {error.strerror}")
try:
    ended = os.pidfd_open(pid)
    if ended not in select.select([0, ended], [], [])[0]:
        os.killpg(0, 9)
except OSError:  # an old system, which cannot wait for both
    pass
_, status, usage = os.wait4(pid, 0)
seconds = time.perf_counter() - begin
code = os.waitstatus_to_exitcode(status)
os.write(report,
         f"{code} {seconds!r} {usage.ru_utime + usage.ru_stime!r} {usage.ru_maxrss / 1024!r}".encode())
sys.exit(code if 0 <= code < 256 else 1)
