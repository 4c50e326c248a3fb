"""What `cmake --install` puts in place: a package that another project finds, the man page, completion."""
import csv
import functools
import gzip
import re
import subprocess
import unittest
from pathlib import Path

from support import PROGRAM, ROOT, InSharedFolder, answered_once
from zsh_session import ZshSession

BUILD = Path(PROGRAM).parent


def output(*command, **options):
    done = subprocess.run([str(each) for each in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=600, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command}: exit code {done.returncode}\n{done.stdout[-4000:]}")
    return done.stdout


@functools.cache
def help_of(program, *path):
    return output(program, *path, "--help")


def commands(program, *path):
    """Every command, and the lines of its help."""
    lines = help_of(program, *path).splitlines()
    yield path, lines
    begin = lines.index("Subcommands:") + 1 if "Subcommands:" in lines else len(lines)
    for line in lines[begin:]:
        if re.match(r"  \S", line):
            yield from commands(program, *path, line.split()[0])


class Install(InSharedFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.prefix = cls.folder / "prefix"
        (cls.folder / "pandoc-answers").mkdir()
        cls.environment = answered_once("pandoc", cls.folder / "pandoc-answers")
        output("cmake", "--install", BUILD, "--prefix", cls.prefix, env=cls.environment)

    def test_another_project_finds_the_package(self):
        # Elsewhere, so that nothing of the source tree is seen by accident.
        package = self.folder / "moved"
        self.prefix.rename(package)
        self.addCleanup(package.rename, self.prefix)
        build = self.folder / "examples"
        # The generator of this build: CMake's default one need not be installed.
        generator = re.search(r"^CMAKE_GENERATOR:INTERNAL=(.+)$", (BUILD / "CMakeCache.txt").read_text(),
                              re.M).group(1)
        output("cmake", "-S", ROOT / "examples", "-B", build, "-G", generator,
               f"-DCMAKE_PREFIX_PATH={package}", "-DCMAKE_BUILD_TYPE=Release",
               "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG")  # they run for less time than -O3 takes
        output("cmake", "--build", build)
        commands = (build / "CMakeFiles/press.dir/flags.make", build / "build.ninja")
        text = "".join(path.read_text() for path in commands if path.exists())
        self.assertIn(str(package / "include/mortier"), text)
        self.assertNotIn(str(ROOT / "cpp"), text)

        scene, settings = ROOT / "scenes/compression.toml", ["time.steps=20", "contact.variant=interpolation"]
        rows = [line.split() for line in output(build / "press", scene, *settings).splitlines()]
        self.assertEqual(len(rows), 21)
        for time, _, force in rows:
            # the traction is 10 t on a side of length 1
            self.assertAlmostEqual(float(force), 10 * float(time), places=9)
        # The same as the installed program's.
        output(package / "bin/mortier", "run", scene, "--quiet", "--out", self.folder / "result", "--set",
               *settings)
        history = list(csv.DictReader((self.folder / "result/history.csv").read_text().splitlines()))
        for row, (_, _, force) in zip(history, rows[1:]):
            self.assertAlmostEqual(float(row["contact_force[N/m]"]), float(force), delta=1e-14 * float(force))

        self.compare_own_law(build / "own_law", package / "bin/mortier")
        self.compare_two_blocks(build / "two_blocks", package / "bin/mortier")

    def compare_two_blocks(self, example, program):
        """The method by the layers, in a page: the patch test, and the same stresses as the program's."""
        import meshio
        shape = 'shape = "rectangle", cut = "both"'
        material = "material = { young = 1000, poisson = 0.3 }"
        scene = self.folder / "two_blocks.toml"
        scene.write_text(f'''
[[body]]
name = "upper"
mesh = {{ {shape}, cells = 3, lower = [0, 0], upper = [1, 1] }}
{material}
boundary = [ {{ label = 4, ux = 0 }}, {{ label = 3, ty = "-t" }} ]
[[body]]
name = "lower"
mesh = {{ {shape}, cells = 4, lower = [0, -1], upper = [1, 0] }}
{material}
boundary = [ {{ label = 4, ux = 0 }}, {{ label = 1, uy = 0 }} ]
[contact]
nonmortar = {{ body = "upper", label = 1 }}
mortar = {{ body = "lower", label = 3 }}
[time]
end = 1
steps = 1
''')
        for line in output(example).splitlines():
            variant = line.split()[0]
            numbers = [float(word) for word in re.findall(r"-?[\d.]+", line.split("upper")[1])]
            folder = self.folder / variant
            output(program, "run", scene, "--quiet", "--out", folder, "--set", f"contact.variant={variant}")
            theirs = [limit(meshio.read(folder / f"{body}_000001.vtu").cell_data["stress"][0][:, 1])
                      for body in ("upper", "lower") for limit in (min, max)] + [1]
            self.assertEqual(len(numbers), len(theirs))
            for ours, told in zip(numbers, theirs):
                self.assertAlmostEqual(ours, told, delta=1e-9)
            self.assertEqual(numbers == [-1, -1, -1, -1, 1], variant == "mortar")
        self.assertLessEqual(len((ROOT / "examples/two_blocks.cpp").read_text().splitlines()), 120)

    def compare_own_law(self, example, program):
        """The example's law beside the same one as expressions."""
        mises = "sqrt(s11^2 + s22^2 + s33^2 - s11*s22 - s22*s33 - s33*s11 + 3*s12^2)"
        rates = "".join(f'rate{c} = "flow*(s{c}{"" if c == "12" else " - mean"})"\n'
                        for c in ("11", "22", "12", "33"))
        expression = (f'law = "expression"\n{rates}[body.material.parameters]\nratio = "{mises}/stress"\n'
                      'mean = "(s11 + s22 + s33)/3"\n'
                      'flow = "1.5*rate/stress*(ratio > 1e-4 ? sinh(ratio)/ratio : 1 + ratio^2/6)"\n')
        scene = self.folder / "own.toml"
        for law in (expression, 'law = "sinh-creep"\n[body.material.parameters]\n'):
            scene.write_text('plane = "strain"\n[[body]]\nname = "bar"\nmesh = { shape = "rectangle", '
                             'cells = 2, lower = [0, 0], upper = [1, 1] }\n[body.material]\nyoung = 2e11\n'
                             f'poisson = 0.3\n{law}rate = 1e-3\nstress = 2e7\n[[body.boundary]]\n'
                             'label = 1\nux = 0\nuy = 0\n[[body.boundary]]\nlabel = 3\n'
                             'uy = "1e-3*min(t, 0.5)"\n[time]\nend = 1\nsteps = 4\n')
            if law is expression:
                output(program, "run", scene, "--quiet", "--out", self.folder / "own")
        history = list(csv.DictReader((self.folder / "own/history.csv").read_text().splitlines()))
        rows = [line.split() for line in output(example, scene).splitlines()]
        self.assertEqual(len(rows), 5)
        for row, (_, largest) in zip(history, rows[1:]):
            self.assertAlmostEqual(float(row["von_mises_max[Pa]"]) / float(largest), 1, delta=1e-10)

    def test_pictures_and_reports_of_the_installed_program(self):
        program = self.prefix / "bin/mortier"
        output(program, "run", ROOT / "scenes/compression.toml", "--quiet", "--out", "drawn", "--set",
               "time.steps=2", cwd=self.folder)
        text = output(program, "plot", "drawn", "--only", "fields", cwd=self.folder)
        text += output(program, "report", "drawn", cwd=self.folder)
        self.assertIn("drawn.plots/fields.svg", text)
        self.assertGreater((self.folder / "drawn.html").stat().st_size, 20000)

    def test_every_layer_is_a_target_with_its_headers(self):
        targets = (next(self.prefix.rglob("mortierTargets.cmake"))).read_text()
        layers = [path.name for path in (ROOT / "cpp").iterdir()
                  if path.is_dir() and path.name not in ("commands", "mumps")]
        self.assertGreaterEqual(len(layers), 10)
        for layer in layers:
            self.assertIn(f"add_library(mortier::{layer} ", targets)
            for header in (ROOT / "cpp" / layer).glob("*.h"):
                self.assertTrue((self.prefix / "include/mortier" / layer / header.name).exists(), header.name)

    def test_man_page_says_what_help_says(self):
        page = next(self.prefix.rglob("man1/mortier.1"))
        shown = output("groff", "-man", "-ww", "-Tutf8", "-P-c", "-rLL=1000n", "-rHY=0", page)
        self.assertNotIn("warning:", shown)
        # Tags and texts stand on lines of their own or side by side; words keep their order.
        words = re.sub(r".\x08", "", shown).split()
        known = list(commands(self.prefix / "bin/mortier"))
        self.assertGreaterEqual(len(known), 6)
        at = 0
        for path, lines in known:
            for word in " ".join(lines).replace("Usage: ", "").split():
                self.assertIn(word, words[at:], f"{path}: {word} is missing in the man page")
                at = words.index(word, at) + 1

    def bash(self, *words):
        """What bash offers after these words."""
        script = self.prefix / "share/bash-completion/completions/mortier"
        program = str(self.prefix / "bin/mortier")
        text = (f'source "{script}"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _mortier; '
                'printf "%s\\n" "${COMPREPLY[@]}"')
        return sorted(output("bash", "-c", text, "bash", program, *words, cwd=self.folder).split())

    def test_completion_of_bash(self):
        self.check_completion(self.bash)

    def test_completion_of_zsh(self):
        zsh = ZshSession(self.folder, self.prefix / "bin", self.prefix / "share/zsh/site-functions")
        self.addCleanup(zsh.close)
        self.check_completion(lambda *words: zsh.complete("mortier", *words))

    def fish(self, *words):
        """What fish offers after these words."""
        script = self.prefix / "share/fish/vendor_completions.d/mortier.fish"
        line = " ".join([str(self.prefix / "bin/mortier"), *words])
        text = f'source "{script}"; complete -C "{line}"'
        return sorted(each.split("\t")[0].rstrip("/") for each in
                      output("fish", "--no-config", "-c", text, cwd=self.folder).splitlines())

    def test_completion_of_fish(self):
        self.check_completion(self.fish)

    def test_package_of_debian(self):
        output("cpack", "-G", "DEB", "-B", self.folder / "packages", cwd=BUILD, env=self.environment)
        package, = (self.folder / "packages").glob("*.deb")
        facts = output("dpkg-deb", "--info", package)
        for name in ("libcholmod", "libumfpack", "libopenblas"):
            self.assertRegex(facts, rf"\n Depends: [^\n]*{name}")
        self.assertRegex(facts, r"\n Recommends: [^\n]*python3-meshio")
        if (BUILD / "python").is_dir():  # the module is of one version of Python
            self.assertRegex(facts, r"python3 \(>= 3\.\d+\), python3 \(<< 3\.\d+\)")
        description = facts.partition("Description")[2].partition(" Maintainer")[0]
        self.assertLess(max(map(len, description.splitlines())), 82)
        output("dpkg-deb", "-e", package, self.folder / "control")
        self.assertTrue((self.folder / "control/prerm").stat().st_mode & 0o100)
        root = self.folder / "root"
        output("dpkg-deb", "-x", package, root)
        documents = root / "usr/share/doc/mortier"
        self.assertIn("common-licenses/GPL-3", (documents / "copyright").read_text())
        changes = gzip.decompress((documents / "changelog.gz").read_bytes()).decode()
        self.assertRegex(changes, r"^mortier \([\d.]+\) .*\n\n  \* .*\n\n -- .* <.*>  \w{3}, \d\d \w{3} ")
        self.assertEqual([path.name for path in root.rglob("man1/*")], ["mortier.1.gz"])
        program = root / "usr/bin/mortier"
        output(program, "run", documents / "examples/scenes/compression.toml", "--quiet", "--out", "packed",
               "--set", "time.steps=2", cwd=self.folder)
        self.assertIn("packed.plots/fields.svg", output(program, "plot", "packed", "--only", "fields",
                                                        cwd=self.folder))
        self.assertTrue((root / "usr/share/mortier/freefem/coupling.idp").is_file())

    def check_completion(self, complete):
        def stated(*path):
            return sorted(re.findall(r"^  (?:-h,)?(--[a-z-]+)", help_of(PROGRAM, *path), re.M))
        known = [path for path, _ in commands(PROGRAM)]
        for path in known:
            self.assertEqual(complete(*path, "--"), stated(*path))
            below = sorted(each[-1] for each in known if each[:-1] == path and len(each) == len(path) + 1)
            if below:
                self.assertEqual(complete(*path, ""), below)
        self.assertEqual(complete("ru"), ["run"])
        self.assertEqual(complete("mesh", "cr"), ["crisscross"])
        self.assertEqual(complete("plot", "scene", "--anim"), ["--animate"])
        self.assertEqual(complete("run", "scene.toml", "--che"), ["--checkpoint"])
        keys = [line.split("\t")[0] for line in output(PROGRAM, "keys").splitlines()]
        for words in (("--set",), ("--quiet", "--set", "time.steps=2")):
            self.assertEqual(complete("run", "scene.toml", *words, "time."),
                             sorted(f"{key}=" for key in keys if key.startswith("time.")))
        for name in ("a.toml", "a.mesh", "a.txt"):
            (self.folder / name).touch()
        self.assertEqual(complete("run", "a"), ["a.mesh", "a.toml"])
        self.assertEqual(complete("run", "--out", "pre"), ["prefix"])


if __name__ == "__main__":
    unittest.main()
