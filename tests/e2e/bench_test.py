"""`semigeo bench`: figures, documents, comparison with a baseline, and what it leaves behind."""

import json
import os
import signal
import subprocess
import time
import unittest

from support import PROGRAM, TIMEOUT, SemigeoTest, boulder, write_ply

FAST = ("bench", "--quick", "--filter", "read/ply|level/even")


class BenchTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()
        self.environment = dict(os.environ, TMPDIR=str(self.temporary))

    def bench(self, *arguments, code=0):
        process = self.semigeo(*FAST, *arguments, code=code, env=self.environment)
        self.assertEqual(list(self.temporary.iterdir()), [], "files were left behind")
        return process

    def scaled(self, path, factor):
        """The baseline as if everything had been `factor` times as fast."""
        document = json.loads(path.read_text())
        for entry in document["benchmarks"]:
            entry["items_per_second"] *= factor
            entry["real_time"] /= factor
            entry["cpu_time"] /= factor
        result = self.folder / "scaled.json"
        result.write_text(json.dumps(document))
        return result

    def test_list_names_what_there_is(self):
        names = self.semigeo("bench", "--list", "--threads", 2, env=self.environment).stdout.split()
        self.assertEqual(list(self.temporary.iterdir()), [])
        for name in ("machine/memory", "kernel/scalar/even", "kernel/baseline/scan", "level/even", "level/scan",
                     "job/small", "job/large", "job/scan", "read/ply", "read/obj", "read/dataset", "write/ply",
                     "write/dataset", "library/triplets", "library/build", "recognise/scene"):
            self.assertIn(f"{name}/threads:1", names)
            self.assertIn(f"{name}/threads:2", names)
        self.assertEqual(len(names), len(set(names)))

    def test_every_case_runs(self):
        scan = self.folder / "mine.ply"
        write_ply(scan, boulder(3, 1))
        process = self.semigeo("bench", "--quick", "--threads", 2, "--scan", scan, "--json", env=self.environment)
        document = json.loads(process.stdout)
        names = {entry["run_name"] for entry in document["benchmarks"]}
        listed = self.semigeo("bench", "--list", "--threads", 2).stdout.split()
        self.assertEqual(names, set(listed))
        for entry in document["benchmarks"]:
            if entry["run_type"] == "iteration":
                self.assertGreater(entry["items_per_second"], 0, entry["name"])
                self.assertGreater(entry["real_time"], 0, entry["name"])
        self.assertEqual(document["context"]["scan"], str(scan))
        self.assertEqual(list(self.temporary.iterdir()), [])

    def test_a_table_and_a_document_for_later(self):
        base = self.folder / "base.json"
        table = self.bench("--output", base).stdout
        for text in ("machine/memory", "read/ply", "MB/s", "spread", "bounded by", "load average"):
            self.assertIn(text, table)
        self.assertNotIn("level/scan", table)
        document = json.loads(base.read_text())
        self.assertTrue(document["context"]["quick"])
        entries = [e for e in document["benchmarks"] if e["run_name"] == "read/ply/threads:1"]
        self.assertEqual([e["run_type"] for e in entries[-4:]], ["aggregate"] * 4)
        self.assertGreaterEqual(len(entries), 3 + 4)

    def test_the_document_of_github(self):
        document = json.loads(self.bench("--format", "github").stdout)
        entry = next(e for e in document if e["name"] == "read/ply/threads:1")
        self.assertEqual(entry["unit"], "MB/s")
        self.assertGreater(entry["value"], 0)
        self.assertTrue(entry["range"].startswith("± "))

    def test_what_fell_is_named_and_is_exit_code_1(self):
        base = self.folder / "base.json"
        self.bench("--output", base)
        faster = self.scaled(base, 1000)
        process = self.bench("--baseline", faster, "--fail-below", 0.9, code=1)
        self.assertIn("fell: read/ply/threads:1:", process.stdout)
        self.assertIn("fell: level/even/threads:1:", process.stdout)
        self.assertNotIn("fell: machine/", process.stdout)
        self.assertIn("The machine itself differs", process.stdout)
        slower = self.scaled(base, 0.001)
        process = self.bench("--baseline", slower, "--fail-below", 0.9, "--json")
        json.loads(process.stdout)
        self.assertIn("No figure fell below 0.9 of the baseline.", process.stderr)
        self.assertIn("faster", process.stderr)

    def test_misuse_is_exit_code_2(self):
        other = self.folder / "other.json"
        other.write_text("{}")
        for arguments in (("--filter", "nothing-has-this-name"), ("--filter", "("), ("--baseline", other),
                          ("--baseline", self.folder / "missing.json"), ("--fail-below", "0.9"),
                          ("--format", "xml"), ("--scan", self.folder / "missing.ply")):
            with self.subTest(arguments=arguments):
                process = self.semigeo("bench", "--quick", *arguments, code=2, env=self.environment)
                self.assertEqual(process.stdout, "")
                self.assertNotEqual(process.stderr, "")
                self.assertEqual(list(self.temporary.iterdir()), [])

    def test_an_interrupted_measurement_leaves_nothing(self):
        process = subprocess.Popen([PROGRAM, "bench"], env=self.environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + TIMEOUT
        while not list(self.temporary.rglob("*.*")) and time.monotonic() < deadline:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=TIMEOUT)
        self.assertEqual(process.returncode, 75)
        self.assertEqual(out, "")
        self.assertIn("stopped before everything was measured", err)
        self.assertEqual(list(self.temporary.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
