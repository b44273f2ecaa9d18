"""The commands as a user meets them: help, exit codes, JSON, plans, configuration, progress."""

import fcntl
import json
import os
import pty
import re
import shutil
import struct
import subprocess
import termios
import unittest
from pathlib import Path

import h5py

from support import PROGRAM, TIMEOUT, SemigeoTest, icosphere, obj_text, plane, write_ply

COMMANDS = ("run", "info", "check", "export", "prune", "report")


class UsageTest(SemigeoTest):
    def test_help_begins_with_examples_and_shows_defaults(self):
        for arguments in ((), *((command,) for command in COMMANDS)):
            text = self.semigeo(*arguments, "--help").stdout
            self.assertEqual(text.strip().splitlines()[0], "Examples:", arguments)
        text = self.semigeo("--help").stdout
        for command in COMMANDS:
            self.assertIn(command, text)
        text = self.semigeo("run", "--help").stdout
        for option, default in (("--levels", "8"), ("--surface", "curved"), ("--step", "1"),
                                ("--compression", "deflate"), ("--unit", "unknown"),
                                ("--threads", "0")):
            line = next(l for l in text.splitlines() if l.strip().startswith(option + " "))
            self.assertIn(f"={default}", line.replace(" ", ""), option)

    def test_version_names_the_instruction_set(self):
        self.assertRegex(self.semigeo("--version").stdout,
                         r"^\d+\.\d+\.\d+\ncommit: (unknown|[0-9a-f]{12}( with changes)?)\n"
                         r"build: \w+ by .*, HDF5 \d.*\n"
                         r"simd: \w+ \(this CPU has scalar, baseline.*\)\n$")

    def test_the_instruction_set_can_be_forced_and_changes_no_byte(self):
        write_ply(self.scans / "a.ply", icosphere(3))
        datasets = {}
        for name in re.search(r"has (.*)\)", self.semigeo("--version").stdout)[1].split(", "):
            with self.subTest(name):
                simd = {**os.environ, "SEMIGEO_SIMD": name}
                self.assertIn(f"simd: {name} (", self.semigeo("--version", env=simd).stdout)
                archive = self.folder / name
                self.semigeo("run", self.scans, "--output", archive, "--levels", 2, env=simd)
                datasets[name] = (archive / "scans/a.ply.vtkhdf").read_bytes()
        self.assertEqual(len(set(datasets.values())), 1)

    def test_an_unknown_instruction_set_is_misuse(self):
        simd = {**os.environ, "SEMIGEO_SIMD": "mmx"}
        process = self.semigeo("--version", env=simd, code=2)
        self.assertIn("SEMIGEO_SIMD=mmx: no such instruction set; give one of scalar, baseline",
                      process.stderr)

    def test_misuse_is_exit_code_2_and_touches_nothing(self):
        write_ply(self.scans / "a.ply", icosphere(0))
        (self.scans / "notes.txt").write_text("no scan")
        empty = self.folder / "empty"
        empty.mkdir()
        run = ("run", self.scans, "--output", self.archive)
        for arguments in ((), ("frobnicate",), ("run",), ("run", self.scans),
                          (*run, "--levels", -1), (*run, "--levels", 1000),
                          (*run, "--levels", "many"), (*run, "--step", 0), (*run, "--step", "nan"),
                          (*run, "--surface", "round"), (*run, "--compression", "zip"),
                          (*run, "--threads", -1), (*run, "--unit", b"\xff"), (*run, "--frobnicate"),
                          (*run, "--config", self.folder / "none.toml"),
                          ("run", self.folder / "missing", "--output", self.archive),
                          ("run", self.scans / "notes.txt", "--output", self.archive),
                          ("run", empty, "--output", self.archive),
                          ("info",), ("check",), ("export", "x.vtkhdf")):
            with self.subTest(arguments=arguments):
                process = self.semigeo(*arguments, code=2)
                self.assertEqual(process.stdout, "")
                self.assertNotEqual(process.stderr, "")
        self.assertFalse(self.archive.exists())

    def test_results_that_cannot_be_written_are_a_failure(self):
        write_ply(self.scans / "a.ply", icosphere(0))
        run = ("run", self.scans, "--output", self.archive)
        self.semigeo(*run)
        with open("/dev/full", "w") as full:
            for arguments in (("info", self.archive, "--json"), ("info", self.archive), run,
                              (*run, "--dry-run"), ("check", self.archive), ("--help",),
                              ("export", self.dataset("a.ply"), "-o", self.folder / "a.ply")):
                process = subprocess.run([PROGRAM, *arguments], stdout=full,
                                         stderr=subprocess.PIPE, timeout=TIMEOUT, text=True)
                self.assertEqual(process.returncode, 1, arguments)
                self.assertIn("standard output", process.stderr)

    def test_a_closed_standard_output_is_no_dataset(self):
        write_ply(self.scans / "a.ply", icosphere(0))
        process = subprocess.run(["sh", "-c", '"$@" >&-', "sh", PROGRAM, "run", self.scans,
                                  "--output", self.archive], stderr=subprocess.PIPE, timeout=TIMEOUT)
        self.assertEqual(process.returncode, 1)
        self.semigeo("check", self.archive)

    def test_missing_targets_are_named(self):
        for command in ("info", "check"):
            process = self.semigeo(command, self.folder / "none", code=1)
            self.assertIn(f"semigeo: {self.folder / 'none'}: ", process.stderr)
        process = self.semigeo("check", self.scans, code=1)
        self.assertIn("holds no dataset", process.stderr)


class RunTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        write_ply(self.scans / "sphere.ply", icosphere(2))
        square = plane(6)
        broken = (square[0], square[1].copy())
        broken[1][0] = broken[1][0][::-1]  # looks the other way
        (self.scans / "sub").mkdir()
        (self.scans / "sub/square.obj").write_text(obj_text(broken))
        (self.scans / "readme.txt").write_text("no scan")

    def test_json_tells_what_was_made(self):
        document = self.run_scans("--levels", 3)
        self.assertEqual((document["done"], document["up_to_date"], document["failed"]), (2, 0, 0))
        self.assertEqual(document["vertex_levels"], 4 * (162 + 49))
        for number in ("vertex_levels_per_second", "wall_seconds", "cpu_seconds",
                       "peak_memory_bytes"):
            self.assertGreater(document[number], 0)
        sphere, square = document["scans"]
        self.assertEqual({k: sphere[k] for k in ("name", "input", "output", "state", "vertices",
                                                 "triangles", "parts", "levels", "format")},
                         {"name": "sphere.ply", "input": str(self.scans / "sphere.ply"),
                          "output": str(self.dataset("sphere.ply")), "state": "done",
                          "vertices": 162, "triangles": 320, "parts": 1, "levels": 4,
                          "format": "PLY binary little endian"})
        self.assertEqual(sphere["repairs"]["flipped_faces"], 0)
        self.assertEqual(square["name"], "sub__square.obj")
        self.assertEqual(square["repairs"]["flipped_faces"], 1)

    def test_text_tells_repairs_and_totals(self):
        process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 1)
        lines = process.stdout.splitlines()
        self.assertEqual(lines[0], "repaired: sub/square.obj: 1 flipped faces")
        self.assertRegex(lines[-1], r"^2 done, 0 up to date, 0 failed; \S+( [kMG])? vertex levels/s; "
                                    r".* wall, .* CPU, \d+ MB peak$")
        self.assertEqual(process.stderr, "")

    def test_a_dry_run_says_what_would_run_and_writes_nothing(self):
        process = self.semigeo("run", self.scans, "--output", self.archive, "--dry-run")
        self.assertIn("sphere.ply: would run: no dataset yet\n", process.stdout)
        self.assertIn("2 scans: 2 would run, 0 up to date\n", process.stdout)
        self.assertFalse(self.archive.exists())
        self.run_scans("--levels", 1)
        write_ply(self.scans / "sphere.ply", icosphere(1))
        document = self.run_scans("--levels", 1, "--dry-run")
        self.assertEqual(self.states(document),
                         {"sphere.ply": "would run", "square.obj": "up to date"})
        self.assertIn("changed", document["scans"][0]["reason"])
        self.assertEqual(self.run_scans("--levels", 1)["done"], 1)

    def test_the_configuration_that_was_used_can_be_used_again(self):
        self.run_scans("--levels", 2, "--surface", "flat", "--step", 1.3, "--compression", "none",
                       "--unit", "mm")
        config = self.archive / "semigeo.toml"
        for arguments in (("--config", config, "run"), ("run", "--config", config)):
            process = self.semigeo(*arguments, self.scans, "--output", self.archive)
            self.assertIn("0 done, 2 up to date", process.stdout)
        # The command line is stronger than the file.
        process = self.semigeo("run", self.scans, "--output", self.archive, "--config", config,
                               "--levels", 3)
        self.assertIn("2 done", process.stdout)

    def test_a_configuration_by_hand(self):
        config = self.folder / "my.toml"
        config.write_text("# mine\n[run]\nlevels = 1\nunit = \"µm\"\nthreads = 2\n")
        self.run_scans("--config", config)
        document = json.loads(self.semigeo("info", self.dataset("sphere.ply"), "--json").stdout)
        self.assertEqual((len(document["levels"]), document["length_unit"]), (2, "µm"))
        for text in ("[run]\nlevls = 3\n", "[run]\nlevels = \"many\"\n", "[run\n"):
            config.write_text(text)
            process = self.semigeo("run", self.scans, "--output", self.archive, "--config", config,
                                   code=2)
            self.assertNotEqual(process.stderr, "")

    def test_files_may_be_named_one_by_one(self):
        process = self.semigeo("run", self.scans / "sphere.ply", self.scans / "sub/square.obj",
                               self.scans / "sphere.ply", "-o", self.archive, "--levels", 0)
        self.assertIn("2 done", process.stdout)
        self.assertTrue(self.dataset("square.obj").exists())

    def shown_on_terminal(self, columns=None):
        """What a run shows on a terminal, and the process."""
        try:
            terminal, stderr = pty.openpty()
        except OSError as error:  # a container without /dev/pts
            self.skipTest(f"no terminal can be had here: {error}")
        if columns:
            fcntl.ioctl(stderr, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        process = subprocess.run([PROGRAM, "run", self.scans, "--output", self.archive],
                                 stdout=subprocess.PIPE, stderr=stderr, timeout=TIMEOUT, text=True)
        os.close(stderr)
        shown = b""
        while True:
            try:
                piece = os.read(terminal, 1 << 16)
            except OSError:  # nothing is left, and nobody could write more
                break
            if not piece:
                break
            shown += piece
        os.close(terminal)
        self.assertEqual(process.returncode, 0)
        return shown.decode(), process

    def test_a_live_line_fits_into_the_terminal(self):
        name = "n" * 150 + ".ply"
        write_ply(self.scans / name, icosphere(1))
        for columns, width in ((None, 80), (60, 60), (20, 20), (300, 300)):
            shutil.rmtree(self.archive, ignore_errors=True)
            shown, _ = self.shown_on_terminal(columns)
            lines = shown.split("\r\x1b[K")
            self.assertGreater(len(lines), 3)
            self.assertLess(max(len(line) for line in lines), width)
            self.assertEqual(any(name in line for line in lines), width == 300)

    def test_a_terminal_sees_a_line_that_goes_away(self):
        shown, process = self.shown_on_terminal()
        lines = shown.split("\r\x1b[K")
        self.assertTrue(any("0 done, 0 failed, 2 left" in l and "sphere.ply" in l for l in lines))
        self.assertTrue(any("1 done, 0 failed, 1 left" in l for l in lines))
        self.assertEqual(lines[-1], "")  # erased
        self.assertNotIn("\n", shown)
        self.assertNotIn("\x1b[3", shown)  # no colour
        lines = process.stdout.splitlines()
        self.assertEqual((len(lines), lines[1]), (3, "passed over: 1 .txt"))


class InfoTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        write_ply(self.scans / "sphere.ply", icosphere(3, 2))
        write_ply(self.scans / "square.ply", plane(10))
        self.run_scans("--levels", 2, "--unit", "cm")

    def test_of_a_dataset(self):
        document = json.loads(self.semigeo("info", self.dataset("sphere.ply"), "--json").stdout)
        self.assertEqual(document["input_name"], "sphere.ply")
        self.assertEqual(document["length_unit"], "cm")
        self.assertEqual(document["parameters"]["levels"], 2)
        self.assertEqual(len(document["input_xxh3"]), 32)
        self.assertEqual(len(document["levels"]), 3)
        for k, level in enumerate(document["levels"]):
            self.assertEqual((level["iteration"], level["vertices"], level["triangles"],
                              level["parts"]), (k, 642, 1280, 1))
            low, high = level["gaussian_curvature"]
            self.assertTrue(0.23 < low <= high < 0.27, (low, high))
            low, high = level["mean_curvature"]
            self.assertTrue(-0.52 < low <= high < -0.48, (low, high))
            self.assertEqual((level["invalid_vertices"], level["truncated_vertices"]), (0, 0))
        text = self.semigeo("info", self.dataset("sphere.ply")).stdout
        self.assertIn(document["digest"], text)
        self.assertEqual(len(text.splitlines()), 8 + 3 + 1 + 3)
        self.assertLessEqual(max(len(line) for line in text.splitlines()[-4:]), 120)
        self.assertIn(f"level {document['selection']['level']}, chosen by the curve", text)
        with h5py.File(self.dataset("sphere.ply"), "r") as file:
            for k, level in enumerate(document["levels"]):
                group = file[f"levels/{k:03d}"]
                names = ("gaussian", "mean", "gaussian_torsion", "mean_torsion")
                kinds = list(group["features"]["kind"])
                self.assertEqual(level["features"],
                                 {name: kinds.count(i) for i, name in enumerate(names)})
                self.assertEqual(sum(level["features"].values()),
                                 document["selection"]["feature_counts"][k])
                self.assertEqual(level["contours"],
                                 {name: {"count": list(group["contours"]["kind"]).count(i),
                                         "length": group.attrs["contour_lengths"][i]}
                                  for i, name in enumerate(names[:2])})
            self.assertEqual(document["selection"]["level"], file["selection"].attrs["level"])
            self.assertEqual(document["selection"]["smoothed"], list(file["selection/smoothed"]))

    def test_of_an_archive(self):
        for target in (self.archive, self.archive / "scans"):
            document = json.loads(self.semigeo("info", target, "--json").stdout)
            self.assertEqual([(d["input_name"], d["vertices"], d["triangles"], d["levels"])
                              for d in document["datasets"]],
                             [("sphere.ply", 642, 1280, 3), ("square.ply", 121, 200, 3)])
        lines = self.semigeo("info", self.archive).stdout.splitlines()
        self.assertEqual([line.split()[0] for line in lines], ["sphere.ply", "square.ply"])

    def test_check_as_json(self):
        document = json.loads(self.semigeo("check", self.archive, "--json").stdout)
        self.assertEqual(document["broken"], 0)
        self.assertEqual([(Path(f["file"]).name, f["ok"]) for f in document["files"]],
                         [("sphere.ply.vtkhdf", True), ("square.ply.vtkhdf", True)])
        self.dataset("square.ply").write_text("not HDF5")
        process = self.semigeo("check", self.archive, "--json", code=1)
        document = json.loads(process.stdout)
        self.assertEqual(document["broken"], 1)
        self.assertIn("square.ply.vtkhdf", document["files"][1]["error"])


if __name__ == "__main__":
    unittest.main()
