"""Every page: its links lead somewhere, its lines are short, the first page and those of folders are short.
Started as `python3 -B pages_test.py REPOSITORY`."""

import re
import sys
import unittest
from pathlib import Path

from pages import anchors_of, links_of, pages_of, split_blocks

ROOT = Path(sys.argv.pop(1)).resolve()
LONGEST_LINE = 200
LARGEST_FIRST_PAGE = 6000
LONGEST_FOLDER_PAGE = 60
NAMED_PATH = re.compile(r"`((?:engine|kernels|io|jobs|tests|bench|scripts|cmake|docs)/[\w./-]*)`")
LAYERS = ("engine", "kernels", "io", "jobs", "jobs/stages")
FOLDER_PAGES = ("engine", "kernels", "io", "jobs", "jobs/stages", "tests", "bench")


def text_of(page):
    return page.read_text(encoding="utf-8")


class PagesTest(unittest.TestCase):
    def test_links_lead_to_files_and_headings(self):
        for page in pages_of(ROOT):
            prose, _ = split_blocks(text_of(page))
            for number, target in links_of(prose):
                if "://" in target or target.startswith("mailto:"):
                    continue
                with self.subTest(page=str(page.relative_to(ROOT)), line=number, target=target):
                    file, _, anchor = target.partition("#")
                    path = (page.parent / file).resolve() if file else page
                    self.assertTrue(path.exists(), "there is no such file")
                    self.assertTrue(path.is_relative_to(ROOT), "the file is outside of the repository")
                    if anchor:
                        self.assertIn(anchor, anchors_of(split_blocks(text_of(path))[0]))

    def test_lines_are_short(self):
        for page in pages_of(ROOT):
            for number, line in enumerate(text_of(page).splitlines(), 1):
                with self.subTest(page=str(page.relative_to(ROOT)), line=number):
                    self.assertLessEqual(len(line), LONGEST_LINE)

    def test_the_first_page_is_short(self):
        self.assertLessEqual(len((ROOT / "README.md").read_bytes()), LARGEST_FIRST_PAGE)

    def test_pages_of_folders_are_short(self):
        for folder in FOLDER_PAGES:
            with self.subTest(folder=folder):
                lines = text_of(ROOT / folder / "README.md").splitlines()
                self.assertLessEqual(len(lines), LONGEST_FOLDER_PAGE)

    def test_files_that_pages_name_exist(self):
        for page in pages_of(ROOT):
            if page.name == "CHANGELOG.md":
                continue
            for number, line in split_blocks(text_of(page))[0]:
                for name in NAMED_PATH.findall(line):
                    with self.subTest(page=str(page.relative_to(ROOT)), line=number, name=name):
                        path = ROOT / name
                        self.assertTrue(path.exists() or any(path.parent.glob(f"{path.name}[._]*")))

    def test_pages_of_layers_list_every_source(self):
        for layer in LAYERS:
            rows = re.findall(r"^\|(.*)\|[^|]*\|$", text_of(ROOT / layer / "README.md"), flags=re.MULTILINE)
            named = {word for row in rows for word in re.findall(r"[a-z0-9_]+", row)}
            for source in sorted((ROOT / layer).rglob("*.[ch]pp")):
                # A folder that is a layer of its own has a page of its own.
                if any(source.is_relative_to(ROOT / other) for other in LAYERS if other.startswith(layer + "/")):
                    continue
                with self.subTest(layer=layer, source=str(source.relative_to(ROOT))):
                    self.assertIn(source.stem, named)

    def test_decisions_ask_and_answer(self):
        for page in sorted((ROOT / "docs/decisions").glob("[0-9]*.md")):
            for heading in ("**Question.**", "**Decision.**", "**Code.**"):
                with self.subTest(page=page.name, heading=heading):
                    self.assertIn(heading, text_of(page))

    def test_every_decision_is_listed(self):
        folder = ROOT / "docs/decisions"
        listed = {target.partition("#")[0]
                  for _, target in links_of(split_blocks(text_of(folder / "README.md"))[0])}
        for page in sorted(folder.glob("[0-9]*.md")):
            with self.subTest(page=page.name):
                self.assertIn(page.name, listed)

    def test_every_document_is_listed(self):
        folder = ROOT / "docs"
        listed = {(folder / target.partition("#")[0]).resolve()
                  for _, target in links_of(split_blocks(text_of(folder / "README.md"))[0])}
        for page in sorted([*folder.glob("*.md"), *(folder / "formats").glob("*.md")]):
            if page.name == "README.md":
                continue
            with self.subTest(page=str(page.relative_to(ROOT))):
                self.assertIn(page.resolve(), listed)


class ReaderTest(unittest.TestCase):
    """What the checks rest on."""

    def test_anchors(self):
        prose, _ = split_blocks("# `a.json`\n## The `/x`, y\n```\n# no heading\n```\n## The x y\n")
        self.assertEqual(anchors_of(prose), {"ajson", "the-x-y", "the-x-y-1"})

    def test_links(self):
        prose, _ = split_blocks("a [b](c.md) ![d](e.png) `[f](g)` [`h`](i.md#j)\n```\n[k](l)\n```\n")
        self.assertEqual([target for _, target in links_of(prose)], ["c.md", "e.png", "i.md#j"])

    def test_blocks(self):
        _, blocks = split_blocks("```sh\na\n```\n```\nb\n```\n```python\nc\nd\n```\n")
        self.assertEqual(blocks, [("sh", "a\n"), ("", "b\n"), ("python", "c\nd\n")])


if __name__ == "__main__":
    unittest.main()
