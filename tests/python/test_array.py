"""Arrays with coordinates, without any program."""

import unittest

import shared
import numpy

from vkfv.array import Array, centred_coords


class ArrayTest(unittest.TestCase):
    def setUp(self):
        coords = {"z": numpy.array([-1.0, 0.0, 1.0]), **centred_coords(columns=5, rows=4, pitch_um=2.0)}
        self.array = Array(numpy.arange(60.0).reshape(3, 4, 5), ("z", "y", "x"), coords, "um", "height")

    def test_pixel_centres_and_edges(self):
        numpy.testing.assert_array_equal(self.array.x, [-4, -2, 0, 2, 4])
        numpy.testing.assert_array_equal(self.array.y, [3, 1, -1, -3])
        self.assertEqual(self.array.isel(z=0).extent, (-5, 5, -4, 4))

    def test_selection_by_position(self):
        value = self.array.sel(z=0, y=3, x=2.9)
        self.assertEqual(value.shape, ())
        self.assertEqual(float(value.values), self.array.values[1, 0, 3])
        part = self.array.sel(y=slice(-1, 1), x=slice(2, None))
        numpy.testing.assert_array_equal(part.y, [1, -1])
        numpy.testing.assert_array_equal(part.x, [2, 4])
        numpy.testing.assert_array_equal(part.values, self.array.values[:, 1:3, 3:])
        self.assertEqual(self.array.sel(x=5.0).values[0, 0], self.array.values[0, 0, 4])  # the pixel's edge
        for outside in ({"x": 5.1}, {"y": -4.1}):
            with self.assertRaises(KeyError):
                self.array.sel(**outside)
        with self.assertRaisesRegex(KeyError, "no dimension w"):
            self.array.sel(w=0)

    def test_values_and_coordinates_fit(self):
        with self.assertRaisesRegex(ValueError, "shape"):
            Array(numpy.zeros((2, 2)), ("y", "x"), centred_coords(3, 2, 1.0))

    def test_numpy_takes_it(self):
        self.assertEqual(numpy.max(numpy.asarray(self.array)), 59)
        doubled = self.array.with_values(2 * self.array.values, unit="nm")
        self.assertEqual((doubled.unit, doubled.values[0, 0, 1], doubled.dims), ("nm", 2, ("z", "y", "x")))

    def test_xarray(self):
        try:
            import xarray  # noqa: F401
        except ImportError:
            self.skipTest("xarray is not installed, and nothing else needs it")
        converted = self.array.to_xarray()
        self.assertEqual(float(converted.sel(z=0, y=3, x=2)), self.array.values[1, 0, 3])
        self.assertEqual((converted.units, converted.x.units, converted.name), ("um", "um", "height"))


if __name__ == "__main__":
    unittest.main()
