"""Results of others: what is no file, endless, too large or names files elsewhere is refused with one line."""
import contextlib
import os
import re
import unittest

from support import InFolder, mortier
from views_support import solve, view

FILES = ("summary.json", "fields.pvd", "contact.csv", "history.csv", "upper_000004.vtu")


class HostileResults(InFolder):
    def setUp(self):
        super().setUp()
        solve(self.folder, "run", "output.every=1", "contact.variant=interpolation")

    @contextlib.contextmanager
    def instead(self, name):
        """The path of a file of the result, for something else in its place."""
        path = self.folder / "run" / name
        sound = path.read_bytes()
        path.unlink()
        yield path
        path.unlink()
        path.write_bytes(sound)

    def refuse(self, message, *words):
        code, _, errors = view(self.folder, *words)
        self.assertEqual((code, errors.count("\n")), (2, 1), errors)
        self.assertIn(message, errors)
        self.assertEqual(self.names(), ["run"])

    def test_what_is_no_file_or_too_large(self):
        for name in FILES:
            for make, message in ((os.mkfifo, "no regular file"),
                                  (lambda path: path.symlink_to("/dev/zero"), "no regular file"),
                                  (lambda path: (path.touch(), os.truncate(path, 1 << 42)), " at most")):
                with self.subTest(name=name, message=message), self.instead(name) as path:
                    make(path)
                    for command in ("plot", "report"):
                        self.refuse(f"run/{name}: ", command, "run")
                        self.refuse(message, command, "run")
        with self.instead("history.csv") as path:
            os.mkfifo(path)
            done = mortier("freefem", self.folder / "none.toml", "--steps-of", "run", cwd=self.folder)
            self.assertEqual(done.returncode, 2)

    def test_collections_name_files_of_their_folder(self):
        sound = (self.folder / "run/fields.pvd").read_text()
        for other in ("../upper_000004.vtu", "/upper_000004.vtu", "upper.vtu", "", "upper_٠٠٠٠٠٤.vtu",
                      "upper_" + "9" * 300 + ".vtu", "a\nb_000004.vtu"):
            with self.subTest(other), self.instead("fields.pvd") as path:
                path.write_text(sound.replace("upper_000004.vtu", other))
                for command in ("plot", "report"):
                    self.refuse("expected BODY_STEP.vtu in the same folder", command, "run")

    def test_tables_with_other_numbers_of_cells(self):
        for name in ("contact.csv", "history.csv"):
            sound = (self.folder / "run" / name).read_text()
            for cells in (lambda row: row.rsplit(",", 1)[0], lambda row: row + ",1"):
                with self.instead(name) as path:
                    path.write_text(re.sub(r"^\S+\n\Z", lambda row: cells(row[0][:-1]) + "\n", sound, flags=re.M))
                    self.refuse("has not as many cells as there are columns", "plot", "run")

    def test_scales_and_windows_of_any_size(self):
        for large in ("1e308", "-1e308", "1e30"):
            self.refuse("--scale", "plot", "run", f"--scale={large}")
        for window in ("-1e308,1e308,-1e308,1e308", "-1,1,0,1e30", "0,1e-300,0,1e-300", "0,5e-324,0,1"):
            self.refuse("--window: a side of ", "plot", "run", f"--window={window}")
        for drawn in ("--scale=1e6", "--scale=-10", "--window=0,1e5,0,1e-5", "--window=5,6,5,6"):
            code, _, errors = view(self.folder, "plot", "run", drawn, "--only", "fields", "--out", "a.png")
            self.assertEqual((code, errors), (0, ""))

    def test_numbers_that_overflow(self):
        for name, letters in (("history.csv", r"[^,\n]+$"), ("contact.csv", r"[^,\n]+$"),
                              ("summary.json", r"(?<=\"interpenetration\": )[^,]+")):
            sound = (self.folder / "run" / name).read_text()
            for number in ("1e999", "-1e308", "nan"):
                with self.subTest(name=name, number=number), self.instead(name) as path:
                    path.write_text(re.sub(letters + r"(?=,?\n?\Z|,)", number, sound, flags=re.M))
                    self.refuse("run", "plot", "run")
                    self.refuse("run", "report", "run")

    def test_without_a_home_there_is_no_other_line(self):
        nowhere = {"PATH": os.environ["PATH"], "HOME": "/nonexistent"}
        for environment in (nowhere, {"PATH": os.environ["PATH"]}):
            done = mortier("plot", "run", "--only", "history", cwd=self.folder, env=environment)
            self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
