"""X3P files, as the program writes them and as others do."""

import hashlib
import subprocess
import unittest
import zipfile

import numpy
import shared
from shared import vkfv


def main_xml(kind, points, valid="", listed=""):
    md5 = hashlib.md5(points).hexdigest()
    linked = f"<DataLink><PointDataLink>bindata/data.bin</PointDataLink><MD5ChecksumPointData>{md5}</MD5ChecksumPointData>"
    linked += f"<ValidPointsLink>{valid}</ValidPointsLink>" if valid else ""
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>
<CX><AxisType>I</AxisType><DataType>D</DataType><Increment>2e-6</Increment><Offset>1e-5</Offset></CX>
<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>3e-6</Increment><Offset>-4e-5</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>{kind}</DataType><Increment>1e-9</Increment><Offset>5e-7</Offset></CZ></Axes></Record1>
<Record2><Date>2024-01-01T00:00:00Z</Date><Creator>me</Creator><Instrument><Manufacturer>unknown</Manufacturer>
<Model>M</Model><Serial>1</Serial><Version>2</Version></Instrument><CalibrationDate>2024-01-01T00:00:00Z</CalibrationDate>
<ProbingSystem><Type>Software</Type><Identification>none</Identification></ProbingSystem></Record2>
<Record3><MatrixDimension><SizeX>3</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ></MatrixDimension>
{listed or linked + "</DataLink>"}</Record3>
<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>"""


def write_x3p(name, kind, dtype, valid=b"", listed="", folder=""):
    points = numpy.array([100, 200, -300, 400, 500, 600]).astype(dtype).tobytes()
    file = shared.folder() / name
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr(folder + "main.xml", main_xml(kind, points, "bindata/valid.bin" if valid else "", listed))
        if not listed:
            archive.writestr(folder + "bindata/data.bin", points)
        if valid:
            archive.writestr(folder + "bindata/valid.bin", valid)
    return file


class X3pTest(unittest.TestCase):
    def test_of_the_program(self):
        heights = shared.tilted().heights
        read = vkfv.read_x3p(shared.tilted().folder / "topography.x3p")
        numpy.testing.assert_allclose(read.values, heights.values, atol=1e-6)  # float32 um there
        numpy.testing.assert_allclose(read.x, heights.x, atol=1e-9)
        numpy.testing.assert_allclose(read.y, heights.y, atol=1e-9)
        self.assertEqual((read.unit, read.attributes["model"]), ("um", "virtual focus-variation microscope"))

    def test_of_others_as_the_program_reads_them(self):
        data = "".join(f"<Datum>{z}</Datum>" for z in ("100", "200", "0;0;-300", "", "500", "600"))
        files = {
            "I": write_x3p("i.x3p", "I", "<i2"),
            "L": write_x3p("l.x3p", "L", "<i4", folder="packed/"),
            "F": write_x3p("f.x3p", "F", "<f4"),
            "D": write_x3p("d.x3p", "D", "<f8", valid=bytes([0b110111])),
            "list": write_x3p("list.x3p", "D", "<f8", listed=f"<DataList>{data}</DataList>"),
        }
        for kind, file in files.items():
            read = vkfv.read_x3p(file)
            expected = 0.5 + numpy.array([[100, 200, -300], [400, 500, 600]]) / 1000
            if kind in ("D", "list"):
                expected[1, 0] = numpy.nan
            numpy.testing.assert_allclose(read.values, expected, atol=1e-7, err_msg=kind)
            numpy.testing.assert_allclose(read.x, [10, 12, 14])
            numpy.testing.assert_allclose(read.y, [-37, -40])
            self.assertEqual(
                read.attributes,
                {"creator": "me", "date": "2024-01-01T00:00:00Z", "model": "M", "serial": "1", "version": "2"},
            )
        # The program's own reader has the same heights in the same rows.
        out = shared.folder() / "converted.csv"
        command = [vkfv.find_program(), "surface", files["I"], "--form", "none", "--out", out, "--quiet"]
        subprocess.run(command, check=True, capture_output=True)
        numpy.testing.assert_allclose(
            numpy.genfromtxt(out, delimiter=",", comments="#"), vkfv.read_x3p(files["I"]).values, atol=1e-7
        )

    def test_damage_is_told(self):
        file = shared.folder() / "damaged.x3p"
        with zipfile.ZipFile(write_x3p("whole.x3p", "I", "<i2")) as whole, zipfile.ZipFile(file, "w") as damaged:
            damaged.writestr("main.xml", whole.read("main.xml"))
            damaged.writestr("bindata/data.bin", bytes(12))
        with self.assertRaisesRegex(ValueError, "MD5"):
            vkfv.read_x3p(file)
        with self.assertWarnsRegex(UserWarning, "MD5"):
            self.assertEqual(vkfv.read_x3p(file, accept_checksum=True).values.shape, (2, 3))
        with zipfile.ZipFile(file, "w") as other:
            other.writestr("readme", "no surface")
        with self.assertRaisesRegex(ValueError, "no main.xml"):
            vkfv.read_x3p(file)

    def test_a_file_cut_or_changed_anywhere_is_refused_as_a_value(self):
        whole = write_x3p("whole.x3p", "D", "<f8", valid=bytes([0b110111])).read_bytes()
        file = shared.folder() / "hurt.x3p"
        cut = [whole[:length] for length in range(0, len(whole), 41)]
        changed = [whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1 :] for at in range(0, len(whole), 3)]
        for content in [b"no archive", *cut, *changed]:
            file.write_bytes(content)
            try:
                vkfv.read_x3p(file)  # a changed byte may be one that no reader looks at
                self.assertIn(content, changed)
            except ValueError:
                pass

    def test_every_checksum_is_held_to(self):
        whole = write_x3p("whole.x3p", "D", "<f8", valid=bytes([0b110111]))
        with zipfile.ZipFile(whole) as archive:
            entries = {name: archive.read(name) for name in archive.namelist()}
        digest = hashlib.md5(entries["main.xml"]).hexdigest()
        file = shared.folder() / "changed.x3p"

        def read(changed, **options):
            with zipfile.ZipFile(file, "w") as archive:
                for name, content in {**entries, **changed}.items():
                    archive.writestr(name, content)
            return vkfv.read_x3p(file, **options)

        good = {"md5checksum.hex": f"{digest} *main.xml\n"}
        self.assertEqual(read(good).values.shape, (2, 3))
        pitch = entries["main.xml"].decode().replace("2e-6", "3e-6", 1).encode()
        self.assertNotEqual(pitch, entries["main.xml"])
        for name, content in {"main.xml": pitch, "bindata/data.bin": bytes(48)}.items():
            with self.subTest(name), self.assertRaisesRegex(ValueError, f"{name} does not have the MD5"):
                read({**good, name: content})
            with self.assertWarnsRegex(UserWarning, "MD5"):
                read({**good, name: content}, accept_checksum=True)

    def test_what_unpacks_to_more_is_refused(self):
        file = shared.folder() / "large.x3p"
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("main.xml", "<a>" + " " * (17 << 20) + "</a>")
        with self.assertRaisesRegex(ValueError, "longer than"):
            vkfv.read_x3p(file)
        text = main_xml("D", bytes(48), "", "").replace("<SizeX>3<", "<SizeX>20000<").replace("<SizeY>2<", "<SizeY>10000<")
        with zipfile.ZipFile(file, "w") as archive:
            archive.writestr("main.xml", text)
            archive.writestr("bindata/data.bin", bytes(48))
        with self.assertRaisesRegex(ValueError, "more than a file of its size holds"):
            vkfv.read_x3p(file)
        with zipfile.ZipFile(file, "w") as archive:
            archive.writestr("main.xml", text.replace("20000", "200000"))
        with self.assertRaisesRegex(ValueError, "at most"):
            vkfv.read_x3p(file)

    def test_valid_points_may_be_a_byte_each(self):
        with self.assertWarnsRegex(UserWarning, "a byte for each point"):
            read = vkfv.read_x3p(write_x3p("bytes.x3p", "D", "<f8", valid=bytes([1, 1, 1, 0, 1, 1])))
        self.assertTrue(numpy.isnan(read.values[1, 0]))
        self.assertEqual(numpy.isnan(read.values).sum(), 1)


if __name__ == "__main__":
    unittest.main()
