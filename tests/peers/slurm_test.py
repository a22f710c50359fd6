"""A study by an array of a real Slurm, of one node that this test starts, has the bytes of one by --jobs 1.

usage: slurm_test.py EMSCAPE STUDY
Needs root (slurmd sets up its tasks) and Debian's slurmctld, slurmd, slurm-client and munge; skipped (77) without.
"""
import filecmp
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time

CONFIGURATION = """ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmctldPort={port}
SlurmdPort={next_port}
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SchedulerParameters=sched_interval=1
MpiDefault=none
NodeName={host} NodeAddr=127.0.0.1 CPUs={processors} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
PARTS = 8


def wait_for(condition, seconds, what):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            sys.exit(f"{what}: not within {seconds} s")
        time.sleep(0.2)


def free_ports():
    """Two ports that follow each other and that nobody listens at."""
    for port in range(16817, 17817, 2):
        with socket.socket() as first, socket.socket() as second:
            try:
                first.bind(("127.0.0.1", port))
                second.bind(("127.0.0.1", port + 1))
            except OSError:
                continue
            return port
    sys.exit("no free ports")


class Slurm:
    """One node with its controller and its authentication."""

    def __init__(self, folder):
        self.folder = folder
        host, port = socket.gethostname().split(".")[0], free_ports()
        for name in ("state", "spool", "munge"):
            (folder / name).mkdir(mode=0o700)
        key = folder / "munge/key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        folder.chmod(0o755)  # munge refuses folders that others can write
        configuration = folder / "slurm.conf"
        configuration.write_text(
            CONFIGURATION.format(host=host, folder=folder, port=port, next_port=port + 1, processors=os.cpu_count()))
        os.environ["SLURM_CONF"] = str(configuration)
        self.processes = []
        self.start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={folder}/munge.socket",
                   f"--pid-file={folder}/munge/pid", f"--log-file={folder}/munge/log", f"--seed-file={folder}/munge/seed")
        wait_for((folder / "munge.socket").exists, 10, "munged")
        self.start("slurmctld", "-D", "-f", configuration)
        self.start("slurmd", "-D", "-f", configuration, "-N", host)
        wait_for(lambda: "idle" in subprocess.run(["sinfo"], capture_output=True, text=True).stdout, 30, "slurmd")

    def start(self, *command):
        with open(self.folder / f"{command[0]}.out", "wb") as output:
            self.processes.append(subprocess.Popen([str(word) for word in command], stdout=output, stderr=output))

    def stop(self):
        for process in reversed(self.processes):
            process.terminate()
        for process in self.processes:
            process.wait(20)


def main(emscape, study):
    os.environ["PATH"] += ":/usr/sbin"
    missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch") if shutil.which(name) is None]
    if missing or os.geteuid() != 0:
        print("skipped: " + ("needs root" if not missing else "no " + ", ".join(missing)))
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        array, alone = folder / "array", folder / "alone"
        os.environ["EMSCAPE_DIR"] = str(pathlib.Path(emscape).parent)
        slurm_folder = folder / "slurm"
        slurm_folder.mkdir()
        slurm = Slurm(slurm_folder)
        try:
            subprocess.run([emscape, "study", study, "-o", array, "--slurm", folder / "job.sh", "--chunks", str(PARTS), "--time",
                            "00:05:00", "--submit"], check=True, cwd=folder)
            wait_for((array / "report.html").exists, 60, "the array and its merging")
            wait_for(lambda: not subprocess.run(["squeue", "--noheader"], capture_output=True).stdout, 30, "the end of the jobs")
        finally:
            slurm.stop()
        subprocess.run([emscape, "study", study, "-o", alone, "--jobs", "1", "--quiet"], check=True)
        different = [file for file in ("results.csv", "results.nc", "report.html")
                     if not filecmp.cmp(array / file, alone / file, shallow=False)]
        if different:
            sys.exit("not the same bytes: " + ", ".join(different))
        print(f"an array of {PARTS} parts and their merging: the same bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
