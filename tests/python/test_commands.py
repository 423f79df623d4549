"""The program run from Python: its results, its errors, its end."""

import fcntl
import json
import os
import shutil
import signal
import subprocess
import sys
import textwrap
import unittest
from pathlib import Path
from unittest import mock

import numpy
import shared
from shared import SMALL, vkfv

from test_outputs import undocumented, validate
from vkfv.overrides import settings
from vkfv.program import CHECKOUT

IMAGES = """
[sweep]
z_um = 0.5
[[sweep.parameter]]
key = "specimen.material.g"
label = "g"
values = [0.3, 0.8]
[[sweep.parameter]]
key = "trace.estimator"
label = "from"
values = ["backward"]
"""
STACKS = """
[sweep]
of = "stacks"
repeats = 2
[[sweep.parameter]]
key = "specimen.roughness.noise_um"
label = "noise"
values = [1.0]
"""
SHORT = {"scan": {"z_start_um": -6, "z_stop_um": 6, "z_step_um": 3}}
LONG = {**SMALL, "scan.z_step_um": 0.1}
LONG_IMAGES = 241


def printed_json(*arguments):
    """With --json the program prints a JSON document and nothing else."""
    command = [vkfv.find_program(), *map(str, arguments), "--json"]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout), done


def set_options(*overrides):
    """The same as arguments of the program."""
    return [word for table in overrides for setting in settings(table) for word in ("--set", setting)]


class RunTest(unittest.TestCase):
    def test_a_stack(self):
        stack = shared.tilted()
        self.assertEqual(stack.folder, shared.folder() / "out")  # of the configuration
        seen = [event for event in shared.events() if event["event"] == "image"]
        numpy.testing.assert_allclose([event["z_um"] for event in seen], stack.z, atol=1e-9)
        self.assertEqual(seen[-1]["done"], 13)

    def test_json_is_results_json(self):
        out = shared.folder() / "json"
        printed, done = printed_json("stack", shared.configuration(), "--out", out, "--timings", *set_options(SMALL, SHORT))
        self.assertEqual(printed, vkfv.Stack(out).results)
        validate(printed, "results")
        self.assertIn("wall clock", done.stderr)  # --timings stands beside the JSON, not in it
        self.assertIn("5 images traced", done.stderr)

    def test_json_of_a_shard(self):
        out = shared.folder() / "shard"
        printed, _ = printed_json(
            "stack", shared.configuration(), "--shard", "5/5", "--out", out, *set_options(SMALL, SHORT)
        )
        self.assertEqual(printed, {"shard": 5, "shards": 5, "traced": 1, "kept": 0, "folder": str(out)})

    def test_an_image(self):
        image = shared.small_image()
        self.assertEqual((image.file, image.pixels.shape), (shared.folder() / "small.tif", (12, 16)))
        self.assertEqual(image.pixels.unit, "W")
        figures = image.figures
        mean = figures["mean_pixel_W"]
        self.assertAlmostEqual(image.pixels.values.mean(dtype=float), mean, delta=1e-6 * mean)
        fates = {entry["name"]: entry["power_W"] for entry in figures["ledger"]["entries"]}
        self.assertAlmostEqual(fates["detected"], image.pixels.values.sum(dtype=float), delta=1e-6 * fates["detected"])
        self.assertAlmostEqual(sum(fates.values()), figures["ledger"]["emitted_W"], places=9)
        self.assertEqual(figures["z_um"], 2)

    def test_a_sweep_of_images(self):
        file = shared.folder() / "images.toml"
        file.write_text(shared.CONFIGURATION + IMAGES, encoding="utf-8")
        sweep = vkfv.sweep(file, out=shared.folder() / "images", **SMALL)
        self.assertEqual([(record["g"], record["from"]) for record in sweep.records], [(0.3, "backward"), (0.8, "backward")])
        dark, bright = (sweep.image(record) for record in sweep.records)
        self.assertGreater(bright.values.mean(), dark.values.mean())  # more light goes on as it came
        self.assertEqual((bright.unit, bright.shape), ("W", (12, 16)))
        validate(json.loads((sweep.folder / "sweep.json").read_text(encoding="utf-8")), "sweep")
        self.assertEqual(undocumented(sweep.folder, "sweep"), [])
        ratio = sweep.column("signal to noise")
        self.assertEqual(ratio.shape, (2,))
        self.assertTrue(numpy.isnan(sweep.column("share collected")).all())  # traced backward: there is none
        self.assertEqual(sweep.select(g=0.8), [sweep.records[1]])
        # The values are those of the table for people, to its digits.
        lines = (sweep.folder / "sweep.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual(lines[0].split(",")[:3], ["g", "from", "signal to noise"])
        for line, value in zip(lines[1:], ratio):
            self.assertAlmostEqual(float(line.split(",")[2]), value, delta=1e-4 * value)
        with self.assertRaisesRegex(ValueError, "sweep of images"):
            sweep.stacks(sweep.records[0])

    def test_a_sweep_of_stacks(self):
        file = shared.folder() / "stacks.toml"
        file.write_text(shared.CONFIGURATION + STACKS, encoding="utf-8")
        out = shared.folder() / "stacks"
        all_points = {"topography": {"false_peak_rate": 1}}  # of so few rays none is more than chance
        printed, _ = printed_json("sweep", file, "--out", out, *set_options(SMALL, SHORT, all_points))
        self.assertEqual(printed, json.loads((out / "sweep.json").read_text(encoding="utf-8")))
        validate(printed, "sweep")
        sweep = vkfv.Sweep(out)
        (record,) = sweep.records
        stacks = sweep.stacks(record)
        self.assertEqual([stack.results["seed"] for stack in stacks], [1, 2])
        mean = numpy.mean([stack.results["rms_deviation_um"] for stack in stacks])
        self.assertAlmostEqual(record["rms deviation / um"], mean, places=9)

    def test_overrides(self):
        overrides = {
            "trace": {"rays": 1e6, "seed": numpy.int64(3)},
            "specimen.material": {"scatter": "ggx", "layers": [{"weight": 0.5}]},
            "detector.pixels": numpy.array([4, 5]),
            "topography.repair_outliers": True,
            "topography.flatness_file": Path("flat.x3p"),
            "output.directory": 'a "b"\\c\n',
        }
        self.assertEqual(
            list(settings(overrides)),
            [
                "trace.rays=1000000.0",
                "trace.seed=3",
                'specimen.material.scatter="ggx"',
                "specimen.material.layers=[{weight = 0.5}]",
                "detector.pixels=[4, 5]",
                "topography.repair_outliers=true",
                f'topography.flatness_file="{os.path.abspath("flat.x3p")}"',
                'output.directory="a \\"b\\"\\\\c\\n"',
            ],
        )
        with self.assertRaisesRegex(TypeError, "no value of a configuration"):
            list(settings({"trace.rays": None}))
        # The program reads nested settings back.
        self.assertEqual(vkfv.check(shared.configuration(), **{"scan.z_step_um": 4, "trace": {"rays": 3e5}})["images"], 7)

    def test_warnings(self):
        with self.assertWarnsRegex(vkfv.RunWarning, "saturated"):
            image = vkfv.image(
                shared.configuration(), 0, out=shared.folder() / "grey.tif", camera={"preset": "IMX250"}, **SMALL
            )
        self.assertEqual(image.pixels.unit, "DN")
        self.assertIn("are saturated", "".join(warning["sentence"] for warning in image.figures["warnings"]))
        validate(image.figures, "image")


class ErrorTest(unittest.TestCase):
    def test_names_are_no_options(self):
        """A file whose name looks like an option reaches the program as a file."""
        for name in ("--help", "--version", "-x.toml", "--json"):
            for command in (vkfv.check, vkfv.run):
                with self.subTest(name=name, command=command.__name__), self.assertRaisesRegex(vkfv.InputError, "no such file"):
                    command(name)
        shutil.copy(shared.configuration(), shared.folder() / "-x.toml")
        here = Path.cwd()
        try:
            os.chdir(shared.folder())
            self.assertIn("magnification", vkfv.check("-x.toml"))
        finally:
            os.chdir(here)

    def test_input(self):
        with self.assertRaises(vkfv.InputError) as caught:
            vkfv.run(shared.configuration(), trace={"ray": 1e6})
        self.assertEqual(caught.exception.exit_code, 2)
        self.assertRegex(str(caught.exception), r'trace\.ray = .*Did you mean "rays"')
        with self.assertRaisesRegex(vkfv.InputError, "absent.toml"):
            vkfv.check("absent.toml")

    def test_no_device(self):
        with self.assertRaises(vkfv.DeviceError) as caught:
            vkfv.image(shared.configuration(), 0, out=shared.folder() / "x.tif", trace={"device": "no such device"})
        self.assertEqual(caught.exception.exit_code, 3)

    def test_folder_in_use(self):
        stack = shared.tilted()
        with open(stack.folder / ".lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            with self.assertRaises(vkfv.FolderInUse) as caught:
                vkfv.run(shared.configuration())
        self.assertEqual(caught.exception.exit_code, 5)
        self.assertIsInstance(caught.exception, vkfv.RunError)

    def test_a_program_that_a_signal_ends(self):
        program = shared.folder() / "killed"
        program.write_text("#!/bin/sh\necho 'not JSON' >&2\nkill -TERM $$\n", encoding="utf-8")
        program.chmod(0o755)
        with self.assertRaisesRegex(vkfv.RunError, "not JSON") as caught:
            vkfv.check(shared.configuration(), program=program)
        self.assertEqual(caught.exception.exit_code, 128 + signal.SIGTERM)

    def test_an_exception_of_the_caller_ends_the_program(self):
        out = shared.folder() / "stopped"

        def stop(event):
            if event["event"] == "image":
                raise StopIteration("enough")

        with self.assertRaisesRegex(StopIteration, "enough"):
            vkfv.run(shared.configuration(), out=out, on_event=stop, **LONG)
        self.assertTrue(0 < len(list((out / "images").glob("*.tif"))) < LONG_IMAGES)
        self.assertFalse((out / "results.json").exists())


class InterruptTest(unittest.TestCase):
    def test_ctrl_c_is_passed_on(self):
        """SIGINT to Python alone, as a notebook's button sends it: the program says what it kept, and goes on later."""
        out = shared.folder() / "interrupted"
        script = textwrap.dedent(
            f"""
            import os, signal, vkfv
            def interrupt(event):
                if event["event"] == "image":
                    os.kill(os.getpid(), signal.SIGINT)
            try:
                vkfv.run({str(shared.configuration())!r}, out={str(out)!r}, on_event=interrupt, **{LONG!r})
            except KeyboardInterrupt as interruption:
                print("interrupted:", interruption)
            """
        )
        done = subprocess.run(
            [sys.executable, "-c", script], capture_output=True, text=True, timeout=300, env=shared.program_environment()
        )
        self.assertRegex(done.stdout, r"interrupted: .*(continue|resume|again)", done.stderr)
        kept = len(list((out / "images").glob("z_*.tif")))
        self.assertTrue(0 < kept < LONG_IMAGES)
        self.assertFalse((out / "results.json").exists())
        # The folder is free again, since the program is gone.
        vkfv.Stack(out).image(0)
        with open(out / ".lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)


class FindTest(unittest.TestCase):
    def setUp(self):
        self.places = {}
        for name in ("argument", "environment", "path"):
            folder = shared.folder() / f"found_{name}"
            folder.mkdir(exist_ok=True)
            program = folder / "vkfv"
            program.write_text("#!/bin/sh\n", encoding="utf-8")
            program.chmod(0o755)
            self.places[name] = program

    def test_in_this_order(self):
        environment = {"VKFV": str(self.places["environment"]), "PATH": str(self.places["path"].parent)}
        with mock.patch.dict(os.environ, environment, clear=True):
            self.assertEqual(vkfv.find_program(self.places["argument"]), self.places["argument"])
            self.assertEqual(vkfv.find_program(), self.places["environment"])
            del os.environ["VKFV"]
            self.assertEqual(vkfv.find_program(), self.places["path"])
            os.environ["PATH"] = str(shared.folder())
            built = [CHECKOUT / "build" / preset / "vkfv" for preset in ("release", "dev")]
            first = next((program for program in built if program.exists()), None)
            if first is not None:
                self.assertEqual(vkfv.find_program(), first)
            with mock.patch("vkfv.program.CHECKOUT", shared.folder()), self.assertRaisesRegex(FileNotFoundError, "tools/demo"):
                vkfv.find_program()

    def test_what_is_named_must_be_there(self):
        with self.assertRaisesRegex(FileNotFoundError, "argument"):
            vkfv.find_program("no/such/vkfv")
        with mock.patch.dict(os.environ, {"VKFV": "no/such/vkfv"}), self.assertRaisesRegex(FileNotFoundError, "VKFV"):
            vkfv.find_program()


if __name__ == "__main__":
    unittest.main()
