#!/usr/bin/env python3
"""Writes every shipped pattern as SVG, has Inkscape save it, and reads it back: the same document. Then a corner of the
first panel is moved: that panel comes back as drawn, all others as they were.

usage: inkscape.py TOILE [PATTERN...]
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

PATTERNS = pathlib.Path(__file__).resolve().parent.parent / "patterns"
# Longest that Inkscape may take for a file [s].
PATIENCE = 120
# The corner that is moved: the first whole one of the sew line of the first panel, and by how much [mm].
SEW = re.compile(r'(id="[^"]*-sew-1"[^>]*? d="M)([-\d.]+) ([-\d.]+)')
MOVED = (4.0, 3.0)


class Fault(Exception):
    """Something that does not hold."""


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=PATIENCE)
    if done.returncode != 0:
        raise Fault(f"{' '.join(str(word) for word in words)}: {done.stdout}{done.stderr}")


def through(toile, drawing):
    """The document of a drawing that Inkscape has saved."""
    saved, back = drawing.with_suffix(".saved.svg"), drawing.with_suffix(".toile.json")
    run("inkscape", drawing, "--export-type=svg", f"--export-filename={saved}")
    if b"sodipodi:namedview" not in saved.read_bytes():
        raise Fault(f"{saved.name}: Inkscape did not save it")
    run(toile, "convert", saved, back)
    return json.loads(back.read_text())


def check(toile, path, folder):
    name = path.name.removesuffix(".toile.json")
    own = json.loads(path.read_text())
    drawing = folder / f"{name}.svg"
    run(toile, "convert", path, drawing)
    if through(toile, drawing) != own:
        raise Fault(f"{name}: another document came back")
    text = drawing.read_text()
    if not SEW.search(text):
        raise Fault(f"{name}: no sew line is found in the drawing")
    places = lambda found: (float(found[2]) + MOVED[0], float(found[3]) + MOVED[1])
    moved = folder / f"{name}-moved.svg"
    moved.write_text(SEW.sub(lambda found: f"{found[1]}{places(found)[0]} {places(found)[1]}", text, count=1))
    back = through(toile, moved)
    changed = [now["name"] for was, now in zip(own["panels"], back["panels"]) if was != now]
    if changed != [own["panels"][0]["name"]] or len(back["panels"]) != len(own["panels"]):
        raise Fault(f"{name}: the first panel was edited, and {changed or 'none'} came back otherwise")
    print(f"{name}: the same after a save; one panel edited, {len(own['panels']) - 1} kept", flush=True)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    toile = pathlib.Path(sys.argv[1]).resolve()
    paths = [pathlib.Path(path) for path in sys.argv[2:]] or sorted(PATTERNS.glob("*.toile.json"))
    faults = 0
    with tempfile.TemporaryDirectory() as folder:
        for path in paths:
            try:
                check(toile, path, pathlib.Path(folder))
            except (Fault, OSError, ValueError, subprocess.TimeoutExpired) as fault:
                faults += 1
                print(f"FAULT {fault}")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
