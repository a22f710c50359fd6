#!/usr/bin/env python3
"""Replaces the sources of a compile_commands.json by one source per module that includes all headers of the module.

    scripts/headers.py FOLDER     the folder of compile_commands.json; the sources are written into FOLDER/headers/
"""

import json
import pathlib
import subprocess
import sys

MODULES = "base document propagation recording scenario interop volume emfield render playback study report apps".split()

folder = pathlib.Path(sys.argv[1]).resolve()
root = pathlib.Path(__file__).resolve().parent.parent
headers = {}
for name in subprocess.check_output(["git", "ls-files", "*.h"], cwd=root, text=True).split():
    path = pathlib.Path(name)
    module = path.parts[2] if path.parts[0] == "include" else path.parts[0]
    # Templates of one instruction set and device code are no headers that stand alone.
    if module in MODULES and "cuda" not in path.parts and "-inl" not in name:
        headers.setdefault(module, []).append(name.removeprefix("include/"))

commands = {}  # of one source per module
for entry in json.loads((folder / "compile_commands.json").read_text()):
    for module in headers:
        if f"CMakeFiles/emscape_{module}.dir" in entry["command"] or (module == "apps" and "emscape_view.dir" in entry["command"]):
            commands[module] = entry

(folder / "headers").mkdir(exist_ok=True)
entries = []
for module, names in sorted(headers.items()):
    source = folder / "headers" / f"{module}.cpp"
    source.write_text("".join(f'#include "{name}"\n' for name in names))
    entry = dict(commands[module])
    entry["command"] = entry["command"].replace(entry["file"], str(source))
    entry["file"] = str(source)
    entries.append(entry)
(folder / "compile_commands.json").write_text(json.dumps(entries))
