"""Signals are acted on within about a second of work, also while meshes are refined between rounds."""
import os
import signal
import subprocess
import time
import unittest

from support import PROGRAM, ROOT, InFolder

MOST = 3.0  # seconds of processor time from the signal to the end, all threads


def processor_time(pid):
    fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Interruption(InFolder):
    def latency(self, scene, after, by):
        """Processor time from a signal to the end, sent after so many seconds of processor time."""
        process = subprocess.Popen([PROGRAM, "run", ROOT / f"scenes/{scene}.toml", "--quiet", "--out", "out",
                                    "--set", "accuracy.energy=0.001"], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while process.poll() is None and processor_time(process.pid) < after:
            time.sleep(0.01)
        self.assertIsNone(process.returncode, "it has ended")
        begin = processor_time(process.pid)
        process.send_signal(by)
        errors = process.stderr.read()
        process.stderr.close()
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 1, errors)
        self.assertRegex(errors.splitlines()[-1], "^mortier: .*: interrupted .*; mortier run --restart out "
                         "begins the rounds again$")
        return used.ru_utime + used.ru_stime - begin

    def test_between_rounds_and_in_them(self):
        for after, by in ((3, signal.SIGTERM), (6, signal.SIGINT), (9, signal.SIGTERM), (12, signal.SIGHUP)):
            for scene in ("punch", "hertz"):
                with self.subTest(scene=scene, after=after):
                    self.assertLess(self.latency(scene, after, by), MOST)


if __name__ == "__main__":
    unittest.main()
