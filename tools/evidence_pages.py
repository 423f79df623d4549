"""Pages, their lists of runs and their records: what tools/evidence writes and tests/evidence compares. Runs no program.

docs/evidence/PAGE.toml lists the runs whose figures docs/PAGE.md states; docs/evidence/PAGE.json has the record of each run. In the
page a figure stands behind a comment that readers do not see, a table below one; the page's programs are named below a third:

    the step is <!-- evidence: piece.step -->9.68 ± 0.22 um

    <!-- evidence: lambertian.shares -->
    | slope / degrees | 0 to 15 | 15 to 30 |

    <!-- evidence: programs -->
    *Figures of ...*

CONTRIBUTING.md, section Evidence, explains the keys of a list.
"""

import functools
import hashlib
import json
import re
import string
import textwrap
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs" / "evidence"

RUN = "run by tools/evidence"
FROM_THE_PAGE = "recorded from the page, not run by tools/evidence yet"


# The names that `depends` of a list may use for what a run depends on, and the folders whose files they stand for.
DEPENDENCIES = {
    "kernels": ["shaders"],
    "optics": ["src/optics", "assets/objectives", "assets/tube_lenses", "assets/illuminators"],
    "trace": ["src/trace", "src/specimen"],
    "scan": ["src/scan"],
    "camera": ["src/camera"],
    "evaluation": ["src/topography", "shaders/focus"],
    "surface": ["src/surface", "src/dimensions", "src/statistics"],
    "report": ["src/report"],
    "program": ["src", "shaders"],
}
SOURCES = {".cpp", ".hpp", ".glsl", ".comp", ".cmake", ".txt"}


# --- What a record depends on ---


def essence(name, text):
    """The text without comments, white space and #include lines: rewording or moving a source makes no record older."""
    if Path(name).suffix in SOURCES:
        text = re.sub(r"^\s*#\s*include\b.*$", "", text, flags=re.MULTILINE)
        text = re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)
    else:
        text = re.sub(r"^\s*#.*$", "", text, flags=re.MULTILINE)
    return "".join(text.split())


def digest_of_files(files):
    """The digest of the files' contents. Their names and their order do not matter."""
    parts = sorted(hashlib.sha256(essence(file.name, file.read_text(encoding="utf-8", errors="replace")).encode()).hexdigest()
                   for file in files)
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def files_below(folder):
    return [file for file in folder.rglob("*") if file.is_file() and "__pycache__" not in file.parts]


@functools.cache
def digest_of(name, root=ROOT):
    return digest_of_files([file for folder in DEPENDENCIES[name] for file in files_below(root / folder)])


def files_named(command):
    """The scripts and configurations of this repository that a command names."""
    return sorted(set(re.findall(r"(?<![\w./-])(?:tools|tests|assets)/[\w./-]*\w", command)))


def digests(run, root=ROOT):
    """The digests of all that a run depends on, by name."""
    commands = [run["command"].replace("{each}", each) for each in run.get("each", [""])]
    named = [file for command in commands for file in (root / name for name in files_named(command)) if file.is_file()]
    found = {name: digest_of(name, root) for name in run.get("depends", [])}
    return found | ({"files of the command": digest_of_files(named)} if named else {})


# --- How a number is written, and read back ---


def alternatives(form):
    """A format's alternatives, each with the number of values that it takes."""
    return [(one, sum(field is not None for _, field, _, _ in string.Formatter().parse(one))) for one in form.split("|")]


def shown(values, form):
    """The values as the page states them. values: a number, a text, a list of these, or None for nothing."""
    if values is None:
        return ""
    values = values if isinstance(values, list) else [values]
    for one, count in alternatives(form):
        if count == len(values):
            return re.sub(r"(?<=\d)e([+-])0*(\d)", lambda found: "E" + found[1].strip("+") + found[2], one.format(*values))
    raise ValueError(f"format {form!r} does not take {len(values)} values")


def pattern(form):
    """A regular expression that matches what one alternative of a format can write."""
    parts = []
    for literal, field, spec, _ in string.Formatter().parse(form):
        parts.append(re.escape(literal))
        if field is not None:
            parts.append(r"([-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)" if spec else r"(.*?)")
    return "".join(parts)


def number(text):
    """A number where the text is one; without a decimal point, an integer."""
    try:
        return int(text) if re.fullmatch(r"[-+]?\d+", text) else float(text)
    except ValueError:
        return text


def read_back(text, form):
    """The values of a text that a format wrote: shown(), the other way round."""
    if text == "":
        return None
    for one, _ in sorted(alternatives(form), key=lambda each: -each[1]):
        if found := re.fullmatch(pattern(one), text):
            values = [number(group) for group in found.groups()]
            return values[0] if len(values) == 1 else values
    raise ValueError(f"{text!r} is not of the form {form!r}")


def figure_record(values, declared):
    """The record of a figure: with a ± in its format, the last value is the uncertainty."""
    record = {"value": values[0] if len(values) == 1 else values, "unit": declared.get("unit", "")}
    if "±" in declared["format"] and len(values) > 1:
        record |= {"value": values[0] if len(values) == 2 else values[:-1], "uncertainty": values[-1]}
    return record


# --- Pages ---

COMMENT = re.compile(r"<!-- evidence: ([\w.-]+) -->")


class Page:
    """A document, the list of its runs, and their records."""

    def __init__(self, name, root=ROOT):
        self.name, self.root = name, root
        folder = root / "docs" / "evidence"
        self.file, self.records_file = root / "docs" / f"{name}.md", folder / f"{name}.json"
        self.text = self.file.read_text(encoding="utf-8")
        self.runs = tomllib.loads((folder / f"{name}.toml").read_text(encoding="utf-8"))
        self.records = json.loads(self.records_file.read_text(encoding="utf-8")) if self.records_file.exists() else {}

    def entry(self, name, kind):
        """The declaration and the record of RUN.NAME; kind: figures or tables. None for what is not declared or recorded."""
        run, _, own = name.partition(".")
        declared = self.runs.get(run, {}).get(kind, {}).get(own)
        return declared, self.records.get(run, {}).get(kind, {}).get(own)

    def names(self, kind):
        return [f"{name}.{own}" for name, run in self.runs.items() for own in run.get(kind, {})]

    def value(self, name):
        """The value of a figure, without its uncertainty."""
        declared, record = self.entry(name, "figures")
        if declared and "formula" in declared:
            return self.formula(name, declared)
        return record["value"]

    def formula(self, name, declared):
        """A figure that follows from others of its run, by their names; of other runs, RUN.NAME. Tables: NAME[row][column]."""
        run = name.partition(".")[0]
        others = {other: Known(self, other) for other in self.records if other != run}
        return eval(declared["formula"], {"__builtins__": {}, "min": min, "max": max, "round": round}, others | self.known(run))

    def known(self, run):
        """The names that a formula may use of a run: its figures, and its tables without uncertainties."""
        figures = {own: self.value(f"{run}.{own}") for own, other in self.runs[run].get("figures", {}).items() if "formula" not in other}
        return figures | {own: [[cell[0] if isinstance(cell, list) else cell for cell in row] for row in table["rows"]]
                          for own, table in self.records[run].get("tables", {}).items()}

    def figure_text(self, name):
        declared, record = self.entry(name, "figures")
        if "formula" in declared:
            return shown(self.formula(name, declared), declared["format"])
        values = record["value"] if isinstance(record["value"], list) else [record["value"]]
        return shown(values + [record[key] for key in ("uncertainty",) if key in record], declared["format"])

    def table_text(self, name):
        declared, record = self.entry(name, "tables")
        return table_text(declared, record["rows"])

    def programs_text(self):
        """The sentence at the page's head that says where its figures come from."""
        text = (f"*Figures of {days(list(self.records.values()))}. Command, program, device and date of each: "
                f"[evidence/{self.name}.json](evidence/{self.name}.json).*")
        return textwrap.fill(text, 150, break_long_words=False, break_on_hyphens=False) + "\n"

    def problems(self):
        """The disagreements between list, records and page: a line each."""
        found = [f"{name}: no record" for name in self.runs if name not in self.records]
        found += [f"{name}: a record that the list does not declare" for name in self.records if name not in self.runs]
        if found:
            return found
        for name, run in self.runs.items():
            for kind in ("figures", "tables", "pictures"):
                declared = [own for own, entry in run.get(kind, {}).items() if "formula" not in entry]
                recorded = list(self.records[name].get(kind, {}))
                found += [f"{name}.{own}: {'no' if own in declared else 'an undeclared'} record"
                          for own in sorted(set(declared) ^ set(recorded))]
            found += self.picture_problems(name, run)
            for each in run.get("each", [""]):
                found += [f"{name}: {file}: no such file" for file in files_named(run["command"].replace("{each}", each))
                          if not (self.root / file).exists()]
        return found or self.place_problems()

    def picture_problems(self, name, run):
        for picture in run.get("pictures", {}):
            file = self.root / picture
            if not file.exists():
                yield f"{name}: {picture}: no such picture"
            elif digest_of_picture(file) != self.records[name]["pictures"][picture]:
                yield f"{name}: {picture} is not the picture of the record"
            if file.name not in self.text:
                yield f"{name}: {picture}: the page does not show it"

    def place_problems(self):
        """The disagreements in the figures and tables that the page states from a record: a line each."""
        found, seen = [], set()
        for place in COMMENT.finditer(self.text):
            name, line = place[1], self.text.count("\n", 0, place.start()) + 1
            seen.add(name)
            where = f"{self.file.name}:{line}: {name}"
            if is_block(self.text, place):
                stated, expected = block_after(self.text, place), self.expected_block(name)
            elif begins_line(self.text, place):
                found.append(f"{where}: a comment before a figure must not begin a line, where Markdown ends")
                continue
            else:
                expected = self.figure_text(name) if self.entry(name, "figures")[0] else None
                stated = self.text[place.end():place.end() + len(expected or "")]
                if re.match(r"\d|[.,]\d", self.text[place.end() + len(expected or ""):]):
                    stated += "..."
            if expected is None:
                found.append(f"{where}: not declared")
            elif stated != expected:
                found.append(f"{where}: the page states {first_difference(stated, expected)}")
        stated = ["programs", *self.names("figures"), *self.names("tables")]
        return found + [f"{name}: the page does not state it" for name in stated if name not in seen]

    def expected_block(self, name):
        if name == "programs":
            return self.programs_text()
        return self.table_text(name) if self.entry(name, "tables")[0] else None

    def written(self):
        """The page's text with every figure and table of a record written anew."""
        parts, end = [], 0
        for place in COMMENT.finditer(self.text):
            parts.append(self.text[end:place.end()])
            if is_block(self.text, place):
                end = place.end() + 1 + len(block_after(self.text, place))
                parts.append("\n" + (self.expected_block(place[1]) or block_after(self.text, place)))
            else:
                declared, _ = self.entry(place[1], "figures")
                end = place.end()
                if declared:
                    end += len(stated_figure(self.text[end:], declared["format"]) or "")
                    parts.append(self.figure_text(place[1]))
        return "".join(parts) + self.text[end:]

    def stale(self):
        """Names of runs whose records are older than what they depend on, each with the reason."""
        for name, run in self.runs.items():
            record = self.records.get(name)
            if record is None:
                yield name, "no record"
            elif record["how"] != RUN:
                yield name, record["how"]
            elif record["command"] != run["command"].strip():
                yield name, "the command has changed"
            else:
                now = digests(run, self.root)
                changed = [key for key in now if record["depends_on"].get(key) != now[key]]
                if changed:
                    yield name, "changed since: " + ", ".join(changed)


class Known:
    """A run as the formulas of other runs see it: RUN.NAME is its figure or table of this name."""

    def __init__(self, page, run):
        self.page, self.run = page, run

    def __getattr__(self, name):
        return self.page.known(self.run)[name]


def days(records):
    dates = sorted({record["date"] for record in records})
    return dates[0] if len(dates) == 1 else f"{dates[0]} to {dates[-1]}"


def table_text(declared, rows):
    forms = declared["format"]
    lines = [declared["head"], ["---"] * len(declared["head"])]
    for label, cells in zip(declared["rows"], rows, strict=True):
        labels = label if isinstance(label, list) else [label]
        each = forms if isinstance(forms, list) else [forms] * len(cells)
        lines.append([*labels, *(shown(cell, form) for cell, form in zip(cells, each, strict=True))])
    return "".join(row_text(line) for line in lines)


def row_text(cells):
    if set(cells) == {"---"}:
        return "|" + "---|" * len(cells) + "\n"
    return "|" + "".join(f" {cell} |" if cell else " |" for cell in cells) + "\n"


def begins_line(text, place):
    """True where only a list's mark or white space stands before the comment on its line: Markdown takes the line as HTML."""
    return re.fullmatch(r"\s*(?:[-*>]|\d+\.)?\s*", text[text.rfind("\n", 0, place.start()) + 1:place.start()]) is not None


def is_block(text, place):
    """True for a comment that has a line to itself: a table or the page's programs are below it."""
    return begins_line(text, place) and text[place.end():place.end() + 1] == "\n"


def block_after(text, place):
    """The lines below a comment up to the next empty one."""
    return re.match(r"(?:[^\n]+\n)*", text[place.end() + 1:])[0]


def stated_figure(text, form):
    """The figure of this form that a text begins with; None if it begins with none."""
    for one, _ in sorted(alternatives(form), key=lambda each: -each[1]):
        if found := re.match(pattern(one), text):
            return found[0]
    return None


def first_difference(stated, expected):
    """The first line of a table, or the figure, that is not as its record says."""
    for one, other in zip(stated.splitlines() or [""], expected.splitlines()):
        if one != other:
            return f"{one!r}, the record {other!r}"
    return f"{len(stated.splitlines())} lines, the record {len(expected.splitlines())}"


def digest_of_picture(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()[:16]


def page_names(root=ROOT):
    return sorted(file.stem for file in (root / "docs" / "evidence").glob("*.toml"))
