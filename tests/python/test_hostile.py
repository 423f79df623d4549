"""The program among unlucky circumstances: limits, closed descriptors, names that a terminal would obey."""

import concurrent.futures
import csv
import ctypes
import hashlib
import json
import os
import resource
import select
import subprocess
import tempfile
import time
import unittest
import xml.dom.minidom
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


def obey_permissions():
    """Root reads and writes what it likes, unless these two capabilities are gone."""
    drop_capability, override, read_search = 24, 1, 2
    for capability in (override, read_search):
        ctypes.CDLL(None).prctl(drop_capability, capability, 0, 0, 0)


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
        """Messages go into no file that is opened while the descriptor of standard output or error is closed."""
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

    def test_names_command_nothing_in_what_is_written(self):
        """Output and files of every kind are safe to show, and JSON and SVG stay valid, whatever a file is called."""
        name = os.fsdecode(b"e\x1b[31m\nx,\"<&>\x9b\xc2\x9b\xff")
        surface = shared.folder() / (name + ".x3p")
        surface.write_bytes((shared.tilted().folder / "topography.x3p").read_bytes())
        configuration = shared.folder() / (name + ".toml")
        configuration.write_bytes(shared.configuration().read_bytes())
        out = shared.folder() / "named"
        commands = (
            ("surface", surface, "--json"),
            ("surface", surface),
            ("compare", surface, surface, "--json", "--out", out),
            ("compare", surface, surface),
            ("check", configuration, "--json"),
            ("check", configuration),
            ("layout", configuration, shared.folder() / "named.svg"),
            ("image", configuration, "--z", "0", "--rays", "1e3", "--device", "host", "--json", "--out", "named.tif"),
            ("verify", surface),
        )
        for command in commands:
            done = run(*command)
            self.assertNotIn(b"unexpected failure", done.stderr, command)
            self.assertEqual(done.returncode, 2 if command[0] == "verify" else 0, (command, done.stderr))
            for said in (done.stdout, done.stderr):
                self.assertEqual(said.translate(None, b"\n\t"), bytes(c for c in said if c >= 32 and c != 127), command)
                self.assertNotIn("\x9b", said.decode("utf-8"), command)
            if "--json" in command:
                json.loads(done.stdout)
        json.loads((out / "compare.json").read_text(encoding="utf-8"))
        for file in (shared.folder() / "named.svg", out / "compare.svg"):
            xml.dom.minidom.parse(str(file))

    def test_a_label_stays_in_its_cell_and_its_folder(self):
        text = shared.configuration().read_text(encoding="utf-8")
        file = shared.folder() / "labelled.toml"
        file.write_text(text + '\n[sweep]\n[[sweep.parameter]]\nkey = "trace.seed"\nlabel = "a, \\"b\\" | c"\nvalues = [1, 2]\n',
                        encoding="utf-8")
        done = run("sweep", file, "--device", "host", "--rays", "1e3", "--out", "labelled")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = list(csv.reader((shared.folder() / "labelled" / "sweep.csv").read_text(encoding="utf-8").splitlines()))
        self.assertEqual(rows[0][0], 'a, "b" | c')
        self.assertEqual([row[0] for row in rows[1:]], ["1", "2"])

    def test_signals_are_told(self):
        """A signal is sent once the program traces: its folder then has the configuration."""
        for number, name in ((12, "SIGUSR2"), (24, "SIGXCPU"), (3, "SIGQUIT"), (26, "SIGVTALRM"), (5, "SIGTRAP")):
            process = subprocess.Popen(
                [vkfv.find_program(), "stack", shared.configuration(), "--rays", "9e7", "--out", str(shared.folder() / name)],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                cwd=shared.folder(),
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0)),
            )
            end = time.monotonic() + 60
            while not (shared.folder() / name / "stack.toml").exists() and time.monotonic() < end:
                self.assertIsNone(process.poll())
                time.sleep(0.01)
            process.send_signal(number)
            _, said = process.communicate(timeout=60)
            self.assertEqual(process.returncode, -number, said)
            self.assertIn(f"ended by {name}".encode(), said)

    def test_a_surface_without_any_deviation_is_compared(self):
        surface = shared.tilted().folder / "topography.x3p"
        done = run("compare", surface, surface, "--out", shared.folder() / "same")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(Path(shared.folder() / "same" / "compare.svg").exists())

    def test_lengths_are_those_that_something_has(self):
        for setting in ("detector.pixel_um=1e-310", "objective.focal_length_mm=1e12", "scan.z_stop_um=1e300"):
            done = run("check", shared.configuration(), "--set", setting)
            self.assertEqual(done.returncode, 2, (setting, done.stderr))
            self.assertIn(b"(1 pm)", done.stderr)

    def test_a_folder_whose_name_is_no_text(self):
        done = run("stack", shared.configuration(), "--out", os.fsdecode(b"bytes\xff"), "--rays", "1e3")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"UTF-8", done.stderr)

    def test_permissions_are_told_as_such(self):
        surface = shared.tilted().folder / "topography.x3p"
        closed = shared.folder() / "closed"
        closed.mkdir()
        closed.chmod(0o555)
        hidden = shared.folder() / "hidden"
        hidden.mkdir()
        (hidden / "c.toml").write_bytes(shared.configuration().read_bytes())
        hidden.chmod(0)
        try:
            for command, code in (
                (("surface", surface, "--out", closed / "s.csv"), 4),
                (("stack", shared.configuration(), "--rays", "1e3", "--out", closed / "below" / "stack"), 4),
                (("stack", shared.configuration(), "--rays", "1e3", "--out", closed / "stack"), 4),
                (("image", shared.configuration(), "--z", "0", "--rays", "1e3", "--out", closed / "i.tif"), 4),
                (("check", hidden / "c.toml"), 2),
                (("surface", hidden / "s.x3p"), 2),
                (("verify", hidden), 4),
            ):
                done = run(*command, before=obey_permissions)
                self.assertEqual(done.returncode, code, (command, done.stderr))
                self.assertIn(b"Permission denied", done.stderr, command)
                self.assertNotIn(b"install vkfv again", done.stderr, command)
        finally:
            closed.chmod(0o755)
            hidden.chmod(0o755)

    def test_a_link_to_another_file_is_not_emptied(self):
        precious = shared.folder() / "precious.txt"
        precious.write_text("kept", encoding="utf-8")
        (shared.folder() / ".linked.csv.part").hardlink_to(precious)
        done = run("surface", shared.tilted().folder / "topography.x3p", "--out", "linked.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(precious.read_text(encoding="utf-8"), "kept")
        self.assertTrue((shared.folder() / "linked.csv").exists())

    def test_a_cache_of_another_making_is_none(self):
        with tempfile.TemporaryDirectory() as cache:
            first = run("check", shared.configuration(), XDG_CACHE_HOME=cache)
            kept = [file for file in Path(cache).rglob("*") if file.is_file()]
            self.assertTrue(kept)
            mark = b"vkfv cache 3\n"
            for text in (b"[", b"[]", b'{"files": 3}', b'{"text": 1, "json": 2, "files": [[]], "messages": []}'):
                for file in kept:
                    self.assertTrue(file.read_bytes().startswith(mark))
                    file.write_bytes(mark + hashlib.sha256(text).hexdigest().encode() + text)
                again = run("check", shared.configuration(), XDG_CACHE_HOME=cache)
                self.assertEqual((again.returncode, again.stdout), (0, first.stdout), (text, again.stderr))

    def test_a_wrong_command_line_is_told_in_json(self):
        for words in (("stack", "--log-json", "--no-such"), ("nothing", "--log-json")):
            done = run(*words)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(json.loads(done.stderr.splitlines()[-1])["exit_code"], 2)

    def test_a_long_image_is_told_of_and_forecast(self):
        """Nobody sits before a silent program for more than ten seconds. Both commands are waited for at once."""

        def watch(command):
            process = subprocess.Popen(
                [vkfv.find_program(), command[0], shared.configuration(), *command[1:], "--rays", "1e11", "--device",
                 "host", "--log-json", "--set", 'trace.estimator="forward"', "--out", f"long_{command[0]}"],
                stderr=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                cwd=shared.folder(),
            )
            try:
                told, warning = None, None
                end = time.monotonic() + 60
                while (told is None or warning is None) and time.monotonic() < end:
                    before = time.monotonic()
                    self.assertTrue(select.select([process.stderr], [], [], 30)[0])
                    line = json.loads(process.stderr.readline())
                    self.assertLess(time.monotonic() - before, 15)
                    if line.get("event") == "at work" and line.get("share", 0) > 0:
                        told = told or line
                    if "left at this speed" in line.get("text", ""):
                        warning = warning or line
                self.assertIsNotNone(told)
                self.assertGreater(told["seconds_left"], 3600)
                self.assertIsNotNone(warning)
            finally:
                process.kill()
                process.communicate()

        with concurrent.futures.ThreadPoolExecutor() as pool:
            list(pool.map(watch, (("stack",), ("image", "--z", "0"))))  # raises what either raises

    def test_a_stack_whose_configuration_is_changed_meanwhile(self):
        out = shared.folder() / "changed"
        process = subprocess.Popen(
            [vkfv.find_program(), "stack", shared.configuration(), "--device", "host", "--rays", "2e5", "--out", out],
            stderr=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
        )
        while not (out / "images" / "z_0000.tif").exists():
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        (out / "stack.toml").write_text("# overwritten\n", encoding="utf-8")
        _, said = process.communicate(timeout=300)
        self.assertEqual(process.returncode, 0, said)
        self.assertIn(b"was changed while the stack was traced", said)
        self.assertEqual(run("verify", out).returncode, 0)


if __name__ == "__main__":
    unittest.main()
