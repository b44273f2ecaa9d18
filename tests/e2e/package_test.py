"""The Debian package: what it depends on, what it installs, and that the program in it runs."""

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

BUILD = Path(sys.argv.pop(2))
CPACK = sys.argv.pop(2)

from support import SemigeoTest, icosphere, write_ply  # noqa: E402: takes PROGRAM from the rest


def output_of(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True,
                          text=True).stdout


class PackageTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        packages = self.folder / "packages"
        output_of(CPACK, "--config", BUILD / "CPackConfig.cmake", "-B", packages)
        self.package = next(packages.glob("semigeo_*.deb"))
        self.root = self.folder / "root"
        output_of("dpkg-deb", "--extract", self.package, self.root)
        self.program = self.root / "usr/bin/semigeo"

    def field(self, name):
        return output_of("dpkg-deb", "--field", self.package, name).strip()

    def test_installs_the_program_and_its_pages(self):
        pages = self.root / "usr/share/doc/semigeo"
        for path in (self.program, pages / "README.md", pages / "docs/README.md"):
            self.assertTrue(path.is_file(), path)
        for page in pages.rglob("*.md"):
            for link in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
                if not re.search(r"\.(md|svg|png)$", link):
                    continue  # scripts and sources are not installed
                self.assertTrue((page.parent / link).exists(), f"{page}: {link}")
        self.assertEqual(self.field("Section"), "science")
        self.assertTrue(self.package.name.startswith(f"semigeo_{self.field('Version')}_"))

    def test_installs_man_pages_and_completions(self):
        share = self.root / "usr/share"
        for path in ("man/man1/semigeo.1", "man/man1/semigeo-run.1", "bash-completion/completions/semigeo",
                     "zsh/vendor-completions/_semigeo", "fish/vendor_completions.d/semigeo.fish"):
            self.assertTrue((share / path).is_file(), path)
        commands = output_of(self.program, "--help")
        pages = {page.stem for page in (share / "man/man1").iterdir()}
        self.assertIn("semigeo-picture", pages)
        self.assertNotIn("semigeo-system-files", pages)
        self.assertIn("picture", commands)

    def test_depends_on_every_library_that_the_program_loads(self):
        named = set(re.findall(r"[a-z0-9][a-z0-9+.-]+(?= |,|$)", self.field("Depends")))
        needed = re.findall(r"NEEDED +(\S+)", output_of("objdump", "-p", self.program))
        self.assertIn("libtbb.so.12", needed)
        for library in needed:
            path = re.search(rf"{re.escape(library)} .*=> (\S+)",
                             output_of("/sbin/ldconfig", "-p"))
            if path is None:  # the loader itself
                continue
            files = {path.group(1), path.group(1).replace("/lib/", "/usr/lib/", 1),
                     str(Path(path.group(1)).resolve())}
            owners = {line.split(":")[0]
                      for line in subprocess.run(["dpkg-query", "--search", *files],
                                                 capture_output=True, text=True).stdout.splitlines()}
            self.assertTrue(owners & named, f"{library}: {owners} is none of {sorted(named)}")

    def test_the_program_in_it_runs(self):
        write_ply(self.scans / "a.ply", icosphere(2))
        made = subprocess.run([self.program, "run", self.scans, "--output", self.archive, "--json"],
                              capture_output=True, check=True)
        self.assertEqual(json.loads(made.stdout)["done"], 1)
        self.assertTrue(self.dataset("a.ply").is_file())


if __name__ == "__main__":
    unittest.main()
