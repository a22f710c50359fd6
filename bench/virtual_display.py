"""A display for programs that draw with OpenGL on machines without one."""

import contextlib
import os
import subprocess


@contextlib.contextmanager
def virtual_display():
    """A private X server without a screen, as $DISPLAY while the context lasts; yields its name.

    It ends with this process at the latest. The server chooses a number that is free, so that any number of them start at
    the same time. Needs xvfb.
    """
    before = os.environ.get("DISPLAY")
    read, write = os.pipe()
    # Without -noreset it starts anew after its last client, and refuses one that comes meanwhile.
    server = subprocess.Popen(
        ["setpriv", "--pdeathsig", "TERM", "Xvfb", "-displayfd", str(write), "-noreset", "-screen", "0", "1920x1200x24",
         "-nolisten", "tcp"],
        pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as answer:
            number = answer.readline().strip()
        if not number:
            raise RuntimeError(f"Xvfb did not start: exit status {server.wait()}")
        os.environ["DISPLAY"] = f":{number}"
        yield os.environ["DISPLAY"]
    finally:
        if before is None:
            os.environ.pop("DISPLAY", None)
        else:
            os.environ["DISPLAY"] = before
        server.terminate()
        server.wait()


@contextlib.contextmanager
def display():
    """The existing display, otherwise a virtual one."""
    if os.environ.get("DISPLAY"):
        yield os.environ["DISPLAY"]
    else:
        with virtual_display() as name:
            yield name
