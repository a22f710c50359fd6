"""Runs subcommands of emscape with pairs of options drawn at random from their help texts, with usual and odd values.

After each run:
- the status is one that docs/command-line.md documents (0 to 5); after the time limit it stops at SIGTERM;
- a failure has one message, without words of the program's inside;
- a failure leaves no file under the name of an output, and no run an unfinished one;
- inputs, files beside them, and files of the user, one of them often under the name of an output, are unchanged.

usage: option_pairs.py EMSCAPE SCENARIO_FOLDER [--pairs N] [--seed N] [SUBCOMMAND...]
"""

import argparse
import os
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

# What each subcommand needs; {q}: a scenario, {l}: one with links, {v}: a series of volumes, {t}: elevations, {r}: a recording,
# {w}: a script of the window, {s}: a study, {m}: measured paths, {p}: a free port, {o}: a folder of outputs.
BASE = {
    "simulate": "simulate {q} -o {o}/s --set region.dims=[8,8,4] --set duration_s=1",
    "render": "render {q} -o {o}/a.png --size 64x48 --times 0 --set region.dims=[8,8,4]",
    "coverage": "coverage {q} -o {o}/maps --cell 4000 --times 0 --format cog",
    "compare": "compare {q} -o {o}/maps --set-b emitters.radar.power_w=1 --cell 4000 --times 0 --format cog",
    "profile": "profile {q} --emitter radar --to 52.05,5.05,100",
    "link": "link {l} --times 0:2:1",
    "vertical": "vertical {q} --emitter radar --azimuth 30 -o {o}/v.png",
    "exposure": "exposure {l} --platform drone --times 0:4:1 -o {o}/e.png",
    "info": "info {v}",
    "validate": "validate {q}",
    "terrain": "terrain {l}",
    "blockage": "blockage {l} --emitter mast --beamwidth 2 --elevation 0 --range 9000 -o {o}/b.nc",
    "import": "import {r} --emitters {r}.emitters.yaml -o {o}/i.yaml",
    "export": "export {q} -o {o}/e.czml",
    "study": "study {s} -o {o}/st --set region.dims=[8,8,4]",
    "check": "check {m} --scenario {q}",
    "live": "live --base {q} --dis {p} --duration 0.2 -o {o}/live --record {o}/r.pcap",
    "play": "play {r} --dis-out {p} --rate 1000000",
    "bench field": "bench field {q} --repeats 1 --set region.dims=[8,8,4]",
    "bench cells": "bench cells {q} --mesh terrain:2 --size 64x48 --frames 0 --set region.dims=[8,8,4]",
    "bench coverage": "bench coverage {q} --cell 4000 --repeats 1",
    "bench render": "bench render {q} --size 64x48 --frames 1 --set region.dims=[8,8,4]",
    "bench reconstruction": "bench reconstruction {q} --size 64x48 --frames 1 --set region.dims=[8,8,4]",
    "bench models": "bench models --repeats 1",
    "bench march": "bench march --cases sea-auto --azimuths 1 --repeats 1",
    "view": "view {q} --backend cpu --script {w}",
}
# Global options, those that wait for a network or a person, and those that start other machinery.
LEFT_OUT = {"--help", "--version", "--licences", "--realtime", "--verify", "--quiet", "--duration", "--serve", "--submit", "--acmi-server"}
# A file of the user in the folder of outputs, and its content.
MINE, MINE_TEXT = "{o}/mine.png", "of the user\n"
# Options with which the file of the user is replaced.
REPLACING = {"blockage", "export", "import", "live"}
VALUES = {
    "FLOAT": ["1", "0", "-1", "1e-300", "1e300", "nan", "inf", "0x10", "1_000", "", "52.5"],
    "INT": ["1", "0", "-1", "3", "2147483648", "1e9", "x", ""],
    "BOOLEAN": ["on", "off", "1", "x", ""],
    "UINT": ["1", "0", "-1", "3", "4294967296", "x"],
    "TEXT": ["", "-", "radar", "mast", "0", "0:1:1", "1:0:1", "agl:100", "msl:9000", "64x48", "32767x32767", "0x0", "-1x5", "nan:1",
             MINE, "{o}/out.png", "{o}/out.csv", "{o}/out.json", "{o}", "{q}", "/dev/null", "/dev/full", "{o}/no/such", "local", "EPSG:4326",
             "52,5,1000", "bbox:-180,-60,180,60", "power_density_dbwm2", "png", "a" * 5000, "\u0661", "%d", "$(true)", "--", "terrain:2"],
}
# Drawn most of the time.
USUAL = {
    "FLOAT": ["1", "0.5", "2"], "INT": ["1", "3"], "UINT": ["1", "3"], "BOOLEAN": ["on", "off"],
    "--camera": ["orbit:azimuth_deg=30", "lookat:eye_x_m=1,target_x_m=5"], "--plane": ["horizontal:altitude_m=500", "vertical:bearing_deg=20"],
    "--range-rings": ["radar:spacing_m=2000"], "--map-layer": ["100", "off"], "--scenario": ["{q}"], "--base": ["{q}"], "--drape": ["land-cover"],
    "--interface": ["127.0.0.1"], "--coverage": ["agl:100"], "--follow": ["mast"], "--volume": ["{o}/d.vdb", "{o}/d.vti"], "--areps": ["{o}/areps"],
    "--set-b": ["emitters.radar.power_w=5"], "--part": ["1/2", "any"], "--slurm": ["{o}/job.sh"], "--columns": ["frequency_mhz=100"],
    "--where": ["loss_db>=115"], "--region": ["52,5,30"], "--terrain": ["{t}"], "--only": ["*"], "--picture": ["{o}/p.png"], "--models": ["horizon,itm"],
    "--emitters": ["radar", "on"], "--record": ["{o}/rec.pcap"], "--target": ["drone"], "--receiver": ["handset"], "--look": ["fog", "scan"],
    "--set": ["emitters.radar.power_w=5", "region.dims=[9,8,4]", "emitters.transmitter=null", "output.floor=-100"],
    "--compare": ["original", "{q}"], "--times": ["0", "0:1:1", "1"], "--time": ["0", "1"], "--range": ["-100:0"], "--size": ["64x48"],
    "--quantity": ["power_density_dbwm2", "detection_probability"], "--mesh": ["terrain:2"], "--heights": ["agl:100", "msl:500"],
    "--plot": ["{o}/plot.png", "{o}/plot.svg"], "--csv": ["{o}/a.csv"], "--area": ["52,5,9000", "bbox:4.9,51.9,5.1,52.1"],
    "--crs": ["local", "utm"], "--cell": ["4000"], "--products": ["covered", "value"], "--threshold": ["-90"], "--save-state": ["{o}/a.view.json"],
    "--emitter": ["radar"], "--azimuths": ["0:90:45"], "--range-m": ["9000"], "--to": ["52.05,5.05,100"], "--model": ["free_space"],
}
GLOBAL = [("--json", ""), ("--threads", "INT"), ("--backend", "TEXT:{auto,cpu}"), ("--devices", "TEXT")]
# Keys of the scenarios, to which the odd values are given by --set.
PATHS = ["region.dims", "region.size_m", "region.origin.latitude_deg", "duration_s", "step_s", "epoch", "name", "terrain",
         "terrain.files", "platforms.mast.position", "platforms.mast.position.height_agl_m", "emitters.radar.scan", "emitters.radar.antenna",
         "emitters.radar.antenna.beamwidth_az_deg", "emitters.radar.propagation", "emitters.radar.frequency_hz", "emitters.radar.receiver",
         "emitters.radar.clutter", "emitters.radar.active_s", "output", "output.quantities", "output.interval", "atmosphere.refractivity",
         "ground", "bands", "targets", "receivers", "emitters", "emitters.none.power_w", "", "a.b.c.d"]
ODD = ["{}", "[]", "null", "1e400", "[1, 2, 3]", "[[0, 1]]", "{kind: raster, bars: 1000}", "{kind: mean, seconds: 1e9}", "{a: &a [*a]}",
       "{file: /dev/zero}", "{kind: soundings, file: {q}}", "{pattern: file, file: {q}}", "parabolic_equation", "[nan]", "'", "\n", "[65535, 65535, 2]"]
OPTION = re.compile(r"^  +(?:-\w,\s*)?(--[a-z0-9-]+)((?: (?:TEXT|FLOAT|INT|UINT|BOOLEAN))?(?::\{[^}]*\})?)", re.MULTILINE)
INSIDE = re.compile(
    r"(std|emscape|YAML|nlohmann|CLI|tbb|openvdb|vector)::|terminate called|what\(\)|\.(cpp|cc|h):\d|\.cpp\b|_ZN|pthread|SQLite|basic_string|"
    r"bad_alloc|json\.exception|\bassert|\bGDAL|\bPROJ\b|\bproj_|\bOGR|\bH5[A-Z]|\bNC_|\berrno\b|0x[0-9a-f]{6}", re.I)
TIME_LIMIT_S = 20
STOP_LIMIT_S = 5
STUDY = """schema_version: 1
name: pairs
scenario: scenarios/quick.yaml
times: 0
cell_m: 4000
sweep: {emitters.radar.power_w: {values: [1, 10, 100]}}
measures: [{name: covered, product: covered, height: "agl:300"}]
"""
PATHS_MEASURED = """transmitter_latitude_deg,transmitter_longitude_deg,transmitter_height_agl_m,receiver_latitude_deg,receiver_longitude_deg,receiver_height_agl_m,frequency_mhz,loss_db
52,5,20,52.05,5.06,10,100,110
52,5,20,52.1,5.06,10,100,120
"""


def is_unfinished_record(path):
    """True for the record by which a series or a study is continued with --resume."""
    if path.name == "manifest.json":
        return True
    return path.name == "series.json" and '"complete": false' in path.read_text()


def options_of(emscape, subcommand):
    text = subprocess.run([emscape, *subcommand.split(), "--help"], capture_output=True, text=True, check=True).stdout
    return sorted({(name, kind.strip()) for name, kind in OPTION.findall(text) if name not in LEFT_OUT})


def drawn(option, random_):
    name, kind = option
    if not kind:
        return [name]
    if name == "--set" and random_.random() < 0.5:
        return [name, random_.choice(PATHS) + "=" + random_.choice(ODD + VALUES["TEXT"] + VALUES["FLOAT"])]
    type_name = kind.split(":")[0]
    choices = re.findall(r"[\w.-]+", kind[kind.find("{"):]) if "{" in kind else USUAL.get(name) or USUAL.get(type_name)
    return [name, random_.choice(choices if choices and random_.random() < 0.7 else VALUES[type_name])]


def faults_of(done, folder, mine, may_replace):
    errors = [line for line in done.stderr.splitlines() if line.startswith(("emscape: error:", "emscape-view: error:"))]
    if done.returncode not in [*range(6), 128 + signal.SIGTERM]:
        yield f"status {done.returncode}"
    if done.returncode in (1, 2, 3, 4) and len(errors) != 1 and not re.search(r"error:|: \"error\"", done.stdout):
        yield f"{len(errors)} messages of an error"
    if (found := INSIDE.search(done.stderr)) is not None:
        yield f"'{found[0]}' in a message"
    for path in mine:
        if not may_replace and (path.is_symlink() or not path.is_file() or path.read_text(errors="replace") != MINE_TEXT):
            yield f"a file of the user is changed: {path.name}"
    left = [path for path in folder.rglob("*") if path not in mine and (path.is_file() or ".part-" in path.name)]
    failed = done.returncode not in (0, 5) and "finished files are kept" not in done.stderr
    names = [str(path.relative_to(folder)) for path in left if ".part-" in path.name or (failed and not is_unfinished_record(path))]
    if names:
        yield f"left {', '.join(names[:3])}"


def inputs_of(work):
    """What would tell that a file among the inputs is changed, new or gone."""
    return {path: (path.stat().st_mtime_ns, path.stat().st_size, path.stat().st_ino) for path in work.rglob("*") if path.is_file()}


def ended(command, folder):
    """The process of the command, ended; stopped if it takes too long."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace", cwd=folder) as process:
        try:
            stdout, stderr = process.communicate(timeout=TIME_LIMIT_S)
            return subprocess.CompletedProcess(command, process.returncode, stdout, stderr)
        except subprocess.TimeoutExpired:
            process.terminate()
        try:
            stdout, stderr = process.communicate(timeout=STOP_LIMIT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            stdout, stderr = process.communicate()
        return subprocess.CompletedProcess(command, process.returncode, stdout, stderr)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("emscape")
    parser.add_argument("scenarios", type=Path)
    parser.add_argument("subcommands", nargs="*")
    parser.add_argument("--pairs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_intermixed_args()
    given.emscape = os.path.abspath(given.emscape)
    failed = 0
    with tempfile.TemporaryDirectory() as root:
        root = Path(root)
        work = root / "inputs"
        scenarios = work / "scenarios"
        shutil.copytree(given.scenarios, scenarios)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as unused:
            unused.bind(("127.0.0.1", 0))
            port = unused.getsockname()[1]
        names = {"q": scenarios / "quick.yaml", "l": scenarios / "links.yaml", "v": work / "volumes",
                 "t": scenarios / "data" / "jacksboro.tif", "r": scenarios / "recordings" / "jamming.pcap", "w": work / "script.jsonl",
                 "s": work / "study.yaml", "m": work / "paths.csv", "p": port}
        names["s"].write_text(STUDY)
        names["m"].write_text(PATHS_MEASURED)
        names["w"].write_text('{"do": "wait_frame"}\n{"do": "quit", "edits": "discard"}\n')

        def command_of(words, out):
            for key, value in {**names, "o": out}.items():
                words = [word.replace("{" + key + "}", str(value)) for word in words]
            return [given.emscape, "-q", *words]

        subprocess.run(command_of(BASE["simulate"].split(), work), check=True)
        (work / "s").rename(work / "volumes")
        inputs = inputs_of(work)
        has_bench = Path(given.emscape).with_name("emscape-bench").exists()
        drawn_from = [name for name in BASE if (name != "view" or "DISPLAY" in os.environ) and (has_bench or not name.startswith("bench"))]
        for subcommand in given.subcommands or drawn_from:
            random_ = random.Random(f"{given.seed} {subcommand}")
            options = [option for option in options_of(given.emscape, subcommand) + GLOBAL if option[0] not in BASE[subcommand].split()]
            out = root / "out"
            out.mkdir()
            done = ended(command_of(BASE[subcommand].split(), out), out)
            if done.returncode != 0:
                sys.exit(f"{subcommand} fails without further options: {done.stderr}")
            outputs = sorted(path.relative_to(out) for path in out.rglob("*") if path.is_file())
            statuses = {}
            for number in range(given.pairs):
                shutil.rmtree(out)
                mine = [Path(MINE.format(o=out))]
                if outputs and random_.random() < 0.25:
                    mine.append(out / random_.choice(outputs))
                for path in mine:
                    path.parent.mkdir(parents=True, exist_ok=True)
                    path.write_text(MINE_TEXT)
                words = BASE[subcommand].split()
                pair = random_.sample(options, 2) if random_.random() < 0.9 else 2 * [random_.choice(options)]
                for option in pair:
                    words += drawn(option, random_)
                done = ended(command_of(words, out), out)
                statuses[done.returncode] = statuses.get(done.returncode, 0) + 1
                may_replace = subcommand in REPLACING and "--force" in words
                faults = list(faults_of(done, out, mine, may_replace))
                before, inputs = inputs, inputs_of(work)
                if inputs != before:
                    faults.append(f"inputs are changed: {[path.name for path, _ in set(inputs.items()) ^ set(before.items())]}")
                for fault in faults:
                    failed += 1
                    in_way = "".join(f" (in the way: {path.relative_to(out)})" for path in mine[1:])
                    print(f"{fault}: {' '.join(word if len(word) < 200 else word[:20] + '...' for word in words)}{in_way}")
                    print("   ", *[line[:300] for line in done.stderr.splitlines() if "warning:" not in line][-2:], sep="\n    ", flush=True)
            shutil.rmtree(out)
            print(f"{subcommand}: {given.pairs} pairs of {len(options)} options; statuses {dict(sorted(statuses.items()))}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
