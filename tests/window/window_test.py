#!/usr/bin/env python3
"""Plays with the real window: `plumb run` on a virtual display, keys and clicks by xdotool.

usage: window_test.py PROGRAM [--keep DIR]

Every step waits for what it brings about, as the window's title tells it ("scene - paused -
step 12 - Plumb"), so a slow machine is only slow. With --keep the pictures are left in DIR.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

PATIENCE = 60.0  # seconds for any one thing to happen
SKIPPED = 77
SCREEN = (1280, 800)


class Failure(Exception):
    pass


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def wait_for(what, condition, process, patience=PATIENCE):
    """The first true value of `condition`."""
    deadline = time.monotonic() + patience
    while True:
        value = condition()
        if value:
            return value
        if process.poll() is not None:
            raise Failure(f"the program ended with {process.returncode}, waiting for {what}")
        if time.monotonic() > deadline:
            raise Failure(f"waited {patience:g} s in vain for {what}")
        time.sleep(0.05)


class Window:
    def __init__(self, process):
        self.process = process
        self.id = wait_for("the window", self._find, process)
        run("xdotool", "windowfocus", "--sync", self.id)

    @staticmethod
    def _find():
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "Plumb"],
                               capture_output=True, text=True).stdout.split()
        return found[0] if found else None

    def title(self):
        return run("xdotool", "getwindowname", self.id).strip()

    def state(self):
        """(scene, running or paused or stopped, step), or None before the scene is there."""
        match = re.fullmatch(r"(.*) - (running|paused|stopped) - step (\d+) - Plumb", self.title())
        return (match[1], match[2], int(match[3])) if match else None

    def wait_state(self, what, condition, patience=PATIENCE):
        def check():
            state = self.state()
            return state if state and condition(*state) else None
        try:
            return wait_for(what, check, self.process, patience)
        except Failure as failure:
            raise Failure(f"{failure}; the title is \"{self.title()}\"") from None

    def key(self, *names):
        run("xdotool", "key", "--clearmodifiers", *names)

    def click(self, x, y):
        run("xdotool", "mousemove", str(x), str(y), "click", "1")


class Picture:
    """The pixels of a PNG file, by way of a PPM."""

    def __init__(self, path):
        data = subprocess.run(["convert", path, "-depth", "8", "ppm:-"], check=True,
                              capture_output=True).stdout
        match = re.match(rb"P6\s+(\d+)\s+(\d+)\s+255\s", data)
        if not match:
            raise Failure(f"{path} is no picture")
        self.size = (int(match[1]), int(match[2]))
        self.pixels = data[match.end():]

    def colours(self):
        return len({self.pixels[i:i + 3] for i in range(0, len(self.pixels), 3)})

    def fraction_unlike(self, other):
        unlike = sum(1 for i in range(0, len(self.pixels), 3)
                     if max(abs(a - b) for a, b in
                            zip(self.pixels[i:i + 3], other.pixels[i:i + 3])) > 8)
        return unlike / (len(self.pixels) / 3)


def check(condition, message):
    if not condition:
        raise Failure(message)


def play(process, folder):
    window = Window(process)

    # It runs by itself, and the pause key stops it.
    scene, _, _ = window.wait_state("a running scene", lambda _, s, n: s == "running" and n >= 3)
    window.key("p")
    _, _, step = window.wait_state("a pause", lambda _, s, n: s == "paused")

    # Steps forward and back, each exactly as many as asked for.
    for keys, change in ((("period",), 1), (("Right",), 1), (("shift+Right",), 5),
                         (("comma",), -1), (("Left",), -1)):
        window.key(*keys)
        step += change
        window.wait_state(f"step {step} after {keys[0]}",
                          lambda _, s, n, step=step: s == "paused" and n == step)

    window.key("r")
    window.wait_state("the start after R", lambda _, s, n: s == "paused" and n == 0)
    window.key("shift+Right")
    window.wait_state("step 5", lambda _, s, n: n == 5)

    # A screenshot: the program's own, and the display's.
    def pictures():
        return sorted(name for name in os.listdir(folder) if name.endswith(".png"))
    window.key("ctrl+p")
    wait_for("a screenshot", pictures, process)
    check(len(pictures()) == 1, f"more than one screenshot: {pictures()}")
    own = Picture(os.path.join(folder, pictures()[0]))
    check(own.size == SCREEN, f"the screenshot is {own.size}")
    check(own.colours() > 1000, f"the screenshot has only {own.colours()} colours")

    def same_as_display():
        path = os.path.join(folder, "display")
        run("import", "-window", "root", "png:" + path)
        display = Picture(path)
        check(display.size == SCREEN, f"the display is {display.size}")
        # Only the display shows, for a while, the note that the picture was written.
        return display.fraction_unlike(own) < 0.01
    wait_for("the display to show what the screenshot shows", same_as_display, process)

    # Click in the scene list, from the top down, until another scene opens.
    def other_scene():
        state = window.state()
        return state is not None and state[0] != scene
    for y in range(80, 330, 11):
        window.click(100, y)
        # Whether this was a row shows a few frames later; another click does no harm.
        try:
            wait_for("another scene", other_scene, process, patience=1.0)
            break
        except Failure:
            if process.poll() is not None:
                raise
    clicked, _, _ = window.wait_state("another scene", lambda c, _, __: c != scene, patience=5)

    # Open a scene by name, once the search box has the keyboard: a few frames. Return is pressed
    # and released long before a slow machine's next frame.
    for pause in (0.5, 2, 8):
        window.key("ctrl+o")
        time.sleep(pause)
        run("xdotool", "type", "--delay", "1", "free_fall")
        run("xdotool", "key", "--delay", "1", "Return")
        try:
            clicked, _, _ = window.wait_state("free fall", lambda c, _, __: c == "free_fall", 5)
            break
        except Failure:
            if pause == 8 or process.poll() is not None:
                raise
            window.key("Escape")

    # Open the next scene by key; Escape and the panels' key do not end the program.
    window.key("bracketright")
    window.wait_state("the next scene", lambda c, _, __: c != clicked)
    window.key("Escape", "Escape", "Tab", "F1", "Escape", "Tab")
    window.key("p")
    window.wait_state("running again", lambda _, s, __: s == "running")

    window.key("ctrl+q")
    try:
        code = process.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        raise Failure("Ctrl+Q does not end the program") from None
    check(code == 0, f"the program ended with {code}")


def main():
    program = os.path.abspath(sys.argv[1])
    for tool in ("Xvfb", "xdotool", "import", "convert"):
        if shutil.which(tool) is None:
            print(f"skipped: there is no {tool}")
            return SKIPPED
    # A display of its own; Xvfb picks a free number and reports it. It must not reset when its last
    # client leaves: a client that connects just then is turned away.
    server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0",
                               f"{SCREEN[0]}x{SCREEN[1]}x24", "-nolisten", "tcp", "-noreset"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    try:
        os.environ["DISPLAY"] = ":" + server.stdout.readline().decode().strip()
        os.environ.pop("WAYLAND_DISPLAY", None)
        return play_on_display(program)
    finally:
        server.terminate()
        server.wait()


def play_on_display(program):
    keep = sys.argv[sys.argv.index("--keep") + 1] if "--keep" in sys.argv else None
    folder = keep or tempfile.mkdtemp(prefix="plumb-window-")
    os.makedirs(folder, exist_ok=True)
    # Keep the pointer off the scene, where it would highlight a body.
    run("xdotool", "mousemove", "640", "760")
    process = subprocess.Popen([program, "run", "--gl", "window", "--out", folder,
                                "--size", f"{SCREEN[0]}x{SCREEN[1]}", "ten_box_stack"])
    try:
        play(process, folder)
    except (Failure, subprocess.CalledProcessError) as failure:
        print(f"FAILED: {failure}")
        if isinstance(failure, subprocess.CalledProcessError):
            print(failure.stderr)
        return 1
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
        if not keep:
            shutil.rmtree(folder, ignore_errors=True)
    print("passed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
