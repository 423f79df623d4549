"""The programs that the files of this repository start: shell scripts and documents by shfmt's syntax tree, Python by its
own, C++ tests and CMake by their string literals.

A program may be missing on a machine if the file that starts it asks for it first (`command -v`, `needs` of tools/steps.bash,
shutil.which, find_program without REQUIRED) and so can say what to do. Programs that a file names by a variable are not seen.
"""

import ast
import dataclasses
import json
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Programs that start the program that their arguments name.
WRAPPERS = {"command", "env", "exec", "nice", "sudo", "time", "timeout", "xargs", "xvfb-run"}
# Functions of our scripts that start a program, with the number of arguments that stand before it.
FUNCTIONS = {"step": 1, "inside": 0, "inside_root": 1}
SHELLS = {"bash", "sh"}
# C++ functions of the tests that start the program which a string names.
RUNNERS = r"(?:std::system|popen|shell|run_script)"


@dataclasses.dataclass(frozen=True)
class Start:
    """A program that a file starts. Asked for: the file copes where it is missing."""

    program: str
    file: str
    line: int
    asked: bool = False

    def __str__(self):
        return f"{self.file}:{self.line}: {self.program}"


def builtins():
    """Names that bash itself knows."""
    said = subprocess.run(["bash", "-c", "compgen -b -k"], capture_output=True, text=True, check=True)
    return set(said.stdout.split())


BUILTINS = builtins()


# Functions of tools/steps.bash and of whatever else scripts read in.
SHARED = {name for path in ROOT.glob("t*/**/*.bash") for name in re.findall(r"(?m)^(\w+)\(\)", path.read_text(encoding="utf-8"))}


def literal(word):
    """The text of a word of shfmt's tree, or None if a part of it is not known before it runs."""
    text = ""
    for part in word.get("Parts") or []:
        if part["Type"] in ("Lit", "SglQuoted"):
            text += part.get("Value", "")
        elif part["Type"] == "DblQuoted":
            inner = literal(part)
            if inner is None:
                return None
            text += inner
        else:
            return None
    return text


def nodes(tree):
    if isinstance(tree, dict):
        yield tree
        tree = tree.values()
    if not isinstance(tree, str) and hasattr(tree, "__iter__"):
        for part in tree:
            yield from nodes(part)


def of_shell(text, file, first_line=1):
    """Programs that a shell script starts. Raises ValueError for a script that shfmt cannot read."""
    parsed = subprocess.run(["shfmt", "--language-dialect", "bash", "--to-json"], input=text, capture_output=True, text=True, check=False)
    if parsed.returncode != 0:
        raise ValueError(f"{file}:{first_line}: {parsed.stderr.strip()}")
    tree = json.loads(parsed.stdout)
    functions = {node["Name"]["Value"] for node in nodes(tree) if node.get("Type") == "FuncDecl"}
    starts = []
    for call in nodes(tree):
        if call.get("Type") != "CallExpr" or not call.get("Args"):
            continue
        words = [literal(word) for word in call["Args"]]
        starts += of_words(words, file, first_line - 1 + call["Pos"]["Line"], functions)
    asked = {start.program for start in starts if start.asked}
    return [dataclasses.replace(start, asked=start.program in asked) for start in starts]


def of_words(words, file, line, functions=frozenset()):
    """Programs that a command of these words starts; None for a word that is not known."""
    program, further = words[0], words[1:]
    if program == "command" and further[:1] in (["-v"], ["-V"]):
        return [Start(name, file, line, asked=True) for name in further[1:] if name]
    if program == "needs":
        return [Start(name, file, line, asked=True) for name in further[1:] if name]
    starts = []
    if program in FUNCTIONS:
        further = further[FUNCTIONS[program]:]
        return of_words(further, file, line, functions) if further else starts
    if program and "/" not in program and program not in functions | SHARED | BUILTINS and re.fullmatch(r"[a-z][\w.+-]*", program):
        starts.append(Start(program, file, line))
    if program in SHELLS and "-c" in further[:-1] and (script := further[further.index("-c") + 1]):
        starts += of_shell(script, file, line)
    elif program in WRAPPERS:
        # Options, their numbers and settings stand before the program.
        while further and (further[0] is None or re.match(r"-|\d+[smh]?$|\w+=", further[0])):
            further = further[1:]
        if further:
            starts += of_words(further, file, line, functions)
    return starts


def of_python(text, file):
    starts = []
    for call in ast.walk(ast.parse(text)):
        if not isinstance(call, ast.Call) or not call.args:
            continue
        function, first = ast.unparse(call.func), call.args[0]
        if re.fullmatch(r"(subprocess\.)?(run|Popen|call|check_call|check_output)", function) and isinstance(first, ast.List):
            words = [word.value if isinstance(word, ast.Constant) and isinstance(word.value, str) else None for word in first.elts]
            starts += of_words(words, file, call.lineno) if words and words[0] else []
        elif function == "os.system" and isinstance(first, ast.Constant):
            starts += of_shell(first.value, file, call.lineno)
        elif function in ("shutil.which", "which") and isinstance(first, ast.Constant):
            starts.append(Start(first.value, file, call.lineno, asked=True))
    asked = {start.program for start in starts if start.asked}
    return [dataclasses.replace(start, asked=start.program in asked) for start in starts]


STRING = re.compile(r'R"\((?P<raw>.*?)\)"|"(?P<plain>(?:[^"\\\n]|\\.)*)"', re.DOTALL)


def strings_of(code):
    """String literals of C++, those that are put together as one; what is put in between, or by fmt, is the word VALUE."""
    texts, end = [], None
    for found in STRING.finditer(code):
        text = found["raw"] if found["raw"] is not None else found["plain"].encode().decode("unicode_escape", errors="replace")
        between = "," if end is None else code[end:found.start()].strip()
        if re.search(r"[,;{}?]|(?<!:):(?!:)", between):
            texts.append(text)
        else:
            texts[-1] += ("VALUE" if between else "") + text
        end = found.end()
    return [re.sub(r"\{\d*\}", "VALUE", text) for text in texts]


def until(code, start, closing):
    """The text from `start` to a character of `closing` outside of strings and of parentheses that open in it."""
    depth, at = 0, start
    while at < len(code):
        if found := STRING.match(code, at):
            at = found.end()
            continue
        if depth == 0 and code[at] in closing:
            break
        depth += {"(": 1, ")": -1}.get(code[at], 0)
        at += 1
    return code[start:at]


def of_cpp(text, file):
    starts = []
    code = re.sub(r"(?m)^\s*//.*$", "", text)
    for call in re.finditer(RUNNERS + r"\(", code):
        said = until(code, call.end(), ")")
        scripts = strings_of(said)
        for name in re.findall(r"^(\w+)\.c_str\(\)", said): # a string that was made before
            made = [found.end() for found in re.finditer(rf"\b{name}\s*=", code[:call.start()])]
            scripts += strings_of(until(code, made[-1], ";")) if made else []
        for script in (script for script in scripts if " " in script): # a word alone is a file or a choice
            starts += of_shell(script, file, text.count("\n", 0, text.find(said)) + 1)
    for script in strings_of(code):
        if script.startswith("#!"):
            starts += of_shell(script, file)
    return starts


def of_cmake(text, file):
    starts = []
    code = re.sub(r"(?m)^\s*#.*$", "", text)
    for found in re.finditer(r"find_program\(([^)]*)\)", code):
        words = found[1].split()
        names = [word for word in words[1:] if re.fullmatch(r"[a-z][\w.+-]*", word)]
        line = text.count("\n", 0, text.find(found[0])) + 1
        # Any of several names suffices: the first is the one that the table should have.
        starts += [Start(name, file, line, asked="REQUIRED" not in words) for name in names[:1]]
    for found in re.finditer(r"(?<!NAME )\bCOMMAND\s+([a-z][\w.+-]*)", code):
        starts.append(Start(found[1], file, text.count("\n", 0, text.find(found[0])) + 1))
    return starts


def blocks_of(document):
    """Fenced blocks of a Markdown file without a language, or of a shell: (first line, text)."""
    blocks, language, lines = [], None, []
    for number, line in enumerate(document.splitlines(), 1):
        if line.strip().startswith("```"):
            if language is None:
                language, lines, first = line.strip()[3:], [], number + 1
            else:
                if language in ("", "sh", "bash", "shell"):
                    blocks.append((first, "\n".join(lines) + "\n"))
                language = None
        elif language is not None:
            lines.append(line)
    return blocks


def of_document(text, file):
    starts = []
    for line, block in blocks_of(text):
        starts += of_shell(block, file, line)
    return starts


def of_file(text, name):
    """Programs that a file starts, by its name and its first line."""
    first = text.split("\n", 1)[0]
    if name.endswith(".md"):
        return of_document(text, name)
    if name.endswith((".cpp", ".hpp")):
        return of_cpp(text, name)
    if name.endswith((".cmake", "CMakeLists.txt")):
        return of_cmake(text, name)
    if name.endswith((".yml", ".yaml")):
        return [start for found in re.finditer(r"(?m)^\s*(?:- )?run: ([^|\n]+)$", text) for start in of_shell(found[1], name)]
    if name.endswith(".py") or re.match(r"#!.*python", first):
        return of_python(text, name)
    if name.endswith(".bash") or re.match(r"#!.*\b(ba)?sh\b", first):
        return of_shell(text, name)
    return []


def targets_of(files):
    """Names of programs that the build makes."""
    return {name for text in files.values() for name in re.findall(r"add_executable\((\w+)", text)}


def tracked(changelog=False):
    """The text of every file of this repository in which programs are looked for, by its name; the changelog is of its time."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, check=True).stdout.decode().split("\0")
    texts = {}
    for name in listed:
        path = ROOT / name
        # The program itself starts no other programs than its options name.
        if not name or name.startswith(("src/", "assets/", "tests/data/", "tests/fuzz/corpus/")) and not name.endswith(".cmake"):
            continue
        if name == "CHANGELOG.md" and not changelog or not path.is_file():
            continue
        try:
            texts[name] = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            pass
    return texts
