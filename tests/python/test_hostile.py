"""The program among unlucky circumstances: limits, closed descriptors, names that a terminal would obey."""

import os
import resource
import subprocess
import tempfile
import unittest
from pathlib import Path

import shared
from shared import vkfv


def run(*arguments, before=None, **environment):
    return subprocess.run(
        [vkfv.find_program(), *map(str, arguments)],
        cwd=shared.folder(),
        capture_output=True,
        preexec_fn=before,
        timeout=120,
        env={**os.environ, **environment},
        check=False,
    )


class HostileTest(unittest.TestCase):
    def test_a_limit_of_file_sizes_ends_no_check(self):
        """The cache is an option, and one that cannot be written is none."""

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512))

        with tempfile.TemporaryDirectory() as cache:
            done = run("check", shared.configuration(), before=limit, XDG_CACHE_HOME=cache)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"magnification", done.stdout)

    def test_a_limit_of_file_sizes_is_told_where_the_file_is_wanted(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512))

        surface = shared.tilted().folder / "topography.x3p"
        out = shared.folder() / "limited.csv"
        done = run("surface", surface, "--out", out, before=limit)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn(b"limited.csv", done.stderr)

    def test_closed_descriptors_are_not_taken(self):
        """What the program says goes into no file, though its number is free."""
        surface = shared.tilted().folder / "topography.x3p"
        for closed in ((2,), (1, 2), (0, 1, 2)):
            out = shared.folder() / "closed.csv"

            def close(descriptors=closed):
                for descriptor in descriptors:
                    os.close(descriptor)

            run("surface", surface, "--form", "plane", "--out", out, before=close)
            text = out.read_bytes()
            self.assertTrue(text.startswith(b"# vkfv heights in um"), text[:100])
            self.assertNotIn(b"warning", text)
            out.unlink()

    def test_names_do_not_command_the_terminal(self):
        for name in ("\x1b[31mred.toml", "bell\x07.toml", "two\rlines.toml"):
            done = run("check", name)
            self.assertEqual(done.returncode, 2)
            for character in "\x1b\x07\r":
                self.assertNotIn(character.encode(), done.stderr)
            self.assertIn(b"\\x", done.stderr)

    def test_signals_are_told(self):
        for number, name in ((12, "SIGUSR2"), (24, "SIGXCPU"), (3, "SIGQUIT")):
            process = subprocess.Popen(
                [vkfv.find_program(), "stack", shared.configuration(), "--rays", "1e9", "--out", str(shared.folder() / name)],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                cwd=shared.folder(),
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0)),
            )
            try:
                process.communicate(timeout=3)
            except subprocess.TimeoutExpired:
                process.send_signal(number)
            _, said = process.communicate(timeout=60)
            self.assertEqual(process.returncode, -number, said)
            self.assertIn(f"ended by {name}".encode(), said)

    def test_a_surface_without_any_deviation_is_compared(self):
        surface = shared.tilted().folder / "topography.x3p"
        done = run("compare", surface, surface, "--out", shared.folder() / "same")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(Path(shared.folder() / "same" / "compare.svg").exists())


if __name__ == "__main__":
    unittest.main()
