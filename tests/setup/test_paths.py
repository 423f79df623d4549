"""Whether every file of tools, tests and elsewhere that a document or a comment names is there."""

import re
import unittest

import programs

# A path that starts at the top of the repository and is not a part of another one.
PATH = re.compile(r"(?<![\w/.$}-])(?:tools|tests|shaders|src)/[\w./*-]*\w(?![*{\w]|/[*A-Z$])")
# Words in capitals stand for what a reader puts in.
STANDS_FOR = re.compile(r"(^|[/_.])[A-Z]{4,}")


def broken(text, name):
    """Paths that lead nowhere, as "file:line: path". Sources may be named without .hpp and .cpp."""
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        for path in PATH.findall(line):
            if "*" in path or STANDS_FOR.search(path):
                continue
            if not any((programs.ROOT / (path + ending)).exists() for ending in ("", ".hpp", ".glsl", "_test.cpp")):
                found.append(f"{name}:{number}: {path}")
    return found


def named_in():
    """Documents, and the files beside what they name."""
    for name, text in programs.tracked(changelog=True).items():
        # Tests of these tests hold paths that are nowhere.
        if name.endswith(".md") or re.match("(tools|tests)/", name) and not name.startswith(("tests/setup/", "tests/evidence/")):
            yield name, text


class PathsTest(unittest.TestCase):
    def test_every_path_leads_somewhere(self):
        self.assertEqual([line for name, text in named_in() for line in broken(text, name)], [])

    def test_a_path_that_leads_nowhere_is_found(self):
        self.assertEqual(broken("a\n`tools/test` and `tools/tset --fast`, tools/studies/NAME, tests/fuzz/*.cpp\n", "a.md"), ["a.md:2: tools/tset"])

    def test_every_study_is_named_by_a_document(self):
        documents = "".join(text for name, text in named_in() if name.endswith(".md") and name != "CHANGELOG.md")
        for study in sorted((programs.ROOT / "tools/studies").iterdir()):
            if study.is_file():
                self.assertIn(f"tools/studies/{study.name}", documents)


if __name__ == "__main__":
    unittest.main()
