"""What mortier plot refuses, and what it never overwrites."""
import io
import json
import resource
import shutil
import unittest
import xml.etree.ElementTree as xml

from PIL import Image

from support import InFolder, mortier
from damaged_results import explore
from views_support import solve, view
import files
import pictures
from ending import Wrong


class Refused(InFolder):
    def setUp(self):
        super().setUp()
        solve(self.folder, "run", "output.every=1", "contact.variant=interpolation")

    def refuse(self, message, *words, code=2):
        names = self.names()
        for command in ("plot", "report"):
            if command == "report" and any(str(word).startswith("--") for word in words):
                continue
            found, _, errors = view(self.folder, command, *words)
            self.assertEqual(found, code, errors)
            self.assertEqual(errors.count("\n"), 1, errors)
            self.assertTrue(errors.startswith("mortier: "), errors)
            self.assertTrue(errors[:-1].isprintable(), errors)
            self.assertIn(message, errors)
            self.assertEqual(self.names(), names)

    def test_options(self):
        self.refuse("step 99 was not kept, expected one of 0, 1, 2, 3, 4", "run", "--step", 99)
        self.refuse("expected one of von_mises, s11", "run", "--field", "s33")
        self.refuse("expected a number", "run", "--scale", "nan")
        for window in ("1,0,0,1", "0,1,2", "a,b,c,d"):
            self.refuse("--window", "run", "--window", window)
        self.refuse("a .gif is for --animate", "run", "--out", "a.gif")

    def test_what_is_no_result(self):
        (self.folder / "empty").mkdir()
        self.refuse("empty/summary.json: cannot be read", "empty")
        self.refuse("no such folder", "nowhere")
        self.refuse("no such folder", "run/summary.json")
        self.refuse("no such folder", "a\n\x1b[31mb")

    def test_damaged_files(self):
        """Every file of a result cut short, emptied, gone, or with other bytes in its middle."""
        sound = self.folder / "sound"
        shutil.copytree(self.folder / "run", sound)
        for name in ("summary.json", "fields.pvd", "contact.csv", "history.csv", "upper_000004.vtu"):
            data = (sound / name).read_bytes()
            middle = len(data) // 2
            for damage, changed in (("cut", data[:middle]), ("empty", b""), ("gone", None),
                                    ("other", data[:middle] + b"\xff\x00<&" + data[middle + 4:])):
                if name.endswith(".vtu") and damage == "other":
                    continue  # another number is a number
                with self.subTest(name=name, damage=damage):
                    path = self.folder / "run" / name
                    path.unlink() if changed is None else path.write_bytes(changed)
                    code, _, errors = view(self.folder, "plot", "run", "--only", "fields", "--out", "x.png")
                    if name == "history.csv" and damage == "empty":
                        self.assertEqual(code, 0, errors)  # as before the first step
                        (self.folder / "x.png").unlink()
                    else:
                        self.assertEqual(code, 2, errors)
                        self.assertEqual(errors.count("\n"), 1, errors)
                        self.assertFalse((self.folder / "x.png").exists())
                    path.write_bytes(data)

    def test_seeded_damage(self):
        (self.folder / "damaged").mkdir()
        faults, codes = explore(self.folder / "damaged", 7, 25)
        self.assertEqual(faults, [])
        self.assertGreater(min(codes[0], codes[2]), 5)

    def test_numbers_that_are_none(self):
        path = self.folder / "run" / "contact.csv"
        table = path.read_text().splitlines()
        for row in ("4,1,0,99,0,0,0,0,0,0", "4,1,7,0,0,0,0,0,0,0", "4,1,0,0,nan,0,0,0,0,0",
                    "4,1,0,0,0,0,0,1,inf,0", "4,1", "x"):
            with self.subTest(row):
                path.write_text("\n".join([*table, row]) + "\n")
                self.refuse("", "run")

    def test_summaries_that_lie(self):
        path = self.folder / "run" / "summary.json"
        summary = json.loads(path.read_text())
        for change in ({"bodies": []}, {"bodies": [{"name": "../../x"}]}, {"bodies": 3},
                       {"interfaces": [{"nonmortar": "z"}]},
                       {"interfaces": [{"nonmortar": {}, "mortar": []}]},
                       {"steps": "4"}, {"status": "running"},
                       {"bodies": [{"name": "upper", "nodes": 1, "triangles": 1}]}):
            with self.subTest(str(change)):
                path.write_text(json.dumps({**summary, **change}))
                self.refuse("", "run")
        path.write_text("[" * 100000)
        self.refuse("", "run")
        deep = "x"
        for _ in range(800):
            deep = {"a": deep}
        for change in ({"accuracy": deep}, {"accuracy": {"bodies": deep, "bound": deep, "asked": deep}},
                       {"bodies": [{**each, "material": deep} for each in summary["bodies"]]},
                       {"quantities": {"a": deep, "b": {"value": "x"}}}, {"peaks": 3, "final": {
                           **summary["final"], "contact_force": 1, "von_mises_max": 2, "active_nodes": 0}},
                       {"rounds": [3, {"triangles": "x"}], "settings": deep, "scheme": [], "plane": {}}):
            with self.subTest(str(change)[:60]):  # only what is of the expected form is shown
                path.write_text(json.dumps({**summary, **change}))
                code, _, errors = view(self.folder, "report", "run")
                self.assertEqual((code, errors), (0, ""))

    def test_titles_are_shown_as_they_are(self):
        path = self.folder / "run" / "summary.json"
        summary = json.loads(path.read_text())
        for title in ("$\\frac{", "a\nb\x1b[31m", "日本", "x" * 10000, "_", "</svg><script>"):
            path.write_text(json.dumps({**summary, "title": title}))
            code, _, errors = view(self.folder, "plot", "run", "--only", "contact", "--out", "titled.svg")
            self.assertEqual((code, errors), (0, ""))
            xml.parse(self.folder / "titled.svg")

    def test_files_of_others_stay(self):
        """What the program did not write, whatever kind of file it is; what it wrote is written again."""
        for kind in ("png", "svg", "gif", "html"):
            path = self.folder / f"a.{kind}"
            words = ("report", "run") if kind == "html" else ("plot", "run", "--only", "fields", *(
                ["--animate"] if kind == "gif" else []))
            for _ in range(2):
                self.assertEqual(view(self.folder, *words, "--out", path.name)[0::2], (0, ""))
            own, drawn = path.read_bytes(), self.folder / "drawn"
            drawn.write_bytes(own)
            plain = io.BytesIO()
            if kind in ("png", "svg"):  # of other programs that draw with matplotlib
                figure, _ = pictures.plt.subplots()
                figure.savefig(plain, format=kind)
                pictures.plt.close(figure)
            elif kind == "gif":
                Image.new("RGB", (9, 9)).save(plain, "gif", comment="somebody else")
            for change in (lambda: path.write_bytes(b"mine"), lambda: path.write_bytes(b""),
                           lambda: path.write_bytes(plain.getvalue()),
                           lambda: (path.unlink(), path.symlink_to("drawn")),
                           lambda: (path.unlink(), path.mkdir())):
                change()
                before = None if path.is_dir() else path.read_bytes()
                with self.assertRaisesRegex(Wrong, f"a.{kind}: in the way"):
                    files.put({self.folder / "other.png": b"x", path: b"drawn again"})
                self.assertEqual(None if path.is_dir() else path.read_bytes(), before)
                self.assertFalse((self.folder / "other.png").exists())
                path.rmdir() if path.is_dir() and not path.is_symlink() else path.unlink()
                path.write_bytes(own)
            files.put({path: b"drawn again"})
        (self.folder / "run.html").write_text("mine")
        code, _, errors = view(self.folder, "report", "run")
        self.assertEqual((code, self.read("run.html")), (2, "mine"))
        self.assertIn("run.html: in the way", errors)

    def test_whole_or_not_at_all(self):
        done = mortier("plot", "run", "--only", "fields", cwd=self.folder,
                       preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (30000, 30000)))
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("cannot be written", done.stderr)
        self.assertEqual(list((self.folder / "run.plots").iterdir()), [])


if __name__ == "__main__":
    unittest.main()
