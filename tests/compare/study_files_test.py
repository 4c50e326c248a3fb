"""mortier study and what others wrote: names in its page and pictures."""
import html
import re
import unittest
import xml.etree.ElementTree as xml

from study_support import SPACE, StudyTest
from support import told

HEAD = SPACE[:SPACE.index("[[error]]")]
NAMES = [r"a $\\frac{1}$ b", "a b", "A-b", "<script>alert(1)</script>", "_x" + 298 * "y"]


def errors(names):
    return "".join(f"[[error]]\nname = \"{name}\"\nquantity = \"von_mises_max\"\nexact = 10\n" for name in names)


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
        self.path.write_text(HEAD.replace("[3, 6, 12]", "[3, 6]").replace("[8, 16, 32]", "[8, 16]") + errors(NAMES) +
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


if __name__ == "__main__":
    unittest.main()
