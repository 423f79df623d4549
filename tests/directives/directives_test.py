#!/usr/bin/env python3
"""Whether the build refuses a misspelt directive (shaders/directives.cmake) of a scatter model or a kind of specimen.

A project without languages is configured: it generates from copies of the files. Spellings are tried by the function alone,
in a script, which starts sooner.
"""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODELS = pathlib.Path("shaders/physics/scatter")
KINDS = pathlib.Path("src/specimen/kinds")
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(directives LANGUAGES NONE)
set(CMAKE_CURRENT_SOURCE_DIR ${PROJECT_SOURCE_DIR}/shaders)
include(shaders/scatter_models.cmake)
vkfv_scatter_models(${PROJECT_BINARY_DIR})
set(CMAKE_CURRENT_SOURCE_DIR ${PROJECT_SOURCE_DIR}/src/specimen)
include(src/specimen/kinds.cmake)
vkfv_specimen_kinds(${PROJECT_BINARY_DIR})
"""


class Directives(unittest.TestCase):
    def configured(self, file=None, old="", new=""):
        """Replaces `old` with `new` in a copy of the sources; returns CMake's output and the registry, empty if CMake failed."""
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder)
            shutil.copytree(ROOT / "shaders", copy / "shaders")
            shutil.copytree(ROOT / "src/specimen", copy / "src/specimen")
            (copy / "CMakeLists.txt").write_text(PROJECT)
            if file:
                text = (copy / file).read_text()
                self.assertIn(old, text)
                (copy / file).write_text(text.replace(old, new, 1))
            run = subprocess.run(["cmake", "-S", copy, "-B", copy / "build"], capture_output=True, text=True)
            registry = copy / "build/physics/scatter_registry.hpp"
            # CMake breaks the lines of its messages where it likes.
            return " ".join(run.stderr.split()), registry.read_text() if run.returncode == 0 else ""

    def refused(self, file, old, new):
        said, registry = self.configured(file, old, new)
        self.assertEqual(registry, "", f"accepted: {new!r}")
        return said

    def read(self, text):
        """The output of the function for a file of this text, and the directives that it found: empty if it refuses the file."""
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "model.glsl"
            file.write_text(text)
            script = pathlib.Path(folder) / "read.cmake"
            script.write_text(f"""cmake_minimum_required(VERSION 3.25)
include({ROOT / "shaders/directives.cmake"})
vkfv_directives(says {file} FLAGS lossy cone VALUES place LISTS parameter)
message(STATUS "${{says_lossy}} ${{says_cone}} (${{says_place}}) (${{says_parameter}})")
""")
            run = subprocess.run(["cmake", "-P", script], capture_output=True, text=True)
            return " ".join(run.stderr.split()), run.stdout.strip()

    def test_files_as_they_are_are_accepted(self):
        said, registry = self.configured()
        self.assertEqual(said, "")
        self.assertIn('{"ggx", ggx_parameters, false, true}', registry)
        self.assertIn('{"mirror", mirror_parameters, true, false}', registry)

    def test_a_misspelt_flag_is_refused_with_its_place_and_the_known_ones(self):
        line = (ROOT / MODELS / "ggx.glsl").read_text().splitlines().index("// lossy") + 1
        said = self.refused(MODELS / "ggx.glsl", "// lossy\n", "// lossly\n")
        self.assertIn(f'ggx.glsl:{line}: "// lossly"', said)
        for known in ("// delta", "// lossy", "// table", "// ceiling", "// cone", "// parameter: ..."):
            self.assertIn(f'"{known}"', said)

    def test_a_misspelt_place_of_a_kind_is_refused(self):
        said = self.refused(KINDS / "sphere.hpp", "// place: 3", "// plaice: 3")
        self.assertIn('sphere.hpp:1: "// plaice: 3"', said)
        self.assertIn('"// place: ..."', said)

    def test_directives_are_found(self):
        said, found = self.read("// Prose.\n// parameter: a, 1\n// lossy\n// parameter: b, 2\n// place: 4\n\n// lossy prose\nint x;\n")
        self.assertEqual((said, found), ("", "-- true false (4) (a, 1;b, 2)"))

    def test_wrong_spellings_are_refused(self):
        for wrong in ("//lossy", "// Lossy", "// lossy ", "// lossy.", "// lossy: yes", "// lossy, cone", "// lossy\n// lossy", "// losy",
                      "// paramter: a", "// parameter a", "// Parameter: a", "// parameter = a", "// parameter:", "// place 3",
                      "// place: 3\n// place: 4", "// Prose.\n\n// lossy", "#pragma once\n// place: 3"):
            with self.subTest(wrong):
                said, found = self.read(wrong + "\n")
                self.assertEqual(found, "")
                self.assertIn("model.glsl:", said)

    def test_prose_is_no_directive(self):
        for prose in ("// A lossy model, as it were: masking.", "//   f = D(m) / 4", "// Reciprocal: f(i, o) = f(o, i).", "// placeholders are none", "// Lossless."):
            with self.subTest(prose):
                self.assertEqual(self.read(prose + "\n"), ("", "-- false false () ()"))


if __name__ == "__main__":
    unittest.main()
