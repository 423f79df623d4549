#!/usr/bin/python3
"""Every figure, table and picture that a page of docs/evidence states is that of its record, and all pages are short. Runs no program.

Each comparison has a wrong twin, which it must reject: a page with one digit changed, a record made older, a picture of other bytes.
Records that are older than what they depend on are listed at the end; they fail nothing.
"""

import copy
import importlib.machinery
import importlib.util
import json
import re
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tools"))

import evidence_pages  # noqa: E402
from evidence_pages import COMMENT, Page, essence, read_back, shown  # noqa: E402

loader = importlib.machinery.SourceFileLoader("evidence", str(SOURCE / "tools" / "evidence"))
evidence = importlib.util.module_from_spec(importlib.util.spec_from_loader("evidence", loader))
loader.exec_module(evidence)

PAGES = {name: Page(name) for name in evidence_pages.page_names()}


def changed_digit(text, at):
    """The text with the first digit from `at` on changed."""
    digit = re.compile(r"\d").search(text, at)
    return text[:digit.start()] + str((int(digit[0]) + 1) % 10) + text[digit.end():]


class PagesTest(unittest.TestCase):
    def test_pages_state_what_their_records_say(self):
        for name, page in PAGES.items():
            with self.subTest(page=name):
                self.assertEqual(page.problems(), [])

    def test_writing_changes_nothing(self):
        for name, page in PAGES.items():
            with self.subTest(page=name):
                self.assertEqual(page.written(), page.text)

    def test_a_changed_digit_behind_any_comment_is_found_and_mended(self):
        for name, page in PAGES.items():
            for place in COMMENT.finditer(page.text):
                with self.subTest(page=name, figure=place[1]):
                    twin = copy.copy(page)
                    twin.text = changed_digit(page.text, place.end())
                    found = twin.place_problems()
                    self.assertEqual(len(found), 1)
                    self.assertIn(place[1], found[0])
                    self.assertEqual(twin.written(), page.text)

    def test_a_further_digit_is_found(self):
        page = PAGES["tutorial"]
        text = page.figure_text("piece.measured")
        twin = copy.copy(page)
        twin.text = page.text.replace(f"-->{text}", f"-->{text}7")
        self.assertEqual(len(twin.place_problems()), 1)

    def test_a_changed_record_is_found(self):
        twin = copy.copy(PAGES["camera"])
        twin.records = copy.deepcopy(twin.records)
        twin.records["clip"]["tables"]["levels"]["rows"][0][0] += 1
        self.assertEqual(len(twin.place_problems()), 1)

    def test_comments_that_nothing_declares_and_figures_without_a_place_are_found(self):
        page = PAGES["tutorial"]
        twin = copy.copy(page)
        twin.text = page.text.replace("evidence: piece.step", "evidence: piece.steq")
        problems = "\n".join(twin.place_problems())
        self.assertIn("piece.steq: not declared", problems)
        self.assertIn("piece.step: the page does not state it", problems)

    def test_a_comment_that_begins_a_line_of_text_is_refused(self):
        page = PAGES["tutorial"]
        twin = copy.copy(page)
        twin.text = page.text.replace(" <!-- evidence: piece.step", "\n<!-- evidence: piece.step")
        self.assertIn("must not begin a line", twin.place_problems()[0])

    def test_runs_and_records_must_be_of_each_other(self):
        twin = copy.copy(PAGES["tutorial"])
        twin.records = {**twin.records, "other": twin.records["piece"]}
        self.assertIn("other: a record that the list does not declare", twin.problems())
        twin.records = {name: record for name, record in PAGES["tutorial"].records.items() if name != "piece"}
        self.assertIn("piece: no record", twin.problems())

    def test_commands_name_files_that_exist(self):
        twin = copy.copy(PAGES["tutorial"])
        twin.runs = copy.deepcopy(twin.runs)
        twin.runs["repeats"]["command"] = "tools/step_heigth --paths 256"
        self.assertIn("repeats: tools/step_heigth: no such file", twin.problems())


class CopyTest(unittest.TestCase):
    """With a copy of what one page needs, whose files can be changed."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="vkfv_evidence_test_")
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        for name in ("docs/evidence", "shaders", "tools", "src/topography", "assets"):
            (self.root / name).mkdir(parents=True)
        (self.root / "shaders" / "a.comp").write_text("void main() { x = 1; } // one\n")
        (self.root / "src/topography" / "b.cpp").write_text('#include "b.hpp"\nint b = 2;\n')
        (self.root / "tools" / "study").write_text("#!/bin/sh\n# prints\necho step 9.68\n")
        (self.root / "assets" / "chart.svg").write_text("<svg/>")
        (self.root / "docs/evidence/page.toml").write_text(
            '[study]\ncommand = "tools/study"\ndevice = "any"\nminutes = 1\ndepends = ["kernels", "evaluation"]\n'
            '[study.figures]\nstep = { regex = "step (.*)", unit = "um", format = "{:.2f}" }\n'
            'double = { formula = "2 * step", format = "{:.1f}" }\n'
            '[study.pictures]\n"assets/chart.svg" = "chart.svg"\n')
        (self.root / "docs/page.md").write_text(
            "# Page\n<!-- evidence: programs -->\n*...*\n\nIt is <!-- evidence: study.step -->9.68 um, twice "
            "<!-- evidence: study.double -->19.4. ![](../assets/chart.svg)\n")
        self.page = Page("page", self.root)
        self.page.records = {"study": {
            "how": evidence_pages.RUN, "command": "tools/study", "program": "vkfv 1", "device": "none", "date": "2026-11-27",
            "depends_on": self.digests(), "figures": {"step": {"value": 9.68, "unit": "um"}},
            "pictures": {"assets/chart.svg": evidence_pages.digest_of_picture(self.root / "assets/chart.svg")}}}
        self.page.text = self.page.written()

    def digests(self):
        evidence_pages.digest_of.cache_clear()
        return evidence_pages.digests(self.page.runs["study"], self.root)

    def stale(self):
        evidence_pages.digest_of.cache_clear()
        return list(self.page.stale())

    def test_a_record_as_new_as_what_it_depends_on_is_not_listed(self):
        self.assertEqual(self.page.problems(), [])
        self.assertEqual(self.stale(), [])

    def test_a_record_older_than_a_kernel_an_evaluation_or_its_script_is_listed(self):
        for file, text, name in (("shaders/a.comp", "void main() { x = 2; }", "kernels"),
                                 ("src/topography/b.cpp", "int b = 3;", "evaluation"),
                                 ("tools/study", "echo step 9.69", "files of the command")):
            with self.subTest(file=file):
                before = (self.root / file).read_text()
                (self.root / file).write_text(text)
                self.assertEqual(self.stale(), [("study", f"changed since: {name}")])
                (self.root / file).write_text(before)

    def test_comments_and_moves_make_no_record_older(self):
        (self.root / "shaders" / "a.comp").unlink()
        (self.root / "shaders" / "moved").mkdir()
        (self.root / "shaders/moved/c.comp").write_text("// Says one.\nvoid main() {\n    x = 1;\n}\n")
        (self.root / "src/topography/b.cpp").write_text('#include "other/b.hpp"\nint b = 2;\n')
        self.assertEqual(self.stale(), [])

    def test_a_record_of_a_page_and_one_of_another_command_are_listed(self):
        self.page.records["study"]["command"] = "tools/study --quick"
        self.assertEqual(self.stale(), [("study", "the command has changed")])
        self.page.records["study"]["how"] = evidence_pages.FROM_THE_PAGE
        self.assertEqual(self.stale(), [("study", evidence_pages.FROM_THE_PAGE)])

    def test_a_picture_of_other_bytes_is_found(self):
        (self.root / "assets/chart.svg").write_text("<svg> </svg>")
        self.assertEqual(self.page.problems(), ["study: assets/chart.svg is not the picture of the record"])

    def test_a_formula_follows_its_figures(self):
        self.page.records["study"]["figures"]["step"]["value"] = 9.78
        self.assertIn("9.78 um, twice <!-- evidence: study.double -->19.6.", self.page.written())


class NumbersTest(unittest.TestCase):
    def test_what_is_shown_is_read_back(self):
        for values, form, text in ((9.68, "{:.2f}", "9.68"), ([9.68, 0.22], "{:.2f} ± {:.2f}", "9.68 ± 0.22"),
                                   (1.93e11, "{:.3g}", "1.93E11"), (7.5e-5, "{:.2g}", "7.5E-5"), (-0.0, "{:+.1f}", "-0.0"),
                                   ([14, 14], "{:.0f} x {:.0f}", "14 x 14"), (None, "{:.2f}", ""),
                                   ([3.5], "{:.1f} ({:.1f})|{:.1f}", "3.5"), ([3.5, 2.0], "{:.1f} ({:.1f})|{:.1f}", "3.5 (2.0)")):
            with self.subTest(text=text):
                self.assertEqual(shown(values, form), text)
                back = read_back(text, form)
                self.assertEqual(back, values[0] if isinstance(values, list) and len(values) == 1 else values)

    def test_another_form_is_refused(self):
        with self.assertRaises(ValueError):
            read_back("9.68 um", "{:.2f}")

    def test_essence_leaves_code(self):
        self.assertNotEqual(essence("a.cpp", "int a = 1;"), essence("a.cpp", "int a = 2;"))
        self.assertEqual(essence("a.cpp", "#include <b>\nint a /* n */ = 1; // c"), "inta=1;")
        self.assertEqual(essence("tool", "#!/bin/sh\n# c\nx=1 # d\n"), "x=1#d")


class ReadingTest(unittest.TestCase):
    """How tools/evidence reads what a run printed and wrote."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="vkfv_evidence_test_")
        self.addCleanup(folder.cleanup)
        (Path(folder.name) / "results.json").write_text(json.dumps(
            {"share": 0.894, "dimensions": [{"name": "depth", "measured": 1.0}, {"name": "step height", "measured": 9.68, "deviation": 0.22}],
             "stages": {"images": 2.5}, "rows": [{"noise": 0.5}, {"noise": 0.25}], "none": None}))
        (Path(folder.name) / "table.csv").write_text("image,seconds\n0,1.5\n1,2.5\n")
        self.output = evidence.Output(
            "ring: step 9.70 of 10 seeds\ncoaxial: step 9.80 of 9 seeds\n\n| slope | 0 | 30 |\n|---|---|---|\n| ring | **84** | 0.70 ± 0.01, 2e3 |\n\n"
            "| slope | 60 |\n|---|---|\n| ring | 7 |\n", Path(folder.name))

    def read(self, **spec):
        return self.output.values(spec)

    def test_values(self):
        self.assertEqual(self.read(file="results.json", json="share", scale=100), [89.4])
        self.assertEqual(self.read(file="results.json", json=["dimensions.name=height.measured", "dimensions.1.deviation"]), [9.68, 0.22])
        self.assertEqual(self.read(file="results.json", json="stages.image*"), [2.5])
        self.assertEqual(self.read(file="table.csv", column="seconds"), [2.5])
        self.assertEqual(self.read(regex="^coaxial: step (\\S+) of (\\d+)"), [9.8, 9])

    def test_what_is_not_there_is_told(self):
        for spec in ({"file": "other.json", "json": "share"}, {"file": "results.json", "json": "none"}, {"regex": "mixed: (.*)"}, {}):
            with self.subTest(spec=spec), self.assertRaises(evidence.Unreadable):
                self.read(**spec)

    def test_figures_have_their_uncertainty(self):
        declared = {"file": "results.json", "json": ["dimensions.1.measured", "dimensions.1.deviation"], "unit": "um", "format": "{:.2f} ± {:.2f}"}
        self.assertEqual(evidence.read_figure(declared, {"": self.output}), {"value": 9.68, "unit": "um", "uncertainty": 0.22})
        self.assertEqual(evidence.read_figure({**declared, "format": "{} x {}"}, {"": self.output}), {"value": [9.68, 0.22], "unit": "um"})

    def read_table(self, **declared):
        return evidence.read_table({"rows": ["ring"], **declared}, {"": self.output})["rows"]

    def test_tables(self):
        self.assertEqual(self.read_table(printed="slope", format="{:.0f}"), [[84, [0.7, 0.01, 2000]]])
        self.assertEqual(self.read_table(printed="slope", nth=1, format="{:.0f}"), [[7]])
        self.assertEqual(self.read_table(printed="slope", columns=["60"], format="{:.0f}"), [[7]])
        self.assertEqual(self.read_table(head=["", "step", "seeds"], rows=["ring", "coaxial"], regex="^{row}: step (\\S+) of (\\d+)", format="{:.1f}"),
                         [[9.7, 10], [9.8, 9]])
        self.assertEqual(self.read_table(head=["", "step"], regex=["{row}: step (\\S+)"], format="{:.1f}"), [[9.7]])
        self.assertEqual(self.read_table(rows=["a", "b"], keys=["0", "1"], file="results.json", json=["rows.{row}.noise"], scale=[10], format="{:.1f}"),
                         [[5.0], [2.5]])
        self.assertEqual(self.read_table(file="results.json", json=[["none", "none"], "share"], format="{:.1f}"), [[None, 0.894]])

    def test_another_value_and_another_uncertainty_are_told(self):
        run = {"figures": {"step": {"format": "{:.2f} ± {:.2f}", "tolerance": 0.05}}}
        old = {"figures": {"step": {"value": 9.68, "uncertainty": 0.22}}}

        def found(value, uncertainty):
            return list(evidence.differences(run, old, {"figures": {"step": {"value": value, "uncertainty": uncertainty}}}))

        self.assertEqual(found(9.70, 0.25), [])
        self.assertEqual(len(found(9.80, 0.22)), 1)
        self.assertIn("uncertainty", found(9.70, 0.69)[0])

    def test_only_what_the_tolerance_allows_is_as_recorded(self):
        self.assertTrue(evidence.near(9.68, 9.70, {"tolerance": 0.03}, "{:.2f}"))
        self.assertFalse(evidence.near(9.68, 9.72, {"tolerance": 0.03}, "{:.2f}"))
        self.assertTrue(evidence.near(100, 104, {"tolerance": "5 %"}, "{:.0f}"))
        self.assertFalse(evidence.near(100, 106, {"tolerance": "5 %"}, "{:.0f}"))
        self.assertTrue(evidence.near(9.681, 9.684, {}, "{:.2f}"))
        self.assertFalse(evidence.near(9.681, 9.686, {}, "{:.2f}"))
        self.assertFalse(evidence.near(None, 9.68, {"tolerance": 1}, "{:.2f}"))


MOST_WORDS = 28000  # of all pages but these, which programs write from declarations
OF_PROGRAMS = {"commands.md", "configuration.md", "outputs.md"}
MOST_LINES_OF_CHANGELOG = 150


def words_of_pages(folder):
    """The words of all pages that hands write, as `wc -w` counts them; those of notebooks, and pages not yet in git, count too."""
    return sum(len(page.read_text(encoding="utf-8").split()) for page in folder.rglob("*.md")
               if page.relative_to(folder).as_posix() not in OF_PROGRAMS)


class TheDocumentsAreShort(unittest.TestCase):
    def test_pages_have_no_more_words_than_allowed(self):
        words = words_of_pages(SOURCE / "docs")
        self.assertLessEqual(words, MOST_WORDS, "cut docs/*.md and docs/notebooks: CONTRIBUTING.md, section Documents")

    def test_contributing_states_this_limit(self):
        self.assertIn(f"{MOST_WORDS:,} words".replace(",", " "), (SOURCE / "CONTRIBUTING.md").read_text(encoding="utf-8"))

    def test_words_of_every_page_but_the_generated_count(self):
        with tempfile.TemporaryDirectory(prefix="vkfv_evidence_test_") as name:
            folder = Path(name)
            (folder / "notebooks").mkdir()
            for page, text in (("one.md", "# One\n| a | ± |\n"), ("notebooks/two.md", "two words\n"), ("notebooks/outputs.md", "no reference\n"),
                               ("commands.md", "a b c\n"), ("notes.txt", "d e f\n")):
                (folder / page).write_text(text, encoding="utf-8")
            self.assertEqual(words_of_pages(folder), 11)

    def test_the_changelog_has_no_more_lines_than_allowed(self):
        self.assertLessEqual(len((SOURCE / "CHANGELOG.md").read_text(encoding="utf-8").splitlines()), MOST_LINES_OF_CHANGELOG)


def names_of_tests():
    """The beginnings of all names that ctest lists, as the sources tell them: ROOM.SUITE, and whole names of tests that are not of gtest."""
    names = {"fuzz_corpus."}  # a test a reader, from a loop of tests/fuzz/CMakeLists.txt
    for path in (SOURCE / "tests").rglob("CMakeLists.txt"):
        names.update(re.findall(r"add_test\(NAME ([\w./]+)", path.read_text(encoding="utf-8")))
    for path in (SOURCE / "tests").rglob("*.cpp"):
        folders = path.relative_to(SOURCE / "tests").parts[:-1]
        text = path.read_text(encoding="utf-8")
        kinds = {"statistics": f"{folders[0]}_statistics."} if folders[1:] else {}
        room = kinds.get(folders[-1], f"{folders[0]}." if folders[0] != "gwyddion" else "")
        prefixes = {suite: prefix for prefix, suite in re.findall(r"INSTANTIATE_TEST_SUITE_P\(\s*(\w+),\s*(\w+)", text)}
        for kind, suite in re.findall(r"^(TEST|TEST_F|TEST_P)\((\w+),", text, re.MULTILINE):
            names.add(f"{room}{prefixes[suite]}/{suite}" if kind == "TEST_P" else f"{room}{suite}")
    return names


def section_of(page, anchor):
    """The text of the page below the heading of this anchor, without the sections beside and above it; None: no such heading."""
    headings = list(re.finditer(r"^(#+) (.*)$", re.sub(r"^```.*?^```", lambda block: re.sub("[^\n]", " ", block[0]), page,
                                                       flags=re.MULTILINE | re.DOTALL), re.MULTILINE))
    for k, heading in enumerate(headings):
        if re.sub(r"[^\w\- ]", "", heading[2].lower()).replace(" ", "-") == anchor:
            end = next((other.start() for other in headings[k + 1:] if len(other[1]) <= len(heading[1])), len(page))
            return page[heading.end():end]
    return None


COMMAND = re.compile(r"(`|^)(vkfv|tools/|tests/|\w+_test )", re.MULTILINE)


class RequirementsTest(unittest.TestCase):
    """docs/requirements.md: every test that it names exists, and every claim has a figure with a record, or a command."""

    @staticmethod
    def problems(text):
        tests, problems, rows = names_of_tests(), [], 0
        claims = text.index("\n## Claims")
        for row in re.finditer(r"^\| .* \|$", text, re.MULTILINE):
            cells = [cell.strip() for cell in row[0].strip("|").split("|")]
            if cells[0] in ("requirement", "claim"):
                continue
            rows += 1
            named, page = cells[-2], cells[-1]
            if named != "all" and not re.fullmatch(r"`[\w./]+`(, `[\w./]+`)*", named):
                problems.append(f"{cells[0]}: names no tests")
            problems += [f"{cells[0]}: no test {name}" for name in re.findall(r"`([^`]+)`", named)
                         if not any(test.startswith(name) for test in tests)]
            links = re.findall(r"\]\(([^)#]+)(?:#([^)]+))?\)", page)
            evident = COMMAND.search(page) is not None
            for file, anchor in links:
                path = SOURCE / "docs" / file
                section = path.read_text(encoding="utf-8") if path.exists() else None
                if section is not None and anchor:
                    section = section_of(section, anchor)
                if section is None:
                    problems.append(f"{cells[0]}: no page or heading {file} {anchor}")
                else:
                    evident = evident or "<!-- evidence: " in section or COMMAND.search(section) is not None
            if not links or (row.start() > claims and not evident):
                problems.append(f"{cells[0]}: no figure with a record, and no command")
        return problems if rows > 20 else [*problems, "fewer rows than the page has had"]

    def setUp(self):
        self.text = (SOURCE / "docs/requirements.md").read_text(encoding="utf-8")

    def test_tests_and_figures_exist(self):
        self.assertEqual(self.problems(self.text), [])

    def test_every_wrong_name_and_link_is_found(self):
        for place in re.finditer(r"`([\w/]+\.[\w/]+|Gwyddion\w*|LensFiles|fuzz_corpus)`", self.text):
            with self.subTest(test=place[1]):
                twin = self.text[:place.end() - 1] + "x" + self.text[place.end() - 1:]
                self.assertEqual(len(self.problems(twin)), 1)
        for place in re.finditer(r"\(([\w.]+\.md#[^)]*)\)", self.text):
            with self.subTest(link=place[1]):
                twin = self.text[:place.end() - 1] + "x" + self.text[place.end() - 1:]
                self.assertIn("no page or heading", self.problems(twin)[0])

    def test_a_claim_without_figure_or_command_is_found(self):
        twin = self.text.replace("[camera](validation.md#the-camera)", "[limits](assessment.md#limits-to-know)")
        self.assertIn("no figure with a record", self.problems(twin)[0])
        self.assertEqual(len(self.problems(self.text.replace("`camera.Camera`, `camera.PhotonTransfer`", "none"))), 1)


def list_older_records():
    older = [f"{name}.{run}: {reason}" for name, page in PAGES.items() for run, reason in page.stale()]
    runs = sum(len(page.runs) for page in PAGES.values())
    print(f"{len(older)} of {runs} records are to be renewed (tools/evidence --write):", *older, sep="\n    ")


if __name__ == "__main__":
    program = unittest.main(exit=False)
    list_older_records()
    sys.exit(not program.result.wasSuccessful())
