"""What people read on a terminal: numbers with all their digits, names that cannot steer it."""

import json
import os
import pty
import re
import subprocess
import unittest
from pathlib import Path

from support import PROGRAM, TIMEOUT, SemigeoTest, boulder, plane, write_ply

LEVELS = ("--levels", 2)
ORIGIN = (432109.001, 5123456.789, 123.456)


def numbers(text):
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?", text)]


class NumbersTest(SemigeoTest):
    """A scan in map coordinates, and the same at the origin."""

    def setUp(self):
        super().setUp()
        points, triangles = boulder(4, 1)
        self.scene = write_ply(self.folder / "scene.ply", (points + ORIGIN, triangles))
        write_ply(self.scans / "map.ply", (points + ORIGIN, triangles))
        write_ply(self.scans / "origin.ply", (points, triangles))
        self.semigeo("run", self.scans, "-o", self.archive, "--library", *LEVELS)

    def test_info_shows_origin_scales_and_lengths_in_full(self):
        dataset = self.dataset("map.ply")
        document = json.loads(self.semigeo("info", dataset, "--json").stdout)
        text = self.semigeo("info", dataset).stdout
        origin = next(line for line in text.splitlines() if line.startswith("  origin"))
        self.assertEqual(numbers(origin), document["origin"])
        shown = numbers(text)
        for level in document["levels"]:
            lengths = [level["scale"]] + [level["contours"][kind]["length"]
                                          for kind in ("gaussian", "mean")]
            for length in lengths:
                self.assertTrue(any(abs(number - length) <= 1e-14 * abs(length) for number in shown),
                                length)
            for curvature in level["gaussian_curvature"] + level["mean_curvature"]:
                self.assertTrue(any(abs(number - curvature) <= 6e-8 * abs(curvature)
                                    for number in shown), curvature)
        scales = document["levels"][0]["scale"], document["levels"][-1]["scale"]
        line = next(line for line in self.semigeo("info", self.archive).stdout.splitlines()
                    if line.startswith("map.ply"))
        for found, wanted in zip(numbers(line.split("scale")[1]), scales):
            self.assertAlmostEqual(found, wanted, delta=1e-14 * wanted)

    def test_recognise_shows_poses_in_full(self):
        arguments = ("recognise", self.scene, "--library", self.archive)
        document = json.loads(self.semigeo(*arguments, "--json").stdout)
        text = self.semigeo(*arguments).stdout
        pose = document["scenes"][0]["recognised"]["objects"][0]["pose"]
        seven = next(line for line in text.splitlines() if "d h q" in line)
        wanted = [pose[name] for name in ("scale", "d", "h", "q", "gamma_degrees", "beta_degrees",
                                          "alpha_degrees")]
        for found, number in zip(numbers(seven), wanted, strict=True):
            self.assertAlmostEqual(found, number, delta=1e-14 * abs(number))
        lines = text[text.index(seven):].splitlines()[1:5]
        for line, row in zip(lines, pose["matrix"]):
            for found, number in zip(numbers(line), row, strict=True):
                self.assertAlmostEqual(found, number, delta=1e-14 * abs(number))

    def test_a_translation_over_a_map_keeps_its_millimetres(self):
        # The better of two equal models is in map coordinates; without it the pose leads there.
        self.semigeo("library", "remove", self.archive, "map.ply")
        text = self.semigeo("recognise", self.scene, "--library", self.archive).stdout
        d, h, q = numbers(re.search(r"d h q (.*?);", text)[1])
        for found, wanted in zip((d, h, q), ORIGIN):
            self.assertAlmostEqual(found, wanted, delta=0.01)
            self.assertNotEqual(found, round(found))
        self.assertRegex(text, r"5123456\.\d{3}")

    def test_csv_and_library_have_all_digits(self):
        csv = self.folder / "features.csv"
        self.semigeo("export", self.dataset("map.ply"), "--features", "all", "-o", csv)
        rows = [line.split(",") for line in csv.read_text().splitlines()]
        x, y = rows[0].index("x"), rows[0].index("y")
        for row in rows[1:]:
            self.assertLess(abs(float(row[x]) - ORIGIN[0]), 2)
            self.assertRegex(row[y], r"^51234\d\d\.\d{3}")
        models = json.loads(self.semigeo("library", "list", self.archive, "--json").stdout)["models"]
        text = self.semigeo("library", "list", self.archive).stdout
        for model in models:
            found = float(re.search(rf"{re.escape(model['name'])}: .*diagonal (\S+)", text)[1])
            self.assertAlmostEqual(found, model["diagonal"], delta=6e-8 * found)


HOSTILE = ("esc\x1b[31m\x1b]0;title\a.ply", "line\nfailed: all.ply", "c1\u009b31m.ply",
           "turned\u202eylp.stl.ply", "bytes\udcff\udcfe.ply", "del\x7f.ply")
KIND = ("статуя.ply", "像 7.ply", "50% Öl.ply")


class NamesTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        for name in HOSTILE + KIND:
            write_ply(self.scans / name, plane(4))
            (self.scans / f"bad {name}").write_text("ply\n")

    def assert_harmless(self, data, lines=True):
        """No byte of it steers a terminal."""
        text = data.decode()  # it is UTF-8
        for character in text:
            code = ord(character)
            self.assertFalse((code < 0x20 and character not in "\n\r") or 0x7f <= code < 0xa0 or
                             0x2028 <= code <= 0x202e or 0xdc80 <= code <= 0xdcff,
                             f"{character!r} in {text}")

    def outputs(self, *arguments):
        process = subprocess.run([PROGRAM, *arguments], capture_output=True, timeout=TIMEOUT)
        return process.stdout, process.stderr

    def test_no_name_steers_the_terminal(self):
        run = ("run", self.scans, "-o", self.archive, *map(str, LEVELS))
        commands = [(*run, "--dry-run", "--explain"), (*run, "--dag", "dot"), (*run, "--dag", "json"),
                    (*run, "--json"), (*run, "--explain", "--library"), ("status", self.archive),
                    ("status", self.archive, "--json"), ("info", self.archive),
                    ("info", self.archive, "--json"), ("check", self.archive),
                    ("library", "list", self.archive),
                    ("recognise", self.scans, "--library", self.archive),
                    ("recognise", self.scans, "--library", self.archive, "--json"),
                    ("info", "none\x1b[31m"), ("run", "none\x1b[31m", "-o", "x"),
                    ("export", self.archive / "x", "-o", "\x1b[31m")]
        commands += [("info", path) for path in (self.archive / "scans").glob("*.vtkhdf")]
        for arguments in commands:
            with self.subTest(arguments=arguments):
                for data in self.outputs(*arguments):
                    self.assert_harmless(data)

    def test_on_a_terminal_only_the_live_line_moves_the_cursor(self):
        read, write = pty.openpty()
        process = subprocess.Popen([PROGRAM, "run", self.scans, "-o", self.archive],
                                   stdout=subprocess.DEVNULL, stderr=write)
        os.close(write)
        data = b""
        try:
            while piece := os.read(read, 65536):
                data += piece
        except OSError:
            pass  # the end of a terminal
        process.wait(60)
        self.assert_harmless(data.replace(b"\r\x1b[K", b""))

    def test_one_failure_is_one_line(self):
        stdout, stderr = self.outputs("run", self.scans, "-o", self.archive)
        failed = len(HOSTILE + KIND)
        lines = [line for line in stderr.decode().splitlines() if line.startswith("failed: ")]
        self.assertEqual(len(lines), failed)
        lines = [line for line in stdout.decode().splitlines() if line.startswith("failed")]
        self.assertEqual(len(lines), 1)
        self.assertIn(f"failed, {failed} times: ", lines[0])

    def test_names_of_every_script_are_shown_as_they_are(self):
        _, stderr = self.outputs("run", self.scans, "-o", self.archive)
        listed, _ = self.outputs("info", self.archive)
        scans, _ = self.outputs("run", self.scans, "-o", self.archive, "--json")
        for name in KIND:
            self.assertIn(f"/bad {name}: ", stderr.decode())
            self.assertIn(f"\n{name}  ", "\n" + listed.decode())
            self.assertIn(str(self.scans / name),
                          [scan["input"] for scan in json.loads(scans)["scans"]])


class GivenNamesTest(SemigeoTest):
    """Models are shown under the names of their scans, in any script."""

    def test_models_have_the_names_that_people_gave(self):
        names = ("像 7.ply", "50% Öl.ply", "plain.ply", "esc\x1b[31m.ply")
        for seed, name in enumerate(names):
            write_ply(self.scans / name, boulder(3, seed))
        self.semigeo("run", self.scans, "-o", self.archive, "--library", *LEVELS)
        listed = self.semigeo("library", "list", self.archive)
        said = self.semigeo("recognise", self.scans / "像 7.ply", "--library", self.archive)
        for text in (listed.stdout, said.stdout):
            self.assertIn("像 7.ply (____7.ply-", text)
            self.assertRegex(text, r"(?m)(^| )plain\.ply\b")
            self.assertNotIn("plain.ply (", text)
            self.assertNotIn("%20", text)
            self.assertNotIn("\x1b", text)
        self.assertIn("50% Öl.ply (", listed.stdout)
        self.assertIn("esc\\x1b[31m.ply (", listed.stdout)
        models = json.loads(self.semigeo("library", "list", self.archive, "--json").stdout)["models"]
        self.assertEqual({Path(model["scan"]).name for model in models}, set(names))
        document = json.loads(self.semigeo("recognise", self.scans / "像 7.ply", "--library",
                                           self.archive, "--json").stdout)
        best = document["scenes"][0]["recognised"]["ranking"][0]
        self.assertEqual(best["scan"], str(self.scans / "像 7.ply"))

    def test_models_of_a_library_elsewhere_keep_their_names_in_any_script(self):
        write_ply(self.scans / "a.ply", boulder(3, 1))
        self.semigeo("run", self.scans, "-o", self.archive, *LEVELS)
        for name in ("статуя", "像 50%41"):
            self.dataset(name).write_bytes(self.dataset("a.ply").read_bytes())
        library = self.folder / "mine.h5"
        datasets = [self.dataset(name) for name in ("статуя", "像 50%41")]
        self.semigeo("library", "build", *datasets, "--output", library)
        models = json.loads(self.semigeo("library", "list", library, "--json").stdout)["models"]
        self.assertEqual([model["name"] for model in models], ["статуя", "像 50%41"])
        text = self.semigeo("library", "list", library).stdout
        self.assertIn("像 50%41: ", text)
        self.assertIn("статуя: ", text)


if __name__ == "__main__":
    unittest.main()
