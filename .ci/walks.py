#!/usr/bin/env python3
"""Every shipped scene: its figure walks in its garments, and in no saved frame does cloth cross a body or cloth.

usage: walks.py TOILE
"""

import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

SCENES = pathlib.Path(__file__).resolve().parent.parent / "patterns" / "scenes"
# Each run has two threads.
AT_ONCE = max(1, (os.cpu_count() or 2) // 2)
# Largest stretch that a hundredth of the cloth may exceed in a frame, by clip.
STRETCH = {"walk": 0.12, "run": 0.15}


def walked(toile, scene):
    """Runs a scene; what is wrong with its frames, in words, and a line about it."""
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run([toile, "run", str(scene), "--out", out], capture_output=True, text=True)
        if done.returncode != 0:
            return [f"{done.stdout}{done.stderr}"], scene.name
        with open(os.path.join(out, "report.json"), encoding="utf-8") as file:
            report = json.load(file)
    frames = report["frames"]
    faults = [
        f"{frames[field]} of {frames['frames']} frames: {field}"
        for field in ("crossing_solids", "crossing_cloth")
        if frames[field] > 0
    ]
    stretch = max(frames["stretch_p99"])
    clips = [o["motion"]["clip"] for o in json.loads(scene.read_text("utf-8"))["objects"] if "motion" in o]
    if stretch > max(STRETCH[clip] for clip in clips):
        faults.append(f"stretched by {stretch:.3f}")
    return faults, f"{scene.name}: {frames['frames']} frames, stretch {stretch:.3f}"


def main():
    toile = sys.argv[1]
    scenes = sorted(SCENES.glob("*.scene.json"))
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        results = list(pool.map(lambda scene: walked(toile, scene), scenes))
    failed = 0
    for faults, words in results:
        print(f"{'FAIL' if faults else 'ok'} {words}")
        for fault in faults:
            print(f"  {fault}")
        failed += bool(faults)
    print(f"{len(scenes) - failed} passed, {failed} failed")
    sys.exit(1 if failed or not scenes else 0)


if __name__ == "__main__":
    main()
