#!/usr/bin/env python3
"""Writes every shipped pattern in all sizes as DXF of both standards, and has each file read by ezdxf: no error,
nothing to mend, nothing in blocks but pieces, every layer as the standards have it.

usage: dxf.py TOILE [PATTERN...]
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

PATTERNS = pathlib.Path(__file__).resolve().parent.parent / "patterns"
READER = "ezdxf==1.4.5"
# Layers that hold closed lines, open lines and points, by standard.
CLOSED = {"dxf-aama": {"1", "11", "14"}, "dxf-astm": {"1", "11", "14", "84", "86", "87"}}
OPEN = {"7", "8"}
POINTS = {"2", "3", "4", "13", "80", "81", "82"}
# Kinds of entities that release 12 of the standards has in blocks.
KINDS = {"POLYLINE", "POINT", "TEXT"}
RULE = re.compile(r"# \d+")


class Fault(Exception):
    """Something that does not hold."""


def reader():
    """The module ezdxf, installed into a folder of its own where it is missing."""
    try:
        import ezdxf
    except ImportError:
        folder = tempfile.mkdtemp(prefix="toile-dxf-")
        subprocess.run([sys.executable, "-m", "pip", "install", "-q", "--target", folder, READER], check=True)
        sys.path.insert(0, folder)
        import ezdxf
    return ezdxf


def told(toile, *words):
    """What a command reports."""
    done = subprocess.run([str(toile), "--json", *(str(word) for word in words)], capture_output=True, text=True)
    if done.returncode != 0:
        raise Fault(f"{' '.join(str(word) for word in words)}: {done.stdout}{done.stderr}")
    return json.loads(done.stdout)


def label(block, key):
    """The value of a text `Key: value` in a block."""
    texts = (text.dxf.text for text in block.query("TEXT"))
    pairs = (text.split(":", 1) for text in texts if ":" in text)
    return next((value.strip() for name, value in pairs if name == key), None)


def entities(block, standard):
    """Holds the entities of a block to their layers."""
    closed = 0
    for entity in block:
        kind, layer = entity.dxftype(), entity.dxf.layer
        if kind not in KINDS:
            raise Fault(f"block {block.name}: {kind} is no entity of these formats")
        if kind == "POLYLINE":
            if layer not in (CLOSED[standard] if entity.is_closed else OPEN):
                raise Fault(f"block {block.name}: a line on layer {layer}, closed {entity.is_closed}")
            if len(entity.vertices) < 2:
                raise Fault(f"block {block.name}: a line of {len(entity.vertices)} vertices")
            closed += layer == "1"
        elif kind == "POINT" and layer not in POINTS:
            raise Fault(f"block {block.name}: a point on layer {layer}")
        # The number of a grade rule stands on the layer of its point.
        elif kind == "TEXT" and layer != "1" and not RULE.fullmatch(entity.dxf.text):
            raise Fault(f"block {block.name}: a text on layer {layer}")
    if closed != 1:
        raise Fault(f"block {block.name}: {closed} cut lines")
    twins = len(block.query('POLYLINE[layer=="84"]'))
    if (twins == 1) != (standard == "dxf-astm"):
        raise Fault(f"block {block.name}: {twins} twins of the cut line")


def held(ezdxf, file, standard, sizes):
    """Holds a file to its standard; returns the number of its blocks."""
    document = ezdxf.readfile(file)
    audit = document.audit()
    if audit.errors or audit.fixes:
        raise Fault(f"{[str(error.message) for error in (*audit.errors, *audit.fixes)]}")
    # ezdxf adds the blocks of its model and paper space.
    blocks = [block for block in document.blocks if not block.name.startswith(("*", "$"))]
    placed = [insert.dxf.name for insert in document.modelspace().query("INSERT")]
    if sorted(placed) != sorted(block.name for block in blocks):
        raise Fault(f"blocks and their places differ: {placed}")
    pieces = {}
    for block in blocks:
        if len(block.name) > 31 or not block.name.isascii() or " " in block.name:
            raise Fault(f"{block.name!r} is no name of a block")
        entities(block, standard)
        size = label(block, "Size Name" if standard == "dxf-astm" else "Size")
        pieces.setdefault(label(block, "Piece Name"), []).append(size)
    for piece, own in pieces.items():
        if piece is None or sorted(own) != sorted(sizes):
            raise Fault(f"piece {piece} is there in sizes {own}, not {sizes}")
    outside = {entity.dxftype() for entity in document.modelspace()}
    if outside - {"INSERT", "TEXT"}:
        raise Fault(f"{outside} outside of blocks")
    return len(blocks)


def main(arguments):
    if not arguments:
        sys.exit(__doc__)
    toile = pathlib.Path(arguments[0]).resolve()
    patterns = [pathlib.Path(name) for name in arguments[1:]] or sorted(PATTERNS.glob("*.toile.json"))
    ezdxf = reader()
    faults = 0
    with tempfile.TemporaryDirectory() as folder:
        for pattern in patterns:
            sizes = [size["name"] for size in json.loads(pattern.read_text()).get("sizes", [])] or ["ONE"]
            for standard in CLOSED:
                file = pathlib.Path(folder) / f"{pattern.name.split('.')[0]}.dxf"
                every = ["--all-sizes"] if sizes != ["ONE"] else []
                try:
                    told(toile, "convert", pattern, file, "--to", standard, *every)
                    count = held(ezdxf, file, standard, sizes)
                    print(f"{pattern.name} as {standard}: {count} blocks", flush=True)
                except Fault as fault:
                    faults += 1
                    print(f"{pattern.name} as {standard}: {fault}", flush=True)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main(sys.argv[1:])
