"""What the end of a run says, and that each failure is said once."""

import json
import os
import pty
import subprocess
import unittest

from support import PROGRAM, TIMEOUT, SemigeoTest, icosphere, write_ply

LEVELS = ("--levels", "1")


class ReportTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        write_ply(self.scans / "good.ply", icosphere(2))
        self.bad = [self.scans / f"bad{i}.ply" for i in range(3)]
        for path in self.bad:
            path.write_text("ply\n")
        self.run_command = [str(PROGRAM), "run", str(self.scans), "-o", str(self.archive), *LEVELS]

    def assert_each_once(self, text):
        for path in self.bad:
            self.assertEqual(text.count(f"failed: {path}: "), 1, text)

    def test_one_file_has_each_failure_once(self):
        process = subprocess.run(self.run_command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                 text=True, timeout=TIMEOUT)
        self.assert_each_once(process.stdout)
        with open(self.folder / "log", "w+") as log:
            subprocess.run(self.run_command, stdout=log, stderr=log, timeout=TIMEOUT)
        self.assert_each_once((self.folder / "log").read_text())

    def test_one_terminal_has_each_failure_once(self):
        read, write = pty.openpty()
        process = subprocess.Popen(self.run_command, stdout=write, stderr=write)
        os.close(write)
        data = b""
        try:
            while piece := os.read(read, 65536):
                data += piece
        except OSError:
            pass  # the end of a terminal
        process.wait(60)
        self.assert_each_once(data.decode())
        self.assertIn("1 done, 0 up to date, 3 failed", data.decode())

    def test_two_files_have_it_each(self):
        process = self.semigeo(*self.run_command[1:], code=1)
        self.assert_each_once(process.stdout)
        self.assert_each_once(process.stderr)

    def test_quiet_is_told_at_the_end_only(self):
        process = self.semigeo(*self.run_command[1:], "--quiet", code=1)
        self.assertEqual(process.stderr, "")
        self.assert_each_once(process.stdout)
        process = subprocess.run([*self.run_command, "--quiet"], stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, text=True, timeout=TIMEOUT)
        self.assert_each_once(process.stdout)

    def test_many_are_summed_up_and_status_has_the_details(self):
        for i in range(3, 30):
            (self.scans / f"bad{i}.ply").write_text("ply\n")
        points, triangles = icosphere(1)
        flipped = triangles.copy()
        flipped[0] = flipped[0][::-1]
        for i in range(8):
            write_ply(self.scans / f"repaired{i}.ply", (points, flipped))
        said = self.semigeo(*self.run_command[1:], code=1).stdout
        self.assertLess(len(said.splitlines()), 8)
        self.assertIn(f"failed, 30 times: {self.bad[0]}: ", said)
        self.assertIn("repaired: 8 scans: 8 flipped faces\n", said)
        self.assertIn(f"details: semigeo status {self.archive} --details\n", said)
        status = self.semigeo("status", self.archive).stdout
        self.assertIn("failed, 30 times: ", status)
        self.assertNotIn("repaired", status)
        details = self.semigeo("status", self.archive, "--details").stdout
        self.assertEqual(details.count("failed: surface bad"), 30)
        self.assertIn("repaired: surface repaired7.ply: 1 flipped faces\n", details)
        document = json.loads(self.semigeo("status", self.archive, "--json").stdout)
        self.assertEqual(document["notes"]["surface repaired0.ply"], {"repaired": "1 flipped faces"})
        self.assertEqual(len(document["failed"]), 30)


if __name__ == "__main__":
    unittest.main()
