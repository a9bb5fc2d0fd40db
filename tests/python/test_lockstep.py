"""Comparisons, profiles, images and statistics of the program as python/lockstep.py reads them, and
the figure that python/figure.py draws. Values are checked by another way to the same number."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import coherence
import figure
import lockstep
import numpy

PROGRAM = os.environ["LOCKSTEP_PROGRAM"]
SAMPLERS = ["random", "rcs:c=8,t=0.01", "strata"]
SPP = [1, 4]
SEEDS = 5


def run(*arguments):
    """Runs the program; returns what it prints."""
    command = [PROGRAM, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    if done.returncode:
        raise AssertionError(f"{command}: {done.stderr}")
    return done.stdout


class WithFolder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.make()

    def fails(self, pattern, function, *arguments):
        with self.assertRaisesRegex(lockstep.LockstepError, pattern) as caught:
            function(*arguments)
        self.assertNotIn("\n", str(caught.exception))


class Images(WithFolder):
    @classmethod
    def make(cls):
        cls.exr, cls.json = cls.folder / "a.exr", cls.folder / "a.json"
        weights = cls.folder / "w.exr"
        run(
            *("render", "cornell", "-o", cls.exr, "--resolution", "40x30", "--spp", 9),
            *("--sampler", "rcs:c=8", "--seed", 7, "--stats", cls.json, "--weights", weights),
        )

    def test_pixels(self):
        image = lockstep.load_image(self.exr)
        self.assertEqual(image.pixels.shape, (30, 40, 3))
        self.assertEqual(image.pixels.dtype, numpy.float32)
        # The lamp is above, and brighter than the white of a file of 8 bits.
        row, column = numpy.unravel_index(image.pixels.sum(axis=2).argmax(), (30, 40))
        self.assertLess(row, 8)
        self.assertTrue(12 < column < 28, column)
        self.assertGreater(image.pixels.max(), 1.0)
        # The left wall is red, the right one green.
        left, right = image.pixels[10:20, 7].mean(axis=0), image.pixels[10:20, -8].mean(axis=0)
        self.assertGreater(left[0], 1.5 * left[1])
        self.assertGreater(right[1], 1.5 * right[0])

    def test_error_is_that_of_the_program(self):
        other = self.folder / "b.exr"
        run("render", "cornell", "-o", other, "--resolution", "40x30", "--spp", 2)
        a, b = (lockstep.load_image(path).pixels.astype(float) for path in (self.exr, other))
        told = json.loads(run("metrics", self.exr, other, "--json"))
        self.assertAlmostEqual(numpy.mean((a - b) ** 2) / told["mse"], 1.0, delta=1e-5)

    def test_settings_are_those_of_the_statistics(self):
        settings = lockstep.load_image(self.exr).settings
        stats = lockstep.load_stats(self.json)
        for key in ("scene", "sampler", "spp", "depth", "seed", "threads", "width", "isa", "lanes"):
            self.assertEqual(settings[key], stats[key], key)
        self.assertEqual(settings["resolution"], tuple(stats["resolution"]))
        self.assertIs(settings["biased"], False)
        self.assertIsInstance(settings["version"], str)
        self.assertAlmostEqual(settings["cpu_seconds"] / stats["cpu_seconds"], 1.0, delta=1e-4)
        self.assertEqual(stats["paths"], 40 * 30 * 9)

    def test_weights(self):
        pixels = lockstep.load_image(self.folder / "w.exr").pixels
        self.assertEqual(pixels.shape, (30, 40, 1))
        mean = lockstep.load_stats(self.json)["mean_weight"]
        self.assertAlmostEqual(float(pixels.mean(dtype=float)), mean, delta=1e-5)

    def test_errors(self):
        self.fails("nosuch.exr: no such file; give an image", lockstep.load_image, "nosuch.exr")
        self.fails("is a folder", lockstep.load_image, self.folder)
        self.fails("a.json: not an image", lockstep.load_image, self.json)
        short = self.folder / "short.exr"
        short.write_bytes(self.exr.read_bytes()[:-3000])
        self.fails("short.exr: damaged", lockstep.load_image, short)
        self.fails("not JSON|cannot be read", lockstep.load_stats, self.exr)
        other = self.folder / "other.json"
        other.write_text("[1]")
        self.fails("other.json: not the statistics", lockstep.load_stats, other)


class Comparisons(WithFolder):
    @classmethod
    def make(cls):
        cls.out = cls.folder / "out"
        run(
            *("compare", "cornell", "--samplers", ",".join(SAMPLERS), "--depth", "1,2"),
            *("--spp", ",".join(map(str, SPP)), "--seeds", SEEDS, "--reference-spp", 16),
            *("--resolution", "24x16", "--threads", 1, "--timing-spread", 0.0001, "--quiet"),
            *("-o", cls.out),
        )
        cls.comparison = lockstep.load_comparison(cls.out)
        cls.summary = json.loads((cls.out / "summary.json").read_text())

    def copy(self):
        """A copy of the comparison that may be spoilt."""
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        shutil.copytree(self.out, folder, dirs_exist_ok=True)
        return folder

    def rungs(self):
        """What summary.json says of each scene and depth, sampler and sample count."""
        for scene in self.summary["scenes"]:
            for sampler in scene["samplers"]:
                for rung in sampler["rungs"]:
                    yield scene["scene"], scene["depth"], sampler["sampler"], rung

    def test_rows(self):
        errors = self.comparison.errors
        self.assertEqual(len(errors), 2 * len(SAMPLERS) * len(SPP) * SEEDS)
        header = (self.out / "errors.csv").read_text().split("\n")[0]
        self.assertEqual(list(errors.dtype.names), header.split(","))
        self.assertEqual(errors["spp"].dtype.kind, "i")
        self.assertEqual(errors["rmse"].dtype.kind, "f")
        self.assertEqual(self.comparison.experiments(), [("cornell", 1), ("cornell", 2)])
        self.assertEqual(self.comparison.samplers(), SAMPLERS)
        self.assertTrue(self.comparison.complete)
        some = self.comparison.rows(sampler="rcs:c=8,t=0.01", spp=4, depth=2)
        self.assertEqual(sorted(some["seed"]), list(range(SEEDS)))
        self.fails("no column 'samples'", lambda: self.comparison.rows(samples=4))

    def test_rows_are_those_of_the_journal(self):
        runs = [entry for entry in self.comparison.journal if "run" in entry]
        self.assertEqual(len(runs), len(self.comparison.errors))
        for row, entry in zip(self.comparison.errors, runs):
            self.assertEqual(row["sampler"], entry["sampler"])
            self.assertEqual(row["seed"], entry["run"]["seed"])
            for metric, value in entry["run"]["errors"].items():
                self.assertEqual(row[metric], value)

    def test_errors_of_images(self):
        (reference,) = self.references(2)
        for spp in SPP:
            image = lockstep.load_image(self.out / f"cornell-depth2-strata-{spp}spp.exr")
            difference = image.pixels.astype(float) - reference.pixels
            (row,) = self.comparison.rows(sampler="strata", depth=2, spp=spp, seed=0)
            rmse = numpy.sqrt(numpy.mean(difference**2))
            self.assertAlmostEqual(rmse / row["rmse"], 1.0, delta=1e-5)
            self.assertEqual(image.settings["spp"], spp)

    def references(self, depth):
        images = map(lockstep.load_image, self.out.glob("reference-*.exr"))
        return [image for image in images if image.settings["depth"] == depth]

    def test_times_have_their_repeats(self):
        repeated = 0
        for scene, depth, sampler, rung in self.rungs():
            times = self.comparison.cpu_seconds(scene, depth, sampler, rung["spp"])
            self.assertEqual(len(times), rung["cpu_seconds"]["renders"])
            self.assertAlmostEqual(numpy.median(times), rung["cpu_seconds"]["median"], delta=1e-12)
            repeated += len(times) > SEEDS
        self.assertGreater(repeated, 0)

    def test_a_comparison_under_way(self):
        folder = self.copy()
        (folder / "summary.json").unlink()
        for name in ("errors.csv", "journal.jsonl"):
            text = (folder / name).read_text()
            (folder / name).write_text(text[: int(0.6 * len(text))])
        comparison = lockstep.load_comparison(folder)
        self.assertFalse(comparison.complete)
        self.assertIsNone(comparison.summary)
        rows = len(comparison.errors)
        self.assertTrue(10 < rows < len(self.comparison.errors), rows)
        self.assertEqual(
            list(comparison.errors["rmse"]), list(self.comparison.errors["rmse"][:rows])
        )

    def test_errors(self):
        self.fails("nosuch: no such folder; give the DIR", lockstep.load_comparison, "nosuch")
        self.fails("holds no errors.csv", lockstep.load_comparison, self.folder)
        self.fails("holds no profile.csv", lockstep.load_profile, self.out)
        for name, spoil, message in (
            ("summary.json", lambda text: text[:-20], r"summary.json:\d+: not JSON"),
            ("journal.jsonl", lambda text: text.replace("{", "", 1), "journal.jsonl:1: not JSON"),
            (
                "errors.csv",
                lambda text: text.replace(",1,4,", ",1,4", 1),
                r"errors.csv:\d+: \d+ fields",
            ),
            ("errors.csv", lambda text: "", "errors.csv: is empty"),
        ):
            folder = self.copy()
            (folder / name).write_text(spoil((folder / name).read_text()))
            self.fails(message, lockstep.load_comparison, folder)

    def test_figure(self):
        for across in ("time", "spp"):
            drawn = figure.draw(self.comparison, "flip_ldr", across)
            self.assertEqual(len(drawn.axes), 2)
            for axes, scene in zip(drawn.axes, self.summary["scenes"]):
                self.assertEqual(axes.get_title(), f"cornell, depth {scene['depth']}")
                self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "log"))
                self.assertEqual(axes.get_ylabel(), "FLIP")
                texts = [text.get_text() for text in axes.get_legend().get_texts()]
                self.assertEqual(texts, SAMPLERS)
                self.check_curves(axes, scene, across)

    def check_curves(self, axes, scene, across):
        curves = {line.get_label(): line for line in axes.lines if line.get_linestyle() != "None"}
        dots = [line for line in axes.lines if line.get_linestyle() == "None"]
        self.assertEqual(
            sum(len(line.get_xdata()) for line in dots), len(SAMPLERS) * len(SPP) * SEEDS
        )
        self.assertEqual(list(curves), SAMPLERS)
        for sampler, band in zip(scene["samplers"], axes.collections):
            line, rungs = curves[sampler["sampler"]], sampler["rungs"]
            x = [r["cpu_seconds"]["median"] if across == "time" else r["spp"] for r in rungs]
            numpy.testing.assert_allclose(line.get_xdata(), x, rtol=1e-12)
            medians = [r["flip_ldr"]["median"] for r in rungs]
            numpy.testing.assert_allclose(line.get_ydata(), medians, rtol=1e-12)
            edges = set(numpy.round(band.get_paths()[0].vertices[:, 1], 12))
            for rung in rungs:
                for quantile in ("p5", "p95"):
                    self.assertIn(round(rung["flip_ldr"][quantile], 12), edges)

    def test_figure_of_a_metric_of_which_higher_is_better(self):
        axes = figure.draw(self.comparison, "ssim").axes[0]
        self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "linear"))

    def test_figure_as_a_file(self):
        def make(*arguments):
            command = [sys.executable, figure.__file__, *map(str, arguments)]
            return subprocess.run(command, capture_output=True, text=True, timeout=120)

        for name, start in (("f.png", b"\x89PNG"), ("f.pdf", b"%PDF"), ("f.svg", b"<?xml")):
            done = make(self.out, "-o", self.folder / name, "--metric", "rmse")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertTrue((self.folder / name).read_bytes().startswith(start))
        done = make(self.out, "-o", self.folder / "f.png", "--metric", "beauty")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"^figure.py: no metric 'beauty'; there are rmse, .*\n$")
        self.assertEqual(make(self.out, "-o", self.folder / "f.text").returncode, 2)


class Profiles(WithFolder):
    @classmethod
    def make(cls):
        cls.out = cls.folder / "out"
        cls.printed = run(
            *("profile", "cornell", "--weights", "0,1", "--maps", "4:0.02", "--lanes", "4x4x1"),
            *("--spp", 4, "--depth", 2, "--repeats", 1, "--reference-spp", 4, "--seeds", 1),
            *("--resolution", "32x24", "--quiet", "-o", cls.out),
        )
        cls.profile = lockstep.load_profile(cls.out)

    def test_columns(self):
        self.assertEqual(set(self.profile.speeds["weight"]), {"0", "1", "c=4 t=0.02"})
        self.assertEqual(set(self.profile.coherence["kind"]), {"camera", "shadow", "bounce"})
        self.assertEqual(len(self.profile.renders), 3)
        self.assertEqual(set(self.profile.renders["paths"]), {32 * 24 * 4})
        self.assertEqual(set(self.profile.errors["at"]), {"equal_samples", "equal_time"})

    def test_values(self):
        speeds = self.profile.speeds
        rates = speeds["rays"] / speeds["cpu_seconds"]
        numpy.testing.assert_allclose(rates, speeds["rays_per_cpu_second"], rtol=1e-4)
        camera = self.profile.coherence[self.profile.coherence["kind"] == "camera"]
        self.assertEqual(set(camera["rays"]), {32 * 24 * 4})
        # What the program prints is in millions, with three decimals or so.
        for row in self.profile.renders:
            self.assertIn(f"{row['paths_per_cpu_second'] / 1e6:.3f}", self.printed)

    def test_coherence(self):
        rates = {}
        for row in self.profile.speeds:
            if (row["kind"], row["bounce"]) == ("bounce", 1) and row["mode"] != "auto":
                rates.setdefault(str(row["weight"]), {})[str(row["mode"])] = row[
                    "rays_per_cpu_second"
                ]
        shared, own = rates["0"], rates["1"]
        fewest, coherence.FEWEST_RAYS = coherence.FEWEST_RAYS, 1
        self.addCleanup(setattr, coherence, "FEWEST_RAYS", fewest)
        self.assertEqual(coherence.weights(self.profile), ["0", "1"])
        locality = coherence.ratio(self.profile, "bounce", 1, single=True)
        self.assertAlmostEqual(locality, shared["single"] / own["single"])
        both = coherence.ratio(self.profile, "bounce", 1, single=False)
        self.assertAlmostEqual(both, max(shared.values()) / max(own.values()))
        (row,) = coherence.table([self.profile]).split("\n")[2:]
        simd = [max(modes.values()) / modes["single"] for modes in (shared, own)]
        self.assertIn(f"| {locality:.2f} | {simd[0]:.2f}, {simd[1]:.2f} |", row)
        (axes,) = coherence.draw([self.profile, self.profile]).axes
        means = {line.get_label(): line.get_ydata() for line in axes.lines}
        place = coherence.CLASSES.index(("bounce", 1))
        self.assertAlmostEqual(means["single rays: locality"][place], locality)
        self.assertAlmostEqual(means["best mode: locality and SIMD"][place], both)

    def test_errors(self):
        (self.out / "renders.csv").rename(self.out / "gone.csv")
        self.addCleanup((self.out / "gone.csv").rename, self.out / "renders.csv")
        self.fails("renders.csv: no such file", lockstep.load_profile, self.out)


if __name__ == "__main__":
    unittest.main()
