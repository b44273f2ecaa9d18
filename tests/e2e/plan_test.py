"""What a run says of its plan before it does anything: --explain and --dag; and the journal of what it
did then."""

import json
import signal
import subprocess
import time
import unittest

from support import PROGRAM, TIMEOUT, SemigeoTest, icosphere, write_ply


class ExplainTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        for i, name in enumerate("abc"):
            write_ply(self.scans / f"{name}.ply", icosphere(1, 1 + i))

    def explained(self, *arguments):
        """The lines about each scan, without those for programs and the totals."""
        process = self.semigeo("run", self.scans, "--output", self.archive, "--explain", *arguments)
        return process.stdout.splitlines()

    def test_every_difference_is_named(self):
        self.assertEqual(self.explained("--dry-run")[:2],
                         ["a.ply: would run: no dataset yet", "    no dataset yet"])
        self.run_scans("--levels", 1)
        self.assertEqual(self.explained("--dry-run", "--levels", 1),
                         ["3 scans: 0 would run, 3 up to date"])
        write_ply(self.scans / "a.ply", icosphere(1, 7))
        self.dataset("b.ply").write_text("no dataset")
        self.dataset("c.ply").with_suffix(".xdmf").unlink()
        lines = self.explained("--dry-run", "--levels", 1)
        self.assertEqual(lines[0], "a.ply: would run: the scan changed")
        self.assertRegex(lines[1], r"^    scan: other bytes; XXH3 [0-9a-f]{32}, now [0-9a-f]{32}$")
        self.assertEqual(lines[2],
                         "b.ply: would run: the dataset is damaged, incomplete or of another format")
        self.assertRegex(lines[3], r"^    dataset: .+")
        self.assertEqual(lines[4], "c.ply: would run: its .xdmf is missing")
        self.assertEqual(lines[-1], "3 scans: 3 would run, 0 up to date")
        lines = self.explained("--dry-run", "--levels", 2, "--unit", "mm")
        self.assertEqual(lines[0], "a.ply: would run: the scan and the parameters changed")
        self.assertEqual(lines[2:4], ['    parameter length_unit: "unknown", now "mm"',
                                      "    parameter levels: 1, now 2"])

    def test_json_has_the_values(self):
        self.run_scans("--levels", 1)
        document = self.run_scans("--levels", 2, "--step", 1.5, "--dry-run")
        self.assertEqual(document["scans"][0]["reasons"],
                         [{"kind": "parameter", "name": "levels", "before": 1, "now": 2},
                          {"kind": "parameter", "name": "step", "before": 1.0, "now": 1.5}])

    def test_a_run_explains_before_it_runs(self):
        lines = self.explained("--levels", 0)
        self.assertEqual(lines[:2], ["a.ply: would run: no dataset yet", "    no dataset yet"])
        self.assertIn("3 done, 0 up to date, 0 failed", lines[-1])
        self.assertEqual(len(lines), 3 * 2 + 2)


class DagTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        write_ply(self.scans / "a.ply", icosphere(1))
        write_ply(self.scans / 'sub/b "c".ply', icosphere(1, 2))

    def test_the_graph_as_json(self):
        run = ("run", self.scans, "--output", self.archive, "--levels", 0)
        nodes = json.loads(self.semigeo(*run, "--dag", "json").stdout)["nodes"]
        self.assertFalse(self.archive.exists())  # nothing was run
        self.assertEqual([(node["kind"], node["state"]) for node in nodes],
                         2 * [("scan", "readable"), ("surface", "would run"),
                              ("dataset", "missing")])
        self.assertEqual(nodes[0]["name"], str(self.scans / "a.ply"))
        self.assertEqual(nodes[2]["name"], str(self.dataset("a.ply")))
        self.assertEqual([node["dependencies"] for node in nodes[:3]],
                         [[], [nodes[0]["id"]], [nodes[1]["id"]]])
        self.semigeo(*run)
        nodes = json.loads(self.semigeo(*run, "--dag", "json").stdout)["nodes"]
        self.assertEqual([node["state"] for node in nodes],
                         2 * ["readable", "up to date", "up to date"])

    def test_the_graph_for_graphviz(self):
        dot = self.semigeo("run", self.scans, "--output", self.archive, "--dag", "dot").stdout
        self.assertTrue(dot.startswith("digraph semigeo {"))
        self.assertEqual(dot.count(" -> "), 4)
        self.assertIn('b \\"c\\".ply', dot)
        self.semigeo("run", self.scans, "--output", self.archive, "--dag", "png", code=2)


class StatusTest(SemigeoTest):
    def test_it_tells_how_the_last_run_ended(self):
        write_ply(self.scans / "a.ply", icosphere(2))
        (self.scans / "b.ply").write_text("no ply")
        self.run_scans("--levels", 1, code=1)
        status = json.loads(self.semigeo("status", self.archive, "--json").stdout)
        self.assertEqual((status["state"], status["done"], status["left"], status["datasets"]),
                         ("ended", 1, 0, 1))
        self.assertIn("b.ply", status["failed"]["surface b.ply"])
        text = self.semigeo("status", self.archive).stdout
        self.assertIn("1 done, 0 up to date, 1 failed, 0 running, 0 left", text)
        self.assertIn("failed: surface b.ply: ", text)
        self.semigeo("status", self.folder / "nothing", code=1)


class JournalTest(SemigeoTest):
    def events(self):
        lines = (self.archive / "journal.jsonl").read_text().splitlines()
        return [json.loads(line) for line in lines]

    def test_it_tells_what_every_run_did(self):
        write_ply(self.scans / "a.ply", icosphere(2))
        (self.scans / "b.ply").write_text("no ply")
        self.run_scans("--levels", 1, "--threads", 1, code=1)  # one after the other
        events = self.events()
        self.assertEqual([(e["event"], e.get("job"), e.get("state")) for e in events],
                         [("run_started", None, None), ("started", "surface a.ply", None),
                          ("ended", "surface a.ply", "done"), ("started", "surface b.ply", None),
                          ("ended", "surface b.ply", "failed"), ("run_ended", None, None)])
        done = events[2]
        self.assertEqual({key: done[key] for key in ("vertices", "levels", "input_bytes",
                                                     "format", "error")},
                         {"vertices": 162, "levels": 2, "format": "PLY binary", "error": "",
                          "input_bytes": (self.scans / "a.ply").stat().st_size})
        self.assertIn("b.ply", events[4]["error"])
        self.assertEqual({(e["done"], e["failed"]) for e in events[-1:]}, {(1, 1)})
        self.assertEqual(len({e["run"] for e in events}), 1)
        # A dry run is no run.
        self.run_scans("--levels", 1, "--dry-run")
        self.assertEqual(len(self.events()), len(events))

    def test_nothing_depends_on_it(self):
        write_ply(self.scans / "a.ply", icosphere(1))
        self.run_scans("--levels", 1)
        journal = self.archive / "journal.jsonl"
        for text in (b"", b"torn", b"\xff\n\0\n", b"x" * 1000000):
            journal.write_bytes(text)
            self.assertEqual(self.run_scans("--levels", 1)["up_to_date"], 1)
            self.assertTrue(journal.read_bytes().startswith(text + b"\n" if text[-1:] not in
                                                            (b"", b"\n") else text))
            self.assertEqual(json.loads(journal.read_bytes().splitlines()[-1])["event"],
                             "run_ended")
        journal.unlink()
        journal.mkdir()
        process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 1)
        self.assertIn("1 up to date", process.stdout)
        self.assertIn("journal.jsonl", process.stderr)

    def test_a_killed_run_has_begun_what_it_did_not_end(self):
        for i in range(3):
            write_ply(self.scans / f"{i}.ply", icosphere(5, 1 + i))
        process = subprocess.Popen([PROGRAM, "run", self.scans, "--output", self.archive],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        journal = self.archive / "journal.jsonl"
        deadline = time.monotonic() + TIMEOUT
        while not (journal.exists() and b'"started"' in journal.read_bytes()):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.0005)
        process.kill()
        self.assertEqual(process.wait(), -signal.SIGKILL)
        self.assertNotIn("run_ended", [event["event"] for event in self.events()])
        self.run_scans()
        self.assertEqual(self.events()[-1]["event"], "run_ended")

    def test_estimates_are_learned_from_it(self):
        for i in range(3):
            write_ply(self.scans / f"{i}.ply", icosphere(5, 1 + i))
        self.run_scans("--levels", 1)
        estimates = json.loads((self.archive / "estimates.json").read_text())
        size = (self.scans / "0.ply").stat().st_size
        self.assertAlmostEqual(estimates["formats"]["PLY binary"]["file_bytes_per_vertex"],
                               size / 10242)


if __name__ == "__main__":
    unittest.main()
