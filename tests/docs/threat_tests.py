"""Checks that the tests that the threat table of docs/security.md names exist, and that every line names one.

usage: threat_tests.py --source FOLDER
"""

import argparse
import re
import sys
from pathlib import Path

TEST = re.compile(r"`(\w+\.\w+)`")
TARGETS = re.compile(r"fuzz targets? ((?:`[\w*]+`(?:, | and )?)+)")
DECLARED = re.compile(r"\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)")
FUZZED = re.compile(r"\bFUZZ_TARGET\(\s*(\w+)|\{\"(\w+)\",")
WITHOUT_TEST = {"notebook"}  # it is a program, which may do everything


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--source", type=Path, required=True)
    source = parser.parse_args().source
    text = (source / "docs" / "security.md").read_text()
    declared = {".".join(found) for file in (source / "tests").rglob("*_test.cpp") for found in DECLARED.findall(file.read_text())}
    fuzzed = {
        name for file in (source / "tests" / "fuzz").glob("*.cpp") for found in FUZZED.findall(file.read_text()) for name in found if name
    }
    faults = [f"there is no test {name}" for name in TEST.findall(text) if name not in declared and not name.endswith(".md")]
    for list_ in TARGETS.findall(text):
        for name in re.findall(r"`([\w*]+)`", list_):
            pattern = re.compile(name.replace("*", r"\w+"))
            if not any(pattern.fullmatch(target) for target in fuzzed):
                faults.append(f"there is no fuzz target {name}")
    rows = [line for line in text.splitlines() if line.startswith("|")][2:]
    for row in rows:
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        if cells[0] not in WITHOUT_TEST and not TEST.search(cells[3]) and not TARGETS.search(cells[3]):
            faults.append(f"no test holds: {row}")
    if len(rows) < 10:
        faults.append(f"the table has {len(rows)} lines")
    print("\n".join(faults) or f"{len(rows)} lines of threats name tests that exist")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
