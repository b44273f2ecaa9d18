"""What the night does to a run - kills, a full disk, scans that vanish, jobs that go mad - costs what
it must and no more: nothing broken stands under a final name, and the next run ends with the bytes
of a run that nobody disturbed. SEMIGEO_RECOVERY_MOMENTS is the number of kills."""

import gzip
import json
import os
import random
import select
import shutil
import signal
import subprocess
import tarfile
import tempfile
import time
import unittest
from pathlib import Path

from support import PROGRAM, TIMEOUT, SemigeoTest, children_of, contents, icosphere, write_ply

MOMENTS = int(os.environ.get("SEMIGEO_RECOVERY_MOMENTS", 12))
SEED = int(os.environ.get("SEMIGEO_RECOVERY_SEED", 1993))
SCANS = 5
LEVELS = ("--levels", "3")


class RecoveryTest(SemigeoTest):
    """Tests with a few scans that are shared, and the archive that an undisturbed run makes."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = Path(tempfile.mkdtemp(prefix="semigeo-e2e-"))
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.shared_scans, cls.undisturbed = folder / "scans", folder / "archive"
        for i in range(SCANS):  # the first is the largest, and so the first to be done
            write_ply(cls.shared_scans / f"{i}.ply", icosphere(5 if i == 0 else 4, 1 + i))
        start = time.monotonic()
        subprocess.run([PROGRAM, "run", cls.shared_scans, "--output", cls.undisturbed, *LEVELS],
                       check=True, stdout=subprocess.DEVNULL, timeout=TIMEOUT)
        cls.duration = time.monotonic() - start
        cls.wanted = contents(cls.undisturbed)

    def setUp(self):
        super().setUp()
        self.scans = self.shared_scans

    def own_scans(self):
        """Scans that a test may change."""
        self.scans = self.folder / "scans"
        shutil.copytree(self.shared_scans, self.scans, dirs_exist_ok=True)

    def start(self, *arguments, faults=None):
        environment = os.environ | ({"SEMIGEO_TEST_FAULTS": faults} if faults else {})
        process = subprocess.Popen(
            [str(PROGRAM), "run", str(self.scans), "--output", str(self.archive), "--json", *LEVELS,
             *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def await_worker(self, process):
        """From here on the plan is made, jobs run, and signals are heard."""
        deadline = time.monotonic() + TIMEOUT
        while not children_of(process):
            self.assertIsNone(process.poll())
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.0005)

    def end(self, process, code):
        """The run's JSON."""
        output, errors = process.communicate(timeout=TIMEOUT)
        self.assertEqual(process.returncode, code, errors.decode())
        return json.loads(output)

    def assert_whole(self):
        """What has a final name is as it will ever be."""
        # Partials are passed over: a dying worker may take one away meanwhile.
        for path in self.archive.glob("scans/[!.]*"):
            self.assertTrue(path.read_bytes() == self.wanted[f"scans/{path.name}"],
                            f"{path} is broken")

    def datasets(self):
        return sorted(path.name for path in self.archive.glob("scans/*.vtkhdf"))

    def assert_goes_on(self):
        self.assert_whole()
        kept = len(self.datasets())
        document = self.run_scans(*LEVELS)
        self.assertEqual(document["failed"], 0)
        self.assertEqual(document["up_to_date"] + document["done"], SCANS)
        # A dataset may be whole and its sidecar not yet there.
        self.assertLessEqual(document["up_to_date"], kept)
        self.assertGreaterEqual(document["up_to_date"], kept - 2)
        self.assert_same_archives(self.archive, self.undisturbed)

    def state_of(self, document, name):
        return next(scan for scan in document["scans"] if Path(scan["input"]).name == name)


class KillTest(RecoveryTest):
    def kill_run(self, process):
        process.kill()

    def kill_worker(self, process):
        workers = children_of(process)
        if workers:
            os.kill(self.random.choice(workers), signal.SIGKILL)

    def kill_all(self, process):
        for pid in [*children_of(process), process.pid]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def test_killed_at_any_moment(self):
        self.random = random.Random(SEED)
        victims = (self.kill_run, self.kill_worker, self.kill_all)
        for i in range(MOMENTS):
            victim = victims[i % len(victims)]
            # Stratified: the beginning, the end and all between.
            share = (self.random.random() + i // len(victims)) / -(-MOMENTS // len(victims))
            with self.subTest(seed=SEED, number=i, victim=victim.__name__, share=share):
                shutil.rmtree(self.archive, ignore_errors=True)
                process = self.start()
                try:
                    process.wait(1.1 * share * self.duration)
                except subprocess.TimeoutExpired:
                    victim(process)
                process.communicate(timeout=TIMEOUT)
                # A run outlives its workers, and does their jobs once more.
                self.assertIn(process.returncode,
                              (0,) if victim == self.kill_worker else (0, -signal.SIGKILL))
                if process.returncode == 0:
                    self.assert_same_archives(self.archive, self.undisturbed)
                if i % 4 == 0 and self.datasets():
                    self.semigeo("check", self.archive)
                self.assert_goes_on()

    def test_one_archive_killed_again_and_again(self):
        self.random = random.Random(SEED)
        for i in range(max(4, MOMENTS // 4)):
            process = self.start()
            try:
                process.wait(self.random.random() * self.duration / 2)
            except subprocess.TimeoutExpired:
                self.kill_run(process)
            process.wait(TIMEOUT)
            self.assert_whole()
        self.assert_goes_on()

    def test_workers_do_not_outlive_their_run(self):
        process = self.start(faults=",".join(f"{i}.ply=sleep" for i in range(SCANS)))
        self.await_worker(process)
        workers = [os.pidfd_open(pid) for pid in children_of(process)]
        process.kill()
        for worker in workers:
            self.assertTrue(select.select([worker], [], [], TIMEOUT)[0])  # it has ended
            os.close(worker)
        self.assert_goes_on()

    def test_a_job_whose_workers_are_always_killed_fails_alone(self):
        # By hand, as by the system when memory runs out.
        process = self.start("--retries", "0", "--threads", "1", faults="0.ply=sleep")
        self.await_worker(process)
        os.kill(children_of(process)[0], signal.SIGKILL)
        document = self.end(process, 1)
        self.assertEqual((document["done"], document["failed"]), (SCANS - 1, 1))
        self.assertIn("was killed (signal 9)", self.state_of(document, "0.ply")["error"])
        self.assert_goes_on()


class DiskTest(RecoveryTest):
    """An archive in a small file system of its own."""

    def mount(self, options):
        if os.geteuid() != 0:
            self.skipTest("only root may mount a file system")
        self.archive.mkdir(exist_ok=True)
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "none", self.archive],
                                 capture_output=True, text=True)
        if mounted.returncode != 0:
            self.skipTest(f"no file system may be mounted here: {mounted.stderr}")

    def unmount(self):
        subprocess.run(["umount", "-l", self.archive], check=True)

    def remount(self, options):
        subprocess.run(["mount", "-o", f"remount,{options}", self.archive], check=True)

    def need(self):
        page = 4096
        return sum(-(-len(data) // page) * page for data in self.wanted.values())

    def test_space_that_runs_out_at_any_point(self):
        for tenth in range(10):
            with self.subTest(tenth=tenth):
                self.mount(f"size={max(4096, self.need() * tenth // 10)}")
                try:
                    process = self.semigeo("run", self.scans, "--output", self.archive, *LEVELS,
                                           code=75)
                    reasons = [line for line in process.stderr.splitlines() if "space" in line.lower()]
                    self.assertEqual(len(reasons), 1, process.stderr)
                    self.assertIn(str(self.archive), reasons[0])
                    self.assertIn("No space left on device", reasons[0])
                    self.assertNotIn("failed: ", process.stdout + process.stderr)
                    self.assert_whole()
                    self.assertFalse(list(self.archive.rglob("*.partial")))
                    kept = self.datasets()
                    self.remount("size=1g")
                    if kept:
                        self.semigeo("check", self.archive)
                    self.assert_goes_on()
                finally:
                    self.unmount()

    def test_a_file_system_that_is_read_only(self):
        self.mount("size=1g")
        try:
            self.run_scans(*LEVELS)
            self.remount("ro")
            self.assertEqual(self.run_scans(*LEVELS)["up_to_date"], SCANS)
            process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 1,
                                   code=1)
            self.assertIn(f"semigeo: {self.archive}", process.stderr)
            self.assertIn("Read-only file system", process.stderr)
            self.assert_same_archives(self.archive, self.undisturbed)
        finally:
            self.unmount()


class ScanTest(RecoveryTest):
    """Scans that are not what they were when the plan was made."""

    def run_disturbed(self, disturb):
        """A run before whose last job `disturb` is called; its JSON."""
        self.own_scans()
        for _ in range(5):  # a moment may pass between a look and the signal
            process = self.start("--threads", "1")
            self.await_worker(process)
            process.send_signal(signal.SIGSTOP)  # it cannot hand out the next job meanwhile
            os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
            if len(self.datasets()) < SCANS - 2:  # the last has not begun
                break
            process.kill()
            process.wait()
            shutil.rmtree(self.archive)
        else:
            self.fail("the moment never came")
        disturb()
        process.send_signal(signal.SIGCONT)
        return self.end(process, 1)

    def assert_failed_alone(self, document, name, reason):
        self.assertEqual((document["done"], document["failed"]), (SCANS - 1, 1))
        scan = self.state_of(document, name)
        self.assertEqual(scan["state"], "failed")
        self.assertTrue(scan["error"].startswith(f"{self.scans / name}: "), scan["error"])
        self.assertIn(reason, scan["error"])
        self.assertFalse(self.dataset(name).exists())
        self.assert_whole()

    def test_one_that_is_deleted_fails_alone(self):
        document = self.run_disturbed((self.folder / "scans" / "4.ply").unlink)
        self.assert_failed_alone(document, "4.ply", "no such file")
        shutil.copy(self.shared_scans / "4.ply", self.scans)
        document = self.run_scans(*LEVELS)
        self.assertEqual((document["done"], document["up_to_date"]), (1, SCANS - 1))

    def test_one_that_is_changed_fails_alone_and_is_done_by_the_next_run(self):
        document = self.run_disturbed(
            lambda: write_ply(self.scans / "4.ply", icosphere(4, 40)))
        self.assert_failed_alone(document, "4.ply", "changed")
        document = self.run_scans(*LEVELS)
        self.assertEqual((document["done"], document["up_to_date"]), (1, SCANS - 1))
        self.assertFalse(self.dataset("4.ply").read_bytes() == self.wanted["scans/4.ply.vtkhdf"])
        self.semigeo("check", self.archive)

    def test_one_that_is_replaced_by_nothing_fails_alone(self):
        document = self.run_disturbed(lambda: (self.scans / "4.ply").write_bytes(b""))
        self.assert_failed_alone(document, "4.ply", "empty")


class StopTest(RecoveryTest):
    def test_the_first_signal_lets_running_jobs_end(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                for _ in range(5):  # a moment may pass between a look and the signal
                    process = self.start("--threads", "1")
                    self.await_worker(process)
                    process.send_signal(number)
                    output, errors = process.communicate(timeout=TIMEOUT)
                    if process.returncode != 0:
                        break
                    shutil.rmtree(self.archive)
                self.assertEqual(process.returncode, 75, errors)
                document = json.loads(output)
                states = [scan["state"] for scan in document["scans"]]
                self.assertGreaterEqual(states.count("done"), 1)
                self.assertGreaterEqual(states.count("not run"), 1)
                self.assertEqual(document["failed"], 0)
                self.assertEqual(len(self.datasets()), states.count("done"))
                self.assert_goes_on()
                shutil.rmtree(self.archive)

    def test_a_signal_before_jobs_begin_leaves_no_lock(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                process = self.start()
                deadline = time.monotonic() + TIMEOUT
                while not (self.archive / "lock").exists():
                    self.assertLess(time.monotonic(), deadline)
                    time.sleep(0.0005)
                process.send_signal(signal.SIGSTOP)
                os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
                process.send_signal(number)
                process.send_signal(signal.SIGCONT)
                _, errors = process.communicate(timeout=TIMEOUT)
                self.assertEqual(process.returncode, 75, errors)
                self.assertIn(b"stop", errors)
                self.assertFalse((self.archive / "lock").exists())
                self.assertFalse(list(self.archive.rglob("*.partial")))
                self.assert_goes_on()
                shutil.rmtree(self.archive)

    def test_a_signal_while_scans_are_searched(self):
        # A container whose list is behind much else that has to be decompressed: 1 GiB of zeros.
        member = tarfile.TarInfo("zeros.bin")
        member.size = 1 << 30
        zeros = gzip.compress(bytes(1 << 24), 1)
        self.scans = self.folder / "scans"
        (self.scans / "box.tar.gz").write_bytes(gzip.compress(member.tobuf()) + 64 * zeros)
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                process = self.start()
                self.await_worker(process)  # the child that lists it
                process.send_signal(number)
                _, errors = process.communicate(timeout=TIMEOUT)
                self.assertEqual(process.returncode, 75, errors)
                self.assertFalse(self.archive.exists())

    def test_the_second_signal_ends_them(self):
        process = self.start(faults=",".join(f"{i}.ply=sleep" for i in range(SCANS)))
        self.await_worker(process)
        process.send_signal(signal.SIGINT)
        said = b""
        while b"interrupt again" not in said:  # two at once would be one
            line = process.stderr.readline()
            self.assertTrue(line, said)
            said += line
        process.send_signal(signal.SIGINT)
        document = self.end(process, 75)
        self.assertEqual({scan["state"] for scan in document["scans"]}, {"not run"})
        self.assertEqual(self.datasets(), [])
        self.assertFalse((self.archive / "lock").exists())
        self.assert_goes_on()

    def test_time_that_is_too_short(self):
        document = self.run_scans(*LEVELS, "--time-limit", "0.001", code=75)
        self.assertEqual({scan["state"] for scan in document["scans"]}, {"not run"})
        self.assert_goes_on()
        self.assertEqual(self.run_scans(*LEVELS, "--time-limit", "0.001")["up_to_date"], SCANS)

    def test_a_time_that_is_none(self):
        for arguments in (("--until", "25:00"), ("--until", "6:60"), ("--until", "noon"),
                          ("--until", "06:00pm"), ("--until", "-1:00"), ("--time-limit", "long"),
                          ("--timeout", "3 weeks"), ("--timeout", "-1"),
                          ("--time-limit", "-8h"), ("--retries", "-1"), ("--memory", "much"),
                          ("--memory", "-1"), ("--memory-per-job", "-2G")):
            with self.subTest(arguments=arguments):
                process = self.semigeo("run", self.scans, "--output", self.archive, *arguments,
                                       code=2)
                self.assertIn(arguments[0], process.stderr)
        self.assertFalse(self.archive.exists())


class PoisonTest(RecoveryTest):
    def assert_failed(self, document, reasons):
        self.assertEqual(document["failed"], len(reasons))
        self.assertEqual(document["done"] + document["up_to_date"], SCANS - len(reasons))
        for name, reason in reasons.items():
            with self.subTest(scan=name):
                scan = self.state_of(document, name)
                self.assertEqual(scan["state"], "failed")
                self.assertTrue(scan["error"].startswith(f"{self.scans / name}: "), scan["error"])
                self.assertIn(reason, scan["error"])
                # A log that the reader is sent to is there.
                log = self.archive / "logs" / f"{name}.log"
                self.assertEqual(str(log) in scan["error"], log.exists(), scan["error"])
        self.assert_whole()

    def test_each_bad_job_is_named_with_its_reason_and_the_others_are_done(self):
        crash = {"1.ply": "crashed (signal 11, Segmentation fault); it last said: about to crash",
                 "2.ply": "crashed (signal 11, Segmentation fault); it last said: about to crash",
                 "3.ply": "needs more than the 600 MiB"}
        process = self.start("--memory-per-job", "600M", "--retries", "0",
                             faults="1.ply=crash,2.ply=crash,3.ply=memory")
        self.assert_failed(self.end(process, 1), crash)
        # A limit on time is for jobs that never end: whatever else runs, no other job may reach it.
        process = self.start("--timeout", "1", "--retries", "0",
                             faults="1.ply=sleep,2.ply=loop,3.ply=loop")
        late = "took longer than 1.0 s and was ended"
        self.assert_failed(self.end(process, 1), dict.fromkeys(crash, late))
        self.assert_goes_on()  # without a log: those were of the last run

    def test_jobs_that_fail_once_are_done(self):
        process = self.start(faults="0.ply=crash-once,2.ply=crash-once")
        document = self.end(process, 0)
        self.assertEqual(document["done"], SCANS)
        self.assert_whole()


if __name__ == "__main__":
    unittest.main()
