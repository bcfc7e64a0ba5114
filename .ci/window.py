#!/usr/bin/env python3
"""Drafts in the built window by mouse and keys, on a display that nobody sees (Xvfb): two panels by
typed numbers, a seam, a dart, a fold, a drag that is undone; saves, and holds the saved file against
numbers that were reckoned beforehand. The last picture of the screen is kept in out/ci/window.png.

With a RECORD of inputs the T-shirt is then drafted from an empty window as the test of that name did it,
input by input, and the saved file must be the same to the byte. It is replayed a second time, slower, before
it is a fault.

usage: window.py TOILE_UI TOILE [RECORD]

RECORD is what the test `t_shirt` wrote (target/tmp/t_shirt.way); beside it lies the file it saved.

It waits for what is to be seen, a title or a file. How long the window takes to show what an input
did is measured first: where an input may show nothing twice as long is waited.
"""

import contextlib
import difflib
import json
import math
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time
import zlib

SCREEN = (1400, 900)
# Longest wait for anything [s]: software drawing on a slow machine.
PATIENCE = 60.0
# Between two looks at anything [s].
INTERVAL = 0.04
# What an answer to an input is given at least [s], and how many times the slowest so far is waited for
# one that may not come.
MIN_ANSWER = 0.2
ANSWERS = 2.0
# Pace of a replay: how long the picture is at rest before the next input, over the slowest answer. Inputs are
# replayed at the first pace, and at the slower one if that was too fast for the machine.
PACES = (0.4, 1.0)
# Fill of a panel by day (ui/src/theme.rs), blue first as it lies in memory.
CLOTH = b"\xfa\xfd\xfe"
# How far a number may be from its closed form [mm], [cm2].
WITHIN = 1e-6
# Shortest run of it across that is taken for a panel [pixels].
MIN_RUN = 40
# Lines told of where two files differ.
MAX_DIFFERS = 30
PICTURE = pathlib.Path(__file__).resolve().parent.parent / "out/ci/window.png"


class Fault(Exception):
    """Something that is not as it should be."""


def wait(words, ask):
    """What `ask` gives once it gives something."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        found = ask()
        if found:
            return found
        time.sleep(INTERVAL)
    raise Fault(f"{words}: not within {PATIENCE:.0f} s")


def end(process):
    """Ends a process, by force where it takes long."""
    process.terminate()
    try:
        process.wait(5)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


class Screen:
    """A display in memory that is read as a file (X11's XWD format)."""

    def __init__(self, folder):
        self.file = folder / "Xvfb_screen0"
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-nolisten", "tcp", "-noreset", "-nocursor", "-r", "-fbdir", str(folder),
             "-screen", "0", f"{SCREEN[0]}x{SCREEN[1]}x24"],
            pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        # It ends with the pipe if it cannot start.
        with os.fdopen(read) as told:
            number = told.readline().strip()
        if not number:
            raise Fault("no display: Xvfb did not start")
        self.name = f":{number}"

    def close(self):
        end(self.server)

    def picture(self):
        return self.file.read_bytes()

    def pixels(self):
        """Rows of blue, green, red and a byte of nothing."""
        data = self.picture()
        head = struct.unpack(">25I", data[:100])
        start, width, height, bits, row = head[0] + 12 * head[19], head[4], head[5], head[11], head[12]
        if bits != 32:
            raise Fault(f"the display has {bits} bits a pixel")
        return [data[start + y * row:start + y * row + 4 * width] for y in range(height)]

    def rest(self, seconds):
        """Waits until nothing new was seen for so long: a cursor that blinks shows nothing new."""
        seen, since = set(), time.monotonic()

        def ask():
            nonlocal since
            now = zlib.crc32(self.picture())
            if now not in seen:
                seen.add(now)
                since = time.monotonic()
            return time.monotonic() - since >= seconds

        wait("the picture comes to rest", ask)

    def keep(self, to):
        """Writes the picture as PNG."""
        rows = self.pixels()
        raw = b"".join(
            b"\0" + bytes(byte for x in range(0, len(row), 4) for byte in (row[x + 2], row[x + 1], row[x]))
            for row in rows)

        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        head = struct.pack(">IIBBBBB", len(rows[0]) // 4, len(rows), 8, 2, 0, 0, 0)
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head)
                       + chunk(b"IDAT", zlib.compress(raw, 6)) + chunk(b"IEND", b""))


class Window:
    """The window, by mouse and keys."""

    def __init__(self, screen, program, home):
        self.screen = screen
        self.environment = {
            **os.environ, "DISPLAY": screen.name, "HOME": str(home), "XDG_RUNTIME_DIR": str(home),
            "XDG_STATE_HOME": str(home / "state"), "WGPU_BACKEND": "vulkan"}
        self.environment.pop("WAYLAND_DISPLAY", None)
        self.log = open(home / "window.log", "w+", encoding="utf-8")
        self.process = subprocess.Popen([str(program)], env=self.environment, cwd=home,
                                        stdout=self.log, stderr=self.log)
        self.id = wait("a window opens", lambda: self.search("Toile"))
        self.xdotool("windowmove", self.id, 0, 0)
        self.xdotool("windowsize", self.id, *SCREEN)
        self.xdotool("windowfocus", self.id)
        self.xdotool("mousemove", SCREEN[0] // 2, SCREEN[1] // 2)
        # How long an answer may take is seen by one that is sure to come: the list of findings.
        self.screen.rest(1.0)
        self.slowest, self.pace = MIN_ANSWER, 1.0
        for _ in range(4):
            self.act("key", "F9", must="the list of findings is shown and hidden")

    def close(self):
        end(self.process)

    def xdotool(self, *words):
        try:
            done = subprocess.run(["xdotool", *(str(word) for word in words)], env=self.environment,
                                  capture_output=True, text=True, timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            raise Fault(f"xdotool {words}: not within {PATIENCE:.0f} s") from None
        return done.stdout.strip() if done.returncode == 0 else ""

    def lives(self):
        """Complains once the window has ended."""
        if self.process.poll() is not None:
            self.log.seek(0)
            raise Fault(f"the window has ended: {self.log.read().strip()}")

    def search(self, title):
        self.lives()
        return self.xdotool("search", "--onlyvisible", "--name", title).split("\n")[0]

    def titled(self, pattern):
        """Waits for a title."""
        def ask():
            self.search("Toile")
            return re.fullmatch(pattern, self.xdotool("getwindowname", self.id))
        wait(f"the title {pattern!r}", ask)

    def act(self, *words, must=None):
        """An input, and what it shows: something if it must, which is then waited for."""
        before, begun = self.screen.picture(), time.monotonic()
        self.xdotool(*words)
        patience = PATIENCE if must else ANSWERS * self.pace * self.slowest

        def ask():
            self.lives()
            return self.screen.picture() != before or time.monotonic() - begun > patience

        wait(must or "an answer", ask)
        if must:
            self.slowest = max(self.slowest, time.monotonic() - begun)
        self.screen.rest(self.pace * self.slowest)

    def key(self, *keys):
        for key in keys:
            self.act("key", key)

    def leave(self):
        """Puts the tool down and selects nothing."""
        self.key("Escape", "Escape")

    def type(self, text):
        self.act("type", "--delay", 20, "--", text)

    def hover(self, at):
        self.act("mousemove", *(round(k) for k in at))

    def click(self, at):
        self.act("mousemove", *(round(k) for k in at), "sleep", 0.03, "click", 1)

    def drag(self, from_, to):
        self.hover(from_)
        self.act("mousedown", 1)
        for share in (0.3, 0.6, 1.0):
            self.hover([a + share * (b - a) for a, b in zip(from_, to)])
        self.act("mouseup", 1)

    def panels(self, count):
        """Where so many panels are seen, from the left: left, top, right, bottom."""
        self.hover((SCREEN[0] // 2, SCREEN[1] - 40))

        def ask():
            boxes = []
            runs = re.compile(b"(?s)(?:" + re.escape(CLOTH) + b".){%d,}" % MIN_RUN)
            for y, row in enumerate(self.screen.pixels()):
                for run in runs.finditer(row):
                    if run.start() % 4:
                        continue
                    left, right = run.start() // 4, run.end() // 4
                    met = [box for box in boxes if left < box[2] and box[0] < right]
                    for box in met:
                        boxes.remove(box)
                    met.append([left, y, right, y])
                    boxes.append([min(box[0] for box in met), min(box[1] for box in met),
                                  max(box[2] for box in met), max(box[3] for box in met)])
            boxes = sorted(box for box in boxes if box[3] - box[1] > MIN_RUN)
            return boxes if len(boxes) == count else None

        return wait(f"{count} panels are seen", ask)

    def rectangle(self, corner, size):
        """A panel of typed numbers [cm]."""
        self.key("r")
        for pair in (corner, size):
            self.type(str(pair[0]))
            self.key("Tab")
            self.type(str(pair[1]))
            self.key("Return")


def middle(box, side):
    left, top, right, bottom = box
    return {"left": (left - 1, (top + bottom) / 2), "right": (right, (top + bottom) / 2),
            "top": ((left + right) / 2, top - 1), "bottom": ((left + right) / 2, bottom)}[side]


def saved(window, file, words, holds):
    """Saves, and waits until the file holds something."""
    def ask():
        # A file as it was saved before may lack what is waited for.
        with contextlib.suppress(OSError, ValueError, KeyError):
            return holds(json.loads(file.read_text(encoding="utf-8")))
        return False
    window.key("ctrl+s")
    wait(words, ask)


def draft(window, file):
    # An empty document.
    window.titled("Toile")
    window.key("F7", "ctrl+n", "ctrl+a")
    window.type("Skirt")
    window.key("Return")
    window.titled("Skirt \N{EN DASH} Toile")
    # Two panels of 20 x 60 cm, side by side.
    window.rectangle((0, 0), (20, 60))
    window.titled("Skirt \N{BULLET} \N{EN DASH} Toile")
    window.rectangle((40, 0), (20, 60))
    window.leave()
    window.key("f")
    left, right = window.panels(2)
    # A file.
    window.key("ctrl+shift+s", "ctrl+a")
    window.type(str(file))
    window.key("Return")
    window.titled("Skirt \N{EN DASH} Toile")
    saved(window, file, "two panels are saved", lambda saved: len(saved["panels"]) == 2)
    # The side seam.
    window.key("s")
    window.click(middle(left, "right"))
    window.click(middle(right, "left"))
    window.leave()
    saved(window, file, "a seam is saved", lambda saved: len(saved["seams"]) == 1)
    # A dart of 2.5 x 11 cm in the left one's waist.
    window.key("d")
    window.click(middle(left, "top"))
    for number in ("2.5", "11"):
        window.type(number)
        window.key("Return")
    window.leave()
    saved(window, file, "a dart is saved", lambda saved: '"dart"' in json.dumps(saved))
    # The right one's centre on the fold.
    window.key("shift+f")
    window.click(middle(right, "right"))
    window.leave()
    saved(window, file, "a fold is saved", lambda saved: '"fold"' in json.dumps(saved))
    window.titled("Skirt \N{EN DASH} Toile")
    # A corner is dragged, and that is undone.
    window.drag((left[0] - 1, left[3]), (left[0] - 60, left[3] + 25))
    window.titled("Skirt \N{BULLET} \N{EN DASH} Toile")
    window.key("ctrl+z")
    window.titled("Skirt \N{EN DASH} Toile")


def trued(half, stretch):
    """Length of a straight edge with a trued dart in its middle, half of whose angle is given, and what truing adds
    to the panel [mm], [mm2]. Beside the mouth lie two stretches of equal length l; one keeps its direction at its far
    end, the other is free there.

    Of least bending with the kink t, the dart's angle, between them: the mouth is raised by h = 5/16 t l square to the
    edge; the stretches come to it at the slopes 9/16 t and 7/16 t, and the free one begins at the slope t/4. Each is
    drawn as the cubic whose handles are a third of its chord, turned by these slopes; its end is moved along the leg,
    h aside being h tan(t/2) along.
    """
    turn = 2.0 * half
    raised = 5.0 / 16.0 * turn * stretch
    x, y = stretch - raised * math.tan(half), raised
    length = area = 0.0
    for begins, comes in ((0.0, 9.0 / 16.0 * turn), (turn / 4.0, 7.0 / 16.0 * turn)):
        third = math.hypot(x, y) / 3.0
        points = [(0.0, 0.0), (third * math.cos(begins), third * math.sin(begins)),
                  (x - third * math.cos(comes), y - third * math.sin(comes)), (x, y)]

        def at(t):
            """Place of the cubic, and its derivative."""
            weights = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t ** 3)
            place = [sum(w * p[k] for w, p in zip(weights, points)) for k in (0, 1)]
            steps = [[b[k] - a[k] for k in (0, 1)] for a, b in zip(points, points[1:])]
            ways = ((1 - t) ** 2, 2 * t * (1 - t), t * t)
            return place, [3 * sum(w * step[k] for w, step in zip(ways, steps)) for k in (0, 1)]

        # Simpson's rule: exact for the area, a polynomial of the fifth degree, to rounding with this many parts.
        parts = 2000
        for k in range(parts + 1):
            weight = (1 if k in (0, parts) else 4 if k % 2 else 2) / (3.0 * parts)
            place, way = at(k / parts)
            length += weight * math.hypot(*way)
            area += weight * place[1] * way[0]
        # From the end of the leg down to where the mouth was.
        area += 0.5 * y * (stretch - x)
    return length, area


def check(toile, file):
    """Holds what the command line tells of the file against numbers of the drawing [mm], [cm2]."""
    done = subprocess.run([str(toile), "--json", "check", str(file)], capture_output=True, text=True)
    if done.returncode != 0:
        raise Fault(f"toile check: {done.stdout}{done.stderr}")
    told = json.loads(done.stdout)
    left, right = told["pieces"]
    tops = sum(edge["length_mm"] for edge in left["edges"] if edge["name"] == "top")
    seams = {seam["name"].split()[0]: seam["lengths_mm"] for seam in told["seams"]}
    # The dart is trued: the waist keeps its direction at the seam and is free at the other side, both 87.5 mm
    # from the mouth. Of least bending, it is raised there by 5/16 of the dart's angle times that, along the legs.
    half = math.atan2(12.5, 110.0)
    leg = math.hypot(110.0, 12.5) + 5.0 / 16.0 * 2.0 * half * 87.5 / math.cos(half)
    waist, raised = trued(half, 87.5)
    numbers = {
        "findings": (len(told["diagnostics"]), 0),
        "pieces on the fold": ([left["folded"], right["folded"]].count(True), 1),
        "area sewn of the left": (left["sewn"]["area_cm2"], (200.0 * 600.0 - 25.0 * 110.0 / 2.0 + raised) / 100.0),
        "waist of the left": (tops, waist),
        "width of the dart": (left["darts"][0]["width_mm"], 2.0 * leg * math.sin(half)),
        "first leg of the dart": (left["darts"][0]["legs_mm"][0], leg),
        "second leg of the dart": (left["darts"][0]["legs_mm"][1], leg),
        "area cut of the right, 1 cm wider all round": (right["cut"]["area_cm2"], 42.0 * 62.0),
        "outline cut of the right": (right["cut"]["outline_mm"], 2.0 * (420.0 + 620.0)),
        "seams": (len(seams), 2),
        "side seam, left": (seams["draft"][0], 600.0),
        "side seam, right": (seams["draft"][1], 600.0),
    }
    wrong = [f"{name} is {number}, not {right}"
             for name, (number, right) in numbers.items() if abs(number - right) > WITHIN]
    if wrong:
        raise Fault("; ".join(wrong))
    return len(numbers)


def replay(window, record, folder, pace):
    """Gives a window the inputs of a record, one after another at a pace; says how many."""
    window.pace = pace
    lines = [line.replace("{folder}", str(folder)) for line in record.read_text(encoding="utf-8").splitlines()]
    begun = time.monotonic()
    for k, line in enumerate(lines):
        if k % 100 == 0:
            print(f"input {k} of {len(lines)}, {time.monotonic() - begun:.0f} s", flush=True)
        kind, rest = line.split(" ", 1)
        if kind == "click":
            window.click([float(word) for word in rest.split()])
        elif kind == "hover":
            window.hover([float(word) for word in rest.split()])
        elif kind == "wheel":
            window.hover([float(word) for word in rest.split()])
            window.act("click", 5)
        elif kind == "key":
            window.key(rest)
        elif kind == "text":
            window.type(rest)
        else:
            raise Fault(f"{record} has an input of no kind that is known: {line!r}")
    return len(lines)


def on_display(program, work):
    """Opens a window on a display of its own; what `work` gives of it and its folder."""
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        folder = pathlib.Path(folder)
        screen = Screen(folder)
        stack.callback(screen.close)
        try:
            window = Window(screen, program, folder)
            stack.callback(window.close)
            return work(window, folder)
        finally:
            with contextlib.suppress(OSError, struct.error):
                screen.keep(PICTURE)


def skirt(toile):
    def drafted(window, folder):
        file = folder / "skirt.toile.json"
        draft(window, file)
        return f"answers of {window.slowest:.2f} s; {check(toile, file)} numbers are as reckoned"
    return drafted


def t_shirt(record, pace):
    def drafted(window, folder):
        begun = time.monotonic()
        count = replay(window, record, folder, pace)
        file, end = folder / "t-shirt.toile.json", record.with_suffix(".toile.json")
        wait("the T-shirt is saved", file.is_file)
        own, other = (path.read_text(encoding="utf-8").splitlines() for path in (file, end))
        if own != other:
            differs = "\n".join(list(difflib.unified_diff(other, own, str(end), str(file), n=1, lineterm=""))[:MAX_DIFFERS])
            raise Fault(f"the T-shirt is not as the test drafted it:\n{differs}")
        return f"the T-shirt in {count} inputs, {time.monotonic() - begun:.0f} s: the same file"
    return drafted


def main(arguments):
    if len(arguments) not in (2, 3):
        sys.exit(__doc__)
    program, toile, *records = (pathlib.Path(argument).resolve() for argument in arguments)
    PICTURE.unlink(missing_ok=True)
    for needed in (program, toile, *records):
        if not needed.is_file():
            raise Fault(f"{needed} is not built")
    print(on_display(program, skirt(toile)), flush=True)
    for record in records:
        fast, slow = PACES
        try:
            print(on_display(program, t_shirt(record, fast)))
        except Fault as fault:
            # A fault of the program comes again.
            print(f"once more, slower: {fault}")
            print(on_display(program, t_shirt(record, slow)))


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except FileNotFoundError as missing:
        sys.exit(f"window.py: {missing.filename} is not there: install xvfb and xdotool")
    except Fault as fault:
        seen = f"; the screen is in {PICTURE}" if PICTURE.is_file() else ""
        sys.exit(f"window.py: {fault}{seen}")
