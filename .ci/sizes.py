#!/usr/bin/env python3
"""Every shipped pattern in every size: it is checked without a finding, laid on its fabric without
a piece missing, and worn by the mannequin of its size, at preview, as one garment at rest that crosses
neither the body nor itself.

usage: sizes.py TOILE [QUALITY]

QUALITY is preview, fit or final.
"""

import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

PATTERNS = pathlib.Path(__file__).resolve().parent.parent / "patterns"
# Enough of a search to find a place for every piece.
EVALUATIONS = "20000"
# Each drape has two threads.
AT_ONCE = max(1, (os.cpu_count() or 2) // 2)


class Fault(Exception):
    """Something that does not hold."""


def told(toile, *words):
    """What a command reports."""
    done = subprocess.run([str(toile), "--json", *(str(word) for word in words)], capture_output=True, text=True)
    if done.returncode != 0:
        raise Fault(f"{' '.join(str(word) for word in words)}: {done.stdout}{done.stderr}")
    return json.loads(done.stdout)


def worn(toile, pattern, size, quality):
    """Makes a pattern in a size."""
    with tempfile.TemporaryDirectory() as out:
        wrong = told(toile, "check", pattern, "--size", size)["diagnostics"]
        markers = told(toile, "nest", pattern, "--size", size, "--evaluations", EVALUATIONS, "--out", out)["markers"]
        for marker in markers:
            if not marker["sound"] or marker["unplaced"] or marker["missing"]:
                wrong.append(f"the marker of {marker['fabric']} is not complete")
        report = told(toile, "drape", pattern, "--size", size, "--quality", quality, "--out", out)["report"]
        wanted = {"body_intersections": 0, "self_intersections": 0, "components": 1}
        wrong += [f"{name} is {report[name]}, not {right}" for name, right in wanted.items() if report[name] != right]
        if report["residual"] > report["residual_goal"]:
            wrong.append(f"it is not at rest: {report['residual']}, not {report['residual_goal']}")
    if wrong:
        raise Fault(f"{pattern.name} {size}: {wrong}")


def main(arguments):
    if len(arguments) not in (1, 2):
        sys.exit(__doc__)
    toile = pathlib.Path(arguments[0]).resolve()
    quality = arguments[1] if len(arguments) == 2 else "preview"
    cases = []
    for pattern in sorted(PATTERNS.glob("*.toile.json")):
        sizes = json.loads(pattern.read_text(encoding="utf-8"))["sizes"]
        cases += [(toile, pattern, size["name"], quality) for size in sizes]
    faults = []
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        for done in [pool.submit(worn, *case) for case in cases]:
            try:
                done.result()
            except Fault as fault:
                faults.append(str(fault))
                print(f"sizes.py: {fault}", flush=True)
    print(f"{len(cases) - len(faults)} of {len(cases)} patterns and sizes are worn")
    sys.exit(1 if faults or not cases else 0)


if __name__ == "__main__":
    main(sys.argv[1:])
