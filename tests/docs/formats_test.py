"""The pages of formats name what is really there: every file of an archive, every attribute and dataset of a dataset and
of a library, every field of a recognised scene, of the journal and of the other JSON files. Started as
`python3 -B formats_test.py PROGRAM REPOSITORY [unittest's arguments]`."""

import json
import re
import sys
import unittest
from pathlib import Path

REPOSITORY = Path(sys.argv.pop(2)).resolve()
sys.path.insert(0, str(REPOSITORY / "tests/e2e"))

import h5py

from support import SemigeoTest, boulder, plane, write_ply

FORMATS = REPOSITORY / "docs/formats"


def page(name):
    return (FORMATS / name).read_text(encoding="utf-8")


def words_of(text):
    """Returns every word of a page, so that the page can be asked for a name."""
    return set(re.findall(r"[A-Za-z_][A-Za-z_0-9]*", text))


def paths_of(text):
    """Returns patterns for the paths in the first column of the page's first table."""
    cells = re.findall(r"^\| (.*?) \|", text[:text.index("\n- ")], flags=re.MULTILINE)
    paths = [path for cell in cells for path in re.findall(r"`([^`]+)`", cell)]
    return [re.compile(re.sub(r"<[^>]+>", "[^/]+", path.replace(".", r"\.")) + (".*" if path.endswith("/") else ""))
            for path in paths]


def keys_of(document):
    """Returns the keys of all objects in a document, but for those whose keys are names."""
    keys = set()
    if isinstance(document, dict):
        for key, value in document.items():
            keys.add(key)
            if key not in ("parameters", "done_by_kind", "running", "failed", "notes", "recognised"):
                keys |= keys_of(value)
    elif isinstance(document, list):
        for value in document:
            keys |= keys_of(value)
    return keys


class FormatsTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        for seed, name in enumerate("ab", 1):
            write_ply(self.scans / f"{name}.ply", boulder(3, seed))
        write_ply(self.scans / "open.ply", plane(12))
        self.semigeo("run", self.scans, "--output", self.archive, "--library", "--principal", "--fill-holes", "20")

    def assert_named(self, names, text):
        missing = sorted(set(names) - words_of(text))
        self.assertEqual(missing, [], "the page does not name these")

    def test_files_of_an_archive(self):
        self.semigeo("recognise", self.scans / "a.ply", "--library", self.archive, "--output", self.archive)
        patterns = paths_of(page("archive.md"))
        for file in self.archive.rglob("*"):
            path = str(file.relative_to(self.archive))
            if file.is_file():
                with self.subTest(path=path):
                    self.assertTrue(any(pattern.fullmatch(path) for pattern in patterns))

    def test_dataset(self):
        with h5py.File(self.dataset("a.ply")) as file:
            names = set(file.attrs) | set(file)
            for group in (file["levels/000"], file["levels/001"], file["selection"]):
                names |= set(group) | set(group.attrs)
                for array in group.values():
                    names |= set(array.dtype.names or ())
        self.assert_named(names, page("dataset.md"))

    def test_library(self):
        with h5py.File(self.archive / "library.h5") as file:
            names = set(file.attrs) | set(file) | set(file["models"])
            for array in (file["postings"], file["models/features"]):
                names |= set(array.dtype.names)
        self.assert_named(names, page("library.md"))

    def test_recognised_scene(self):
        self.semigeo("recognise", self.scans / "a.ply", "--library", self.archive, "--output", self.archive)
        document = json.loads((self.archive / "recognised/a.ply.json").read_text())
        candidate = document["ranking"][0]
        angles = {f"{angle}_{unit}" for angle in ("alpha", "beta", "gamma") for unit in ("degrees", "radians")}
        self.assertLessEqual(angles, set(candidate["pose"]))
        names = set(document) | set(candidate) | set(document["scene"]) | set(document["library"])
        self.assert_named(names | set(candidate["pose"]) - angles, page("archive.md"))

    def test_journal_and_other_records(self):
        text = page("archive.md")
        for line in (self.archive / "journal.jsonl").read_text().splitlines():
            event = json.loads(line)
            self.assert_named(set(event) | {event["event"]}, text)
        self.assert_named(json.loads((self.archive / "estimates.json").read_text()), text)
        first = (self.archive / "digests.txt").read_text().splitlines()[0]
        self.assertRegex(first, r"^semigeo-digests 2 \d+ [0-9a-f]{32}$")

    def assert_document_named(self, *arguments, code=0):
        document = json.loads(self.semigeo(*arguments, code=code).stdout)
        with self.subTest(arguments=[str(a) for a in arguments]):
            self.assert_named(keys_of(document), page("json.md"))

    def test_documents_of_commands(self):
        dataset, library = self.dataset("a.ply"), self.archive / "library.h5"
        run = ("run", self.scans, "--output", self.folder / "other", "--fill-holes", "20", "--decimate", "0.01")
        (self.scans / "bad.off").write_text("OFF\n3 1 0\n0 0 0\n")
        self.assert_document_named(*run, "--library", "--dry-run", "--explain", "--json")
        self.assert_document_named(*run, "--library", "--json", code=1)
        self.assert_document_named(*run, "--levels", "3", "--dry-run", "--json")
        self.assert_document_named(*run, "--dag", "json")
        self.assert_document_named("recognise", self.scans, "--library", self.archive, "--json",
                                   "--output", self.folder / "found", code=1)
        self.assert_document_named("status", self.folder / "other", "--json")
        self.assert_document_named("info", self.archive, "--json")
        self.assert_document_named("info", dataset, "--json")
        self.assert_document_named("library", "list", library, "--json")
        self.assert_document_named("library", "check", library, "--json")
        dataset.write_bytes(dataset.read_bytes()[:5000])
        self.assert_document_named("check", self.archive, "--json", code=1)

    def test_configuration(self):
        options = (self.archive / "semigeo.toml").read_text()
        helped = self.semigeo("run", "--help").stdout
        for name in re.findall(r"^([a-z-]+) = ", options, flags=re.MULTILINE):
            with self.subTest(option=name):
                self.assertIn(f"--{name}", helped)


if __name__ == "__main__":
    unittest.main()
