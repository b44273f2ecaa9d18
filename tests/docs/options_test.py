"""The page of options is what the program prints. Started as
`python3 -B options_test.py PROGRAM REPOSITORY [unittest's arguments]`."""

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


if __name__ == "__main__":
    unittest.main()
