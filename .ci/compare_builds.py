#!/usr/bin/env python3
"""Times two builds of the program in turn: `compare_builds.py OLD NEW [ROUNDS]`.

OLD and NEW are programs built for release. Eight benchmarks of the product, one thread, processor time,
the least of the rounds (7) of each; printed are both, their ratio, and the geometric mean of the ratios.
Ends with 1 where the mean is above 1.03 or a ratio above 1.15.
"""

import json
import math
import subprocess
import sys

BENCHMARKS = [
    "frame-1k-implicit-euler",
    "frame-1k-patch-verlet",
    "frame-1k-vertex-block-descent",
    "hang-65-xpbd",
    "sphere-65-xpbd",
    "sphere-65-touching",
    "rest-shirt-1k",
    "rest-shirt-6k",
]
MAX_MEAN, MAX_RATIO = 1.03, 1.15


def seconds(program, name):
    """Processor time of a benchmark with one thread [s]."""
    run = subprocess.run([program, "bench", "--json", name], capture_output=True, text=True)
    report = json.loads(run.stdout or run.stderr)
    if run.returncode:
        sys.exit(f"{program}: {report.get('error', run.stderr)}")
    times = [timed["cpu_s"] for timed in report["benchmarks"] if timed["threads"] == 1]
    return min(times)


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    programs = sys.argv[1:3]
    rounds = int(sys.argv[3]) if len(sys.argv) == 4 else 7
    ratios = []
    print(f"{'benchmark':32} {'old s':>9} {'new s':>9} {'ratio':>7}")
    for name in BENCHMARKS:
        least = [math.inf, math.inf]
        for round_ in range(rounds):
            # Who begins changes from round to round.
            for k in (0, 1) if round_ % 2 == 0 else (1, 0):
                least[k] = min(least[k], seconds(programs[k], name))
        ratios.append(least[1] / least[0])
        print(f"{name:32} {least[0]:9.4f} {least[1]:9.4f} {ratios[-1]:7.3f}", flush=True)
    mean = math.exp(sum(map(math.log, ratios)) / len(ratios))
    print(f"geometric mean {mean:.3f} (at most {MAX_MEAN}), largest {max(ratios):.3f} (at most {MAX_RATIO})")
    return 1 if mean > MAX_MEAN or max(ratios) > MAX_RATIO else 0


if __name__ == "__main__":
    sys.exit(main())
