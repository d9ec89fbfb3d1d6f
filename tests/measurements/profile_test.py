"""The measurement profile: stacks that perf cut off are completed; modules, a table and an image follow."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

from measurements.profile import __main__ as profile
from measurements.profile import flame_graph, stacks
from measurements.profile.stacks import CUT, Frame

SVG = "{http://www.w3.org/2000/svg}"

# A worker in Embree, called back by frond; the main thread cut off; the loader; a leaf of Embree that could not be unwound.
SCRIPT = """frond
	         14ff6fd [unknown] (/usr/lib/libembree3.so.3.13.5)
	         14ff7aa [unknown] (/usr/lib/libembree3.so.3.13.5)
	           a26f9 rtcIntersect1 (/usr/lib/libembree3.so.3.13.5)
	          144e65 _ZNK5frond8Geometry9intersectEv (/b/libfrond.so.0.1.0)
	          20fd3b _ZN5frond5traceEv (/b/libfrond.so.0.1.0)
	           d4a6f [unknown] (/usr/lib/libstdc++.so.6.0.30)
	           8a3f0 start_thread (/usr/lib/libc.so.6)
	          10a9e0 clone3 (/usr/lib/libc.so.6)

frond
	           11111 cos@@GLIBC_2.2.5 (/usr/lib/libm.so.6)
	          20fd3b _ZN5frond5traceEv (/b/libfrond.so.0.1.0)
	ffffffffffffffff [unknown] ([unknown])

frond
	ffffffff81691b02 clear_page ([kernel.kallsyms])
	ffffffff81691b03 do_fault ([kernel.kallsyms])
	            72b2 _dl_map_object (/usr/lib/ld-linux-x86-64.so.2)
	           27770 _start (/b/frond)

frond
	           22222 _ZN5frond5traceEv (/b/libfrond.so.0.1.0)
	           33333 _ZN5frond3runEv (/b/frond)
	           44444 __libc_start_main@@GLIBC_2.34 (/usr/lib/libc.so.6)
	           27770 _start (/b/frond)

frond
	         14ff602 [unknown] (/usr/lib/libembree3.so.3.13.5)
	ffffffffffffffff [unknown] ([unknown])

frond
	         99ff602 [unknown] (/usr/lib/libembree3.so.3.13.5)
	ffffffffffffffff [unknown] ([unknown])
"""
MODULES = stacks.Modules({
    "_ZNK5frond8Geometry9intersectEv": {"scene"}, "_ZN5frond5traceEv": {"integrators"}, "_ZN5frond3runEv": {"cli"},
    "_ZN5frond8templateEv": {"scene", "leaf"}})


def names(stack):
    return [frame.symbol or frame.file for frame in stack]


class StacksTest(unittest.TestCase):
    def setUp(self):
        self.parsed = stacks.parse(SCRIPT)
        self.whole, self.cut, self.lost = stacks.graft(self.parsed)

    def test_are_read_from_the_outermost_frame_on(self):
        self.assertEqual(len(self.parsed), 6)
        self.assertEqual(names(self.parsed[3]), ["_start", "__libc_start_main", "_ZN5frond3runEv", "_ZN5frond5traceEv"])
        self.assertEqual(self.parsed[1], (Frame("_ZN5frond5traceEv", "libfrond.so.0.1.0"), Frame("cos", "libm.so.6")))
        self.assertEqual(stacks.parse(""), [])

    def test_that_were_cut_off_get_the_way_of_whole_ones(self):
        self.assertEqual((self.cut, self.lost), (3, 1))
        self.assertEqual(names(self.whole[1])[-2:], ["_ZN5frond5traceEv", "cos"])
        self.assertTrue(names(self.whole[1])[0] in ("clone3", "_start"))
        # Code without symbols is known by its place: within a kilobyte of the first stack's, and not.
        self.assertEqual(names(self.whole[4])[:-1], names(self.parsed[0])[:6])
        self.assertEqual(names(self.whole[5])[0], CUT)

    def test_the_most_frequent_way_is_taken(self):
        a, b, f = (Frame(name, "libfrond.so") for name in "abf")
        start, rest = Frame("_start", "frond"), Frame("g", "libfrond.so")
        whole, cut, lost = stacks.graft([(start, a, f), (start, b, f), (start, b, f), (f, rest)])
        self.assertEqual((whole[3], cut, lost), ((start, b, f, rest), 1, 0))

    def test_what_has_become_whole_leads_others_on(self):
        f, g = Frame("f", "libfrond.so"), Frame("g", "libfrond.so")
        start = Frame("_start", "frond")
        self.assertEqual(stacks.graft([(start, f), (f, g), (g,)]), ([(start, f), (start, f, g), (start, f, g)], 2, 0))

    def test_threads_come_below_the_call_that_they_work_for(self):
        joined = stacks.join_threads(self.whole)
        self.assertEqual(names(joined[0])[:5], ["_start", "__libc_start_main", "_ZN5frond3runEv", "_ZN5frond5traceEv",
                                                "_ZNK5frond8Geometry9intersectEv"])
        alone = (Frame("clone3", "libc.so.6"), Frame("own", "libfrond.so"))
        self.assertEqual(stacks.join_threads([alone, *self.whole])[0], alone)

    def test_modules_are_those_of_the_object_files_and_what_several_have_is_the_callers(self):
        stack = [Frame("_start", "frond"), Frame("_ZN5frond3runEv", "frond"), Frame("_ZN5frond5traceEv", "libfrond.so.0.1.0"),
                 Frame("_ZN5frond8templateEv", "libfrond.so.0.1.0"), Frame("cos", "libm.so.6"), Frame("", "libtbb.so.12", 7),
                 Frame("x", "libfrond_image.so.0.1"), Frame("read", "libOpenImageIO.so.2.4"), Frame("_dl_fixup", "ld-linux-x86-64.so.2")]
        self.assertEqual(MODULES.of_stack(stack), ["C and C++ library", "cli", "integrators", "integrators", "libm", "Embree",
                                                 "integrators", "other libraries", "dynamic linking"])
        self.assertEqual(MODULES.of_stack([Frame("_ZN5frond8templateEv", "libfrond.so")]), ["frond"])

    def test_modules_of_a_build_come_from_its_object_files(self):
        with tempfile.TemporaryDirectory() as name:
            build = pathlib.Path(name)
            for module in ("scene", "leaf"):
                folder = build / "CMakeFiles" / f"frond_{module}.dir" / "src" / module / "below"
                folder.mkdir(parents=True)
                source = f"inline int shared() {{ return 1; }} int {module}() {{ return shared(); }}"
                subprocess.run(["g++", "-O0", "-x", "c++", "-c", "-", "-o", folder / "a.cpp.o"], input=source, text=True, check=True)
            modules = stacks.Modules.of_build(build).modules
        self.assertEqual(modules, {"_Z5scenev": "scene", "_Z4leafv": "leaf"})

    def test_folding_counts_ways_and_merges_what_has_no_symbols(self):
        ways = stacks.fold(stacks.join_threads(self.whole), MODULES)
        self.assertEqual(sum(ways.values()), 6)
        begin = (("_start", "C and C++ library"), ("__libc_start_main", "C and C++ library"), ("run", "cli"), ("trace", "integrators"))
        inside = (("Geometry::intersect", "scene"), ("rtcIntersect1", "Embree"), ("Embree", "Embree"))
        self.assertEqual(ways[begin + inside], 2)
        self.assertEqual(ways[begin], 1)
        self.assertEqual(ways[begin + (("cos", "libm"),)], 1)
        self.assertEqual(ways[begin[:1] + (("_dl_map_object", "dynamic linking"), ("kernel", "kernel"))], 1)
        self.assertEqual(ways[((CUT, CUT), ("Embree", "Embree"))], 1)
        itself, below = stacks.shares(ways)
        self.assertEqual((itself["Embree"], below["Embree"], itself["integrators"], below["integrators"]), (3, 3, 1, 4))
        self.assertEqual(itself["kernel"], 1)
        self.assertEqual(below["dynamic linking"], 1)
        self.assertEqual(stacks.functions(ways)["Embree", "Embree"], 3)

    def test_a_stack_counts_in_one_stage(self):
        start, trace = ("_start", "C and C++ library"), ("PathTracer::trace", "integrators")
        hit, embree = ("Scene::intersect", "scene"), ("Embree", "Embree")
        count = stacks.stages({(start, trace): 1, (start, trace, hit, ("rtcIntersect1", "Embree"), embree): 2,
                               (start, trace, hit, ("Geometry::compute_hit", "scene")): 4,
                               (start, trace, ("Diffuse::evaluate", "materials")): 8, ((CUT, CUT), embree): 16,
                               (start, ("Geometry::build", "scene"), embree): 32})
        self.assertEqual({stage: n for stage, n in count.items() if n},
                         {"integrator and render loop": 1, "traversal": 18, "surface at a hit": 4, "materials": 8, None: 32})

    def test_functions_of_stages_exist(self):
        source = "".join(path.read_text(encoding="utf-8") for path in (stacks.tools.ROOT / "src").rglob("*.cpp"))
        named = [name for _, pattern in stacks.STAGES for name in re.findall(r"\^(\w+(?:::\w+)?)\$", pattern)]
        self.assertEqual([name for name in named if f" {name}(" not in source], [])
        self.assertGreater(len(named), 1)

    def test_recursion_counts_once_below(self):
        _, below = stacks.shares({(("a", "scene"), ("E", "Embree"), ("b", "scene"), ("E", "Embree")): 5})
        self.assertEqual(below, {"scene": 5, "Embree": 5})

    def test_names_are_short(self):
        for long, short in {
            "frond::(anonymous namespace)::PathIntegrator::trace(frond::World const&, frond::Ray const&) const": "PathIntegrator::trace",
            "frond::leaf::TableLookup::sum_columns(int) const": "leaf::TableLookup::sum_columns",
            "std::_Function_handler<void (long, int), frond::render(frond::Job const&)::{lambda(long, int)#1}>::_M_invoke("
            "std::_Any_data const&, long&&, int&&)": "render::lambda",
            "frond::add(CLI::App&)::{lambda()#2}::operator()() const": "add::lambda::operator()",
            "void frond::sort<std::vector<int, std::allocator<int> > >(int)": "sort",
            "frond::parse(int) [clone .isra.0]": "parse",
            "frond::operator<(frond::A const&, frond::B const&)": "operator<",
            "rtcIntersect1": "rtcIntersect1",
        }.items():
            self.assertEqual(stacks.short(long), short)

    def test_the_table_has_shares_their_errors_and_functions(self):
        ways = {(("a", "scene"),): 90, (("a", "scene"), ("cos", "libm")): 10}
        table = profile.table(ways, 50, ["a note"])
        self.assertRegex(table, r"^a note\n")
        # 1.96 sqrt(0.9 * 0.1 / 100) = 5.9 %; 90 samples of 1/50 s.
        self.assertRegex(table, r"scene +90\.0 % ± 5\.9 +1\.80 s +100\.0 %\n")
        self.assertRegex(table, r"libm +10\.0 % ± 5\.9 +0\.20 s +10\.0 %\n")
        self.assertRegex(table, r"a +scene +90\.0 %\n")


class FlameGraphTest(unittest.TestCase):
    WAYS = {
        (("main", "cli"), ("Map<int>::at & more", "scene")): 60,
        (("main", "cli"), ("a very long name of a function" * 5, "materials")): 30,
        (("main", "cli"),): 9,
        (("main", "cli"), ("rare", "no such module")): 1,
    }

    def draw(self, ways, title="frond render a.pbrt", notes=("a note",)):
        return xml.etree.ElementTree.fromstring(flame_graph.svg(ways, title, list(notes)))

    def frames(self, image):
        """By name: (x, y, width, label)."""
        result = {}
        for group in image.iter(f"{SVG}g"):
            box, text = group.find(f"{SVG}rect"), group.find(f"{SVG}text")
            label = "" if text is None else text.text
            result[group.find(f"{SVG}title").text] = (float(box.get("x")), float(box.get("y")), float(box.get("width")), label)
        return result

    def test_widths_are_shares_and_children_lie_below(self):
        frames = self.frames(self.draw(self.WAYS))
        x, y, whole, label = frames["main: 100.0 %, 100 samples (cli)"]
        self.assertEqual(label, "main")
        left = frames["Map<int>::at & more: 60.0 %, 60 samples (scene)"]
        self.assertAlmostEqual(left[2] / whole, 0.6, delta=1e-4)
        self.assertEqual(left[:2], (x, y + flame_graph.ROW))
        [second] = [frame for title, frame in frames.items() if title.startswith("a very")]
        self.assertAlmostEqual(second[0], x + 0.6 * whole, delta=0.02)

    def test_nothing_leaves_the_image_or_its_frame(self):
        image = self.draw(self.WAYS, "frond render " + "x" * 300, ["y" * 300, "z"])
        width, height = float(image.get("width")), float(image.get("height"))
        for box in image.iter(f"{SVG}rect"):
            x, y = float(box.get("x", 0)), float(box.get("y", 0))
            self.assertLessEqual(x + float(box.get("width")), width)
            self.assertLessEqual(y + float(box.get("height")), height)
        for text in image.iter(f"{SVG}text"):
            letter = flame_graph.LETTER * (16 / 12 if text.get("class") == "title" else 1)
            self.assertLessEqual(float(text.get("x")) + letter * len(text.text), width)
        for x, _, wide, label in self.frames(image).values():
            self.assertLessEqual(2 + flame_graph.LETTER * len(label), wide if label else 3, label)

    def test_what_is_too_narrow_is_left_out_and_too_narrow_for_letters_has_none(self):
        many = {((f"f{i}", "scene"),): 1 for i in range(3000)} | {(("wide", "scene"),): 1000}
        frames = self.frames(self.draw(many))
        self.assertEqual([label for *_, label in frames.values()], ["wide"])

    def test_the_legend_names_every_module_once(self):
        many = {((f"f{i}", f"module number {i}"),): 100 for i in range(40)}
        texts = [text.text for text in self.draw(many).iter(f"{SVG}text")]
        for i in range(40):
            self.assertEqual(texts.count(f"module number {i}"), 1)

    def test_it_is_the_same_each_time(self):
        backwards = dict(reversed(self.WAYS.items()))
        self.assertEqual(flame_graph.svg(self.WAYS, "a", []), flame_graph.svg(backwards, "a", []))

    def test_nothing_sampled_is_a_image_without_frames(self):
        self.assertEqual(self.frames(self.draw({})), {})


class ScriptTest(unittest.TestCase):
    def run_with(self, perf):
        """The report with a perf of ours, or none."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            if perf:
                (folder / "perf").write_text(f"#!{shutil.which('bash')}\n{perf}\n", encoding="utf-8")
                (folder / "perf").chmod(0o755)
            return subprocess.run([sys.executable, "-B", "-m", "measurements.profile", "-o", folder / "out", "scene.pbrt"],
                                  env=dict(os.environ, PATH=name), capture_output=True, text=True, check=False)

    def test_a_perf_that_may_not_sample_is_told_with_what_helps(self):
        done = self.run_with("echo 'Access to performance monitoring is limited' >&2; exit 255")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"Access to performance monitoring is limited\nmeasurements/run profile: perf cannot sample here "
                         r"\(kernel\.perf_event_paranoid is .*sysctl kernel\.perf_event_paranoid=1")

    def test_no_perf_at_all_is_told(self):
        done = self.run_with(None)
        self.assertEqual((done.returncode, done.stderr.strip()),
                         (1, "measurements/run profile: there is no perf; in Debian it is the package linux-perf"))

    def test_a_render_that_fails_ends_it(self):
        done = self.run_with('case "$*" in *" render "*) exit 3;; esac')
        self.assertEqual(done.returncode, 3)


if __name__ == "__main__":
    unittest.main()
