"""The examples of the pages run: the blocks marked `sh` and `python` of each page, in their order, in a folder of their
own that has scans. Started as `python3 -B examples_test.py PROGRAM REPOSITORY [unittest's arguments]`."""

import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

REPOSITORY = Path(sys.argv.pop(2)).resolve()
sys.path.insert(0, str(REPOSITORY / "tests/e2e"))

from support import PROGRAM, TIMEOUT, SemigeoTest, boulder, joined, write_ply
from pages import split_blocks

PAGES = ("README.md", "docs/usage.md", "docs/recognition.md", "docs/similar.md",
         "docs/pictures.md", "docs/export.md", "docs/python.md")
COMMANDS = ("run", "recognise", "similar", "export", "picture", "formats", "info", "status", "check", "library", "prune")


def runnable_blocks(page):
    _, blocks = split_blocks((REPOSITORY / page).read_text(encoding="utf-8"))
    return [(language, code) for language, code in blocks if language in ("sh", "python")]


class ExamplesTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        models = {name: boulder(4, seed) for seed, name in enumerate("abc", 1)}
        for name, mesh in models.items():
            write_ply(self.scans / f"{name}.ply", mesh)
            write_ply(self.folder / "objects" / f"{name}.ply", mesh)
        points, triangles = models["b"]
        write_ply(self.folder / "scene.ply", joined(models["a"], (0.8 * points + [3, 0, 0], triangles)))
        # The program, as in the repository and as installed.
        (self.folder / "build/release").mkdir(parents=True)
        (self.folder / "build/release/semigeo").symlink_to(PROGRAM)
        self.environment = dict(os.environ, PATH=f"{self.folder / 'build/release'}:{os.environ['PATH']}")

    def run_block(self, language, code):
        command = ["bash", "-eu", "-c", code] if language == "sh" else [sys.executable, "-B", "-c", code]
        process = subprocess.run(command, cwd=self.folder, env=self.environment, capture_output=True, text=True,
                                 timeout=TIMEOUT)
        self.assertEqual(process.returncode, 0, f"{code}\n{process.stdout}{process.stderr}")
        return process.stdout

    def run_page(self, page):
        blocks = runnable_blocks(page)
        self.assertTrue(blocks, f"{page} has no block marked sh or python")
        return [self.run_block(language, code) for language, code in blocks]

    def test_first_page(self):
        printed = self.run_page("README.md")
        self.assertIn("scene.ply: 2 objects", printed[0])

    def test_usage(self):
        printed = self.run_page("docs/usage.md")
        self.assertIn("parameter levels: 8, now 10", printed[1])
        self.assertIn("3 checked, 0 broken", printed[2])

    def test_recognition(self):
        printed = self.run_page("docs/recognition.md")
        self.assertIn("scene.ply: 2 objects", printed[0])

    def test_similar(self):
        printed = self.run_page("docs/similar.md")
        self.assertRegex(printed[0], r"a\.ply +0\.9\d+ .* same")
        self.assertIn('"groups"', printed[1] + (self.folder / "groups.json").read_text(encoding="utf-8"))

    def test_pictures(self):
        self.run_block("sh", "semigeo run scans --output archive")
        self.assertIn("pixels, colours from", self.run_page("docs/pictures.md")[0])

    def test_export(self):
        self.run_block("sh", "semigeo run scans --output archive --unit mm")
        self.assertRegex(self.run_page("docs/export.md")[-1], r"^[0-9.]+ mm -[0-9.]+")

    def test_python(self):
        self.run_block("sh", "semigeo run scans --output archive --library")
        printed = self.run_page("docs/python.md")
        self.assertIn("a.ply score", printed[-1])

    def test_options_of_the_pages_exist(self):
        known = " ".join(self.semigeo(command, "--help").stdout for command in COMMANDS)
        for page in PAGES + ("docs/cluster.md",):
            text = (REPOSITORY / page).read_text(encoding="utf-8")
            for word in sorted(set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", text))):
                with self.subTest(page=page, option=word):
                    self.assertRegex(known, rf"{word}(?![\w-])")


if __name__ == "__main__":
    unittest.main()
