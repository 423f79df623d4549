"""Whether tools/setup installs every program that a script, a test, a document or the build starts."""

import os
import re
import shutil
import subprocess
import unittest

import programs

# Where Debian's packages have their programs.
PATH = "/usr/sbin:/usr/bin:/sbin:/bin"

# Programs that no package of the table has to give.
OTHERS = {
    "apt": "tools/setup itself needs it, and debootstrap puts it into the smallest root",
    "apt-get": "likewise",
    "scontrol": "tools/slurm/stack.sbatch: Slurm itself starts this file",
    "vkfv": "the program that is built here",
}


def table():
    """Names of the packages that tools/setup installs; None on a system that it does not know."""
    listed = subprocess.run([programs.ROOT / "tools/setup", "--list"], capture_output=True, text=True, check=False)
    return {line.split("/")[0] for line in listed.stdout.split()} if listed.returncode == 0 else None


class Packages:
    """The packages of this machine, as dpkg lists them."""

    def __init__(self, names):
        fields = "${Package}\t${Essential}\t${Priority}\t${Pre-Depends}, ${Depends}\n"
        said = subprocess.run(["dpkg-query", "--show", f"--showformat={fields}"], capture_output=True, text=True, check=True)
        rows = [line.split("\t") for line in said.stdout.splitlines()]
        # A package is given if it is of the smallest root or of the table, or if one of the table needs it
        # (python3-minimal of python3).
        self.given = {name for name, essential, priority, _ in rows if essential == "yes" or priority == "required"} | names
        self.given |= {word.strip().split(":")[0].split(" ")[0] for name, _, _, needs in rows if name in names
                       for word in re.split(r"[,|]", needs) if word.strip()}

    def holders(self, names):
        """For each program the packages that hold it, or what it is a link to; none if it is not installed."""
        paths = {name: ways(shutil.which(name, path=PATH)) for name in names}
        said = subprocess.run(["dpkg", "--search", *sorted(set().union(*paths.values()))], capture_output=True, text=True, check=False)
        held = {}
        for line in said.stdout.splitlines():
            packages, path = line.rsplit(": ", 1)
            if not line.startswith("diversion"):
                held.setdefault(path, set()).update(name.split(":")[0].strip() for name in packages.split(","))
        return {name: set().union(*(held.get(path, set()) for path in paths[name])) for name in names}


def ways(path):
    """Names of a file, and of what it is a link to, under which dpkg may know it."""
    names = set()
    while path:
        # Debian 12 names the files of /bin as they were before it became a link to /usr/bin.
        names |= {path, re.sub("^/usr", "", path), "/usr" + path}
        path = os.path.join(os.path.dirname(path), os.readlink(path)) if os.path.islink(path) else None
    return names


def missing(files, packages):
    """The programs that tools/setup does not install, as "file:line: program: why"."""
    made = programs.targets_of(files)
    starts = {}
    for name, text in files.items():
        for start in programs.of_file(text, name):
            if not start.asked and start.program not in OTHERS and start.program not in made:
                starts.setdefault(start.program, start)
    holders = packages.holders(starts.keys())
    return [f"{starts[name]}: " + (f"of {', '.join(sorted(holders[name]))}" if holders[name] else "not installed here")
            for name in sorted(starts) if not holders[name] & packages.given]


class ProgramsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        names = table()
        if names is None:
            raise unittest.SkipTest("tools/setup does not know this system")
        cls.names = names
        cls.packages = Packages(names)

    def test_setup_installs_what_is_started(self):
        files = programs.tracked()
        self.assertIn("tools/test", files)
        self.assertEqual(missing(files, self.packages), [], "name their packages in tools/setup, or ask for them first (programs.py)")

    def test_a_program_that_the_table_lacks_is_found(self):
        planted = {
            "tools/script": '#!/usr/bin/env bash\nif true; then\n  step "a title" no_such_one --option | grep x\nfi\n',
            "tools/nested": "#!/bin/sh\nfind . -print0 | xargs -0 -n 2 no_such_two\nsh -c 'cd / && no_such_three'\n",
            "tools/study.py": 'import subprocess\nsubprocess.run(["no_such_four", "--option"], check=True)\n',
            "tests/room/a_test.cpp": 'const std::string command =\n    "cd \'" + folder + "\' && no_such_five " VKFV_SOURCE_DIR "/x";\n'
                                     'std::system(command.c_str());\nshell(folder, fmt::format("no_such_six \'{}\'", file));\n',
            "tests/CMakeLists.txt": "find_program(SIX NAMES no-such-seven REQUIRED)\nadd_custom_command(OUTPUT x COMMAND no-such-eight x)\n",
            "docs/page.md": "```\nvkfv man | no_such_nine -l -\n```\n",
        }
        self.assertEqual([line.split(": ")[:2] for line in missing(planted, self.packages)], [
            ["tests/CMakeLists.txt:2", "no-such-eight"], ["tests/CMakeLists.txt:1", "no-such-seven"],
            ["tests/room/a_test.cpp:3", "no_such_five"], ["tools/study.py:2", "no_such_four"],
            ["docs/page.md:2", "no_such_nine"], ["tools/script:3", "no_such_one"], ["tests/room/a_test.cpp:4", "no_such_six"],
            ["tools/nested:3", "no_such_three"], ["tools/nested:2", "no_such_two"],
        ])

    def test_what_is_no_program_is_left_out(self):
        planted = {
            "tools/script": "#!/usr/bin/env bash\nown() { echo no_such; }\nown | while read -r no_such; do [[ $no_such ]]; done\n"
                            "tools/other no_such\n$program no_such # no_such\n",
            "tools/asks": "#!/usr/bin/env bash\nif ! command -v no_such >/dev/null; then exit 2; fi\nno_such\n",
            "tools/needs": "#!/usr/bin/env bash\nneeds package no_such no_such_either\nno_such_either\n",
            "tools/study.py": 'import shutil, subprocess\nif shutil.which("no_such"):\n    subprocess.run(["no_such"])\n',
            "tests/CMakeLists.txt": "find_program(NO no_such)\nadd_executable(built x.cpp)\nadd_test(NAME A COMMAND built)\n",
            "docs/page.md": "```text\nno_such\n```\nno_such `no_such`\n",
        }
        self.assertEqual(missing(planted, self.packages), [])

    def test_a_package_that_is_taken_from_the_table_is_found(self):
        without = Packages(self.names - {"man-db"})
        self.assertEqual([line.split(": ")[1] for line in missing(programs.tracked(), without) if "man-db" in line], ["man"])


if __name__ == "__main__":
    unittest.main()
