"""The page of options is what the program prints. Started as
`python3 -B options_test.py PROGRAM REPOSITORY [unittest's arguments]`."""

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


if __name__ == "__main__":
    unittest.main()
