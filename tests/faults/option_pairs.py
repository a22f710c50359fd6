"""Runs subcommands of emscape with pairs of options drawn at random from their help texts, with usual and odd values.

After each run:
- the status is one that docs/command-line.md documents (0 to 5), within the time limit;
- a failure has one message, without words of the program's inside;
- a failure leaves no file under the name of an output, and no unfinished file.

usage: option_pairs.py EMSCAPE SCENARIO_FOLDER [--pairs N] [--seed N] [SUBCOMMAND...]
"""

import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# What each subcommand needs; {q}: a scenario, {l}: one with links, {v}: a series of volumes, {t}: elevations, {r}: a recording,
# {w}: a script of the window, {s}: a study, {m}: measured paths, {o}: an output.
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
    "terrain": "terrain {t}",
    "blockage": "blockage {l} --emitter mast --beamwidth 2 --elevation 0 --range 9000 -o {o}/b.nc",
    "import": "import {r} --emitters {r}.emitters.yaml -o {o}/i.yaml",
    "export": "export {q} -o {o}/e.czml",
    "study": "study {s} -o {o}/st --set region.dims=[8,8,4]",
    "check": "check {m} --scenario {q}",
    "view": "view {q} --backend cpu --script {w}",
}
# Global options, those that wait for a network or a person, and those that start other machinery.
LEFT_OUT = {"--help", "--version", "--licences", "--realtime", "--verify", "--quiet", "--duration", "--serve", "--submit"}
VALUES = {
    "FLOAT": ["1", "0", "-1", "1e-300", "1e300", "nan", "inf", "0x10", "1_000", "", "52.5"],
    "INT": ["1", "0", "-1", "3", "2147483648", "1e9", "x", ""],
    "UINT": ["1", "0", "-1", "3", "4294967296", "x"],
    "TEXT": ["", "-", "radar", "mast", "0", "0:1:1", "1:0:1", "agl:100", "msl:9000", "64x48", "32767x32767", "0x0", "-1x5", "nan:1",
             "{o}/out.png", "{o}/out.csv", "{o}/out.json", "{o}", "{q}", "/dev/null", "/dev/full", "{o}/no/such", "local", "EPSG:4326",
             "52,5,1000", "bbox:-180,-60,180,60", "power_density_dbwm2", "png", "a" * 5000, "\u0661", "%d", "$(true)", "--", "terrain:2"],
}
# Drawn half of the time.
USUAL = {
    "--set": ["emitters.radar.power_w=5", "region.dims=[9,8,4]", "emitters.transmitter=null", "output.floor=-100"],
    "--compare": ["original", "{q}"], "--times": ["0", "0:1:1", "1"], "--time": ["0", "1"], "--range": ["-100:0"], "--size": ["64x48"],
    "--quantity": ["power_density_dbwm2", "detection_probability"], "--mesh": ["terrain:2"], "--heights": ["agl:100", "msl:500"],
    "--plot": ["{o}/plot.png", "{o}/plot.svg"], "--csv": ["{o}/a.csv"], "--area": ["52,5,9000", "bbox:4.9,51.9,5.1,52.1"],
    "--crs": ["local", "utm"], "--cell": ["4000"], "--products": ["covered", "value"], "--threshold": ["-90"], "--save-state": ["{o}/a.view.json"],
    "--emitter": ["radar"], "--azimuths": ["0:90:45"], "--range-m": ["9000"], "--to": ["52.05,5.05,100"], "--model": ["free_space"],
}
# Of subcommands with few options of their own, global ones are drawn, too.
GLOBAL = [("--json", ""), ("--threads", "INT"), ("--backend", "TEXT:{auto,cpu}")]
FEW = 6
# Keys of the scenarios, to which the odd values are given by --set.
PATHS = ["region.dims", "region.size_m", "region.origin.latitude_deg", "duration_s", "step_s", "epoch", "name", "terrain",
         "terrain.files", "platforms.mast.position", "platforms.mast.position.height_agl_m", "emitters.radar.scan", "emitters.radar.antenna",
         "emitters.radar.antenna.beamwidth_az_deg", "emitters.radar.propagation", "emitters.radar.frequency_hz", "emitters.radar.receiver",
         "emitters.radar.clutter", "emitters.radar.active_s", "output", "output.quantities", "output.interval", "atmosphere.refractivity",
         "ground", "bands", "targets", "receivers", "emitters", "emitters.none.power_w", "", "a.b.c.d"]
ODD = ["{}", "[]", "null", "1e400", "[1, 2, 3]", "[[0, 1]]", "{kind: raster, bars: 1000}", "{kind: mean, seconds: 1e9}", "{a: &a [*a]}",
       "{file: /dev/zero}", "{kind: soundings, file: {q}}", "{pattern: file, file: {q}}", "parabolic_equation", "[nan]", "'", "\n", "[65535, 65535, 2]"]
OPTION = re.compile(r"^  +(?:-\w,\s*)?(--[a-z0-9-]+)((?: (?:TEXT|FLOAT|INT|UINT))?(?::\{[^}]*\})?)", re.MULTILINE)
INSIDE = re.compile(r"std::|terminate called|what\(\)|\.cpp\b|_ZN|pthread|SQLite|basic_string|vector::|bad_alloc|json\.exception|\bassert", re.I)
TIME_LIMIT_S = 60
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
    text = subprocess.run([emscape, subcommand, "--help"], capture_output=True, text=True, check=True).stdout
    return sorted({(name, kind.strip()) for name, kind in OPTION.findall(text) if name not in LEFT_OUT})


def drawn(option, random_):
    name, kind = option
    if not kind:
        return [name]
    if name == "--set" and random_.random() < 0.5:
        return [name, random_.choice(PATHS) + "=" + random_.choice(ODD + VALUES["TEXT"] + VALUES["FLOAT"])]
    if name in USUAL and random_.random() < 0.5:
        return [name, random_.choice(USUAL[name])]
    choices = re.findall(r"[\w.-]+", kind[kind.find("{"):]) if "{" in kind else []
    return [name, random_.choice(choices + ["x"] if choices else VALUES[kind.split(":")[0]])]


def faults_of(done, folder):
    errors = [line for line in done.stderr.splitlines() if line.startswith(("emscape: error:", "emscape-view: error:"))]
    if done.returncode not in range(6):
        yield f"status {done.returncode}"
    if done.returncode in (1, 2, 3, 4) and len(errors) != 1 and not re.search(r"error:|: \"error\"", done.stdout):
        yield f"{len(errors)} messages of an error"
    if (found := INSIDE.search(done.stderr)) is not None:
        yield f"'{found[0]}' in a message"
    left = [
        str(path.relative_to(folder))
        for path in folder.rglob("*")
        if path.is_file() and not is_unfinished_record(path)
    ]
    if done.returncode in (1, 2, 3, 4) and left and "finished files are kept" not in done.stderr:
        yield f"left {', '.join(left[:3])}"


def ended(command, folder):
    """The process of the command, ended, and whether it was stopped because it took too long."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace", cwd=folder) as process:
        try:
            stdout, stderr = process.communicate(timeout=TIME_LIMIT_S)
            return subprocess.CompletedProcess(command, process.returncode, stdout, stderr), False
        except subprocess.TimeoutExpired:
            process.terminate()
        try:
            stdout, stderr = process.communicate(timeout=STOP_LIMIT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            stdout, stderr = process.communicate()
        return subprocess.CompletedProcess(command, process.returncode, stdout, stderr), True


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("emscape")
    parser.add_argument("scenarios", type=Path)
    parser.add_argument("subcommands", nargs="*")
    parser.add_argument("--pairs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_intermixed_args()
    failed = 0
    with tempfile.TemporaryDirectory() as work:
        work = Path(work)
        scenarios = work / "scenarios"  # a copy: -o may name a scenario, which is then replaced as any file that is named
        shutil.copytree(given.scenarios, scenarios)
        names = {"q": scenarios / "quick.yaml", "l": scenarios / "links.yaml", "v": work / "volumes",
                 "t": scenarios / "data" / "jacksboro.tif", "r": scenarios / "recordings" / "jamming.pcap", "w": work / "script.jsonl",
                 "s": work / "study.yaml", "m": work / "paths.csv", "o": "{o}"}
        names["s"].write_text(STUDY)
        names["m"].write_text(PATHS_MEASURED)
        names["w"].write_text('{"do": "wait_frame"}\n{"do": "quit", "edits": "discard"}\n')
        subprocess.run([given.emscape, "-q", *BASE["simulate"].format(**{**names, "o": work}).split()], check=True)
        (work / "s").rename(work / "volumes")
        for subcommand in given.subcommands or [name for name in BASE if name != "view" or "DISPLAY" in os.environ]:
            random_ = random.Random(f"{given.seed} {subcommand}")
            options = [option for option in options_of(given.emscape, subcommand) if option[0] not in BASE[subcommand].split()]
            if len(options) < FEW:
                options += GLOBAL
            statuses = {}
            for number in range(given.pairs):
                out = work / f"{subcommand}{number}"
                out.mkdir()
                words = BASE[subcommand].split()
                for option in random_.sample(options, 2):
                    words += drawn(option, random_)
                command = [given.emscape, "-q"]
                for word in words:
                    for key, path in names.items():
                        word = word.replace("{" + key + "}", str(out if key == "o" else path))
                    command.append(word)
                done, stopped = ended(command, out)
                statuses[done.returncode] = statuses.get(done.returncode, 0) + 1
                faults = list(faults_of(done, out)) if not stopped else [f"not within {TIME_LIMIT_S} s, then status {done.returncode}"]
                for fault in faults:
                    failed += 1
                    print(f"{fault}: {' '.join(word if len(word) < 200 else word[:20] + '...' for word in command[1:])}", flush=True)
                subprocess.run(["rm", "-rf", str(out)], check=True)
                for name in ("quick.yaml", "links.yaml"):
                    shutil.copyfile(given.scenarios / name, scenarios / name)
            print(f"{subcommand}: {given.pairs} pairs of {len(options)} options; statuses {dict(sorted(statuses.items()))}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
