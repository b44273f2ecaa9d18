"""A night: a run over hundreds of scans to which everything happens at once. Scans are damaged, hostile, huge, empty, or
change while they are read. The run is killed, its children are killed, it is told to stop, its disk is full, another run
begins beside it, the library is replaced while scenes are recognised, and the disk loses bytes. After that, one run that
nobody disturbs must leave the bytes of an undisturbed archive, and each scan is a dataset or a failure with a line.

SEMIGEO_NIGHT_SCANS is the number of scans. SEMIGEO_NIGHT_SEED repeats a night: it is printed, and decides about scans,
the order of what happens, and the moments, which are told by what a run has written and not by time."""

import json
import os
import random
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import night_scans
from night_scans import FAILED, MADE
from night_watch import Digests, Moments
from support import PROGRAM, SemigeoTest, boulder, children_of, joined, write_ply

COUNT = int(os.environ.get("SEMIGEO_NIGHT_SCANS", 60))
LONG = COUNT >= 1000
SEED = int(os.environ.get("SEMIGEO_NIGHT_SEED") or (random.SystemRandom().randrange(10 ** 6) if LONG else 1993))
TIMEOUT = 900
ENDED = (0, 1)
STOPPED = 75
LOCKED = 73
OPTIONS = ("--levels", "1", "--threads", "2", "--memory-per-job", "600M" if LONG else "300M", "--json")
KILLED = "was killed (signal 9)"


def kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


class NightTest(Moments, SemigeoTest):
    def setUp(self):
        super().setUp()
        print(f"night of {COUNT} scans, SEMIGEO_NIGHT_SEED={SEED}", flush=True)
        self.random = random.Random(SEED)
        self.chance = random.Random(SEED)  # for what depends on what a run has done so far
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()
        self.environment = os.environ | {"TMPDIR": str(self.temporary)}
        scans = night_scans.write_scans(self.scans, self.folder / "twins", COUNT, 547 if LONG else 120, self.random)
        self.by_input = {os.fsencode(scan.path).decode(errors="replace"): scan for scan in scans}
        self.changing = [Path(scan.path) for scan in scans if scan.changes]
        self.kept = {path: path.read_bytes() for path in self.changing}
        self.scenes = self.folder / "scenes"
        for i in range(4 if LONG else 2):
            write_ply(self.scenes / f"{i}.ply", joined(boulder(3, i), boulder(3, 40 + i)))
        (self.scenes / "bad.ply").write_bytes(b"ply\n")
        for i in range(4):  # what is to be recognised
            path = write_ply(self.scans / f"models/{i}.ply", boulder(3, i))
            self.by_input[str(path)] = night_scans.Scan(str(path), MADE, "model")
        self.make_undisturbed()
        self.mount()

    # What runs.

    def command(self, archive):
        return ["run", self.scans, self.folder / "twins", "--output", archive, "--library", "--report", *OPTIONS]

    def start(self, *arguments):
        """A process whose output goes to files."""
        output, errors = (tempfile.TemporaryFile("a+b", dir=self.folder) for _ in range(2))
        process = subprocess.Popen([PROGRAM, *arguments], stdout=output, stderr=errors, env=self.environment)
        process.output, process.errors = output, errors
        for action in (errors.close, output.close, process.wait, process.kill):
            self.addCleanup(action)
        return process

    def text_of(self, file):
        file.seek(0)
        return file.read().decode(errors="backslashreplace")

    def end(self, process, codes):
        """The JSON of a process that ends by itself with one of these codes."""
        process.wait(TIMEOUT)
        errors = self.text_of(process.errors)
        self.assertIn(process.returncode, codes, errors)
        text = self.text_of(process.output)
        return json.loads(text) if text else None

    def call(self, *arguments, codes=(0,)):
        return self.end(self.start(*arguments), codes)

    def start_twice(self):
        """The one of two runs, started at the same moment by cron and by hand, that has the archive."""
        both = [self.start(*self.command(self.archive)) for _ in range(2)]
        while all(process.poll() is None for process in both):
            time.sleep(0.0005)
        ended = next(process for process in both if process.poll() is not None)
        other = both[1 - both.index(ended)]
        if ended.returncode != LOCKED:  # nothing was left to do
            self.assertIn(ended.returncode, ENDED)
            return other
        self.assertIn(f"process {other.pid} on ", self.text_of(ended.errors))
        self.assertEqual(self.text_of(ended.output), "")
        return other

    def watch(self, process, moment):
        """Waits for a moment. Scans change meanwhile. Returns false if the process has ended."""
        while not moment():
            if process.poll() is not None:
                return False
            if self.chance.random() < 0.05:
                self.change_scans()
            time.sleep(0.0005)
        return process.poll() is None

    # What must hold.

    def make_undisturbed(self):
        self.undisturbed = self.folder / "undisturbed"
        document = self.call(*self.command(self.undisturbed), codes=(1,))
        self.check_scans(document)
        for scan in document["scans"]:
            wanted = self.by_input[scan["input"]].outcome
            if wanted in (MADE, FAILED):
                self.assertEqual(scan["state"], "done" if wanted == MADE else FAILED, scan)
        self.recognise(self.undisturbed, self.undisturbed)
        self.call("report", self.undisturbed, "--json")
        self.wanted_failures = {scan["name"]: scan["error"] for scan in document["scans"] if scan["state"] == "failed"}
        self.reference_journal = (self.undisturbed / "journal.jsonl").stat().st_size
        self.wanted = Digests(self.undisturbed).now()
        self.digests = Digests(self.archive)
        self.names_of_changing = {scan["name"] for scan in document["scans"] if self.by_input[scan["input"]].changes}
        print(f"undisturbed: {document['done']} done, {document['failed']} failed, {document['skipped']} skipped, "
              f"{document['cpu_seconds']:.0f} s of CPU", flush=True)

    def check_scans(self, document, disturbed=False):
        """Each scan stands once in the document, and each failure has a sentence that names it."""
        inputs = [scan["input"] for scan in document["scans"]]
        self.assertEqual(len(inputs), len(set(inputs)))
        gone = set() if not disturbed else {str(path) for path in self.changing}
        self.assertEqual(set(inputs) - gone, set(self.by_input) - gone)
        for scan in document["scans"]:
            error = scan.get("error", "")
            if scan["state"] == "not run" and error:
                self.assertIn("No space left on device", error)
                continue
            self.assertEqual(scan["state"] == "failed", error != "", scan)
            self.assertIn(scan["state"], ("done", "up to date", "failed", *(["not run"] if disturbed else [])))
            if error:
                self.assertTrue(error.startswith(scan["input"]), error)
            expected = self.by_input[scan["input"]]
            if error and expected.outcome == MADE and not expected.changes:
                self.assertIn(KILLED, error if disturbed else "")
        counted = {state: 0 for state in ("done", "up to date", "failed", "skipped", "not run")}
        for job in document["scans"] + document["jobs"]:
            counted[job["state"]] += 1
        self.assertEqual(list(counted.values()),
                         [document[key] for key in ("done", "up_to_date", "failed", "skipped", "not_run")])

    def check_whole(self):
        """What has a final name has the bytes that it will always have."""
        now = self.digests.now()
        for name, digest in now.items():
            if name.endswith(".partial") or name in ("library.h5", "sources.json", "recognised/sources.json"):
                continue  # a library may be without a model whose scan was changed
            if Path(name).name.rsplit(".", 1)[0] in self.names_of_changing or name.startswith("library/partitions/"):
                continue
            if digest == self.wanted.get(name):
                self.lost.discard(name)
            self.assertTrue(digest == self.wanted.get(name) or name in self.lost, f"{name} is broken")

    def check_nothing_left(self):
        self.assertEqual([str(path) for path in self.archive.rglob("*") if path.name.endswith(".partial")], [])
        self.assertFalse((self.archive / "lock").exists())
        self.assertEqual(os.listdir(self.temporary), [])

    def check_end(self, process, disturbed=True):
        """All that must hold when a run has ended by itself."""
        document = self.end(process, (*ENDED, STOPPED))
        errors = self.text_of(process.errors)
        if document is None:
            self.assertIn("No space left on device", errors)
            self.assertEqual(process.returncode, STOPPED)
            return
        self.check_scans(document, disturbed)
        self.assertEqual(process.returncode == STOPPED, document["not_run"] > 0)
        if process.returncode == 0:
            self.assertEqual(document["failed"], 0)
        for error in (scan["error"] for scan in document["scans"] if scan["state"] == "failed"):
            self.assertIn(error.split("\n")[0].split("\x1b")[0], errors)
        self.check_nothing_left()
        status = self.call("status", self.archive, "--json")
        failed = {job["name"]: job["error"] for job in document["scans"] if job["state"] == "failed"}
        told = {job.removeprefix("surface "): error for job, error in status["failed"].items() if job.startswith("surface ")}
        if "stopped" in document:  # the journal had no room either
            self.assertIn(status["state"], ("stopped early", "interrupted"))
            self.assertLessEqual(told.items(), failed.items())
        else:
            self.assertEqual(status["state"], "stopped early" if document["not_run"] else "ended")
            self.assertEqual(told, failed)
        return document

    # What happens.

    def disturbed(self, what, moment):
        """A run to which something happens at a moment."""
        name, come = moment
        process = self.start_twice()
        reached = self.watch(process, come)
        if reached:
            what(process)
        process.wait(TIMEOUT)
        self.told(f"{what.__name__} at {name}" + ("" if reached else ", which was not seen"), process)
        if process.returncode == LOCKED:  # the other run did all
            return False
        if process.returncode == -signal.SIGKILL:
            self.assertIn(what, (self.kill_run, self.kill_all))
            status = self.call("status", self.archive, "--json")
            self.assertIn(status["state"], ("interrupted", "stopped early", "ended", "never run"))
        else:
            self.check_end(process)
        self.check_whole()
        return reached

    def surely(self, what, moment):
        """Something to which a run must come. Once more if it was too fast. Something is lost before, so that there is
        something to do."""
        for _ in range(8):
            self.lose(2)
            (self.archive / "library.h5").unlink(missing_ok=True)
            if self.disturbed(what, moment()):
                return
        self.fail("the moment never came")

    def told(self, what, process):
        datasets = len(list(self.archive.glob("scans/*.vtkhdf")))
        print(f"{what}: code {process.returncode}, {datasets} datasets", flush=True)

    def kill_run(self, process):
        process.kill()

    def kill_all(self, process):
        victims = [*children_of(process), process.pid]
        self.chance.shuffle(victims)
        for pid in victims:
            kill(pid)

    def kill_child(self, process):
        """A few, one after the other."""
        for _ in range(self.chance.randrange(1, 4)):
            if children := children_of(process):
                kill(self.chance.choice(children))
            _, come = self.when_journal_has_grown(0.01, 0.01)
            self.watch(process, come)

    def kill_child_and_stop(self, process):
        self.kill_child(process)
        process.terminate()

    def stop(self, process):
        process.send_signal(self.random.choice((signal.SIGINT, signal.SIGTERM)))

    def stop_at_once(self, process):
        process.terminate()
        self.watch(process, lambda: b"interrupt again" in self.text_of(process.errors).encode())
        if process.poll() is None:
            process.terminate()

    def fill_disk(self, process):
        """No more room than a few pages."""
        if self.disk:
            for _ in range(1000):  # the run may write meanwhile
                if self.remount(f"size={self.used() + 16384}", check=False):
                    break
            self.watch(process, lambda: False)
            self.remount("size=8g")
        else:
            process.terminate()

    def run_on_full_disk(self, share):
        """A disk that has room for a share of what is still to be made."""
        if not self.disk:
            return
        left = sum(path.stat().st_size for path in self.undisturbed.rglob("*") if path.is_file()) - self.used()
        self.remount(f"size={self.used() + max(1 << 16, int(share * left))}")
        process = self.start(*self.command(self.archive))
        self.watch(process, lambda: False)
        self.told(f"disk with room for {100 * share:.0f} %", process)
        self.assertEqual(process.returncode, STOPPED, self.text_of(process.errors))
        self.assertEqual(self.text_of(process.errors).count("No space left on device"), 1)
        self.check_end(process)
        self.check_whole()
        self.remount("size=8g")

    def mount(self):
        """Puts the archive on a disk of its own, if that is permitted."""
        disk = self.folder / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8g", "none", disk], capture_output=True)
        self.disk = disk if mounted.returncode == 0 else None
        if self.disk:
            self.addCleanup(subprocess.run, ["umount", "-l", disk], check=True)
        else:
            print("no disk may be mounted here, so none will be full")
        self.archive = disk / "archive"
        self.digests = Digests(self.archive)

    def remount(self, options, check=True):
        command = ["mount", "-o", f"remount,{options}", self.disk]
        return subprocess.run(command, capture_output=not check, check=check).returncode == 0

    def used(self):
        room = os.statvfs(self.disk)
        return (room.f_blocks - room.f_bfree) * room.f_frsize

    def lose(self, count):
        """The disk loses files, ends of files and bits."""
        for kind in ("scans/*.vtkhdf", "scans/*.xdmf", "library/triplets/*.run", "report/scans/*.html", "library.h5"):
            there = sorted(self.archive.glob(kind))
            for path in self.chance.sample(there, min(count, len(there))):
                how = self.chance.randrange(3) if kind != "report/scans/*.html" else 0
                data = path.read_bytes()
                if path.stem not in self.names_of_changing and kind != "library.h5":
                    self.lost.add(str(path.relative_to(self.archive)))
                if how == 0:
                    path.unlink()
                elif how == 1:
                    path.write_bytes(data[:self.chance.randrange(len(data))])
                else:
                    at = self.chance.randrange(len(data))
                    path.write_bytes(data[:at] + bytes([data[at] ^ 1 << self.chance.randrange(8)]) + data[at + 1:])
                    if path.suffix == ".vtkhdf" and self.call("check", path, "--json", codes=(0, 1))["broken"] == 0:
                        path.write_bytes(data)  # nothing reads this byte
        for record in ("journal.jsonl", "digests.txt", "estimates.json"):
            path = self.archive / record
            if path.exists():
                data = path.read_bytes()
                at = self.chance.randrange(max(1, len(data)))
                path.write_bytes(data[:at] + self.chance.randbytes(3) + data[at + 3:])

    # Recognition while the library is replaced.

    def recognise(self, archive, output, codes=(1,)):
        return self.call("recognise", self.scenes, "--library", archive, "--output", output, "--json", codes=codes)

    def check_recognised(self, folder, by_library):
        for path in (folder / "recognised").glob("[0-9]*.json"):
            data = path.read_bytes()
            digest = json.loads(data)["library"]["digest"]
            self.assertTrue(data == by_library[digest][path.name], f"{path} is none of library {digest}")

    def replace_library(self):
        """Scenes are recognised and a report is made while the library gets other models."""
        libraries = {}
        removals = [["0.ply"], ["1.ply", "3.ply"]]
        models = [model["name"] for model in self.call("library", "list", self.archive, "--json")["models"]]
        removals = [[next(m for m in models if m.endswith(name)) for name in names] for names in removals]
        changes = [("library", "remove", self.archive / "library.h5", *names) for names in removals]
        changes.append(("library", "build", self.archive))
        for number, change in enumerate(changes):  # what each library says, alone
            self.call(*change, "--json")
            folder = self.folder / f"alone {number}"
            document = self.recognise(self.archive, folder)
            libraries[document["library"]["digest"]] = {
                path.name: path.read_bytes() for path in (folder / "recognised").glob("*.json")}
        self.assertEqual(len(libraries), len(changes))
        found = self.folder / "found"
        for number in range(6 if LONG else 3):
            recogniser = self.start("recognise", self.scenes, "--library", self.archive, "--output", found, "--json")
            reporter = self.start("report", self.archive, "--index-only", "--json")
            self.watch(recogniser, lambda: (found / "lock").exists())
            self.call(*changes[number % len(changes)], "--json")
            document = self.end(recogniser, (1,))
            for scene in document["scenes"]:
                if scene["state"] == "failed" and not scene["input"].endswith("bad.ply"):
                    self.assertIn("the library has changed meanwhile; run again", scene["error"])
            self.assertEqual(self.end(reporter, (0,))["scans"], len(self.by_input))
            self.check_recognised(found, libraries)
        document = self.recognise(self.archive, found)
        self.assertEqual(document["failed"], 1)
        self.check_recognised(found, libraries)
        self.assertFalse((found / "lock").exists())

    # The night.

    def test_everything_at_once(self):
        self.lost = set()
        kills = [self.kill_run, self.kill_all, self.kill_child_and_stop, self.stop, self.stop_at_once]
        self.surely(self.kill_run, self.when_huge_appears)
        evening = self.random.sample(kills, len(kills)) + (self.random.choices(kills, k=5) if LONG else [])
        for number, what in enumerate(evening):
            self.disturbed(what, self.when_journal_has_grown())
            if number == len(evening) // 2:
                self.run_on_full_disk(0.1)
        for what in (self.kill_run, self.kill_child_and_stop):
            self.disturbed(what, self.when_locked())
        for kind in ("triplets", "partition", "library", "page", "report"):
            self.surely(self.random.choice((self.kill_run, self.kill_all)), lambda: self.when_started(kind))
        self.surely(self.fill_disk, lambda: self.when_started("library"))
        self.surely(self.kill_child, lambda: self.when_started("surface"))
        self.surely(self.kill_run, self.when_ended)
        self.lose(2)
        self.check_end(self.start(*self.command(self.archive), "--verify"))
        self.check_whole()
        self.assertEqual(self.lost, set())
        self.replace_library()
        self.lose(2)
        self.morning()

    def morning(self):
        """One run that nobody disturbs, and then everything is there that can be."""
        for path, data in self.kept.items():
            path.write_bytes(data)
        process = self.start(*self.command(self.archive), "--verify")
        document = self.check_end(process, disturbed=False)
        self.assertEqual(process.returncode, 1)
        scenes = self.recognise(self.archive, self.archive)["scenes"]
        self.call("report", self.archive, "--json")
        self.assertEqual(self.digests.now(), self.wanted)
        self.check_nothing_left()
        self.check_losses(document, [scene["error"] for scene in scenes if scene["state"] == "failed"])
        self.call("check", self.archive, "--json")
        self.call("library", "check", self.archive / "library.h5", "--json")
        again = self.end(self.start(*self.command(self.archive)), (1,))
        made = [job["kind"] for job in again["scans"] + again["jobs"] if job["state"] == "done"]
        self.assertEqual(made, ["report"])  # without the scene that could not be read
        self.check_losses(again)
        self.assertEqual(self.digests.now(), self.wanted)
        self.check_processes()
        print(f"morning: {document['done']} done, {document['up_to_date']} up to date, {document['failed']} failed",
              flush=True)

    def check_losses(self, document, more=()):
        """Each scan has a dataset, or a line in each place that tells of failures. `more` are those of no scan."""
        failed = {scan["name"]: scan["error"] for scan in document["scans"] if scan["state"] == "failed"}
        self.assertEqual(failed, self.wanted_failures)
        for scan in document["scans"]:
            self.assertEqual(self.dataset(scan["name"]).exists(), scan["name"] not in failed, scan)
        page = (self.archive / "report/index.html").read_text()
        shown = json.loads(page.split('<script type="application/json" id="data">')[1].split("</script>")[0])
        self.assertEqual({scan["name"] for scan in shown["scans"] if scan["state"] == "failed"}, set(failed))
        self.assertEqual({scan["name"] for scan in shown["scans"] if scan["state"] == "done"},
                         {scan["name"] for scan in document["scans"]} - set(failed))
        self.assertEqual(sorted(f"{one['reason']}; {one['remedy']}" for one in shown["failures"]),
                         sorted([*failed.values(), *more]))

    def check_processes(self):
        """No process of the night is left."""
        mark = f"TMPDIR={self.temporary}".encode()
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                self.assertNotIn(mark, (folder / "environ").read_bytes().split(b"\0"), (folder / "cmdline").read_bytes())
            except OSError:
                pass  # it has ended, or belongs to somebody else


if __name__ == "__main__":
    unittest.main()
