"""Every call of the C library that can fail fails once in small commands, from a run to a removal: the program
says so or goes on, nothing broken stands under a final name, nothing is left over, and the same command again ends
with the bytes of an undisturbed one. `python3 -B faults_test.py PROGRAM LIBRARY [unittest's arguments]`, where LIBRARY
is built from counted_calls.cpp and its neighbours.

SEMIGEO_FAULTS_SAMPLE is the number of calls of each function and scenario that fail, or `all`.
SEMIGEO_FAULTS_ONLY, such as `run`, `run.write` or `run.write.12.ENOSPC`, says which."""

import concurrent.futures
import errno
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "e2e"))
from support import PROGRAM, RECORDS, boulder, write_ply  # noqa: E402

LIBRARY = Path(sys.argv.pop(1)).resolve()
SAMPLE = os.environ.get("SEMIGEO_FAULTS_SAMPLE", "1")
ONLY = os.environ.get("SEMIGEO_FAULTS_ONLY", "").split(".")
ALLOCATIONS = 300  # of each scenario, if all calls are to fail: there are many thousands
TIMEOUT = 120
STATE_BYTES = 4096
SHORT = "short"  # half of the bytes are moved

# In the order in which counted_calls.hpp counts them, with the errors that Linux gives.
FUNCTIONS = {
    "write": ("ENOSPC", "EIO", "EINTR", SHORT),
    "pwrite": ("ENOSPC", "EIO", "EINTR", SHORT),
    "fsync": ("EIO", "ENOSPC"),
    "rename": ("EACCES", "EIO", "ENOSPC"),
    "open": ("EACCES", "EMFILE", "EIO", "ENOMEM", "EINTR"),
    "close": ("EIO", "EINTR"),
    "read": ("EIO", "EINTR", SHORT),
    "pread": ("EIO", "EINTR", SHORT),
    "mmap": ("ENOMEM", "EACCES"),
    "ftruncate": ("EIO", "ENOSPC"),
    "malloc": ("ENOMEM",),
    "pipe_read": ("EINTR", SHORT),
    "pipe_write": ("EINTR", SHORT),
    "stat": ("EACCES", "EIO", "ENOMEM"),
    "fstat": ("EIO", "ENOMEM"),
    "lseek": ("EIO",),
    "readdir": ("EIO",),
    "mkdir": ("EACCES", "ENOSPC", "EIO"),
    "unlink": ("EACCES", "EIO"),
    "link": ("EPERM", "EIO", "EMLINK"),
    "pipe": ("EMFILE", "ENFILE"),
    "fork": ("EAGAIN", "ENOMEM"),
    "exec": ("ENOMEM", "EACCES", "EIO"),
    "thread": ("EAGAIN",),
    "poll": ("EINTR", "ENOMEM"),
    "wait": ("EINTR",),
    "dup": ("EMFILE",),
    "lock": ("ENOLCK", "EINTR"),
    "socket": ("EINTR", SHORT, "ENOBUFS"),
    "limit": ("EPERM",),
    "path": ("EACCES", "EIO", "ENOMEM"),
    "watch": ("EMFILE", "ENFILE"),
}
# Advice that costs work, or results. It is wrong after an error that passes.
COSTLY_ADVICE = re.compile(r"\b(remove\b|delete|rebuild|compute it again|copy the file again|is damaged|broken:)")
DOCUMENTED_CODES = (0, 1, 2, 73, 75)


def contents(folder):
    """Every file of a folder but records and logs of runs."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*"))
            if path.is_file() and path.name not in RECORDS and path.parent.name != "logs"}


class Scenario:
    """A command, and the folder that it begins with: how another one has left it, or empty. `again` is whether it may
    be given once more when it is done; `tells` is whether its output is always the same; `tidies` is whether
    it removes what an earlier command could not remove."""

    def __init__(self, name, start, *arguments, again=True, tells=False, tidies=True):
        self.name, self.start, self.arguments = name, start, arguments
        self.again, self.tells, self.tidies = again, tells, tidies

    def command(self, scans):
        return [str(PROGRAM), *(str(a).replace("SCANS", str(scans)) for a in self.arguments)]


class Case:
    """A folder of its own, in which a scenario runs. Archives do not know where they are."""

    def __init__(self, scenario, scans, folder):
        self.scenario, self.scans, self.folder = scenario, scans, folder
        self.place, self.temporary = folder / "place", folder / "temporary"
        self.state = folder / "state"
        self.temporary.mkdir(parents=True)
        if scenario.start is None:
            self.place.mkdir()
        else:
            shutil.copytree(scenario.start.place, self.place, symlinks=True)
        self.before = contents(self.place)

    def run(self, fault=None, counted=False):
        """The process, with its output as text. `fault` is FUNCTION:N:ERRNO."""
        environment = os.environ | {"TMPDIR": str(self.temporary)}
        if fault or counted:
            self.state.write_bytes(bytes(STATE_BYTES))
            environment |= {"LD_PRELOAD": str(LIBRARY), "SEMIGEO_FAULTS_STATE": str(self.state),
                            "SEMIGEO_FAULTS_FAIL": fault or ""}
        return subprocess.run(self.scenario.command(self.scans), cwd=self.place, env=environment, timeout=TIMEOUT,
                              capture_output=True, text=True, errors="backslashreplace")

    def counts(self):
        numbers = struct.unpack_from("<32Q", self.state.read_bytes())
        return dict(zip(FUNCTIONS, numbers))

    def failed_call(self):
        return self.state.read_bytes()[256:1280].split(b"\0")[0].decode(errors="backslashreplace")


def numbers_to_fail(count, function):
    """Which calls of `count` fail: all, or one of each of as many equal parts as the sample has."""
    sample = SAMPLE
    if sample == "all":
        if function != "malloc" or count <= ALLOCATIONS:
            return range(1, count + 1)
        sample = ALLOCATIONS
    parts = min(count, int(sample))
    # Not the same place of each part.
    return sorted({1 + int((part + 0.618 * (part + 1) % 1) * count / parts) for part in range(parts)})


def faults(scenario, counts):
    """FUNCTION, N, ERROR of all cases of a scenario."""
    found = []
    for function, errors in FUNCTIONS.items():
        for turn, number in enumerate(numbers_to_fail(counts[function], function)):
            # A sample gives each error its turn.
            chosen = errors if SAMPLE == "all" else (errors[(turn + len(found)) % len(errors)],)
            found += [(function, number, error) for error in chosen]
    wanted = ONLY[1:]
    return [fault for fault in found if all(a == str(b) for a, b in zip(wanted, fault))]


class FaultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="semigeo-faults-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.scans = cls.folder / "scans"
        for i in range(2):
            for folder in ("models", "more"):
                write_ply(cls.scans / folder / f"{i}.ply", boulder(3, i))
        write_ply(cls.scans / "scenes" / "scene.ply", boulder(3, 1))
        run = ("run", "SCANS/models", "--output", "archive", "--levels", 1, "--threads", 1)
        search = ("SCANS/scenes/scene.ply", "--library", "archive/library.h5", "--output", "archive", "--threads", 1)
        first, second = (f"archive/scans/{i}.ply.vtkhdf" for i in range(2))
        cls.scenarios = {}

        def add(name, start, *arguments, **properties):
            scenario = Scenario(name, cls.scenarios.get(start), *arguments, **properties)
            case = Case(scenario, cls.scans, cls.folder / name)
            process = case.run()
            if process.returncode != 0:
                raise AssertionError(process.stdout + process.stderr)
            scenario.wanted, scenario.place, scenario.output = contents(case.place), case.place, process.stdout
            cls.scenarios[name] = scenario

        add("run", None, *run)
        add("library", "run", *run, "--library")
        add("recognise", "library", "recognise", *search)
        add("similar", "library", "similar", *search)
        add("report", "recognise", "report", "archive", "--threads", 1)
        add("check", "report", "check", "archive", tells=True)
        add("info", "report", "info", "archive", tells=True)
        add("status", "report", "status", "archive", tells=True)
        add("picture", "run", "picture", first, "--output", "0.png", "--size", 64)
        add("export", "run", "export", "archive", "--levels", "0", "--output", "exported")
        add("build", "run", "library", "build", first, "--output", "mine.h5", "--threads", 1)
        add("add", "build", "library", "add", "mine.h5", second, "--threads", 1)
        add("remove", "add", "library", "remove", "mine.h5", "1.ply", "--threads", 1, again=False)
        add("more", None, "run", "SCANS/more", "--output", "archive", "--levels", 1, "--threads", 1)
        (cls.scans / "more" / "1.ply").unlink()
        add("prune", "more", "prune", "archive", tidies=False)

    def problems(self, scenario, folder, fault):
        """What is wrong after this fault, as text; empty if all is well."""
        function, number, error = fault
        code = 0 if error == SHORT else getattr(errno, error)
        case = Case(scenario, self.scans, folder)
        found = []
        try:
            process = case.run(f"{function}:{number}:{code}")
        except subprocess.TimeoutExpired:
            return f"hangs ({case.failed_call()})"
        failed = case.failed_call()
        text = process.stdout + process.stderr
        if process.returncode not in DOCUMENTED_CODES:
            found.append(f"ended with {process.returncode}")
        if failed and process.returncode != 0 and not re.search(r"archive|mine|scans|scene|memory|output|semigeo:", text):
            found.append("says nothing")
        if failed and COSTLY_ADVICE.search(text):
            found.append("gives costly advice")
        if process.returncode == 0 and scenario.tells and process.stdout != scenario.output:
            found.append("ended with 0, but says something else")
        found += self.problems_of_files(case, function, process.returncode, text)
        # What could not be forced to the disk may be done all the same.
        if scenario.again or contents(case.place).get("mine.h5") != scenario.wanted["mine.h5"]:
            found += self.problems_of_next(case)
        if not found:
            return ""
        return f"{'; '.join(found)}\n  failed call: {failed or 'none'}\n  code {process.returncode}: {text.strip()}"

    def problems_of_files(self, case, function, code, text):
        found, now, wanted = [], contents(case.place), case.scenario.wanted
        # What could not be removed, or read to be removed, stays, and the next run removes it.
        unremoved = case.failed_call().partition(": ")[2].removeprefix(f"{case.place}/")
        if function == "unlink" or unremoved.endswith(("/lock", "/partitions", "/triplets", ".run")):
            now = {path: data for path, data in now.items() if path in wanted or
                   not (path.startswith(unremoved) or path.endswith(unremoved))}
        # What a library is made of stays until it is made; what was to be removed may be there.
        left = [path for path in now if path not in wanted and now[path] != case.before.get(path) and
                (path.endswith(".partial") or not path.startswith(("archive/library/", "mine.h5.parts/")))]
        # A folder that could not be listed when it was to be removed stays.
        left += [str(path) for path in case.temporary.rglob("*") if str(case.temporary) not in case.failed_call()]
        # Without memory the program ends at once, and leaves that to the next run.
        if left and "there is not enough memory" not in text and "Cannot allocate memory" not in text:
            found.append(f"leaves {left}")
        changed = [path for path in now if path in wanted and now[path] not in (wanted[path], case.before.get(path))]
        # The first page of a report tells what cannot be read, and is made all the same.
        tells = re.search(r"failures: [1-9]", text)
        differ = sorted(path for path in now.keys() | wanted.keys() if now.get(path) != wanted.get(path)
                        and not (tells and path == "archive/report/index.html"))
        if code == 0 and differ:
            found.append(f"ended with 0, but these differ: {differ}")
        # Whole, but of less: a library without a model, a page of a report that says so.
        for path in changed:
            if path.endswith(".h5") and not self.is_whole(case.place / path):
                found.append(f"{path} is broken")
            elif path.endswith(".html") and not now[path].rstrip().endswith(b"</html>"):
                found.append(f"{path} is broken")
            elif path.endswith(".json"):
                json.loads(now[path])
            elif not path.endswith((".h5", ".html")):
                found.append(f"{path} differs")
        return found

    def is_whole(self, library):
        return subprocess.run([PROGRAM, "library", "check", library], capture_output=True).returncode == 0

    def problems_of_next(self, case):
        process = case.run()
        if process.returncode != 0:
            return [f"the next run ends with {process.returncode}: {process.stdout}{process.stderr}"]
        now, wanted = contents(case.place), case.scenario.wanted
        if not case.scenario.tidies:
            now = {path: data for path, data in now.items() if not path.endswith(".partial")}
        differ = sorted(path for path in now.keys() | wanted.keys() if now.get(path) != wanted.get(path))
        return [f"after the next run these differ: {differ}"] if differ else []

    def examine(self, name):
        if ONLY[0] not in ("", name):
            self.skipTest("not asked for")
        scenario = self.scenarios[name]
        with tempfile.TemporaryDirectory(prefix="semigeo-faults-") as folder:
            case = Case(scenario, self.scans, Path(folder) / "case")
            process = case.run(counted=True)
            self.assertEqual(process.returncode, 0, process.stderr)
            self.assertEqual(contents(case.place), scenario.wanted)
            counts = case.counts()
        cases = faults(scenario, counts)
        print(f"{name}: {len(cases)} faults in", json.dumps(counts), flush=True)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for fault, problems in zip(cases, pool.map(lambda fault: self.in_folder(scenario, fault), cases)):
                with self.subTest(fault=".".join(map(str, (name, *fault)))):
                    self.assertFalse(problems, problems)

    def in_folder(self, scenario, fault):
        with tempfile.TemporaryDirectory(prefix="semigeo-faults-") as folder:
            return self.problems(scenario, Path(folder) / "case", fault)

    def test_run(self):
        self.examine("run")

    def test_library(self):
        self.examine("library")

    def test_recognise(self):
        self.examine("recognise")

    def test_similar(self):
        self.examine("similar")

    def test_report(self):
        self.examine("report")

    def test_check(self):
        self.examine("check")

    def test_info(self):
        self.examine("info")

    def test_status(self):
        self.examine("status")

    def test_picture(self):
        self.examine("picture")

    def test_export(self):
        self.examine("export")

    def test_build(self):
        self.examine("build")

    def test_add(self):
        self.examine("add")

    def test_remove(self):
        self.examine("remove")

    def test_prune(self):
        self.examine("prune")


if __name__ == "__main__":
    unittest.main()
