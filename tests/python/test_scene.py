"""Scenes in this process, against the program's own files. The build gives the folder of vkfv._core (VKFV_PYTHON_MODULE)."""

import os
import tempfile
import threading
import unittest
from pathlib import Path

import shared
import numpy

import vkfv

FOLDER = os.environ.get("VKFV_MODULE_FOLDER")
if FOLDER:
    vkfv.__path__.append(FOLDER)


@unittest.skipUnless(FOLDER, "the build has no vkfv._core")
class SceneTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.file = Path(cls.folder.name) / "plane.toml"
        cls.file.write_text(shared.CONFIGURATION)
        cls.program = vkfv.run(cls.file, out=Path(cls.folder.name) / "out")
        cls.scene = vkfv.load(cls.file)
        cls.images = cls.scene.stack()

    def test_images_have_the_bits_of_the_program(self):
        self.assertEqual(len(self.images), len(self.program.z))
        for ours, theirs in zip(self.images, self.program.images.values):
            numpy.testing.assert_array_equal(ours.values, theirs)
        numpy.testing.assert_array_equal(self.scene.image(self.program.z[3]).values, self.images[3].values)

    def test_heights_have_the_bits_of_the_program(self):
        found = self.scene.evaluate(self.images)
        self.assertGreater(numpy.count_nonzero(found.measured.values), 500)
        for ours, theirs in (
            (found.heights, self.program.heights),
            (found.truth, self.program.truth),
            (found.height_uncertainty, self.program.height_uncertainty),
        ):
            numpy.testing.assert_array_equal(ours.values.astype(numpy.float32), theirs.values)
            numpy.testing.assert_allclose(ours.x, theirs.x, atol=1e-9)
            numpy.testing.assert_allclose(ours.y, theirs.y, atol=1e-9)

    def test_a_key_remakes_only_what_depends_on_it(self):
        scene = vkfv.load(self.file)
        first = scene.image(0.0).values.copy()
        scene.set("topography.window_px", 9)
        numpy.testing.assert_array_equal(scene.image(0.0).values, first)
        self.assertEqual(scene._scene.lights_made(), 1)
        scene.set("specimen.material.g", 0.3)
        self.assertFalse(numpy.array_equal(scene.image(0.0).values, first))
        self.assertEqual(scene._scene.lights_made(), 2)

    def test_a_wrong_key_is_refused_and_changes_nothing(self):
        before = self.scene.configuration
        with self.assertRaises(vkfv.InputError) as caught:
            self.scene.set("specimen.material.g", 3)
        self.assertEqual(caught.exception.problems[0]["key"], "specimen.material.g")
        for part in ("found", "expectation", "remedy"):
            self.assertTrue(caught.exception.problems[0][part], part)
        self.assertEqual(self.scene.configuration, before)
        with self.assertRaisesRegex(vkfv.InputError, "images"):
            self.scene.evaluate(self.images[:-1])

    def test_two_scenes_in_two_threads(self):
        found = {}

        def work(name):
            found[name] = vkfv.load(self.file).stack()

        threads = [threading.Thread(target=work, args=(name,)) for name in "ab"]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for name in "ab":
            for ours, first in zip(found[name], self.images, strict=True):
                numpy.testing.assert_array_equal(ours.values, first.values)

    def test_an_exception_of_progress_ends_the_stack(self):
        seen = []

        def progress(done, images):
            seen.append((done, images))
            if done == 2:
                raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            self.scene.stack(progress)
        self.assertEqual(seen, [(1, len(self.images)), (2, len(self.images))])
        numpy.testing.assert_array_equal(self.scene.stack()[0].values, self.images[0].values)

    def test_arrays_outlive_their_scene_and_copy_nothing(self):
        scene = vkfv.load(self.file)
        image = scene.image(0.0)
        copy = image.values.copy()
        self.assertFalse(image.values.flags.owndata)
        del scene
        numpy.testing.assert_array_equal(image.values, copy)
