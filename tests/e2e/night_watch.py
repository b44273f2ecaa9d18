"""What a night watches: the moments at which something happens, told by what a run has written, and what files hold."""

import hashlib
import os

from support import RECORDS


class Digests:
    """Digests of the files of a folder but records and logs of runs, and the first page of the report, which has times."""

    def __init__(self, folder):
        self.folder, self.known = folder, {}

    def now(self):
        found = {}
        for path in self.folder.rglob("*"):
            name = str(path.relative_to(self.folder))
            if path.name in (*RECORDS, "lock") or name.startswith("logs/") or name == "report/index.html":
                continue
            try:
                if not path.is_file():
                    continue
                status = path.stat()
                stamp = (status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
                if self.known.get(name, (None,))[0] != stamp:
                    self.known[name] = (stamp, hashlib.blake2b(path.read_bytes()).hexdigest())
            except FileNotFoundError:
                continue  # a partial file of a child that is dying
            found[name] = self.known[name][1]
        return found


class Moments:
    """Moments of a run in self.archive: each is a name, and a function that says whether it has come."""

    def journal_size(self):
        try:
            return (self.archive / "journal.jsonl").stat().st_size
        except OSError:
            return 0

    def when_journal_has_grown(self, least=0.02, most=0.12):
        """By a share of the journal of an undisturbed run."""
        share = self.random.uniform(least, most)
        wanted = self.journal_size() + share * self.reference_journal
        return f"journal +{100 * share:.0f} %", lambda: self.journal_size() >= wanted

    def when_locked(self):
        return "lock", lambda: (self.archive / "lock").exists()

    def when_journal_says(self, sign):
        before = self.journal_size()

        def seen():
            try:
                with (self.archive / "journal.jsonl").open("rb") as file:
                    file.seek(before)
                    return sign in file.read()
            except OSError:
                return False
        return seen

    def when_started(self, kind):
        """A job of this kind."""
        return f"start of a {kind} job", self.when_journal_says(b'"event":"started","job":"%s ' % kind.encode())

    def when_huge_appears(self):
        """The dataset of the largest scan, under any name: it is being written."""
        folder = self.archive / "scans"
        (folder / "huge.ply.vtkhdf").unlink(missing_ok=True)

        def seen():
            return folder.is_dir() and any("huge.ply.vtkhdf" in name for name in os.listdir(folder))
        return "huge dataset", seen

    def when_ended(self):
        """The jobs, but not yet the run."""
        return "end of the jobs", self.when_journal_says(b'"event":"run_ended"')

    def change_scans(self):
        """One of those that change: it is cut off, grows, vanishes, or is whole again."""
        path = self.chance.choice(self.changing)
        data = self.kept[path]
        change = self.chance.randrange(4)
        if change == 0:
            path.write_bytes(data[:self.chance.randrange(len(data))])
        elif change == 1:
            with path.open("ab") as file:
                file.write(self.chance.randbytes(500))
        elif change == 2:
            path.unlink(missing_ok=True)
        else:
            beside = path.with_suffix(".other")
            beside.write_bytes(data)
            beside.rename(path)
