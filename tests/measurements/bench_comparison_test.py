"""Verdicts of comparisons (slower, faster, another image) and their rates of error."""

import math
import unittest

import bench_runs as runs
from measurements.bench.comparison import FALSE_ALARMS, Comparison, holm, warnings
from measurements.bench.results import Run

NAMES = [f"bsdf/{i}" for i in range(50)]
EXPERIMENTS = 200
ONE_IN_A_MILLION = 1e-6


def binomial_bounds(trials, rate):
    """Bounds of a binomial count, each exceeded with a probability of 1e-6. (1 - rate)^trials must be a number."""
    chance, below, low, high = (1 - rate) ** trials, 0.0, None, trials
    for k in range(trials + 1):
        below += chance
        if low is None and below > ONE_IN_A_MILLION:
            low = k
        if 1 - below < ONE_IN_A_MILLION:
            high = k
            break
        chance *= (trials - k) / (k + 1) * rate / (1 - rate)
    return low, high


class Holm(unittest.TestCase):
    def test_weighs_by_rank_and_keeps_the_order(self):
        for found, expected in zip(holm([0.01, 0.04, 0.03, 0.005]), [0.03, 0.06, 0.06, 0.02]):
            self.assertAlmostEqual(found, expected)
        self.assertEqual(list(holm([0.9, 0.8])), [1.0, 1.0])


class FalseAlarms(unittest.TestCase):
    """Seeds are fixed; over all seeds each of these fails less than four times in a million."""

    def check(self, pair_of_runs):
        rng = runs.seeded()
        alarms = outside = 0
        for _ in range(EXPERIMENTS):
            times = Comparison(*pair_of_runs(rng, NAMES)).times
            alarms += any(c.mark for c in times)
            outside += sum(not c.low <= 1 <= c.high for c in times)
        _, most = binomial_bounds(EXPERIMENTS, FALSE_ALARMS)
        self.assertLessEqual(alarms, most)
        least, most = binomial_bounds(EXPERIMENTS * len(NAMES), 0.05)
        self.assertLessEqual(outside, most)
        return outside, least

    def test_of_runs_in_turn_on_a_machine_that_drifts(self):
        outside, least = self.check(runs.in_turn)
        self.assertGreaterEqual(outside, least)

    def test_of_runs_apart(self):
        self.check(runs.apart)  # degrees of freedom are rounded down: intervals are a little wide

    def test_intervals_hold_a_true_change_as_often_as_they_say(self):
        rng, outside = runs.seeded(2), 0
        for _ in range(EXPERIMENTS):
            times = Comparison(*runs.in_turn(rng, NAMES, slower=NAMES)).times
            outside += sum(not c.low <= 1.1 <= c.high for c in times)
        least, most = binomial_bounds(EXPERIMENTS * len(NAMES), 0.05)
        self.assertTrue(least <= outside <= most, f"{outside} is not from {least} to {most}")


class Changes(unittest.TestCase):
    def test_ten_per_cent_are_found_and_nothing_else(self):
        slower = {NAMES[7], NAMES[31]}
        for pair_of_runs in (runs.in_turn, runs.apart):
            comparison = Comparison(*pair_of_runs(runs.seeded(), NAMES, slower, noise=0.01))
            self.assertEqual({c.name for c in comparison.slower()}, slower)
            self.assertEqual(comparison.faster(), [])
            self.assertEqual({c.name for c in comparison.slower(least=0.2)}, set())

    def test_the_other_way_round_they_are_faster(self):
        a, b = runs.apart(runs.seeded(), NAMES, NAMES[3:5], noise=0.01)
        self.assertEqual({c.name for c in Comparison(b, a).faster()}, set(NAMES[3:5]))

    def test_drift_hides_a_change_of_runs_that_do_not_belong_together(self):
        a, b = runs.in_turn(runs.seeded(), NAMES, NAMES[:1], noise=0.01)
        self.assertEqual(len(Comparison(a, b).slower()), 1)
        b.context["session"] = "another"
        self.assertEqual(Comparison(a, b).slower(), [])

    def test_one_round_tells_nothing(self):
        rng = runs.seeded()
        a, b = (Run(runs.noisy(rng, NAMES, rounds=1, slower=s)) for s in ((), NAMES))
        comparison = Comparison(a, b)
        self.assertEqual({(c.mark, c.high) for c in comparison.times}, {("", math.inf)})
        self.assertIn("1 rounds are few", " ".join(warnings(comparison)))

    def test_a_family_is_its_geometric_mean(self):
        comparison = Comparison(*runs.in_turn(runs.seeded(), NAMES, slower=NAMES[:25], noise=0.01))
        _, (_, _, ratio, low, high, _) = comparison.families()["bsdf"]
        self.assertTrue(low < math.sqrt(1.1) < high)
        self.assertTrue(low < ratio < high)

    def test_benchmarks_that_only_one_run_has_are_left_out(self):
        rng = runs.seeded()
        comparison = Comparison(Run(runs.noisy(rng, ["x", "y"])), Run(runs.noisy(rng, ["y", "z"])))
        self.assertEqual([c.name for c in comparison.times], ["y"])
        self.assertIn("In A alone, and left out: x (1).", warnings(comparison))
        self.assertIn("In B alone, and left out: z (1).", warnings(comparison))
        with self.assertRaisesRegex(SystemExit, "no benchmark in common"):
            Comparison(Run(runs.noisy(rng, ["x"])), Run(runs.noisy(rng, ["z"])))


class Images(unittest.TestCase):
    def marks(self, a, b):
        return {f.counter: f.mark for f in Comparison(Run(a), Run(b)).figures}

    def test_the_same_to_the_last_digit(self):
        marks = self.marks(runs.images(0.01), runs.images(0.01))
        self.assertEqual(set(marks.values()), {"same"})
        self.assertEqual(len(marks), 10)

    def test_other_noise_is_within_errors(self):
        marks = self.marks(runs.images(0.01), runs.images(0.0101))
        self.assertEqual(marks["rms_red"], "within errors")

    def test_another_image_is_found(self):
        a = runs.images(0.01)
        marks = self.marks(a, runs.images(0.01, bias2_blue=0.012))
        self.assertEqual([c for c, mark in marks.items() if mark == "changed"], ["bias2_blue"])

    def test_images_that_change_from_round_to_round_are_told(self):
        b = runs.images(0.01)
        b["benchmarks"][3]["rms_red"] += 1e-9
        self.assertIn("differ from round to round", " ".join(warnings(Comparison(Run(runs.images(0.01)), Run(b)))))


class Warnings(unittest.TestCase):
    def of(self, **context):
        a, b = runs.in_turn(runs.seeded(), NAMES[:2])
        b.context |= context
        return warnings(Comparison(a, b))

    def test_none_where_nothing_differs(self):
        self.assertEqual(self.of(), [])

    def test_of_another_machine_compiler_session_and_of_other_work(self):
        self.assertIn("Another machine: a machine in A, big iron in B.", self.of(machine="big iron"))
        self.assertIn("Another compiler: g++ 12 in A, clang in B.", self.of(compiler="clang"))
        self.assertRegex(" ".join(self.of(session="t")), "one after the other")
        self.assertRegex(" ".join(self.of(load_avg=[3.5])), "during B: a load of 3.5 on 2 processors")


if __name__ == "__main__":
    unittest.main()
