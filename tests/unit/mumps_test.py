"""Skeletons distributed by MUMPS (skeletons_on_ranks.cpp), on one, two and four processes."""
import os
import subprocess
import unittest

ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_mpi_yield_when_idle": "1",
               "OPENBLAS_NUM_THREADS": "1"}


class Mumps(unittest.TestCase):
    def test_on_ranks(self):
        for count in (1, 2, 4):
            with self.subTest(ranks=count):
                done = subprocess.run(["mpirun", "--oversubscribe", "--quiet", "-n", str(count),
                                       os.environ["SKELETONS_ON_RANKS"]], capture_output=True, text=True,
                                      timeout=300, env=ENVIRONMENT)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertIn("[  PASSED  ]", done.stdout)


if __name__ == "__main__":
    unittest.main()
