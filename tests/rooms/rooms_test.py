#!/usr/bin/env python3
"""Whether the rooms of src are as docs/architecture.md draws them: each includes only the rooms that its link line names,
no arrow goes up or in a circle, and no room has become a hall.

    tests/rooms/rooms_test.py            exit code 1 and a line for each breach
    tests/rooms/rooms_test.py --graph    the arrows between rooms, and their sizes
"""
import collections
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_FILES = 60  # of a folder's own
MOST_SHARE = 0.15  # of all lines of src and shaders, of a room or of a sub-room where there are some
SHADER_FOLDERS = ("physics", "focus", "device", "estimate", "waves")
INCLUDE = re.compile(r'^\s*#\s*include "([^"]+)"', re.MULTILINE)
SOURCES = (".cpp", ".hpp", ".glsl", ".comp")
# Programs inside of a room's folder that have link lines of their own.
APART = ("images/openimageio", "app/memory")


class House:
    """The rooms of a checkout: their files, their link lines, and what they include."""

    def __init__(self, root):
        self.root = root
        self.source = root / "src"
        self.rooms = re.findall(r"[\w]+", re.search(r"set\(VKFV_ROOMS ([^)]*)\)", (root / "CMakeLists.txt").read_text())[1])
        self.includes = {}
        self.lines = {}
        for path in sorted([*self.source.rglob("*"), *(root / "shaders").rglob("*")]):
            if path.suffix in SOURCES:
                text = path.read_text()
                self.includes[path] = INCLUDE.findall(text)
                self.lines[path] = text.count("\n")
        self.files_of = collections.defaultdict(list)
        for path in self.includes:
            parts = path.relative_to(root).parts
            if parts[0] == "src" and "/".join(parts[1:3]) not in APART:
                self.files_of[parts[1]].append(path)

    def files(self, room):
        return self.files_of[room]

    def resolve(self, name):
        """The file that an include names, and its room; (None, None) for a package's header or a generated one."""
        folder = name.split("/")[0]
        if folder == "spirv":
            return None, "spirv"
        if folder in SHADER_FOLDERS:
            path = self.root / "shaders" / name
            return (path if path in self.includes else None), "physics"
        path = self.source / name
        if path in self.includes or (self.source / folder).is_dir() and folder in self.rooms:
            return path, folder
        return None, None

    def included_by(self, path):
        """The files that a file includes; for a generated header, all the kinds from which it is generated."""
        if path in self.includes:
            return self.includes[path]
        kinds = path.parent / "kinds"
        return [f"{path.parent.name}/kinds/{kind.name}" for kind in sorted(kinds.glob("*.hpp"))]

    def used(self, room):
        """Rooms whose headers the room's files include, and the rooms which those headers include in turn."""
        direct, through, seen, pending = set(), set(), set(), list(self.files(room))
        for path in self.files(room):
            direct |= {self.resolve(name)[1] for name in self.includes[path]}
        while pending:
            path = pending.pop()
            if path not in seen:
                seen.add(path)
                for name in self.included_by(path):
                    found, other = self.resolve(name)
                    through.add(other)
                    if found:
                        pending.append(found)
        own = {None, room}
        return direct - own, through - direct - own

    def named(self, room):
        """The rooms of a link line: USES and THROUGH."""
        text = re.search(r"vkfv_room\((.*?)\)", (self.source / room / "CMakeLists.txt").read_text(), re.DOTALL)[1]
        lists = collections.defaultdict(set)
        current = None
        for word in text.split()[1:]:
            if re.fullmatch("[A-Z_]+", word):
                current = word
            else:
                lists[current].add(word.removeprefix("vkfv_"))
        return lists["USES"], lists["THROUGH"]

    def sub_rooms(self, room):
        return sorted({path.relative_to(self.source / room).parts[0] for path in self.files(room)
                       if path.parent != self.source / room})

    def table(self):
        """The rooms that docs/architecture.md lets each room use; None for all."""
        allowed = {}
        text = (self.root / "docs" / "architecture.md").read_text()
        for names, uses in re.findall(r"^\| ([\w, ]+) \| ([^|]+) \|$", text.split("## The way of a ray")[0], re.MULTILINE):
            for name in names.split(", "):
                if name in self.rooms:
                    rooms = {re.sub("^shaders.*", "shaders", use) for use in uses.strip().split(", ")}
                    allowed[name] = None if uses.startswith("all") else rooms - {"packages alone"}
        return allowed

    def breaches(self):
        found = []
        allowed = self.table()
        for place, room in enumerate(self.rooms):
            uses, through = self.used(room)
            named_uses, named_through = self.named(room)
            for kind, included, named in (("USES", uses, named_uses), ("THROUGH", through, named_through)):
                found += [f"src/{room} includes {other}, which {kind} of its link line does not name" for other in sorted(included - named)]
                found += [f"{kind} of src/{room}'s link line names {other}, which it does not include" for other in sorted(named - included)]
            above = set(self.rooms[place + 1:])
            found += [f"src/{room} includes {other}, a room above it" for other in sorted(uses & above)]
            if room not in allowed:
                found.append(f"docs/architecture.md has no row for src/{room}")
            elif allowed[room] is not None:
                plain = {"shaders" if other in ("physics", "spirv") else other for other in uses}
                found += [f"docs/architecture.md does not let src/{room} use {other}" for other in sorted(plain - allowed[room])]
            found += self.circles(room)
        found += self.halls()
        return found

    def sub_room_arrows(self, room):
        arrows = collections.defaultdict(set)
        for path in self.files(room):
            own = path.relative_to(self.source / room).parts[0]
            for name in self.includes[path]:
                parts = name.split("/")
                if parts[0] == room and len(parts) == 3 and parts[1] != own and path.parent != self.source / room:
                    arrows[own].add(parts[1])
        return arrows

    def circles(self, room):
        arrows = self.sub_room_arrows(room)
        found = []
        for start in sorted(arrows):
            reached, pending = set(), list(arrows[start])
            while pending:
                current = pending.pop()
                if current not in reached:
                    reached.add(current)
                    pending += arrows[current]
            if start in reached:
                found.append(f"src/{room}/{start} includes itself through {', '.join(sorted(arrows[start]))}")
        return found

    def sizes(self):
        """Lines of each room, or of each of its sub-rooms where it has some."""
        result = collections.Counter()
        with_sub_rooms = {room for room in self.rooms if self.sub_rooms(room)}
        for path, lines in self.lines.items():
            parts = path.relative_to(self.root).parts
            if parts[0] == "shaders":
                name = "/".join(parts[:2]) if len(parts) > 2 else "shaders"
            else:
                name = "/".join(parts[:3] if parts[1] in with_sub_rooms and len(parts) > 3 else parts[:2])
            result[name] += lines
        return result

    def halls(self):
        sizes = self.sizes()
        most = MOST_SHARE * sum(sizes.values())
        found = [f"{name} has {lines} lines, more than {most:.0f}, {MOST_SHARE:.0%} of all" for name, lines in sizes.items() if lines > most]
        files = collections.Counter(path.parent for path in self.source.rglob("*") if path.is_file())
        return found + [f"{folder.relative_to(self.root)} has {count} files of its own, more than {MOST_FILES}"
                        for folder, count in files.items() if count > MOST_FILES]

    def print_graph(self):
        for room in self.rooms:
            print(f"{room}: {' '.join(sorted(self.used(room)[0]))}")
            for sub_room, others in sorted(self.sub_room_arrows(room).items()):
                print(f"    {sub_room}: {' '.join(sorted(others))}")
        sizes = self.sizes()
        for name, lines in sizes.most_common():
            print(f"{lines:6d} lines {lines / sum(sizes.values()):6.1%}  {name}")


class Rooms(unittest.TestCase):
    def test_are_as_the_architecture_says(self):
        breaches = House(ROOT).breaches()
        self.assertFalse(breaches, "\n" + "\n".join(breaches))

    def planted(self, change):
        """The breaches of a copy of the house after a change."""
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder)
            for name in ("src", "shaders"):
                shutil.copytree(ROOT / name, copy / name)
            (copy / "docs").mkdir()
            for name in ("CMakeLists.txt", "docs/architecture.md"):
                shutil.copy(ROOT / name, copy / name)
            change(copy)
            return "\n".join(House(copy).breaches())

    def add(self, copy, file, text):
        with open(copy / file, "a", encoding="utf-8") as out:
            out.write(text)

    def test_an_include_that_the_link_line_does_not_name_is_found(self):
        found = self.planted(lambda copy: self.add(copy, "src/surface/band.cpp", '\n#include "images/png.hpp"\n#include "images/picture.hpp"\n'))
        self.assertIn("src/surface includes images, which USES of its link line does not name", found)
        self.assertIn("docs/architecture.md does not let src/surface use images", found)

    def test_an_arrow_up_is_found(self):
        def change(copy):
            self.add(copy, "src/optics/train/train.cpp", '\n#include "trace/interface/tracer.hpp"\n')
        self.assertIn("src/optics includes trace, a room above it", self.planted(change))

    def test_a_name_that_nothing_includes_is_found(self):
        def change(copy):
            file = copy / "src/surface/CMakeLists.txt"
            file.write_text(file.read_text().replace("USES vkfv_core", "USES vkfv_core vkfv_vulkan"))
        self.assertIn("USES of src/surface's link line names vulkan, which it does not include", self.planted(change))

    def test_a_circle_of_sub_rooms_is_found(self):
        def change(copy):
            self.add(copy, "src/optics/media/medium.cpp", '\n#include "optics/waves/wavefront.hpp"\n')
        self.assertIn("src/optics/media includes itself through waves", self.planted(change))

    def test_a_hall_is_found(self):
        def change(copy):
            self.add(copy, "src/core/messages/error.cpp", "\n" * 20000)
            for number in range(MOST_FILES):
                self.add(copy, f"src/camera/file_{number}.hpp", "")
        found = self.planted(change)
        self.assertRegex(found, r"src/core/messages has 2\d{4} lines")
        self.assertIn("src/camera has 7", found)


if __name__ == "__main__":
    if sys.argv[1:] == ["--graph"]:
        House(ROOT).print_graph()
    else:
        unittest.main()
