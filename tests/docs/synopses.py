#!/usr/bin/env python3
"""Every synopsis of a subcommand in README.md and docs/*.md names the options that the subcommand requires, by its --help."""
import argparse
import os
import re
import subprocess
import sys

SYNOPSIS = re.compile(r"^    emscape (\w+)((?: \w+)?) .*[A-Z]{2,}")
OPTION = re.compile(r"^  ((?:-\w,)?--[\w-]+|-\w(?:,--[\w-]+)?)")


def help_of(emscape, subcommand):
    run = subprocess.run([emscape, subcommand, "--help"], capture_output=True, text=True)
    return run.stdout if run.returncode == 0 else None


def required_options(text):
    """Lists of the names of each required option."""
    blocks = re.split(r"\n(?=  -)", text)
    found = []
    for block in blocks:
        match = OPTION.match(block)
        words = " ".join(block.split())
        if match and ("REQUIRED" in words or "; required" in words):
            found.append(match.group(1).split(","))
    return found


def synopses(root):
    """Place, subcommand and text of each; lines that go on with more indentation belong to it."""
    names = ["README.md"] + ["docs/" + name for name in sorted(os.listdir(root + "/docs")) if name.endswith(".md")]
    for name in names:
        with open(os.path.join(root, name), encoding="utf-8") as file:
            lines = file.read().splitlines()
        for number, line in enumerate(lines):
            match = SYNOPSIS.match(line)
            if not match:
                continue
            text = re.sub(r"   .*", "", line.strip())
            for more in lines[number + 1:]:
                if not more.startswith("          "):
                    break
                text += " " + more.strip()
            yield f"{name}:{number + 1}", match.group(1), text


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", required=True)
    parser.add_argument("--emscape", required=True)
    arguments = parser.parse_args()
    required, faults, count = {}, [], 0
    for place, subcommand, text in synopses(arguments.source):
        if subcommand not in required:
            shown = help_of(arguments.emscape, subcommand)
            required[subcommand] = required_options(shown) if shown is not None else []
        count += 1
        words = re.split(r"[\s\[\]|]+", text)
        for names in required[subcommand]:
            if not any(name in words for name in names):
                faults.append(f"{place}: '{text}' does not name {names[-1]}, which {subcommand} requires")
    for fault in faults:
        print(fault)
    if count < 20:
        faults.append("few synopses")
        print(f"only {count} synopses were found")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
