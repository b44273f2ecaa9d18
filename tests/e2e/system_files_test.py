"""Man pages, completions of shells, and the manners of a program on a terminal."""

import os
import pty
import re
import select
import shutil
import subprocess
import time
import unittest

from support import PROGRAM, TIMEOUT, SemigeoTest, icosphere, write_ply

COMPLETE = """
. "$1"; shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_semigeo
printf '%s\\n' "${COMPREPLY[@]}"
"""


def output_of(*command, **options):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=True, **options)


class SystemFilesTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        self.system = self.folder / "system"
        self.semigeo("system-files", self.system)
        self.pages = sorted((self.system / "man1").glob("*.1"))

    def manual(self, name):
        """The text of a man page, its words with one space between them."""
        process = output_of("groff", "-man", "-Tutf8", "-ww", "-P-cbou", self.system / "man1" / f"{name}.1")
        self.assertEqual(process.stderr, "")
        return " ".join(process.stdout.replace("\u2010\n", "").replace("\u2010", "-").split())

    def commands(self):
        return [page.stem.removeprefix("semigeo-").replace("-", " ") for page in self.pages
                if page.stem != "semigeo"]

    def test_every_command_has_a_page_with_its_options(self):
        self.assertIn("library build", self.commands())
        self.assertNotIn("system files", self.commands())
        listed = self.manual("semigeo")
        for command in self.commands():
            with self.subTest(command=command):
                help = self.semigeo(*command.split(), "--help").stdout
                page = self.manual("semigeo-" + command.replace(" ", "-"))
                options = re.findall(r"^  (?:-\w,)?(--[a-z-]+)", help, flags=re.MULTILINE)
                self.assertGreater(len(options), 1)
                for option in options:
                    self.assertIn(option, page)
                for example in re.findall(r"^  (semigeo \S+ \S+)", help, flags=re.MULTILINE):
                    self.assertIn(example, page)
                self.assertIn(command, listed)

    def test_the_page_of_the_program_says_exit_codes_and_environment(self):
        page = self.manual("semigeo")
        listed = self.semigeo("options").stdout
        section = listed[listed.index("## Exit codes"):]
        items = re.findall(r"^- `(\w+)`:\n((?:  .*\n)+)", section, flags=re.MULTILINE)
        self.assertGreater(len(items), 9)
        for name, text in items:
            with self.subTest(name=name):
                self.assertIn(f"{name} {' '.join(text.split())}", page)

    def complete_in_bash(self, *words):
        script = self.system / "semigeo.bash"
        return output_of("bash", "-u", "-c", COMPLETE, "bash", script, "semigeo", *words).stdout.split()

    def test_bash_completes_commands_options_and_values(self):
        output_of("bash", "-n", self.system / "semigeo.bash")
        for words, wanted in ((("re",), ["recognise", "report"]),
                              (("library", "b"), ["build"]),
                              (("run", "scans", "--surf"), ["--surface"]),
                              (("run", "--surface", ""), ["curved", "flat"]),
                              (("run", "--surface", "=", "f"), ["flat"]),
                              (("run", "--surface", "="), ["curved", "flat"]),
                              (("picture", "x.vtkhdf", "--view", "f"), ["front"]),
                              (("run", "--levels", ""), []),
                              (("run", ""), [])):
            with self.subTest(words=words):
                self.assertEqual(self.complete_in_bash(*words), wanted)
        self.assertIn("--output", self.complete_in_bash("library", "build", "--"))

    def test_fish_completes_commands_options_and_values(self):
        if shutil.which("fish") is None:
            self.skipTest("fish is not installed")
        script = self.system / "semigeo.fish"
        home = {**os.environ, "HOME": str(self.folder)}
        output_of("fish", "-n", script, env=home)
        for line, wanted in (("semigeo re", ["recognise", "report"]), ("semigeo library b", ["build"]),
                             ("semigeo run --surf", ["--surface"]),
                             ("semigeo run --surface ", ["curved", "flat"])):
            with self.subTest(line=line):
                found = output_of("fish", "-c", f"source {script}; complete -C '{line}'", env=home).stdout
                self.assertEqual([row.split("\t")[0] for row in found.splitlines()], wanted)

    def test_zsh_completes_on_a_terminal(self):
        if shutil.which("zsh") is None:
            self.skipTest("zsh is not installed")
        output_of("zsh", "-n", self.system / "_semigeo")
        child, terminal = pty.fork()
        if child == 0:
            os.environ.update(TERM="xterm", HOME=str(self.folder), COLUMNS="200")
            os.execvp("zsh", ["zsh", "-f", "-i"])
        self.addCleanup(os.waitpid, child, 0)
        self.addCleanup(os.close, terminal)
        seen = b""

        def wait_for(text):
            nonlocal seen
            end = time.monotonic() + TIMEOUT
            while text not in seen and time.monotonic() < end:
                if select.select([terminal], [], [], 1)[0]:
                    seen += os.read(terminal, 65536)
            self.assertIn(text, seen)
            seen = b""

        os.write(terminal, f"PROMPT='<>'; fpath=({self.system} $fpath); autoload -U compinit; compinit -D -u;"
                           " echo rea''dy\n".encode())
        wait_for(b"ready\r")
        for typed, wanted in ((b"semigeo recog\t", b"recognise"), (b"semigeo library bui\t", b"build"),
                              (b"semigeo run --surface=cur\t", b"--surface=curved"),
                              (b"semigeo picture --vi\t", b"--view")):
            os.write(terminal, typed)
            wait_for(wanted)
            os.write(terminal, b"\x15")
        os.write(terminal, b"exit\n")


class TerminalTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        write_ply(self.scans / "a.ply", icosphere(2))

    def on_a_terminal(self, *arguments, **environment):
        """What a command writes when its outputs are a terminal."""
        master, slave = pty.openpty()
        with os.fdopen(master, "rb", 0) as screen:
            process = subprocess.Popen([PROGRAM, *arguments], stdout=slave, stderr=slave,
                                       env={**os.environ, **environment})
            os.close(slave)
            written = b""
            while True:
                try:
                    part = screen.read(65536)
                except OSError:  # the terminal has no writer any more
                    break
                if not part:
                    break
                written += part
            self.assertEqual(process.wait(60), 0)
        return written.decode()

    def test_help_fits_the_width(self):
        for width in (70, 100):
            for arguments in (("run", "--help"), ("recognise", "--help")):
                text = self.semigeo(*arguments, env={**os.environ, "COLUMNS": str(width)}).stdout
                lines = text[text.index("\nOptions:"):].splitlines()
                described = [line for line in lines if line.startswith(" " * 20)]
                self.assertGreater(len(described), 20)
                self.assertLessEqual(max(map(len, described)), width)
        nonsense = self.semigeo("run", "--help", env={**os.environ, "COLUMNS": "wide"}).stdout
        self.assertIn("--surface", nonsense)

    def test_nothing_is_coloured(self):
        run = ("run", self.scans, "--output", self.archive)
        for environment in ({}, {"NO_COLOR": "1"}):
            written = self.on_a_terminal(*run, "--levels", "3", TERM="xterm", **environment)
            self.assertNotRegex(written, r"\x1b\[[0-9;]*m")
            shutil.rmtree(self.archive)

    def test_a_dumb_terminal_gets_plain_lines(self):
        run = ("run", self.scans, "--output", self.archive)
        self.assertIn("\x1b[K", self.on_a_terminal(*run, TERM="xterm"))
        shutil.rmtree(self.archive)
        self.assertNotIn("\x1b", self.on_a_terminal(*run, TERM="dumb"))


if __name__ == "__main__":
    unittest.main()
