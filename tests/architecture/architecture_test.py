"""Rules about the sources as text: who may include whom, how long a file may be, what must not be named."""

import re
import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
ROOMS = ["base", "scene", "mesh", "visibility", "formfactor", "radiosity", "image", "sequence"]
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
LONGEST_FILE = 400

# Where a foreign header may be included. A folder ends with "/"; "one of X/" means a single file in there.
FOREIGN = {
    r"embree3/": ["solver/visibility/", "tests/"],
    r"Imf\w+\.h|spng\.h|turbojpeg\.h": ["solver/base/pixels.cpp"],
    r"OpenImageIO/": ["solver/base/module/other_pictures_module.cpp"],
    r"tbb/|oneapi/": ["solver/base/threads.cpp"],
    r"glm/": ["solver/base/math.h"],
    r"nlohmann/": ["solver/base/json.h", "one of client/"],
    r"xxhash\.h": ["one of solver/base/"],
    r"httplib\.h": ["service/http/", "one of client/", "tests/"],
    r"CLI/": ["service/", "client/"],
    r"zip\.h": ["service/base/zip_archive.cpp", "tests/"],
    r"openssl/": ["one of client/"],
    r"sqlite3\.h|SQLiteCpp/": ["one of service/"],
}


def files(*patterns, folders=("solver", "service", "client", "tests", "docker", "cmake", ".ci")):
    found = []
    for folder in folders:
        for pattern in patterns:
            found += [p for p in (TOP / folder).rglob(pattern) if p.is_file() and "__pycache__" not in p.parts]
    return sorted(found)


def name(path):
    return path.relative_to(TOP).as_posix()


def text(path):
    return path.read_text(encoding="utf-8")


def includes(path):
    return INCLUDE.findall(text(path))


def cpp(*folders):
    return files("*.cpp", "*.h", folders=folders)


class Includes(unittest.TestCase):
    def test_rooms_include_only_rooms_before_them(self):
        seen = 0
        for path in cpp("solver"):
            room = ROOMS.index(name(path).split("/")[1])
            for header in includes(path):
                parts = header.split("/")
                self.assertNotIn(parts[0], ("service", "client", "tests"), f"{name(path)} includes {header}")
                if parts[0] == "solver":
                    seen += 1
                    self.assertLessEqual(ROOMS.index(parts[1]), room, f"{name(path)} includes {header}")
        self.assertGreater(seen, 50, "no includes were found, so nothing was checked")

    def test_client_knows_no_solver_and_no_service(self):
        for path in cpp("client"):
            for header in includes(path):
                self.assertNotRegex(header, "^(solver|service)/", name(path))

    def test_service_knows_no_client(self):
        for path in cpp("service"):
            for header in includes(path):
                self.assertNotRegex(header, "^client/", name(path))

    def test_own_headers_are_included_from_the_top(self):
        for path in cpp("solver", "service", "client", "tests"):
            for header in re.findall(r'#\s*include\s*"([^"]+)"', text(path)):
                self.assertTrue((TOP / header).is_file(), f"{name(path)} includes \"{header}\"")

    def test_foreign_headers_stay_where_they_belong(self):
        for pattern, places in FOREIGN.items():
            users = [name(p) for p in cpp("solver", "service", "client", "tests")
                     if any(re.match(pattern, header) for header in includes(p))]
            for place in places:
                inside = [u for u in users if u.startswith(place.removeprefix("one of "))]
                if place.startswith("one of "):
                    self.assertLessEqual(len(inside), 1, f"{pattern} wants one owner, found {inside}")
                users = [u for u in users if u not in inside]
            self.assertEqual(users, [], f"{pattern} is included outside of {places}")


class Texts(unittest.TestCase):
    def test_no_file_is_too_long(self):
        checked = files("*.cpp", "*.h", "*.py", "*.js", "*.html", "CMakeLists.txt", "*.cmake") + [TOP / "run"]
        self.assertGreater(len(checked), 30)
        for path in checked:
            lines = text(path).count("\n")
            self.assertLessEqual(lines, LONGEST_FILE, f"{name(path)} has {lines} lines")

    def test_no_path_of_a_machine(self):
        machine = re.compile(r"(?<![\w.])/(?:work|home|root|Users)/")
        checked = files("*.cpp", "*.h", "*.py", "*.js", "*.html", "*.txt", "*.cmake", "*.md", "*.json", "run", "Dockerfile")
        checked += [p for p in TOP.glob("*") if p.is_file() and p.suffix in ("", ".md", ".json", ".txt")]
        for path in checked:
            self.assertIsNone(machine.search(text(path)), name(path))

    def test_nothing_is_left_behind(self):
        mark = re.compile(r"\b(?:TODO|FIXME|XXX)\b|#if 0|\bDISABLED_|GTEST_SKIP")
        for path in files("*.cpp", "*.h", "*.py", "*.js"):
            if path == Path(__file__).resolve():
                continue
            self.assertIsNone(mark.search(text(path)), name(path))

    def test_every_header_is_guarded(self):
        for path in files("*.h"):
            self.assertTrue(text(path).startswith("#pragma once\n"), name(path))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "--verbose"])
