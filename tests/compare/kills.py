#!/usr/bin/env python3
"""Runs and restarts that are killed at random moments, and several processes on one folder.

kills.py [--kills N] [--rounds N] [--seed N]    prints what was found, ends with 1 if anything was

After a kill the next command ends in the bytes of a run that was not killed, files of others stay, and
nothing is left. Of several processes at once each ends with its result or with "in use".
"""
import argparse
import random
import signal
import subprocess
import sys
import tempfile
import time

from call_sweep import RESTART, RUN, Sweep


class Kills(Sweep):
    def kill_one(self, rng):
        """One run or restart, killed up to three times on its way."""
        begin, command = rng.choice([("base", RUN), ("old", RUN), ("failed", RUN), ("base-stopped", RESTART),
                                     ("old-stopped", RESTART)])
        self.others = not begin.startswith("base")
        folder = self.copy(begin, "tried")
        for _ in range(rng.randrange(1, 4)):
            process = subprocess.Popen([self.program, *command], cwd=folder, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(rng.expovariate(1 / self.seconds))
            process.send_signal(signal.SIGKILL)
            process.wait()
            self.killed += process.returncode == -signal.SIGKILL
            self.expect(f"{begin}, killed",
                        [*self.lost(folder), *(self.not_whole(folder / "out/r") if self.others else [])])
        done = self.run(folder, command)
        complete = command == RESTART and done.returncode == 2 and "no stopped run" in done.stderr
        self.expect(f"{begin}, next command", [*([] if done.returncode == 0 or complete else [done.stderr]),
                                               *self.lost(folder),
                                               *self.not_new(folder), *self.not_whole(folder / "out/r"),
                                               *self.left(folder)])

    def round(self, processes=4):
        folder, self.others = self.folder / "tried", True
        runs = [subprocess.Popen([self.program, *RUN], cwd=folder, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE, text=True)
                for _ in range(processes)]
        faults = []
        for process in runs:
            errors = process.communicate(timeout=600)[1]
            if not (process.returncode == 0 or (process.returncode == 2 and ": in use, " in errors)):
                faults.append(f"{process.returncode} {errors}")
            self.refused += process.returncode != 0
        self.expect("several at once", [*faults, *self.lost(folder), *self.not_new(folder),
                                        *self.not_whole(folder / "out/r"), *self.left(folder)])

    def expect(self, what, faults):
        if faults:
            self.findings.append(f"{what}\n  " + "\n  ".join(faults))
            print(self.findings[-1], flush=True)

    def explore_all(self, kills, rounds, seed):
        rng = random.Random(seed)
        begin = time.perf_counter()
        self.run(self.copy("old", "timed"), RUN)
        self.seconds = time.perf_counter() - begin
        self.killed = self.refused = 0
        while self.killed < kills:
            self.kill_one(rng)
        self.copy("old", "tried")
        for _ in range(rounds):
            self.round()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=500)
    parser.add_argument("--rounds", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        kills = Kills(folder)
        kills.explore_all(given.kills, given.rounds, given.seed)
    print(f"{kills.killed} kills, {given.rounds} rounds of 4 processes ({kills.refused} refused), "
          f"{len(kills.findings)} findings")
    return 1 if kills.findings else 0


if __name__ == "__main__":
    sys.exit(main())
