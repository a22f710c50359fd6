"""Fails system calls of emscape one after another, as SQLite's tests do.

Every command runs once without a fault, under strace. Then it runs again for each system call that touches its
inputs or outputs, and that call fails (strace --inject). After each run:
- the exit status is 0, and every file is as without the fault, or it is 1 or 3, with one error message;
- no file is torn: each one under its final name is as without the fault, coordinate systems and labels included, or an
  older whole state of the bookkeeping;
- no temporary file is left;
- the command again (with --resume where it has it) completes to the same bytes.
Once every write to a file writes half of its bytes only, once no file can be locked, and once none has attributes: the files are as without that.
Then one allocation after another fails, with the same checks.

usage: fault_walk.py EMSCAPE SHORT_WRITES FAILING_ALLOCATIONS SCENARIO_FOLDER [--all] [--calls NAMES] [--allocations N] [--allocation-bytes N] [COMMAND...]
  SHORT_WRITES, FAILING_ALLOCATIONS  the libraries of short_writes.cpp and failing_allocations.cpp
  --all          every occurrence of every call; otherwise the first two, the last two and the middle one
  --calls        only these system calls, separated by commas
  --allocations  how many allocations of each command fail, spread over its run
  --allocation-bytes  of how many bytes they are at least. Those of the destructor of nlohmann's JSON, which would end the program, never fail
"""

import argparse
import contextlib
import hashlib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench"))
from virtual_display import virtual_display

SKIPPED = 77
# What a call can fail with.
FAULTS = {
    "write": ["ENOSPC", "EIO", "EINTR"],
    "writev": ["ENOSPC"],
    "pwrite64": ["ENOSPC"],
    "fsync": ["EIO"],
    "rename": ["EACCES"],
    "openat": ["EACCES", "EMFILE", "EINTR"],
    "mkdir": ["ENOSPC"],
    "ftruncate": ["EIO"],
    "read": ["EIO", "EINTR"],
    "mmap": ["ENOMEM"],
    "flock": ["ENOLCK"],
    "pread64": ["EIO"],
    "lseek": ["EIO"],
    "clone3": ["EAGAIN"],  # threads and processes
}
# Of the window, whose threads also speak with the display: calls that are those of its files.
WINDOW_FAULTS = {call: FAULTS[call] for call in ("write", "fsync", "rename", "openat")}
# What the window saves; each is waited for, and an error ends it with status 5.
SAVES = """
{{"do": "wait_frame"}}
{{"do": "set", "path": "emitters.radar.power_w", "value": "500"}}
{wait}
{{"do": "save", "file": "{out}/changed.yaml"}}
{wait}
{{"do": "save_state", "file": "{out}/view.json"}}
{wait}
{{"do": "save_transfer", "file": "{out}/colors.json"}}
{wait}
{{"do": "picture", "file": "{out}/picture.png"}}
{wait}
{{"do": "quit", "edits": "discard"}}
"""
WAIT = """{"do": "wait_state", "state": "exact"}
{"do": "expect", "key": "error", "op": "==", "value": ""}"""
# Files that are rewritten on the way, volumes for the range of the whole series: an earlier state may stay.
VOLUMES = re.compile(r"\.(vdb|nvdb|vti|raw)$")  # `emscape info` reads them
BOOKKEEPING = re.compile(r"series\.(json|steps)|\.pvd|\.(raw|nvdb)\.json|study\.json|manifest\.json|parts/part_\d+\.(rows|json|csv)$")
# Without content, or with a process's own.
IGNORED = re.compile(r"(^|/)([^/]*\.lock|\.emscape-files)$")
CALL = re.compile(r"^(\d+) +(\w+)\((.*)$")


class Commands:
    def __init__(self, emscape, scenarios):
        self.emscape = str(emscape)
        quick, links = str(scenarios / "quick.yaml"), str(scenarios / "links.yaml")
        small = ["--set", "duration_s=1", "--set", "region.dims=[12,12,6]"]
        simulate = ["-q", "simulate", quick, *small, "-o", "{out}/series"]
        self.table = {
            "simulate-vdb": (simulate + ["--format", "vdb"], ["--resume"]),
            "simulate-nvdb": (simulate + ["--format", "nvdb"], ["--resume"]),
            "simulate-vti": (simulate + ["--format", "vti"], ["--resume"]),
            "simulate-raw": (simulate + ["--format", "raw"], ["--resume"]),
            "render": (["-q", "render", quick, *small, "--size", "64x48", "--times", "0", "-o", "{out}/picture.png"], []),
            "frames": (["-q", "render", quick, *small, "--size", "64x48", "-o", "{out}/frames"], []),
            "film": (["-q", "render", quick, *small, "--size", "64x48", "-o", "{out}/film.mp4"], []),
            "coverage": (
                ["-q", "coverage", quick, "--quantity", "power_density_dbwm2", "--threshold", "-60", "--heights", "agl:100",
                 "--cell", "2000", "--format", "cog,png,gpkg,geojson,nc,kmz,czml", "-o", "{out}/map"],
                [],
            ),
            "window": (["view", quick, *small, "-q", "--size", "320x240", "--backend", "cpu", "--script", "{out}/../script.jsonl"], []),
            "compare": (
                ["-q", "compare", quick, "--set-b", "emitters.radar.power_w=1", "--times", "0", "--cell", "4000",
                 "--volume", "{out}/map/difference.vdb", "-o", "{out}/map"],
                [],
            ),
            "vertical": (
                ["-q", "vertical", quick, "--emitter", "radar", "--azimuth", "30", "--areps", "{out}/areps",
                 "-o", "{out}/v.png", "-o", "{out}/v.svg", "-o", "{out}/v.csv", "-o", "{out}/v.json"],
                [],
            ),
            "profile": (["-q", "profile", quick, "--emitter", "radar", "--to", "52.05,5.05,100", "--plot", "{out}/p.png"], []),
            "link": (["-q", "link", links, "--times", "0:2:1", "--csv", "{out}/l.csv", "--plot", "{out}/l.svg"], []),
            "exposure": (["-q", "exposure", links, "--platform", "drone", "--times", "0:4:1", "-o", "{out}/e.png", "-o", "{out}/e.csv"], []),
            "blockage": (
                ["-q", "blockage", links, "--emitter", "mast", "--beamwidth", "2", "--elevation", "0", "--range", "9000",
                 "-o", "{out}/b.nc", "-o", "{out}/b.tif", "-o", "{out}/b.csv", "-o", "{out}/b.png"],
                ["--force"],
            ),
            "import": (["-q", "import", str(scenarios / "recordings" / "jamming.pcap"), "-o", "{out}/i.yaml"], ["--force"]),
            "export-acmi": (["-q", "export", quick, "-o", "{out}/e.zip.acmi"], ["--force"]),
            "export-czml": (["-q", "export", quick, "--coverage", "agl:100", "-o", "{out}/e.czml"], ["--force"]),
            "terrain": (["-q", "terrain", str(scenarios / "data" / "jacksboro.tif"), "-o", "{out}/t.png"], []),
            "study": (["-q", "study", str(scenarios / "study" / "jammer_power.yaml"), "-o", "{out}/study"], ["--resume"]),
        }


def files_of(folder):
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_file() and not IGNORED.search(name):
            found[name] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


def run(command, out, inject=None, log=None, preload=None, **variables):
    arguments = [part.format(out=out) for part in command]
    environment = dict(os.environ, XDG_STATE_HOME=str(out.parent / "state"), XDG_CONFIG_HOME=str(out.parent / "config"), **variables)
    if preload:
        environment["LD_PRELOAD"] = str(preload)
    if inject or log:
        calls = ",".join(FAULTS)
        tracing = ["strace", "-f", "-qq", "-y", "-e", "signal=none", "-o", str(log or "/dev/null")]
        tracing += ["-e", f"inject={inject}"] if inject else []
        # Calls that are not traced run at full speed.
        tracing += ["--seccomp-bpf", "-e", f"trace={inject.split(':')[0] if inject else calls}"]
        arguments = tracing + arguments
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=120, errors="replace", env=environment)
    return done.returncode, done.stderr


def occurrences(log, touched, faults):
    """For each call the numbers, per thread as strace counts them, at which it touches one of the folders."""
    counts, found, loaded = {}, {}, {}
    for line in log.read_text(errors="replace").splitlines():
        match = CALL.match(line)
        if not match or match[2] not in faults:
            continue
        thread, call, rest = match.groups()
        counts[thread, call] = counts.get((thread, call), 0) + 1
        # Calls of the loader of libraries come before; strace counts by thread, so that others share its numbers.
        # PROJ reads its database, from which coordinate systems are written, by pread64.
        touches = any(folder in rest for folder in touched) or (call == "pread64" and "proj.db" in rest)
        if touches and not loaded:
            loaded = {kind: counts.get((thread, kind), 1) - 1 for kind in ("mmap", "read", "openat")}
            loaded[call] = counts[thread, call] - 1
        if call == "clone3" or ((touches or (call == "mmap" and "MAP_ANONYMOUS" in rest)) and loaded):
            if counts[thread, call] > loaded.get(call, 0):
                found.setdefault(call, set()).add(counts[thread, call])
    # HDF5 alone uses pwrite64. Its last write is the head of the file again: where it fails, netCDF 4.9.0 (NC4_close)
    # asks for the names of the objects of the file that is closed already, and HDF5 1.10 crashes.
    found["pwrite64"] = found.get("pwrite64", set()) - {max(found.get("pwrite64", {0}))}
    return {call: sorted(numbers) for call, numbers in found.items()}


def spared_code(program):
    """The program's destructors of JSON, which allocate and cannot report that it failed."""
    symbols = subprocess.run(["nm", "-C", "-S", "--defined-only", program], capture_output=True, text=True, check=True).stdout
    destructors = re.findall(r"^(\w+) (\w+) \w nlohmann::.*::json_value::destroy\(", symbols, re.MULTILINE)
    return " ".join(f"{int(begin, 16):x}-{int(begin, 16) + int(size, 16):x}" for begin, size in destructors)


def some_of(numbers, all_of_them):
    if all_of_them or len(numbers) <= 4:
        return numbers
    return [numbers[i] for i in sorted({0, 1, len(numbers) // 2, len(numbers) - 2, len(numbers) - 1})]


class Walk:
    def __init__(self, name, command, resume, short_writes, failing_allocations):
        self.name, self.command, self.resume = name, command, resume
        self.short_writes, self.failing_allocations = short_writes, failing_allocations
        is_window = name == "window"
        self.kinds = dict(WINDOW_FAULTS if is_window else FAULTS)
        if name == "film":
            self.kinds.pop("lseek")  # ffmpeg's own, whose result it does not check
        self.statuses = (1, 3, 5) if is_window else (1, 3)
        self.faults = self.findings = 0

    def report(self, inject, problem, stderr):
        self.findings += 1
        print(f"{self.name}, {inject}: {problem}")
        for line in [line for line in stderr.splitlines() if "warning:" not in line][-4:]:
            print(f"    {line[:300]}")

    def is_whole(self, path):
        return subprocess.run([self.command[0], "-q", "info", str(path)], capture_output=True).returncode == 0

    def check(self, inject, status, stderr, out, expected):
        # GLib, below the library that sets texts, ends the program where a thread cannot be created. As after a kill,
        # temporary files stay; the run after it, which is checked, removes them.
        if status == 127 and "error while loading shared libraries" in stderr:
            return  # the loader's own, before the program runs
        if status == -signal.SIGTRAP and "creating thread '[pango]" in stderr:
            return
        # So does log4cplus, which OpenVDB loads; where the system's limit of threads is too low, the program says so before.
        if status == -signal.SIGABRT and self.is_of_log4cplus(inject) and "terminate called" in stderr:
            return
        found = files_of(out)
        left = [name for name in found if ".part-" in name]
        if left:
            self.report(inject, f"temporary files are left: {left[:3]}", stderr)
        torn = [
            name
            for name, digest in found.items()
            if name not in left
            and digest != expected.get(name)
            and not (status != 0 and BOOKKEEPING.search(name))
            and not (status != 0 and VOLUMES.search(name) and self.is_whole(out / name))
        ]
        if torn:
            self.report(inject, f"status {status}: not as without the fault: {torn[:5]}", stderr)
        if status == 0:
            missing = [name for name in expected if name not in found]
            if missing:
                self.report(inject, f"status 0, but files are missing: {missing[:5]}", stderr)
        elif status not in self.statuses:
            self.report(inject, f"status {status}", stderr)
        elif "error:" not in stderr and inject.startswith("write:"):
            pass  # the message itself could not be written
        elif len(re.findall(r"^(emscape|[^ :]+): error:", stderr, re.MULTILINE)) != 1:
            self.report(inject, "not one error message", stderr)
        elif re.search(r"std::|basic_|terminate|exception|what\(\)", stderr):
            self.report(inject, "a library's text as the message", stderr)

    def is_of_log4cplus(self, fault):
        return fault.startswith("clone3") and "vdb" in self.name

    def check_fault(self, fault, out, expected, run_with_fault):
        """Runs into the fault, and again without it."""
        try:
            status, stderr = run_with_fault()
        except subprocess.TimeoutExpired:
            if not self.is_of_log4cplus(fault):  # whose threads may also wait for one another
                self.report(fault, "does not end", "")
            return
        self.faults += 1
        self.check(fault, status, stderr, out, expected)
        status, stderr = run(self.command + self.resume, out)
        if status != 0 or files_of(out) != expected:
            unequal = [n for n, d in expected.items() if files_of(out).get(n) != d]
            self.report(fault, f"again: status {status}, unequal: {unequal[:5]}", stderr)

    def walk_allocations(self, out, expected, fresh, count, least_bytes):
        # One thread: the allocations of a run are those of the next.
        command = [*self.command, "--threads", "1"]
        counted = out.parent / "allocations"
        settings = {"preload": self.failing_allocations, "EMSCAPE_FAILING_BYTES": str(least_bytes),
                    "EMSCAPE_SPARED_CODE": spared_code(self.command[0])}
        fresh()
        status, stderr = run(command, out, EMSCAPE_ALLOCATIONS=str(counted), **settings)
        if status != 0 or files_of(out) != expected:
            self.report("allocations counted", f"status {status}", stderr)
            return
        allocations = int(counted.read_text())
        for number in sorted({1 + n * (allocations - 1) // max(count - 1, 1) for n in range(count)}):
            fresh()
            self.check_fault(
                f"allocation {number} of {allocations}", out, expected,
                lambda: run(command, out, EMSCAPE_FAILING_ALLOCATION=str(number), **settings),
            )

    def walk(self, root, scenarios, options):
        out = root / "out"
        log = root / "log"

        def fresh():
            shutil.rmtree(out, ignore_errors=True)
            out.mkdir()

        fresh()
        status, stderr = run(self.command, out, log=log)
        if status != 0:
            sys.exit(f"{self.name}: failed without a fault: {stderr}")
        expected = files_of(out)
        fresh()
        run(self.command, out)
        if files_of(out) != expected:
            unequal = [n for n, d in files_of(out).items() if expected.get(n) != d]
            self.report("no fault", f"two runs differ: {unequal[:5]}", "")
        fresh()
        status, stderr = run(self.command, out, preload=self.short_writes)
        self.faults += 1
        if status != 0 or files_of(out) != expected:
            unequal = [n for n, d in expected.items() if files_of(out).get(n) != d]
            self.report("short writes", f"status {status}, unequal: {unequal[:5]}", stderr)
        for kind, inject in (("no locks", "flock:error=ENOLCK"), ("no attributes", "fsetxattr,fgetxattr:error=EOPNOTSUPP")):
            fresh()
            status, stderr = run(self.command, out, inject)  # each time, as on a file system without them
            self.faults += 1
            if status != 0 or files_of(out) != expected:
                unequal = [n for n, d in expected.items() if files_of(out).get(n) != d]
                self.report(kind, f"status {status}, unequal: {unequal[:5]}", stderr)
        kinds = {call: errors for call, errors in self.kinds.items() if call in options.calls.split(",")}
        for call, numbers in occurrences(log, [str(out), str(scenarios)], kinds).items():
            for number in some_of(numbers, options.all):
                for error in FAULTS[call]:
                    inject = f"{call}:error={error}:when={number}"
                    fresh()
                    self.check_fault(inject, out, expected, lambda: run(self.command, out, inject))
        self.walk_allocations(out, expected, fresh, options.allocations, options.allocation_bytes)
        return self.findings


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("emscape", type=Path)
    parser.add_argument("short_writes", type=Path)
    parser.add_argument("failing_allocations", type=Path)
    parser.add_argument("scenarios", type=Path)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--calls", default=",".join(FAULTS))
    parser.add_argument("--allocations", type=int, default=20)
    parser.add_argument("--allocation-bytes", type=int, default=1024)
    parser.add_argument("commands", nargs="*")
    options = parser.parse_intermixed_args()
    if not shutil.which("strace"):
        print("skipped: strace is missing")
        return SKIPPED
    if subprocess.run(["strace", "-f", "-o", "/dev/null", "true"], capture_output=True).returncode != 0:
        print("skipped: strace cannot trace here")
        return SKIPPED
    table = Commands(options.emscape, options.scenarios).table
    findings = faults = 0
    for name, (command, resume) in table.items():
        if options.commands and name not in options.commands:
            continue
        with tempfile.TemporaryDirectory(prefix="emscape-faults-") as root, contextlib.ExitStack() as stack:
            if name == "window":
                if not shutil.which("Xvfb"):
                    print("window: skipped: Xvfb is missing")
                    continue
                stack.enter_context(virtual_display())
                Path(root, "script.jsonl").write_text(SAVES.format(out=Path(root, "out"), wait=WAIT))
            walk = Walk(name, [str(options.emscape), *command], resume, options.short_writes.resolve(), options.failing_allocations.resolve())
            findings += walk.walk(Path(root), options.scenarios.resolve(), options)
            faults += walk.faults
            print(f"{name}: {walk.faults} faults, {walk.findings} findings", flush=True)
    print(f"{faults} faults, {findings} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
