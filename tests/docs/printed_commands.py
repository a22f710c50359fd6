#!/usr/bin/env python3
"""Runs every command that README.md and docs/*.md print, verbatim and in order, in a fresh clone.

A command is a line of a code block, or a piece of code in the text that names a file, which begins with a program of the
project (PROGRAMS). A line with a placeholder (SCENARIO, -o DIR, ...) is a synopsis and is not run, nor are the commands of
not_run.txt, each with its reason. Windows are run in a display of their own.
"""
import argparse
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
PROGRAMS = re.compile(r"(emscape|emscape-view|scripts/\w+|bench/[\w.]+|docs/\w+\.py|cmake|ctest|pip|env/bin/pip|python3|apt-get|export|cd|cp) ?")
# Words in capitals, and marks of alternatives and repetition.
PLACEHOLDER = re.compile(r"(^|[=|,:/.\[])[A-Z][A-Z_]*($|[\]|,.:=)/])|^[A-Z]\w*$|WxH|\.\.\.|^\[|\|")
TIME_LIMIT_S = 1200
WINDOW_LIMIT_S = 60
SKIPPED = 77


class Command:
    def __init__(self, file, line, text, saved_as=None):
        self.file, self.line, self.text = file, line, text
        self.saved_as = saved_as  # name of a file with this text, instead of a command

    def __str__(self):
        return f"{self.file}:{self.line}: " + (f"save as {self.saved_as}" if self.saved_as else self.text)

    @property
    def is_synopsis(self):
        if self.saved_as:
            return False
        words = shlex.split(self.text.replace("$PWD", "").replace("$PATH", "").replace("PATH=", ""), comments=True)
        return any(PLACEHOLDER.search(word) for word in words)

    @property
    def is_window(self):
        return bool(re.match(r"(\S*/)?emscape view", self.text))


def begins_with_program(text):
    match = PROGRAMS.match(text)
    return bool(match) and (match.end() == len(text) or match.group().endswith(" "))


def names_a_file(text):
    """False for a name of a subcommand or an option, such as `emscape check` or `emscape render --camera`."""
    words = shlex.split(text)[1:]
    return words[0] in ("--help", "--version", "--licences") if len(words) == 1 and text.startswith("emscape") else any(
        re.search(r"\w\.\w|\w/\w|^\.$", word) for word in words)


def commands_of(root, file):
    """Commands in the order of the text; those of captions, which say how a picture was made, last."""
    with open(os.path.join(root, file), encoding="utf-8") as stream:
        lines = stream.read().split("\n")
    commands, captions, prose = [], [], []

    def take_prose():
        text = "\n".join(line for _, line in prose)
        for match in re.finditer(r"`([^`]+)`", text):
            code = match.group(1).replace("\n", " ")
            if begins_with_program(code) and names_a_file(code):
                at = prose[text.count("\n", 0, match.start())]
                (captions if at[1].startswith("*") and text.startswith("![") else commands).append(Command(file, at[0], code))
        prose.clear()

    fence, is_shell, open_line, save_as = False, False, None, None
    for number, line in enumerate(lines, 1):
        saved = re.search(r"[Ss]ave this as `([^`]+)`", line)
        save_as = saved.group(1) if saved else save_as
        mark = re.match(r"\s*```(\w*)", line)
        if mark:
            take_prose()
            fence = not fence
            is_shell = mark.group(1) in ("", "sh", "bash")
            if fence and save_as:
                commands.append(Command(file, number, "", save_as))
            elif save_as:
                save_as = None
            continue
        if fence and save_as:
            commands[-1].text += line + "\n"
            continue
        is_code = is_shell if fence else line.startswith("    ") and (open_line or not prose)
        if not is_code:
            if not line or fence or line.startswith("#"):
                take_prose()
            else:
                prose.append((number, line))
            open_line = None
            continue
        text = line.strip()
        if open_line is not None:
            commands[-1].text += "\n" + text
        elif begins_with_program(text):
            commands.append(Command(file, number, text))
        else:
            continue
        open_line = number if text.endswith("\\") else None
    take_prose()
    return commands + captions


def printed_commands(root):
    docs = sorted(name for name in os.listdir(os.path.join(root, "docs")) if name.endswith(".md"))
    return [command for file in ["README.md"] + ["docs/" + name for name in docs] for command in commands_of(root, file)]


def read_not_run():
    """{command: reason}"""
    reasons, reason = {}, ""
    with open(os.path.join(HERE, "not_run.txt"), encoding="utf-8") as stream:
        for line in stream.read().split("\n"):
            if line.startswith("# ") or not line:
                continue
            if line.startswith("    "):
                reasons[line.strip()] = reason
            else:
                reason = line.rstrip(":")
    return reasons


def plain(text):
    """The command without its comment, on one line."""
    return " ".join(re.sub(r"\s#.*", "", line).rstrip("\\").strip() for line in text.split("\n")).strip()


def make_clone(source, clone):
    """A clone of the repository, with the changes that are not yet committed."""
    subprocess.run(["git", "clone", "--quiet", "--shared", source, clone], check=True)
    changed = subprocess.run(["git", "-C", source, "diff", "--name-only", "-z", "HEAD"], check=True, capture_output=True, text=True)
    for name in filter(None, changed.stdout.split("\0")):
        target = os.path.join(clone, name)
        if not os.path.exists(os.path.join(source, name)):
            os.remove(target)
            continue
        os.makedirs(os.path.dirname(target), exist_ok=True)
        shutil.copy2(os.path.join(source, name), target)


CMAKE = """#!/usr/bin/env python3
# Stands in for cmake: instead of compiling a target, takes the program that is already built.
import os, shutil, sys
arguments = sys.argv[1:]
if "--build" in arguments:
    folder = "build/" + arguments[arguments.index("--preset") + 1] + "/bin"
    os.makedirs(folder, exist_ok=True)
    targets = [word for word in arguments[arguments.index("--target") + 1:] if not word.startswith("-")]
    for target in targets:
        shutil.copy2(os.path.join({programs!r}, target.replace("_", "-")), folder)
    shutil.copytree(os.path.join(os.path.dirname({programs!r}), "lib"), os.path.join(os.path.dirname(folder), "lib"), dirs_exist_ok=True)
"""


class Display:
    """An X server without a screen, while commands need one."""

    def __init__(self):
        read_end, write_end = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write_end), "-noreset", "-screen", "0", "1920x1200x24", "-nolisten", "tcp"],
                                       pass_fds=[write_end], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write_end)
        with os.fdopen(read_end) as stream:
            self.name = ":" + stream.readline().strip()

    def close(self):
        self.server.terminate()
        self.server.wait()


class Runner:
    def __init__(self, source, programs, folder):
        self.clone = os.path.join(folder, "emscape")
        make_clone(source, self.clone)
        tools = os.path.join(folder, "tools")
        os.mkdir(tools)
        cmake = os.path.join(tools, "cmake")
        with open(cmake, "w", encoding="utf-8") as stream:
            stream.write(CMAKE.format(programs=os.path.abspath(programs)))
        os.chmod(cmake, 0o755)
        self.environment = {**os.environ, "PATH": tools + ":" + os.environ["PATH"], "XDG_STATE_HOME": os.path.join(folder, "state"),
                            "LIBGL_ALWAYS_SOFTWARE": "1", "PYTHONDONTWRITEBYTECODE": "1"}
        for name in ("EMSCAPE_CUDA", "DISPLAY", "WAYLAND_DISPLAY"):
            self.environment.pop(name, None)
        self.exports = ""
        self.display = Display() if shutil.which("Xvfb") and shutil.which("xdotool") else None
        if self.display:
            self.environment["DISPLAY"] = self.display.name

    def close(self):
        if self.display:
            self.display.close()

    def run(self, command):
        """Error text; empty if the command did what it is printed for."""
        if command.saved_as:
            with open(os.path.join(self.clone, command.saved_as), "w", encoding="utf-8") as stream:
                stream.write(command.text)
            return ""
        if command.text.startswith("export "):
            self.exports += command.text + "\n"
        with tempfile.TemporaryFile("w+", errors="replace") as output:
            process = subprocess.Popen(["bash", "-c", self.exports + command.text], cwd=self.clone, env=self.environment, stdin=subprocess.DEVNULL,
                                       stdout=output, stderr=output, start_new_session=True)
            failure = self.watch_window(process) if command.is_window else self.watch(process)
            output.seek(0)
            text = output.read()
        if not failure and command.text.startswith("scripts/demo"):
            last_line = text.rstrip().rsplit("\n", 1)[-1].strip()
            is_window = re.search(r"bin/emscape view \S+$", last_line)
            return self.run(Command(command.file, command.line, last_line)) if is_window else "its last line opens no window: " + last_line
        return failure and failure + "\n" + text[-3000:]

    @staticmethod
    def watch(process):
        try:
            status = process.wait(TIME_LIMIT_S)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return f"not done within {TIME_LIMIT_S} s"
        return status and f"exit status {status}"

    def watch_window(self, process):
        """Waits for the window, and closes it as a user does."""
        until = time.monotonic() + WINDOW_LIMIT_S
        search = ["xdotool", "search", "--onlyvisible", "--name", "emscape"]
        window = ""
        while not window and process.poll() is None and time.monotonic() < until:
            time.sleep(0.2)
            window = subprocess.run(search, env=self.environment, capture_output=True, text=True, check=False).stdout.strip()
        if not window:
            if process.poll() is not None:
                return f"no window; exit status {process.returncode}"
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return f"no window within {WINDOW_LIMIT_S} s"
        time.sleep(2)  # a failure to open the input ends the program
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGTERM)
        status = self.watch(process)
        return "" if status == f"exit status {128 + signal.SIGTERM}" else f"the window ended with {status or 'exit status 0'}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", required=True, help="working tree of the repository")
    parser.add_argument("--programs", help="folder of the built programs")
    parser.add_argument("--list", action="store_true", help="only prints the commands")
    parser.add_argument("--only", default="", help="only the commands of this file")
    options = parser.parse_args()
    not_run = read_not_run()
    commands = printed_commands(options.source)
    printed = {plain(command.text) for command in commands}
    failures = [f"not_run.txt: this command is printed no longer: {text}" for text in not_run if text not in printed]
    if options.list:
        for command in commands:
            print("synopsis" if command.is_synopsis else "not run " if plain(command.text) in not_run else "run     ", command)
        return 0
    if subprocess.run(["git", "-C", options.source, "rev-parse", "--git-dir"], capture_output=True, check=False).returncode != 0:
        print("skipped: the source tree is no clone of the repository")
        return SKIPPED
    folder = tempfile.mkdtemp(prefix="emscape-docs-")
    runner = Runner(options.source, options.programs, folder)
    if options.only:  # without scripts/demo, which places them
        shutil.copytree(options.programs, os.path.join(runner.clone, "build/release/bin"))
        shutil.copytree(os.path.join(os.path.dirname(options.programs), "lib"), os.path.join(runner.clone, "build/release/lib"))
    try:
        for command in commands:
            is_wanted = command.text.startswith("export ") or not options.only or options.only == command.file
            if command.is_synopsis or plain(command.text) in not_run or not is_wanted:
                continue
            if command.is_window and not runner.display:
                print(f"skipped: {command}: Xvfb and xdotool are not installed", flush=True)
                continue
            begin, cpu = time.monotonic(), os.times()
            failure = runner.run(command)
            now = os.times()
            cpu_s = now.children_user + now.children_system - cpu.children_user - cpu.children_system
            print(f"{time.monotonic() - begin:6.1f} s {cpu_s:6.1f} s cpu  {'FAILED' if failure else 'done'}  {command}", flush=True)
            if failure:
                print(failure, flush=True)
                failures.append(f"{command}: {failure.splitlines()[0]}")
    finally:
        runner.close()
        shutil.rmtree(folder)
    print(*failures, sep="\n")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
