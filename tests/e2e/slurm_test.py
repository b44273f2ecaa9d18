"""`run --executor slurm` on a real cluster of this machine: the same datasets as here, whatever becomes of its tasks."""

import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import slurm_cluster
from support import PROGRAM, TIMEOUT, SemigeoTest, boulder, icosphere, write_ply


@unittest.skipIf(slurm_cluster.why_not(), slurm_cluster.why_not())
class SlurmTest(SemigeoTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = Path(tempfile.mkdtemp(prefix="semigeo-slurm-"))
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.cluster = slurm_cluster.Cluster(folder / "cluster")
        cls.addClassCleanup(cls.cluster.stop)

    def setUp(self):
        super().setUp()
        self.addCleanup(self.empty_queue)

    def empty_queue(self):
        self.cluster.command("scancel", "--user=root")
        self.wait_for(lambda: not self.queue())

    def queue(self):
        """The tasks in the queue: their states by number."""
        lines = self.cluster.command("squeue", "--noheader", "--array", "--format=%K %T").splitlines()
        return {int(number): state for number, state in map(str.split, lines)}

    def wait_for(self, condition):
        deadline = time.monotonic() + TIMEOUT
        while not (value := condition()):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)
        return value

    def write_scans(self, *names, subdivisions=3):
        for i, name in enumerate(names):
            write_ply(self.scans / f"{name}.ply", icosphere(subdivisions, 1 + i))

    def environment(self, faults=""):
        return {**self.cluster.environment, "SEMIGEO_TEST_FAULTS": faults}

    def on_slurm(self, *arguments, faults="", code=0):
        return self.run_scans_with(self.environment(faults), "--executor", "slurm", *arguments, code=code)

    def run_scans_with(self, environment, *arguments, code=0):
        process = self.semigeo("run", self.scans, "--output", self.archive, "--json", *arguments, code=code,
                               env=environment)
        return json.loads(process.stdout)

    def start(self, *arguments, faults=""):
        """A run on Slurm that goes on by itself; its JSON comes from end_of."""
        process = subprocess.Popen([str(PROGRAM), "run", str(self.scans), "--output", str(self.archive), "--json",
                                    "--executor", "slurm", *arguments], env=self.environment(faults),
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def end_of(self, process, code):
        out, said = process.communicate(timeout=TIMEOUT)
        self.assertEqual(process.returncode, code, said.decode())
        return json.loads(out)

    def run_folder(self):
        folders = list((self.archive / "slurm").iterdir())
        self.assertEqual(len(folders), 1)
        return folders[0]

    def journal(self):
        return [json.loads(line) for line in (self.archive / "journal.jsonl").read_text().splitlines()]

    def test_the_same_bytes_as_here(self):
        self.write_scans("a", "b", "c", "d", "e")
        document = self.on_slurm("--scans-per-task", "2", "--threads", "2")
        self.assertEqual(set(self.states(document).values()), {"done"})
        self.assertGreater(document["scans"][0]["vertices"], 0)
        local = self.folder / "local"
        self.run_scans(archive=local)
        self.assert_same_archives(self.archive, local)  # also: no traces of tasks are left
        ended = [event for event in self.journal() if event["event"] == "ended"]
        self.assertEqual(len(ended), 5)
        self.assertTrue(all(event["seconds"] > 0 and event["vertices"] > 0 for event in ended))
        self.assertEqual(self.run_scans()["up_to_date"], 5)

    def write_boulders(self, count):
        for i in range(count):
            write_ply(self.scans / f"{i}.ply", boulder(3, i))

    def test_a_library_of_the_same_bytes_as_here(self):
        self.write_boulders(3)
        document = self.on_slurm("--library", "--levels", "2", "--scans-per-task", "2")
        self.assertEqual(document["done"], 8)
        self.assertEqual(document["library"]["models"], 3)
        local = self.folder / "local"
        self.run_scans("--library", "--levels", "2", archive=local)
        self.assert_same_archives(self.archive, local)  # also: no traces of tasks are left
        self.assertEqual(self.run_scans("--library", "--levels", "2")["up_to_date"], 8)

    def test_pages_are_made_by_tasks_too(self):
        if subprocess.run([PROGRAM, "report", "/nonexistent"], capture_output=True).returncode == 2:
            self.skipTest("this program has no report")
        self.write_boulders(2)
        document = self.on_slurm("--report", "--levels", "2")
        self.assertEqual((document["done"], document["report"]["state"]), (5, "done"))
        self.assertTrue((self.archive / "report/index.html").exists())
        # The journal has the ends of the tasks' jobs since, so the first page may be made again.
        self.assertGreaterEqual(self.run_scans("--report", "--levels", "2")["up_to_date"], 4)

    def test_a_scan_that_fails_costs_the_library_its_model_only(self):
        self.write_boulders(2)
        (self.scans / "bad.obj").write_text("v 0 0 0\nf 1 2 7\n")
        document = self.on_slurm("--library", "--levels", "2", "--scans-per-task", "1", code=1)
        states = {job["name"]: job["state"] for job in document["jobs"]}
        self.assertEqual(states, {"0.ply": "done", "1.ply": "done", "bad.obj": "skipped", "000.part": "done",
                                  "library.h5": "done"})
        self.assertEqual(document["library"]["missing"], ["bad.obj"])
        local = self.folder / "local"
        self.run_scans("--library", "--levels", "2", archive=local, code=1)
        self.assertTrue((self.archive / "library.h5").read_bytes() == (local / "library.h5").read_bytes())

    def test_without_what_a_killed_task_would_have_made_nothing_follows(self):
        self.write_boulders(2)
        process = self.start("--library", "--levels", "2", faults="1.ply=sleep")
        os.kill(self.wait_for(self.task_process), signal.SIGKILL)
        document = self.end_of(process, 75)
        self.assertEqual({job["state"] for job in document["jobs"]}, {"not run"})
        self.assertEqual(self.on_slurm("--library", "--levels", "2")["library"]["models"], 2)

    def test_a_bad_scan_harms_no_other_of_its_task(self):
        self.write_scans("a", "b", "c")
        (self.scans / "bad.obj").write_text("v 0 0 0\nf 1 2 7\n")
        document = self.on_slurm("--scans-per-task", "4", faults="b.ply=crash", code=1)
        self.assertEqual(self.states(document),
                         {"a.ply": "done", "b.ply": "failed", "c.ply": "done", "bad.obj": "failed"})
        errors = {Path(scan["input"]).name: scan.get("error", "") for scan in document["scans"]}
        self.assertIn("crashed (signal 11", errors["b.ply"])
        self.assertIn("bad.obj", errors["bad.obj"])
        self.assertIn("about to crash", (self.archive / "logs" / "b.ply.log").read_text())
        self.assertIn("failed: ", (self.run_folder() / "surface" / "task-0.log").read_text())

    def task_process(self):
        """The process of the only task that runs, once it runs."""
        for folder in Path("/proc").iterdir():
            try:
                words = (folder / "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue
            if words[1:3] == [b"job", b"--list"] and words[3].startswith(bytes(self.archive)):
                return int(folder.name)
        return None

    def test_a_killed_task_is_named_and_the_next_run_does_the_rest(self):
        self.write_scans("a", "b", "c")
        process = self.start("--scans-per-task", "3", faults="c.ply=sleep")  # the scans are done in this order
        self.wait_for(lambda: self.dataset("b.ply").exists())
        os.kill(self.wait_for(self.task_process), signal.SIGKILL)
        document = self.end_of(process, 1)
        self.assertEqual(self.states(document), {"a.ply": "done", "b.ply": "done", "c.ply": "failed"})
        log = self.run_folder() / "surface" / "task-0.log"
        self.assertIn(f"its task ended without a result; see {log}", document["scans"][2]["error"])
        self.assertTrue(log.exists())
        self.assertEqual(self.states(self.on_slurm()), {"a.ply": "up to date", "b.ply": "up to date", "c.ply": "done"})

    def test_the_first_signal_cancels_what_waits(self):
        self.write_scans("a", "b", subdivisions=6)
        self.write_scans("c")  # the shortest comes last, and each task fills a node
        process = self.start("--scans-per-task", "1", "--threads", "2", "--levels", "12")
        self.wait_for(lambda: self.queue() == {0: "RUNNING", 1: "RUNNING", 2: "PENDING"})
        process.send_signal(signal.SIGINT)
        document = self.end_of(process, 75)
        self.assertEqual(self.states(document), {"a.ply": "done", "b.ply": "done", "c.ply": "not run"})
        self.assertEqual(self.states(self.run_scans("--levels", "12")),
                         {"a.ply": "up to date", "b.ply": "up to date", "c.ply": "done"})

    def test_the_second_signal_cancels_all(self):
        self.write_scans("a", "b")
        process = self.start("--scans-per-task", "1", faults="a.ply=sleep,b.ply=sleep")
        self.wait_for(lambda: list(self.queue().values()) == ["RUNNING"] * 2)
        process.send_signal(signal.SIGINT)
        self.assertIn(b"interrupt again", self.line_of(process, b"stopping"))
        process.send_signal(signal.SIGINT)
        self.assertEqual(set(self.states(self.end_of(process, 75)).values()), {"not run"})
        self.wait_for(lambda: not self.queue())
        self.assertEqual(set(self.states(self.on_slurm()).values()), {"done"})

    def line_of(self, process, word):
        while word not in (line := process.stderr.readline()):
            self.assertTrue(line)
        return line

    def test_a_full_disk_stops_the_run_with_its_sentence(self):
        self.archive.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", self.archive], capture_output=True)
        if mounted.returncode != 0:
            self.skipTest("mounting a disk is not permitted here")
        self.addCleanup(subprocess.run, ["umount", "-l", self.archive], check=True)
        for seed in range(8):
            write_ply(self.scans / f"{seed}.ply", boulder(4, seed))
        process = self.start("--scans-per-task", "8")
        document = self.end_of(process, 75)
        self.assertIn("No space left on device; free some space and run again", document["stopped"])
        self.assertEqual(document["failed"], 0)
        self.assertEqual(document["done"] + document["not_run"], 8)

    def test_the_reason_why_tasks_wait_is_told(self):
        self.write_scans("a")
        process = self.start("--slurm-option", "hold")
        self.assertIn(b"JobHeldUser", self.line_of(process, b"waiting"))
        process.send_signal(signal.SIGINT)
        self.assertEqual(self.states(self.end_of(process, 75)), {"a.ply": "not run"})

    def test_jobs_of_a_task_that_was_cancelled_have_not_failed(self):
        self.write_scans("a", "b")
        process = self.start("--scans-per-task", "2", faults="b.ply=sleep")
        self.wait_for(lambda: self.dataset("a.ply").exists())
        self.cluster.command("scancel", "--name=semigeo-surface")
        document = self.end_of(process, 75)
        self.assertEqual(self.states(document), {"a.ply": "done", "b.ply": "not run"})

    def test_what_does_not_end_in_time_is_not_begun(self):
        self.write_scans("a")
        document = self.on_slurm("--time-limit", "0.001", code=75)
        self.assertEqual(self.states(document), {"a.ply": "not run"})
        self.assertFalse(self.dataset("a.ply").exists())

    def test_nobody_waits(self):
        self.write_scans("a", "b")
        submitted = self.on_slurm("--no-wait", "--scans-per-task", "1")["submitted"]
        self.assertEqual([(stage["name"], stage["tasks"]) for stage in submitted], [("semigeo-surface", 2)])
        self.assertTrue(submitted[0]["job"].isdigit())
        self.wait_for(lambda: not self.queue())
        results = self.run_folder() / "surface" / "results" / "0.jsonl"
        told = results.read_text()
        # What a requeued copy would do: it finds the dataset made, and leaves what was told of it.
        self.semigeo("job", "--list", self.run_folder() / "surface" / "tasks.jsonl", "--task", 0)
        self.assertEqual(results.read_text(), told)
        self.assertGreater(json.loads(told)["done"]["vertices"], 0)
        self.assertEqual(self.run_scans()["up_to_date"], 2)

    def test_what_verification_finds_damaged_is_made_again(self):
        self.write_scans("a")
        self.on_slurm()
        dataset = self.dataset("a.ply")
        whole = dataset.read_bytes()
        damaged = bytearray(whole)
        damaged[len(whole) // 2] ^= 255
        dataset.write_bytes(damaged)
        self.assertEqual(self.states(self.on_slurm("--verify")), {"a.ply": "done"})
        self.assertTrue(dataset.read_bytes() == whole)


class CommandsTest(SemigeoTest):
    """Programs of Slurm that are missing, or that fail."""

    def setUp(self):
        super().setUp()
        write_ply(self.scans / "a.ply", icosphere(1))
        self.programs = self.folder / "bin"
        self.programs.mkdir()

    def program(self, name, script):
        (self.programs / name).write_text(f"#!/bin/sh\n{script}\n")
        (self.programs / name).chmod(0o755)

    def run_on_slurm(self, *arguments, code):
        return self.semigeo("run", self.scans, "--output", self.archive, "--executor", "slurm", *arguments, code=code,
                            env={**os.environ, "PATH": str(self.programs)})

    def test_a_missing_program_is_named(self):
        said = self.run_on_slurm(code=1).stderr
        self.assertIn("sbatch: is not in PATH; ", said)
        self.assertFalse((self.archive / "slurm").exists())

    def test_what_sbatch_says_is_passed_on(self):
        for name in ("sbatch", "squeue", "scancel"):
            self.program(name, "echo 'sbatch: error: invalid account: geo' >&2; exit 1")
        said = self.run_on_slurm("--slurm-option", "account=geo", code=1).stderr
        self.assertIn(f"{self.programs}/sbatch: failed with exit code 1, and said: "
                      "sbatch: error: invalid account: geo; ", said)
        self.assertFalse((self.archive / "lock").exists())

    def test_an_array_that_is_too_long_has_a_remedy(self):
        for name in ("sbatch", "squeue", "scancel"):
            self.program(name, "echo 'sbatch: error: Batch job submission failed: Invalid job array specification'; exit 1")
        self.assertIn("; give --scans-per-task more\n", self.run_on_slurm(code=1).stderr)
        self.assertFalse((self.archive / "slurm").exists())

    def test_squeue_may_fail_for_a_while(self):
        # A cluster of one machine: sbatch returns when the task has ended.
        self.program("sbatch", 'for script; do :; done; SLURM_ARRAY_TASK_ID=0 /bin/sh "$script" >/dev/null 2>&1; echo 5')
        mark = self.folder / "asked"
        self.program("squeue", f"[ -e {mark} ] && exit 0; : > {mark}; echo 'Unable to contact slurm controller'; exit 1")
        self.program("scancel", "exit 0")
        process = self.run_on_slurm(code=0)
        self.assertIn("said: Unable to contact slurm controller; ", process.stderr)
        self.assertTrue(self.dataset("a.ply").exists())

    def test_options_reach_sbatch(self):
        self.program("sbatch", f'echo "$@" > {self.folder}/arguments; echo warning >&2; echo "17;here"')
        for name in ("squeue", "scancel"):
            self.program(name, "exit 0")
        process = self.run_on_slurm("--no-wait", "--slurm-option", "account=geo", "--slurm-option=--partition=long",
                                    "--threads", "3", "--memory", "4G", code=0)
        self.assertEqual(process.stdout, "17\n")
        arguments = (self.folder / "arguments").read_text().split()
        for wanted in ("--account=geo", "--partition=long", "--cpus-per-task=3", "--mem=4096M", "--array=0-0"):
            self.assertIn(wanted, arguments)

    def test_not_waiting_is_for_slurm(self):
        self.semigeo("run", self.scans, "--output", self.archive, "--no-wait", code=2)


if __name__ == "__main__":
    unittest.main()
