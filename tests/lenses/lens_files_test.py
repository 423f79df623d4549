#!/usr/bin/env python3
"""Whether lens files in the shapes of real ones are imported with the focal lengths of an independent paraxial trace.

    VKFV=build/vkfv python3 tests/lenses/lens_files_test.py
"""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import lens_files

TOLERANCE = 1e-5


def imported(folder, file, *options):
    return subprocess.run([os.environ["VKFV"], "import", file, "--json", *options], cwd=folder, capture_output=True,
                          text=True, timeout=60, check=False)


class LensFiles(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def assert_near(self, found, expected):
        self.assertLess(abs(found - expected), TOLERANCE * abs(expected), (found, expected))

    def test_focal_lengths_of_the_corpus_in_both_orders_of_catalogues(self):
        files = 0
        for lens in lens_files.lenses():
            (self.folder / "VENDORA.agf").write_text(lens_files.catalogue(lens.media))
            (self.folder / "VENDORB.agf").write_text(lens_files.catalogue(lens.media, off=0.01))
            for shape, content, options, (effective, back) in lens_files.shapes_of(lens):
                (self.folder / "lens.zmx").write_bytes(content)
                files += 1
                for order in (("VENDORA.agf", "VENDORB.agf"), ("VENDORB.agf", "VENDORA.agf")):
                    with self.subTest(lens=lens.name, shape=shape, order=order):
                        catalogues = [word for name in order for word in ("--glass-catalog", name)]
                        done = imported(self.folder, "lens.zmx", *catalogues, *options)
                        self.assertEqual(done.returncode, 0, done.stderr)
                        report = json.loads(done.stdout)
                        self.assert_near(report["efl_mm"], effective)
                        self.assert_near(report["bfl_mm"], back)
        self.assertGreaterEqual(files, 40)

    def test_the_other_catalogue_is_another_lens(self):
        """The wrong twin: what the tolerance would not notice if the order decided."""
        lens = next(lens_files.lenses())
        (self.folder / "VENDORA.agf").write_text(lens_files.catalogue(lens.media, off=0.01))
        (self.folder / "lens.zmx").write_bytes(lens_files.text_of(lens_files.file_of(lens)).encode())
        found = json.loads(imported(self.folder, "lens.zmx", "--glass-catalog", "VENDORA.agf").stdout)["efl_mm"]
        expected = lens.focal_lengths(lens_files.LINES_UM["d"])[0]
        self.assertGreater(abs(found - expected), 100 * TOLERANCE * abs(expected))

    def test_without_gcat_catalogues_that_differ_are_refused(self):
        lens = next(lens_files.lenses())
        lines = [line for line in lens_files.file_of(lens) if not line.startswith("GCAT")]
        (self.folder / "lens.zmx").write_bytes(lens_files.text_of(lines).encode())
        (self.folder / "A.agf").write_text(lens_files.catalogue(lens.media))
        (self.folder / "B.agf").write_text(lens_files.catalogue(lens.media, off=2e-6))
        for order in (("A.agf", "B.agf"), ("B.agf", "A.agf")):
            done = imported(self.folder, "lens.zmx", *(word for name in order for word in ("--glass-catalog", name)))
            self.assertEqual(done.returncode, 2)
            for name in order:
                self.assertIn(name, done.stderr)
        (self.folder / "B.agf").write_text(lens_files.catalogue(lens.media, off=5e-7))
        done = imported(self.folder, "lens.zmx", "--glass-catalog", "A.agf", "--glass-catalog", "B.agf")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_lens_from_infinity_is_told(self):
        lens = next(lens_files.lenses())
        (self.folder / "VENDORA.agf").write_text(lens_files.catalogue(lens.media))
        (self.folder / "lens.zmx").write_bytes(lens_files.text_of(lens_files.file_of(lens)).encode())
        told = "from infinity towards its focus"
        self.assertIn(told, imported(self.folder, "lens.zmx", "--glass-catalog", "VENDORA.agf").stderr)
        self.assertNotIn(told, imported(self.folder, "lens.zmx", "--glass-catalog", "VENDORA.agf", "--reverse").stderr)
        near = lens_files.text_of(lens_files.file_of(lens, object_distance="5.0"))
        (self.folder / "lens.zmx").write_bytes(near.encode())
        self.assertNotIn(told, imported(self.folder, "lens.zmx", "--glass-catalog", "VENDORA.agf").stderr)

    def test_check_tells_of_an_objective_the_wrong_way_round(self):
        lens = lens_files.Lens.of(lens_files.ROOT / "assets/objectives/10x_0.28.toml")
        (self.folder / "VENDORA.agf").write_text(lens_files.catalogue(lens.media))
        (self.folder / "lens.zmx").write_bytes(lens_files.text_of(lens_files.file_of(lens.turned())).encode())
        text = (lens_files.ROOT / "assets/stacks/microscope_10x.toml").read_text()
        (self.folder / "c.toml").write_text(text.replace('"10x_0.28"', '"lens.toml"'))
        for options, told in (((), True), (("--reverse",), False)):
            done = imported(self.folder, "lens.zmx", "--glass-catalog", "VENDORA.agf", "--out", "lens.toml", *options)
            self.assertEqual(done.returncode, 0, done.stderr)
            done = subprocess.run([os.environ["VKFV"], "check", "c.toml", "--json"], cwd=self.folder, capture_output=True,
                                  text=True, timeout=60, check=False,
                                  env={**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache")})
            self.assertEqual(done.returncode, 0, done.stderr)
            report = json.loads(done.stdout)
            warnings = report["warnings"]
            self.assertEqual(report["verdict"]["measurable"] == "no", told, report["verdict"])
            self.assertEqual(any(warning["code"] == "objective-turned-round" for warning in warnings), told, warnings)


if __name__ == "__main__":
    unittest.main()
