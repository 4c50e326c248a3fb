"""mortier study and what others wrote: names in its page and pictures, files in its folder."""
import html
import os
import pickle
import re
import subprocess
import sys
import unittest
import xml.etree.ElementTree as xml

import numpy as np

from study_support import SPACE, StudyTest
from support import PROGRAM, ROOT, told
from folder import Folder
from problems import StudyError
import parcel
import plan as plans
from table import AFTER

sys.path.insert(0, str(ROOT / "tests/fuzz"))
from fuzz_study import explore  # noqa: E402

HEAD = SPACE[:SPACE.index("[[error]]")]
NAMES = [r"a $\\frac{1}$ b", "a b", "A-b", "<script>alert(1)</script>", "_x" + 298 * "y"]


def errors(names):
    return "".join(f"[[error]]\nname = \"{name}\"\nquantity = \"von_mises_max\"\nexact = 10\n"
                   for name in names)


ONE_RUN = SPACE[:SPACE.index("[mesh]")] + errors(["a"]) + '[[sweep]]\nname = "s"\ntime.steps = 1\n'


class StudyFiles(StudyTest):
    def refused(self, text, message):
        """One line, code 2, and nothing is made."""
        self.path.write_text(text)
        done = self.study(code=2)
        self.assertEqual(done.stdout, "")
        line, = told(done.stderr)
        self.assertTrue(line.startswith("mortier: " + message), line)
        self.assertFalse(self.out.exists())

    def test_names_are_shown_as_they_are(self):
        self.path.write_text(HEAD.replace("[3, 6, 12]", "[3, 6]").replace("[8, 16, 32]", "[8, 16]")
                             + errors(NAMES) +
                             '[[sweep]]\nname = "_$x^<b>"\nlevel = [0, 1]\ntime.steps = 2\n')
        self.study()
        pictures = [path.name for path in self.out.glob("*-dofs.svg")]
        self.assertEqual(len({name.lower() for name in pictures}), len(NAMES))
        for name in pictures:
            xml.parse(self.out / name)
        page = (self.out / "report.html").read_text()
        self.assertNotIn("<script", page)
        self.assertNotIn("<b>", page)
        for name in NAMES:
            self.assertIn(html.escape(name.replace("\\\\", "\\")), page)
        self.assertEqual(len(set(re.findall(r"base64,(\S+)\"", page))), page.count("base64,"))

    def test_texts_that_cannot_be_shown(self):
        sound = HEAD + errors(["a"]) + '[[sweep]]\nname = "s"\nlevel = 0\n'
        for bad in ("a\\u0000b", "a\\nb", "\\u001b[2J", "\\u202ex", "a" * 301):
            for old, what in (('name = "a"', "error 0: name"), ('name = "s"', "sweep 0: name")):
                with self.subTest(bad=bad[:9], what=what):
                    self.refused(sound.replace(old, f'name = "{bad}"'), f"{self.path}:")
        self.refused(sound + '"time.scheme" = ["a\\u0000b"]\n', f"{self.path}:")
        self.refused('title = "a\\nb"\n' + sound, f"{self.path}:1: title")

    def test_files_of_others_stay(self):
        self.path.write_text(ONE_RUN)
        self.study()
        mine = {"meshes/a": "1", "runs/b": "2", "notes": "3", "mortier-work-7/c": "4", "report.tmp": "5",
                "study.csv.tmp": "6", "report.html": "7", "mortier-work-8": "8"}
        for name, text in mine.items():
            (self.out / name).parent.mkdir(exist_ok=True)
            (self.out / name).write_text(text)
        self.study()
        mine["report.html.kept"] = mine.pop("report.html")
        for name, text in mine.items():
            self.assertEqual((self.out / name).read_text(), text, name)
        self.assertIn("<h2>Runs</h2>", (self.out / "report.html").read_text())
        self.assertEqual({path.name for path in self.out.iterdir()} - {name.split("/")[0] for name in mine},
                         {"study.csv", "report.html", "manifest.json"})

    def test_tables_of_others_and_damaged_ones(self):
        self.path.write_text(ONE_RUN)
        self.study()
        sound = (self.out / "study.csv").read_bytes()
        row = sound.splitlines()[1]
        for damaged in (sound.replace(row, row[:40]),
                        sound.replace(row, bytes(range(128, 256)) + b"\0" + row[5:]),
                        sound.replace(row, row.replace(b",done,", b",dOne,")), sound + b"\xff\xfe\0,,\n" * 3,
                        sound.replace(row, re.sub(rb"[0-9.e-]+$", b"ten", row))):
            (self.out / "study.csv").write_bytes(damaged)
            self.study()
            self.assertEqual([each["status"] for each in self.rows()], ["done"])
        for foreign in (b"", b"\x7fELF\0\0", b"key,sweep\n", b"name,age\n", b"x" * 10**6):
            (self.out / "study.csv").write_bytes(foreign)
            self.assertIn("study.csv is not one of mortier study", self.one_line(2))
            self.assertEqual((self.out / "study.csv").read_bytes(), foreign)

    def one_line(self, code):
        line, = told(self.study("--quiet", code=code).stderr)
        return line

    def test_a_task_is_data_of_others(self):
        """What comes to `mortier study -` is made of values and classes of the study, and calls nothing."""
        called = self.folder / "called"

        class Call:
            def __reduce__(self):
                return os.system, (f"touch {called}",)

        class Inside:
            def __reduce__(self):
                return parcel.RunFailure, (Call(),)
        environment = {**os.environ, "MORTIER": PROGRAM}
        stamp = subprocess.run([sys.executable, "-c", "import remote; print(remote.stamp().decode())"],
                               cwd=ROOT / "study", env=environment, capture_output=True, text=True).stdout
        for value in (Call(), Inside(), [1, {"a": Call()}]):
            data = pickle.dumps(value)
            with self.assertRaisesRegex(parcel.RunFailure, "nothing of a study: posix.system"):
                parcel.unpacked(data)
            done = subprocess.run([PROGRAM, "study", "-"], cwd=self.folder, capture_output=True,
                                  input=stamp.strip().encode() + len(data).to_bytes(8, "little") + data)
            self.assertEqual((done.returncode, done.stdout), (1, b""))
            self.assertRegex(done.stderr.decode(), r"\Amortier: .*nothing of a study: posix.system\n\Z")
        self.assertFalse(called.exists())
        for data in (b"", b"no pickle", pickle.dumps([1, 2])[:-3]):
            with self.assertRaises(parcel.RunFailure):
                parcel.unpacked(data)

    def test_plans_arrive_as_they_were_sent(self):
        self.path.write_text(ONE_RUN.replace("exact = 10", "") + "[reference]\nsteps = 9\n" + """
[let]
a = "x + 2*y"
[[error]]
name = "b"
quantity = "displacement"
exact = { ux = "a*t", uy = 3 }
""")
        sent = plans.read(self.path)
        plan = parcel.unpacked(parcel.packed(sent))
        self.assertEqual((plan.cases(), plan.fingerprint, plan.reference, plan.path),
                         (sent.cases(), sent.fingerprint, sent.reference, sent.path))
        x, y = np.array([[1.0, 2.0], [3.0, 5.0]])
        for one in (plan, sent):
            a = dict(one.let)["a"](x, y, 2.0)
            np.testing.assert_array_equal(one.errors[1].exact[""]["ux"](x, y, 2.0, a=a), [14, 24])

    def test_pipes_in_a_study(self):
        (self.folder / "study").mkdir()
        os.mkfifo(self.folder / "study/study.csv")
        with self.assertRaisesRegex(StudyError, "study.csv is in the way"):
            Folder(self.folder / "study")
        (self.folder / "study/study.csv").unlink()
        os.mkfifo(self.folder / "study/manifest.json")
        with self.assertRaisesRegex(StudyError, "holds other files"):
            Folder(self.folder / "study")
        (self.folder / "study/study.csv").write_text(",".join(("key", "sweep", *AFTER)) + "\n")
        with Folder(self.folder / "study") as folder:
            folder.put_own({"page.html": b"page"})
        self.assertEqual(self.names("study"),
                         ["manifest.json", "manifest.json.kept", "page.html", "study.csv"])

    def test_places_that_cannot_be_used(self):
        self.path.write_text(ONE_RUN)
        self.out.symlink_to("nothing")
        self.assertIn("a link to nothing", self.one_line(2))

    def test_no_result_is_said_also_when_quiet(self):
        self.path.write_text(ONE_RUN.replace("time.steps = 1", "body.material.poisson = 0.7"))
        self.assertIn("no run has a result", self.one_line(1))

    def test_what_cannot_be_evaluated_is_refused(self):
        for bad in ("sin()", "sin(1, 2)", "min()", "1 +", "x.y", "(" * 5000, "a" * 9, "()", "'a'", "9" * 9000,
                    "1 if x else 2"):
            with self.subTest(bad[:20]):
                self.refused(SPACE.replace('s11 = "0"', f's11 = "{bad}"'), f"{self.path}:")
        for bad in ("a = " + "[" * 5000, "a" + ".a" * 5000 + " = 1", "timeout = 1e300",
                    "repeat = 99999999999", "[[" + " " * 100000):
            with self.subTest(bad[:20]):
                self.refused(bad + "\n" + ONE_RUN, "")

    def test_changed_studies_are_read_or_refused(self):
        findings, numbers = explore(300)
        self.assertEqual(findings, [])
        self.assertGreater(min(numbers.values()), 10)

    def test_killed_and_two_at_once(self):
        self.path.write_text(ONE_RUN.replace("time.steps = 1", "time.steps = 100000000"))
        process = subprocess.Popen([PROGRAM, "study", self.path, "--out", self.out, "--quiet"],
                                   start_new_session=True)
        while not list(self.out.glob("mortier-work-*/runs/*/*")):
            self.assertIsNone(process.poll())
        self.assertIn("in use, a study in it still goes on", self.one_line(2))
        process.kill()
        process.wait()
        self.path.write_text(ONE_RUN)
        self.study()
        self.assertEqual(self.names("out"), ["manifest.json", "report.html", "study.csv"])
        processes = subprocess.run(["ps", "ax", "-o", "args"], capture_output=True, text=True).stdout
        self.assertNotIn(f"{self.out}/mortier-work-", processes)


if __name__ == "__main__":
    unittest.main()
