"""A cluster of Slurm on this machine, of two nodes, that listens on loopback only and lives in one folder."""

import os
import secrets
import shutil
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "sinfo")
NODES = ("n1", "n2")
START_SECONDS = 30

CONFIGURATION = """\
ClusterName=semigeotest
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={ports[0]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
SlurmUser=root
SlurmdUser=root
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
MpiDefault=none
JobRequeue=1
ReturnToService=2
SlurmdTimeout=30
InactiveLimit=0
KillWait=2
MinJobAge=5
MaxArraySize=1001
NodeName=n[1-2] NodeHostname=localhost NodeAddr=127.0.0.1 Port=[{ports[1]}-{ports[2]}] CPUs={cpus} RealMemory={memory_mb} State=UNKNOWN
PartitionName=main Nodes=n[1-2] Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO DefMemPerCPU=100
"""


def why_not():
    """Why no cluster can be started here, or None."""
    if os.geteuid() != 0:
        return "Slurm's daemons are started as root"
    missing = [program for program in PROGRAMS if shutil.which(program) is None]
    return f"not installed: {', '.join(missing)}" if missing else None


def free_ports():
    """One, and two that follow each other."""
    for _ in range(100):
        with socket.socket() as one, socket.socket() as first, socket.socket() as second:
            try:
                one.bind(("127.0.0.1", 0))
                first.bind(("127.0.0.1", 0))
                port = first.getsockname()[1]
                second.bind(("127.0.0.1", port + 1))
            except (OSError, OverflowError):
                continue
            return one.getsockname()[1], port, port + 1
    raise RuntimeError("no free ports")


def memory_mb():
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2 ** 20


class Cluster:
    """The daemons stay in the foreground, as children: they can be ended whatever happens."""

    def __init__(self, folder):
        """`folder` and those above it must not be writable for everybody: munge refuses that."""
        self.folder = folder
        self.daemons = []
        for name in ("munge", "state"):
            (folder / name).mkdir(mode=0o755, parents=True)
        folder.chmod(0o755)
        # Cores are only numbers here: the two nodes share them.
        (folder / "slurm.conf").write_text(CONFIGURATION.format(
            folder=folder, ports=free_ports(), cpus=2, memory_mb=memory_mb()))
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
        try:
            self.start()
        except BaseException:
            self.stop()
            raise

    def start(self):
        munge = self.folder / "munge"
        key = munge / "key"
        key.write_bytes(secrets.token_bytes(1024))
        key.chmod(0o400)
        self.daemon("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={munge}/socket",
                    f"--pid-file={munge}/pid", f"--log-file={munge}/log", f"--seed-file={munge}/seed")
        self.wait_for(lambda: (munge / "socket").exists(), "munge")
        self.daemon("slurmctld", "-D", "-i", "-f", self.folder / "slurm.conf")
        for node in NODES:
            self.daemon("slurmd", "-D", "-N", node, "-f", self.folder / "slurm.conf")
        self.wait_for(lambda: self.command("sinfo", "-h", "-N", "-o", "%T").split() == ["idle"] * 2, "the nodes")

    def daemon(self, *arguments):
        with open(self.folder / "daemons.log", "ab") as log:
            self.daemons.append(subprocess.Popen([str(a) for a in arguments], env=self.environment, stdout=log,
                                                 stderr=log, stdin=subprocess.DEVNULL))

    def wait_for(self, condition, what):
        deadline = time.monotonic() + START_SECONDS
        while not condition():
            if time.monotonic() > deadline or any(daemon.poll() is not None for daemon in self.daemons):
                logs = "\n".join(log.read_text(errors="replace")[-2000:] for log in self.folder.glob("*.log"))
                raise RuntimeError(f"{what} did not start\n{logs}")
            time.sleep(0.05)

    def command(self, *arguments):
        """What the command prints; nothing if it fails."""
        process = subprocess.run(arguments, env=self.environment, capture_output=True, text=True, timeout=60)
        return process.stdout if process.returncode == 0 else ""

    def stop(self):
        """Ends the jobs, then the daemons; all of them are gone when this returns."""
        if len(self.daemons) > 1:
            self.command("scancel", "--user=root")
            deadline = time.monotonic() + START_SECONDS
            while self.command("squeue", "--noheader").strip() and time.monotonic() < deadline:
                time.sleep(0.1)
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in reversed(self.daemons):
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        self.daemons = []
