"""The page of options is what the program prints. Started as
`python3 -B options_test.py PROGRAM REPOSITORY [unittest's arguments]`."""

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

PROGRAM = Path(sys.argv.pop(1)).resolve()
REPOSITORY = Path(sys.argv.pop(1)).resolve()


class OptionsPageTest(unittest.TestCase):
    maxDiff = None

    def test_the_page_is_what_the_program_prints(self):
        printed = subprocess.run([PROGRAM, "options"], capture_output=True, check=True, encoding="utf-8").stdout
        page = (REPOSITORY / "docs/options.md").read_text(encoding="utf-8")
        self.assertEqual(page, printed, "make the page anew: build/release/semigeo options > docs/options.md")

    def test_the_page_of_runs_has_the_same_exit_codes(self):
        usage = (REPOSITORY / "docs/usage.md").read_text(encoding="utf-8")
        section = usage[usage.index("## Exit codes"):].split("\n\n")[0]
        rows = dict(re.findall(r"^\| (\d+) \| (.*) \|$", section, flags=re.MULTILINE))
        page = (REPOSITORY / "docs/options.md").read_text(encoding="utf-8")
        section = page[page.index("## Exit codes"):page.index("## Environment")]
        items = re.findall(r"^- `(\d+)`:\n((?:  .*\n)+)", section, flags=re.MULTILINE)
        self.assertEqual(rows, {code: " ".join(text.split()) for code, text in items})

    def test_the_pages_have_the_formats_of_the_program(self):
        printed = subprocess.run([PROGRAM, "formats", "--json"], capture_output=True, check=True, encoding="utf-8").stdout
        formats = json.loads(printed)
        rows = self.rows_of("docs/formats/scans.md", 3)
        self.assertEqual(rows, [[f"`{row['extension']}`", row["content"], row["variants"]] for row in formats["read"]])
        yes = {True: "yes", False: "no"}
        self.assertEqual(self.rows_of("docs/export.md", 4),
                         [[f"`{row['extension']}`", yes[row["surfaces"]], yes[row["features_and_contours"]],
                           row["content"]] for row in formats["written"]])

    def rows_of(self, page, columns):
        """Returns the cells of the first table of a page."""
        text = (REPOSITORY / page).read_text(encoding="utf-8")
        table = re.search(r"^\|---.*\n((?:\|.*\n)+)", text, flags=re.MULTILINE)[1]
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]
        self.assertEqual({len(row) for row in rows}, {columns})
        return rows


if __name__ == "__main__":
    unittest.main()
