"""The report of an archive: what `semigeo report` writes, and how it behaves in a browser. Started with the
folder of playwright-core, node and a browser, or with "none" three times, which skips what needs a browser."""

import json
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

PROGRAM, PACKAGES, NODE, BROWSER = sys.argv[1:5]
del sys.argv[2:5]

import numpy as np  # noqa: E402

from support import TIMEOUT, SemigeoTest, boulder, cpu_of_children, icosphere, joined, write_ply  # noqa: E402

HERE = Path(__file__).resolve().parent
IMAGE = "<img src=x onerror=alert(1)>.ply"
SCRIPT = "</script><script>alert(2)</script>.ply"
GREEK = "αγγείο.ply"


# Without the report the program says so whatever it is given.
HAS_REPORT = subprocess.run([PROGRAM, "report", "/nonexistent"], capture_output=True).returncode != 2


@unittest.skipIf(HAS_REPORT, "this program has the report")
class NoReportTest(SemigeoTest):
    def test_it_says_that_it_has_none_and_why(self):
        process = self.semigeo("report", self.folder, code=2)
        self.assertIn("this program has no report: ", process.stderr)
        self.assertIn("install node and npm", process.stderr)
        run = self.semigeo("run", self.scans, "--output", self.archive, "--report", code=2)
        self.assertEqual(run.stderr, process.stderr)
        self.assertFalse(self.archive.exists())


def page_data(path):
    """The document in a page."""
    text = path.read_text()
    return json.loads(text.split('<script type="application/json" id="data">')[1].split("</script>")[0])


@unittest.skipUnless(HAS_REPORT, "this program has no report")
class ReportTest(SemigeoTest):
    def report(self, *arguments):
        return json.loads(self.semigeo("report", self.archive, "--json", *arguments).stdout)

    def browse(self, check, *arguments):
        if BROWSER == "none":
            self.skipTest("no browser")
        environment = dict(os.environ, HOME=str(self.folder), TMPDIR=str(self.folder))
        process = subprocess.run([NODE, HERE / "report_browser.mjs", PACKAGES, BROWSER, check, *map(str, arguments)],
                                 capture_output=True, text=True, timeout=TIMEOUT, env=environment)
        self.assertEqual(process.returncode, 0, process.stdout + process.stderr)
        return process.stdout

    def make_archive(self):
        write_ply(self.scans / "boulder.ply", boulder(3, 1))
        write_ply(self.scans / IMAGE, icosphere(2))
        write_ply(self.scans / SCRIPT, icosphere(3))
        write_ply(self.scans / GREEK, icosphere(2))
        (self.scans / "<b>broken.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\n")
        (self.scans / "readme.txt").write_text("no scan")
        self.run_scans("--levels", 2, "--unit", "mm", code=1)

    def test_the_index_sorts_filters_lists_failures_and_runs_nothing(self):
        self.make_archive()
        told = self.report()
        index = Path(told["report"])
        self.assertEqual((index, told["scans"], told["failures"]), (self.archive / "report/index.html", 5, 1))
        failed = json.loads(self.semigeo("status", self.archive, "--json").stdout)["failed"]
        reason, remedy = next(iter(failed.values())).rsplit("; ", 1)
        self.browse("index", index, json.dumps({
            "title": "archive", "names": ["boulder.ply", IMAGE, SCRIPT, GREEK, "<b>broken.ply"],
            "failed": "<b>broken.ply", "reason": reason, "remedy": remedy, "scenes": []}))

    def make_scene(self):
        """Two models with hostile names in a scene with another one."""
        write_ply(self.scans / IMAGE, boulder(4, 1))
        write_ply(self.scans / SCRIPT, boulder(4, 2))
        self.run_scans("--levels", 2, "--library")
        (first, faces), (second, _) = boulder(4, 1), boulder(4, 2)
        turned = second @ np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]]).T * 1.5 + [4, 0, 0]
        scene = write_ply(self.folder / "scenes" / IMAGE, joined((first, faces), (turned, faces)))
        self.semigeo("recognise", scene, "--library", self.archive, "--output", self.archive)
        recognised, = (path for path in (self.archive / "recognised").iterdir() if path.name != "sources.json")
        return json.loads(recognised.read_text())

    def test_a_recognised_scene_has_a_page(self):
        found = self.make_scene()
        told = self.report()
        self.assertEqual((told["pages_made"], told["pages_failed"]), (3, 0))
        page, = (self.archive / "report/scenes").iterdir()
        self.assertLess(page.stat().st_size, 6e6)
        data = page_data(page)
        self.assertEqual(len(data["objects"]), 2)
        for found_object in data["objects"]:
            # The scene is made of the models: they lie on it, up to the precision of the poses.
            self.assertLess(found_object["residual"]["median"], 0.01)
            self.assertAlmostEqual(found_object["residual"]["share"], 0.5, delta=0.05)
        titles = [data["titles"][one["model"]] for one in data["objects"]]
        self.assertEqual(sorted(titles), sorted([IMAGE, SCRIPT]))
        self.browse("scene", page, json.dumps({"title": IMAGE, "models": titles,
                                               "matrix": found["objects"][0]["pose"]["matrix"]}))
        index = page_data(Path(told["report"]))
        self.assertEqual([scene["title"] for scene in index["scenes"]], [IMAGE])
        # What is gone is named on the page, and the rest of it is there.
        shutil.rmtree(self.folder / "scenes")
        self.dataset(data["objects"][0]["model"]).unlink()
        self.assertEqual(self.report()["pages_failed"], 0)
        data = page_data(page)
        self.assertIn("missing", data["surface"])
        self.assertEqual(sum("missing" in model for model in data["models"]), 1)
        self.assertEqual(len(data["objects"]), 2)

    def test_a_run_makes_the_report_with_its_datasets(self):
        write_ply(self.scans / "a.ply", boulder(2, 1))
        write_ply(self.scans / "b.ply", boulder(2, 2))
        run = ("run", self.scans, "--output", self.archive, "--levels", 1, "--report")
        graph = json.loads(self.semigeo(*run, "--dag", "json").stdout)["nodes"]
        jobs = [node["id"] for node in graph if "state" in node and node["state"] == "would run"]
        self.assertEqual(jobs, ["surface a.ply", "surface b.ply", "page a.ply", "page b.ply", "report index.html"])
        self.assertFalse(self.archive.exists())
        said = self.semigeo(*run).stdout
        self.assertIn(f"report: {self.archive}/report/index.html\n", said)
        self.assertEqual([scan["state"] for scan in page_data(self.archive / "report/index.html")["scans"]],
                         ["done", "done"])
        self.assertIn("5 up to date", self.semigeo(*run).stdout)
        # The command agrees with the run.
        told = self.report()
        self.assertEqual((told["pages_made"], told["pages_up_to_date"], told["scans"]), (0, 2, 2))
        self.assertIn("would run", self.semigeo("report", self.archive, "--output", self.folder / "x", "--dry-run").stdout)
        write_ply(self.scans / "b.ply", boulder(3, 2))
        dry = json.loads(self.semigeo(*run, "--dry-run", "--json").stdout)
        self.assertEqual({job["name"]: job["state"] for job in dry["jobs"]},
                         {"a.ply": "up to date", "b.ply": "would run", "index.html": "would run"})
        self.semigeo(*run)
        self.assertEqual(self.report()["pages_made"], 0)

    def test_one_scan_harms_no_other_page(self):
        for name in "abc":
            write_ply(self.scans / f"{name}.ply", boulder(3, ord(name)))
        self.run_scans("--levels", 1)
        for fault in ("crash", "crash-once"):
            process = self.semigeo("report", self.archive, "--json", "--retries", int(fault == "crash-once"),
                                   code=int(fault == "crash"), env=dict(os.environ, SEMIGEO_TEST_FAULTS=f"page b.ply={fault}"))
            told = json.loads(process.stdout)
            self.assertEqual((told["pages_made"], told["pages_failed"]), (2, 1) if fault == "crash" else (1, 0))
            if fault == "crash":
                self.assertIn("crashed (signal 11", process.stderr)
        with open(self.dataset("b.ply"), "r+b") as file:  # damage behind the header
            file.seek(self.dataset("b.ply").stat().st_size // 2)
            file.write(b"\xff" * 4096)
        process = self.semigeo("report", self.archive, "--output", self.folder / "pages", "--json", code=1)
        told = json.loads(process.stdout)
        self.assertEqual((told["pages_made"], told["pages_failed"], told["scans"]), (2, 1, 3))
        scans = page_data(Path(told["report"]))["scans"]
        self.assertEqual(sorted(scan["name"] for scan in scans if "page" in scan), ["a.ply", "c.ply"])

    def test_a_report_is_made_while_a_run_has_the_archive(self):
        write_ply(self.scans / "a.ply", boulder(2, 1))
        self.run_scans("--levels", 1)
        before = (self.archive / "journal.jsonl").read_bytes()
        (self.archive / "lock").write_text(json.dumps({"host": "elsewhere", "pid": 1, "boot_id": "x",
                                                       "process_started": 1, "since": "2024-05-31T21:00:00Z"}))
        self.assertEqual(self.report()["pages_made"], 1)
        self.assertEqual((self.archive / "journal.jsonl").read_bytes(), before)

    def test_the_same_archive_gives_the_same_page_elsewhere(self):
        self.make_archive()
        first = Path(self.report()["report"]).read_bytes()
        elsewhere = Path(self.report("--output", self.folder / "a/b")["report"])
        self.assertEqual(elsewhere, self.folder / "a/b/index.html")
        self.assertEqual(elsewhere.read_bytes(), first)
        self.assertEqual(sorted(path.name for path in elsewhere.parent.iterdir()), ["index.html", "scans"])

    def test_a_scan_is_drawn_level_by_level(self):
        points, triangles = boulder(4, 1)
        opened = triangles[points[triangles].mean(axis=1)[:, 2] < 0.6]
        write_ply(self.scans / IMAGE, (points, opened))
        self.run_scans("--levels", 4, "--unit", "mm")
        self.report()
        page, = (self.archive / "report/scans").iterdir()
        self.assertLess(page.stat().st_size, 6e6)
        code = self.browse("scan", page, json.dumps({"title": IMAGE}))
        self.browse("plain", page)
        # The lines of Python that the page shows read this dataset.
        subprocess.run([sys.executable, "-B", "-c", code + "assert H.ndim == 1 and len(H) > 1000"], cwd=self.archive,
                       check=True)

    def test_pages_of_scans_that_have_not_changed_are_left_alone(self):
        write_ply(self.scans / "a.ply", icosphere(2))
        write_ply(self.scans / "b.ply", icosphere(3))
        self.run_scans("--levels", 1)
        told = self.report()
        self.assertEqual((told["pages_made"], told["pages_up_to_date"]), (2, 0))
        pages = self.archive / "report/scans"
        before = {path.name: path.stat().st_ino for path in pages.iterdir()}
        write_ply(self.scans / "a.ply", boulder(2, 1))
        self.run_scans("--levels", 1)
        told = self.report()
        self.assertEqual((told["pages_made"], told["pages_up_to_date"], told["pages_failed"]), (1, 1, 0))
        self.assertEqual((pages / "b.ply.html").stat().st_ino, before["b.ply.html"])
        told = self.report("--index-only", "--output", self.folder / "index")
        self.assertEqual(sorted(path.name for path in (self.folder / "index").iterdir()), ["index.html"])

    def test_a_large_scan_stays_below_6_megabytes(self):
        points, triangles = boulder(5, 1)
        noise = np.random.default_rng(1).normal(scale=0.003, size=points.shape)
        write_ply(self.scans / "a.ply", (points + noise, triangles))
        self.run_scans("--levels", 8)
        self.report()
        self.assertLess((self.archive / "report/scans/a.ply.html").stat().st_size, 6e6)

    def test_a_thousand_scans(self):
        write_ply(self.scans / "a.ply", icosphere(2))
        self.run_scans("--levels", 1)
        for number in range(1, 1000):
            shutil.copyfile(self.dataset("a.ply"), self.archive / "scans" / f"copy-{number}.ply.vtkhdf")
        begin = cpu_of_children()
        told = self.report("--index-only")
        self.assertLess(cpu_of_children() - begin, 40)  # 20 s on two cores
        self.assertEqual(told["scans"], 1000)
        self.assertLess(Path(told["report"]).stat().st_size, 5e6)
        self.browse("many", told["report"], 1000)

    def test_what_is_no_archive_is_named(self):
        process = self.semigeo("report", self.scans, code=1)
        self.assertIn("is no archive", process.stderr)
        self.assertFalse((self.scans / "report").exists())


if __name__ == "__main__":
    unittest.main()
