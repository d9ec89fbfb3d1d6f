"""Man pages and completions have what --help has: all commands, all options. Completion is tried in the shells."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

FROND = os.environ["FROND"]
NO_PLUGINS = {name: value for name, value in os.environ.items() if name != "FROND_PLUGIN_PATH"}
NO_PLUGINS["PATH"] = f"{pathlib.Path(FROND).parent}:{os.environ['PATH']}"  # the scripts ask frond
OPTIONS = re.compile(r"^  (-[-\w]+(?:,-[-\w]+)*)", re.M)


def frond(*words):
    return subprocess.run([FROND, *words], capture_output=True, text=True, check=True, env=NO_PLUGINS).stdout


def options_of(*command):
    return {name for names in OPTIONS.findall(frond(*command, "--help")) for name in names.split(",")}


def commands():
    return re.findall(r"^  (\w[\w-]*) ", frond("--help").split("Examples:")[0], re.M)


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def tool(self, name):
        if not shutil.which(name):
            self.skipTest(f"there is no {name}")
        return name


class ManPages(Folder):
    def setUp(self):
        super().setUp()
        frond("man", "--folder", self.folder)
        self.pages = sorted(self.folder.iterdir())

    def test_there_is_one_for_each_command(self):
        self.assertGreater(len(commands()), 20)
        self.assertEqual({page.name for page in self.pages}, {"frond.1", *(f"frond-{name}.1" for name in commands())})
        self.assertEqual(frond("man", "render"), (self.folder / "frond-render.1").read_text(encoding="ascii"))
        self.assertEqual(frond("man"), (self.folder / "frond.1").read_text(encoding="ascii"))

    def test_frond_1_names_all_commands(self):
        text = (self.folder / "frond.1").read_text(encoding="ascii")
        for name in commands():
            escaped = name.replace("-", r"\-")
            self.assertIn(f"\\fBfrond\\-{escaped}\\fR(1)\n", text)

    def test_they_have_the_options_of_help_and_no_others(self):
        for command in [(), *((name,) for name in commands())]:
            text = (self.folder / ("-".join(["frond", *command]) + ".1")).read_text(encoding="ascii")
            heads = re.findall(r"^\.TP\n(\\fB\\-.*)$", text.split(".SH OPTIONS OF PBRT-V4")[0], re.M)
            found = {name.replace("\\-", "-") for head in heads for name in re.findall(r"\\fB(.*?)\\fR", head)}
            self.assertEqual(found, options_of(*command), command)

    def test_choices_units_ranges_defaults_and_relations_are_there_once(self):
        text = frond("man", "brf").replace("\n", " ").replace("\\-", "-")
        for sentence in ("Range: from 1 to 1024.", "Unit: degrees.", "Default: -75:75:5.", "Excludes --zenith, --azimuth.",
                         "Needs --csv.", "Repeatable."):
            self.assertIn(sentence, text)
        self.assertIn("spherical, planophile,", frond("man", "canopy").replace("\n", " "))

    def test_render_has_the_options_of_pbrt(self):
        section = frond("man", "render").split(".SH OPTIONS OF PBRT-V4")[1]
        self.assertIn("\\fB\\-\\-gpu\\fR\nIgnored.", section)
        self.assertIn("Refused: ", section)

    def test_the_date_is_that_of_source_date_epoch(self):
        page = subprocess.run([FROND, "man"], capture_output=True, text=True, check=True,
                              env=NO_PLUGINS | {"SOURCE_DATE_EPOCH": "0"}).stdout
        self.assertIn(".TH FROND 1 1970-01-01 ", page)

    def test_mandoc_finds_nothing(self):
        r = subprocess.run([self.tool("mandoc"), "-T", "lint", *self.pages], capture_output=True, text=True, check=False)
        self.assertEqual((r.returncode, r.stdout, r.stderr), (0, "", ""))

    def test_groff_finds_nothing(self):
        r = subprocess.run([self.tool("groff"), "-man", "-ww", "-Tascii", *self.pages], capture_output=True, text=True, check=False)
        self.assertEqual((r.returncode, r.stderr), (0, ""))

    def test_an_unknown_command_is_refused(self):
        r = subprocess.run([FROND, "man", "rendre"], capture_output=True, text=True, check=False)
        self.assertEqual((r.returncode, r.stdout), (1, ""))
        self.assertIn('no command "rendre"; did you mean "render"?', r.stderr)


class Completion(Folder):
    """Completions of each shell for a line, whose last word is incomplete."""

    shell = "bash"

    def setUp(self):
        super().setUp()
        self.tool(self.shell)
        self.script = self.folder / f"frond.{self.shell}"
        frond("completion", self.shell, "-o", self.script)
        self.here = self.folder / "here"
        (self.here / "scenes").mkdir(parents=True)
        for name in ("leaf.pbrt", "leaf.pbrt.gz", "leaf.part", "my leaf.exr"):
            (self.here / name).touch()

    def run_shell(self, text, *words):
        r = subprocess.run([self.shell, *self.flags(), "-c", text, self.shell, *map(str, words)], cwd=self.here, capture_output=True,
                           text=True, check=True, env=NO_PLUGINS)
        self.assertEqual(r.stderr, "")
        return r.stdout.splitlines()

    @staticmethod
    def flags():
        return ["--norc", "--noprofile"]

    def offered(self, *words):
        return set(self.run_shell("""
source "$1"
shift
COMP_WORDS=(frond "$@")
COMP_CWORD=$#
"$(complete -p frond | sed 's/.*-F \\([^ ]*\\) .*/\\1/')"
if ((${#COMPREPLY[@]})); then printf '%s\\n' "${COMPREPLY[@]}"; fi""", self.script, *words))

    def test_commands(self):
        self.assertEqual(self.offered(""), set(commands()))
        self.assertEqual(self.offered("com"), {"compare", "completion"})

    def test_options_of_every_command(self):
        for name in commands():
            self.assertEqual(self.offered(name, "--"), {o for o in options_of(name) if o.startswith("--")}, name)
        self.assertEqual(self.offered("--"), {"--help", "--version"})

    def test_choices(self):
        self.assertEqual(self.offered("fit", "leaf.csv", "--structure", ""), {"bifacial", "unifacial"})
        self.assertEqual(self.offered("fit", "--structure", "uni"), {"unifacial"})
        self.assertEqual(self.offered("completion", ""), {"bash", "zsh", "fish"})
        self.assertEqual(self.offered("list", ""), {"specimens"})

    def test_names(self):
        self.assertEqual(self.offered("spectrophotometer", "leaf_so"), {"leaf_solved"})
        self.assertEqual(self.offered("spectrophotometer", "abm", "--with", "leaf_so"), {"leaf_solved"})
        self.assertEqual(self.offered("render", "--integrator", ""), {"path", "volpath"})
        self.assertLess({"hero", "smpte", "bands"}, self.offered("render", "--wavelengths", ""))
        self.assertLess({"soybean", "maize"}, self.offered("table", "--specimen", ""))
        self.assertLess({"abm", "path", "perspective", "brf"}, self.offered("describe", ""))
        self.assertEqual(self.offered("man", "rend"), {"render"})

    def test_files(self):
        self.assertLessEqual({"leaf.pbrt", "leaf.part", "my leaf.exr"}, self.offered("merge", ""))
        self.assertEqual(self.offered("merge", "leaf.pa"), {"leaf.part"})
        self.assertEqual(self.offered("merge", "leaf.part", "-o", "my"), {"my leaf.exr"})
        self.assertEqual(self.offered("render", "--cache", ""), {"scenes"})
        self.assertLessEqual({"leaf.pbrt", "leaf.pbrt.gz", "scenes"}, self.offered("render", ""))

    def test_nothing_where_nothing_is_known(self):
        self.assertEqual(self.offered("render", "--spp", ""), set())
        self.assertEqual(self.offered("nothing", ""), set())


class InBash(Completion):
    def test_values_behind_an_equals_sign(self):
        # Readline parts words there.
        self.assertEqual(self.offered("fit", "--structure", "=", "uni"), {"unifacial"})
        self.assertEqual(self.offered("fit", "--structure", "="), {"bifacial", "unifacial"})
        self.assertEqual(self.offered("render", "--swap", "leaf", "=", "leaf_so"), {"leaf_solved"})
        self.assertIn("abm", self.offered("render", "--swap", "leaf", "="))

    def test_scenes(self):
        self.assertEqual(self.offered("render", ""), {"leaf.pbrt", "leaf.pbrt.gz", "scenes"})

    def test_lists(self):
        self.assertEqual(self.offered("render", "--channels", "albedo,de"), {"albedo,depth"})

    def test_readline_takes_it(self):
        # In an interactive shell, TAB and all.
        out = subprocess.run([self.shell, *self.flags(), "-i"], cwd=self.here, text=True, check=True, capture_output=True,
                             env=NO_PLUGINS | {"TERM": "dumb", "HISTFILE": ""},
                             input=f"source '{self.script}'\nfrond() {{ printf '<%s>' \"$@\"; echo; }}\n"
                             "frond merg\tmy\t\n").stdout
        self.assertIn("<merge><my leaf.exr>", out)


class InFish(Completion):
    shell = "fish"

    @staticmethod
    def flags():
        return ["--no-config"]

    def offered(self, *words):
        line = " ".join(["frond", *words])
        lines = self.run_shell('source $argv[2]; complete -C "$argv[3]"', self.script, line)
        return {word.split("\t")[0].removesuffix("/").replace("\\ ", " ") for word in lines}


class InZsh(Folder):
    def test_the_scripts_syntax_is_right(self):
        script = self.folder / "_frond"
        frond("completion", "zsh", "-o", script)
        subprocess.run([self.tool("zsh"), "-n", script], check=True)

    def test_options_of_every_command(self):
        for name in commands():
            lines = frond("completion", "zsh", "--", "frond", name, "-").splitlines()
            self.assertTrue(all(re.fullmatch(r"--?\w[-\w]*\t.+", line) for line in lines), name)
            self.assertEqual({line.split("\t")[0] for line in lines}, options_of(name), name)


del Completion  # only those that are in a shell

if __name__ == "__main__":
    unittest.main()
