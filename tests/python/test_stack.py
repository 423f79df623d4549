"""A stack's folder as arrays: values, units, and above all where they stand."""

import unittest

import numpy
import shared
import tifffile
from shared import vkfv

from vkfv.focus import axial_shares


def plane_slopes(heights):
    """Least-squares slopes along x and y of a map's values at its coordinates."""
    x, y = numpy.meshgrid(heights.x, heights.y)
    good = numpy.isfinite(heights.values)
    terms = numpy.stack([x[good], y[good], numpy.ones(good.sum())], axis=1)
    return numpy.linalg.lstsq(terms, heights.values[good].astype(float), rcond=None)[0][:2]


def places_of_maxima(averages, width):
    """The middles, in steps, of the Gaussians of this width whose maxima the averages (a matrix) bring to each point."""
    images = numpy.arange(len(averages))
    found, middles = [], []
    for middle in numpy.linspace(0, images[-1], 50 * images[-1] + 1):
        curve = averages @ numpy.exp(-0.5 * ((images - middle) / width) ** 2)
        at = curve.argmax()
        if 0 < at < images[-1]:
            before, here, after = numpy.log(curve[at - 1:at + 2])
            found.append(at + 0.5 * (before - after) / (before - 2 * here + after))
            middles.append(middle)
    return numpy.interp(images, found, middles, left=numpy.nan, right=numpy.nan)


class PlacesByWidth:
    """Where curves lie, in steps, whose averaged maxima are found near an end of the scan: each by its own width."""

    def __init__(self, averages, radius, width):
        images = len(averages)
        self.last_image, self.end = images - 1, min(2 * radius, (images - 1) / 2)
        self.line = averages @ numpy.arange(images)
        self.logarithms = numpy.arange(-6, 7) * numpy.log(2) / 4
        self.tables = [self.table(averages, width * numpy.exp(logarithm)) for logarithm in self.logarithms]
        found, place = self.tables[9][:2]
        moved = found[abs(place - self.straight(found)) > 0.01]
        self.felt = moved[-1] if len(moved) else 0

    def table(self, averages, width):
        """Rows of where the maximum is found, the Gaussian's middle, the logarithm's curvature, and the largest value's image."""
        images, rows = numpy.arange(len(averages)), []
        for middle in numpy.linspace(0, self.end, min(240, int(numpy.ceil(self.end / 0.05))) + 1):
            curve = averages @ numpy.exp(-0.5 * ((images - middle) / width) ** 2)
            at = curve.argmax()
            if 0 < at < images[-1]:
                found, curvature = maximum(*numpy.log(curve[at - 1:at + 2]))
                found = self.end if middle == self.end else at + found
                if found <= self.end and (not rows or found > rows[-1][0]):
                    rows.append((found, middle, curvature, at))
        return numpy.array(rows).T

    def place_of(self, table, found):
        below = self.straight(found) + table[1][0] - self.straight(table[0][0])
        return numpy.where(found < table[0][0], numpy.maximum(0, below), numpy.interp(found, table[0], table[1]))

    def straight(self, at):
        return numpy.interp(at, numpy.arange(len(self.line)), self.line)

    def curvatures(self, table, found, image):
        """The curvatures of curves whose largest value is at the same image."""
        result = numpy.interp(found, table[0], table[2])
        for k in numpy.unique(image):
            here, same = image == k, table[3] == k
            if same.sum() > 1:
                at, values = table[0][same], table[2][same]
                after = numpy.clip(numpy.searchsorted(at, found[here], side="right"), 1, len(at) - 1)
                share = (found[here] - at[after - 1]) / (at[after] - at[after - 1])
                result[here] = values[after - 1] + share * (values[after] - values[after - 1])
        return numpy.where(found < table[0][0], numpy.nan, result)

    def widths(self, found, image, curvature):
        """Logarithms of the widths over the stack's, and their weights."""
        known = numpy.log([self.curvatures(table, found, image) for table in self.tables])
        wanted = numpy.log(curvature)
        best, weight = numpy.full(found.shape, numpy.inf), numpy.zeros(found.shape)
        step = self.logarithms[1] - self.logarithms[0]
        for k in range(len(known) - 1):
            fall = known[k] - known[k + 1]
            here = self.logarithms[k] + step * (known[k] - wanted) / fall
            better = (fall > 0) & (wanted <= known[k]) & (wanted >= known[k + 1]) & (abs(here) < abs(best))
            best, weight = numpy.where(better, here, best), numpy.where(better, (fall / step) ** 2, weight)
        if not numpy.isfinite(best).all():
            raise ValueError("a curve that is wider or narrower than the table's")
        return best, weight

    def places(self, image, offset, curvature, measured, reach):
        """The places of the curves of a map of maxima; widths are means over `reach` pixels around."""
        at = image + offset
        lower = at < self.last_image / 2
        found = numpy.where(lower, at, self.last_image - at)
        near = measured & (found < self.felt)
        logarithm, weight = (numpy.zeros(at.shape) for _ in range(2))
        logarithm[near], weight[near] = self.widths(
            found[near], numpy.where(lower, image, self.last_image - image)[near], curvature[near])
        sums = [around(weight * logarithm, reach), around(weight, reach)]
        width = numpy.clip(6 + sums[0] / numpy.where(sums[1] > 0, sums[1], 1) / (numpy.log(2) / 4), 0, 12)
        narrow = numpy.minimum(width.astype(int), 11)
        every = numpy.array([self.place_of(table, found) for table in self.tables])
        rows, columns = numpy.indices(at.shape)
        place = every[narrow, rows, columns] * (1 - width + narrow) + every[narrow + 1, rows, columns] * (width - narrow)
        # Elsewhere the width is that of the stack, by straight lines between the images.
        points = numpy.arange(numpy.ceil(self.end) + 1)
        of_stack = numpy.where(points < self.end, self.place_of(self.tables[6], points), points)
        place = numpy.where(near, place, numpy.interp(found, points, of_stack))
        return numpy.where(lower, place, self.last_image - place)


def maximum(before, here, after):
    """The distance of a maximum from the middle of three values, and its curvature, by their logarithms."""
    return 0.5 * (before - after) / (before - 2 * here + after), 2 * here - before - after


def around(values, reach):
    """Sums over squares about each pixel."""
    rows, columns = values.shape
    padded = numpy.pad(values, reach)
    return sum(padded[y:y + rows, x:x + columns] for y in range(2 * reach + 1) for x in range(2 * reach + 1))


class StackTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.stack = shared.tilted()
        cls.slopes = numpy.tan(numpy.radians([shared.TILT_X_DEG, shared.TILT_Y_DEG]))

    def test_pixel_centres(self):
        heights = self.stack.heights
        pitch = 20 / (200 / 20)  # of the chip, by the focal lengths of the two lenses
        numpy.testing.assert_allclose(heights.x, (numpy.arange(shared.COLUMNS) - 23.5) * pitch, atol=1e-9)
        numpy.testing.assert_allclose(heights.y, (19.5 - numpy.arange(shared.ROWS)) * pitch, atol=1e-9)
        # Images and maps without a description of their grid stand at the same places.
        small = shared.small_image().pixels
        numpy.testing.assert_allclose(small.x, (numpy.arange(16) - 7.5) * pitch, rtol=1e-5)
        numpy.testing.assert_allclose(small.y, (5.5 - numpy.arange(12)) * pitch, rtol=1e-5)

    def test_all_images_in_one_file(self):
        """tifffile takes images.tif for a z-stack of ImageJ, with um and heights."""
        stack = shared.with_camera_and_stage()
        with tifffile.TiffFile(stack.folder / "images.tif") as file:
            self.assertTrue(file.is_imagej)
            self.assertEqual(file.series[0].axes, "ZYX")
            numpy.testing.assert_array_equal(file.asarray(), stack.images.values)
            told = file.imagej_metadata
            pitch = stack.images.x[1] - stack.images.x[0]
            across, count = file.pages[0].tags["XResolution"].value
        self.assertEqual((told["unit"], told["slices"], told["spacing"]), ("um", len(stack.z), 3))
        self.assertAlmostEqual(-told["zorigin"] * told["spacing"], stack.z[0], 9)
        self.assertEqual(told["Labels"], [f"z_um={z:g}" for z in stack.z])
        self.assertAlmostEqual(count / across, pitch, 6)

    def test_the_plane_rises_as_it_was_tilted(self):
        # The true plane carries a texture of 1 um / 12 a point: 0.0012 is five standard errors of a slope over this field.
        numpy.testing.assert_allclose(plane_slopes(self.stack.truth), self.slopes, atol=0.0012)
        measured = self.stack.heights
        self.assertGreater(numpy.mean(self.stack.measured), 0.9)
        numpy.testing.assert_allclose(plane_slopes(measured), self.slopes, atol=0.008)
        # Heights are high where the coordinates say so.
        high = measured.sel(x=slice(25, None), y=slice(20, None)).values
        low = measured.sel(x=slice(None, -25), y=slice(None, -20)).values
        self.assertGreater(numpy.nanmedian(high) - numpy.nanmedian(low), 3)

    def test_images_are_sharpest_where_the_plane_is(self):
        """The slopes, signs included, follow from the images alone, without anything that the evaluation wrote."""
        curves = self.stack.focus_curves(smoothing_steps=1.0)
        self.assertEqual(curves.shape, (13, shared.ROWS, shared.COLUMNS))
        sharpest = vkfv.Array(curves.z[curves.values.argmax(axis=0)], ("y", "x"), {"y": curves.y, "x": curves.x})
        numpy.testing.assert_allclose(plane_slopes(sharpest), self.slopes, atol=0.012)

    def test_focus_curves_are_those_of_the_evaluation(self):
        """Their maxima, through three points of the logarithm, are the program's heights, to the rounding of float32."""
        evaluated = shared.evaluated()
        settings = evaluated.results["topography"]
        curves = vkfv.focus_curves(self.stack.images, settings).values
        images = len(curves)
        largest = numpy.clip(curves.argmax(axis=0), 1, images - 2)
        rows, columns = numpy.indices(largest.shape)
        offset, curvature = maximum(*(numpy.log(curves[largest + d, rows, columns]) for d in (-1, 0, 1)))
        # The truth is the program's own evaluation of the images as they are, without the flat.
        plain = vkfv.evaluate(self.stack.folder, out=shared.folder() / "plain", topography={"place_by_texture": False})
        inside = plain.measured
        self.assertGreater(inside.mean(), 0.8)
        share = axial_shares(settings["smoothing_steps"], images)
        radius = int(numpy.ceil(3 * settings["smoothing_steps"]))
        by_width = PlacesByWidth(share @ share, radius, plain.results["curves"]["curve_width_steps"])
        places = by_width.places(largest, offset, curvature, inside, 2 * (settings["window_px"] // 2))
        heights = self.stack.z[0] + (self.stack.z[1] - self.stack.z[0]) * places
        error = heights[inside] - plain.heights.values[inside]
        self.assertLess(numpy.sqrt(numpy.mean(error**2)), 1e-4)
        # The wrong twin takes all curves as wide as the stack's.
        error = numpy.interp(largest + offset, numpy.arange(images), plain.results["focus_curves"]["z_um"]) - plain.heights.values
        self.assertGreater(numpy.sqrt(numpy.mean(error[inside]**2)), 1e-3)

    def test_curves_that_the_program_kept(self):
        """curves.npy: row, column, height at the places that results.json tells."""
        kept = numpy.load(self.stack.folder / "curves.npy")
        at = self.stack.results["focus_curves"]
        share = axial_shares(self.stack.results["topography"]["smoothing_steps"], len(self.stack.z))
        places = places_of_maxima(share @ share, self.stack.results["curves"]["curve_width_steps"])
        step = self.stack.z[1] - self.stack.z[0]
        known = numpy.isfinite(places)
        self.assertGreater(known.sum(), len(places) / 2)
        # Two interpolations add up, each of a thousandth of a step.
        numpy.testing.assert_allclose(
            (numpy.array(at["z_um"]) - self.stack.z[0])[known] / step, places[known], atol=0.002)
        self.assertTrue((numpy.diff(at["z_um"]) > 0).all())
        curves = self.stack.focus_curves().values[:, at["rows"]][:, :, at["columns"]].transpose(1, 2, 0)
        numpy.testing.assert_allclose(kept, curves, atol=1e-6 * curves.max())

    def test_every_measure_and_window(self):
        """A single pixel has the curve that it has among all, at the border too."""
        for measure in ("standard-deviation", "tenengrad", "modified-laplacian", "brenner", "wavelet",
                        "gradient-and-curvature"):
            for shape in ("box", "gaussian"):
                settings = {"focus_measure": measure, "window_px": 5, "window_shape": shape, "smoothing_steps": 0.0}
                curves = vkfv.focus_curves(self.stack.images, settings)
                self.assertTrue((curves.values > 0).all())
                for x, y in ((curves.x[0], curves.y[0]), (3.0, -7.0), (curves.x[-1], curves.y[20])):
                    one = self.stack.focus_curve(x, y, **settings)
                    numpy.testing.assert_allclose(one.values, curves.sel(x=x, y=y).values, rtol=1e-9)

    def test_measures_by_hand(self):
        """One bright pixel in a grey image, whose measures are counted on paper."""
        values = numpy.ones((1, 9, 9))
        values[0, 4, 4] = 2.0
        at = numpy.arange(9.0)
        image = vkfv.Array(values, ("z", "y", "x"), {"z": numpy.zeros(1), "y": -at, "x": at})
        level = 1 + 1 / 9
        # The values by hand are means over 3 x 3 pixels around the bright one, over the mean level, and the roots of
        # energies.
        by_hand = {
            "modified-laplacian": (4 + 4 * 1) / 9,
            "tenengrad": numpy.sqrt((4 * 2 + 4 * 4) / 9),
            "brenner": numpy.sqrt(4 / 9),
            # At the bright pixel there are two bends of 4; beside it a step of 2 and bends of -2 and 2; at its corners
            # steps of 1 and bends of -1.
            "gradient-and-curvature": (4 + 4 * numpy.sqrt(8) + 4 * numpy.sqrt(3)) / 9,
            "standard-deviation": numpy.sqrt(8 / 81),
        }
        for measure, amplitude in by_hand.items():
            settings = {"focus_measure": measure, "window_px": 3, "window_shape": "box", "smoothing_steps": 0}
            found = vkfv.focus_curves(image, settings, slice(4, 5), slice(4, 5)).values[0, 0, 0]
            self.assertAlmostEqual(found, amplitude / level, places=12, msg=measure)

    def test_maps_and_units(self):
        shapes = {
            "heights": "um", "truth": "um", "deviation": "um", "height_noise": "um", "height_uncertainty": "um", "contrast": "", "fit_residual": "",
            "mask": "", "all_in_focus": "",
        }
        for name, unit in shapes.items():
            found = getattr(self.stack, name)
            self.assertEqual((found.shape, found.unit), ((shared.ROWS, shared.COLUMNS), unit), name)
        states = numpy.bincount(self.stack.mask.values.ravel(), minlength=len(vkfv.PointState))
        counted = {state.name.lower(): int(states[state]) for state in vkfv.PointState}
        self.assertEqual(counted, self.stack.results["points"])
        has_height = numpy.isfinite(self.stack.heights.values)
        numpy.testing.assert_array_equal(has_height, self.stack.measured)

    def test_figures_are_those_of_the_maps(self):
        """results.json's figures from the maps, by numpy alone."""
        def levelled(heights):
            x, y = numpy.meshgrid(heights.x, heights.y)
            good = numpy.isfinite(self.stack.heights.values)
            terms = numpy.stack([x[good], y[good], numpy.ones(good.sum())], axis=1)
            values = heights.values[good].astype(float)
            return values - terms @ numpy.linalg.lstsq(terms, values, rcond=None)[0]

        measured, true = levelled(self.stack.heights), levelled(self.stack.truth)
        results = self.stack.results
        self.assertAlmostEqual(numpy.std(measured), results["sq_measured_um"], places=5)
        self.assertAlmostEqual(numpy.std(true), results["sq_true_um"], places=5)
        self.assertAlmostEqual(numpy.std(measured - true), results["rms_deviation_um"], places=5)
        self.assertAlmostEqual(numpy.isfinite(self.stack.heights.values).mean(), results["measured_share"], places=9)

    def test_images(self):
        images = self.stack.images
        numpy.testing.assert_allclose(images.z, numpy.arange(-12, 13, 2))
        numpy.testing.assert_array_equal(images.z, self.stack.z)
        self.assertEqual(images.unit, "W")
        numpy.testing.assert_array_equal(self.stack.image(-1).values, images.values[-1])
        for place, row in enumerate(self.stack.ledger):
            self.assertEqual(row["image"], place)
            self.assertEqual(row["z_um"], images.z[place])
            self.assertAlmostEqual(images.values[place].sum(dtype=float), row["detected_W"], delta=1e-6 * row["detected_W"])

    def test_camera_and_stage(self):
        stack = shared.with_camera_and_stage()
        self.assertEqual((stack.images.unit, stack.images.values.dtype), ("DN", numpy.uint16))
        read = [row["read_um"] for row in stack.stage]
        self.assertEqual(len(read), 5)
        self.assertTrue(0 < numpy.std(read - stack.z) < 0.5)
        names = [dimension["name"] for dimension in stack.dimensions]
        self.assertTrue(any("step height" in name for name in names), names)
        self.assertEqual(stack.configuration["stage"]["jitter_um"], 0.1)
        with self.assertRaises(FileNotFoundError):
            self.stack.stage

    def test_evaluations_elsewhere(self):
        evaluated = shared.evaluated()
        self.assertFalse((evaluated.folder / "topography.tif").exists())
        self.assertEqual(evaluated.heights.shape, (shared.ROWS, shared.COLUMNS))  # of topography.x3p
        sharp, blurred = evaluated.heights.values, evaluated.diffracted.heights.values
        self.assertGreater(numpy.nanmax(numpy.abs(sharp - blurred)), 0)
        self.assertIsNone(self.stack.diffracted)
        with self.assertRaisesRegex(FileNotFoundError, "they are in"):
            evaluated.images
        foreign = shared.foreign()
        numpy.testing.assert_allclose(foreign.heights.x, (numpy.arange(shared.COLUMNS) - 23.5) * 0.5)
        # The images descend by half the step, and the pixels are a quarter as far apart: slopes of the other sign, twice.
        expected = -self.slopes * (1 / 2) / (0.5 / (self.stack.heights.x[1] - self.stack.heights.x[0]))
        numpy.testing.assert_allclose(plane_slopes(foreign.heights), expected, atol=0.02)

    def test_a_folder_of_something_else(self):
        with self.assertRaisesRegex(FileNotFoundError, "neither"):
            vkfv.Stack(shared.folder())


if __name__ == "__main__":
    unittest.main()
