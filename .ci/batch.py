#!/usr/bin/env python3
"""Kills batches of 60 jobs at random and resumes them: results and reports have the bytes of a batch that nobody
disturbed, and nothing that a killed batch started lives on.

usage: batch.py TOILE [--ray]

54 jobs check, convert and print, 6 drape. With --ray the same jobs are also done by Ray (installed from PyPI into a
folder of its own), and by Ray and `toile batch` at once in one folder.
"""

import json
import os
import pathlib
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
KILLS = 10
# Seconds after which no child of a killed batch may live.
GRACE = 2.0
QUICK = {
    "patterns": [f"{name}.toile.json" for name in ("t-shirt", "gathered-skirt", "poncho")],
    "sizes": "all",
    "do": ["check", "convert", "print"],
    "options": {"paper": "page", "convert": {"to": "garmentcode", "file": "pattern.json"}},
}
DRAPES = {
    "patterns": ["poncho.toile.json"],
    "sizes": "all",
    "do": ["drape"],
    "options": {"quality": "preview", "formats": ["glb", "report"]},
}


def begin(toile, spec, out):
    words = [toile, "batch", str(spec), "--out", str(out), "--jobs", "2"]
    return subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def alive(out):
    """Processes with the folder of a batch among their words."""
    found = 0
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().decode(errors="replace")
            state = (process / "stat").read_text().rsplit(")", 1)[1].split()[0]
        except OSError:
            continue
        found += str(out) in words and "python" not in words and state != "Z"
    return found


def lasting(out):
    """The bytes of results and report."""
    files = [*out.glob("jobs/*/result.json"), out / "report.json"]
    return {str(file.relative_to(out)): file.read_bytes() for file in files}


def compared(told, out, expected):
    found = lasting(out)
    other = [name for name in expected if found.get(name) != expected[name]]
    left = [name for name in found if name not in expected]
    print(f"{told}: {len(found)} files, {len(other)} other, {len(left)} more")
    return not other and not left


def killed(toile, spec, out, within):
    """Begins a batch and kills it, again and again, then lets it end."""
    is_right = True
    for _ in range(KILLS):
        batch = begin(toile, spec, out)
        time.sleep(random.uniform(0.05, within))
        batch.send_signal(signal.SIGKILL)
        batch.wait()
        time.sleep(GRACE)
        if (left := alive(out)):
            print(f"{left} processes live {GRACE} s after their batch was killed")
            is_right = False
    return begin(toile, spec, out).wait() == 0 and is_right


def by_ray(python, toile, spec, out):
    environment = {**os.environ, "PATH": f"{pathlib.Path(toile).parent}:{os.environ['PATH']}"}
    words = [python, str(ROOT / "docs/examples/batch_ray.py"), str(spec), str(out)]
    return subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def with_ray(folder):
    """A Python that has Ray."""
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    python = str(folder / "bin/python")
    subprocess.run([python, "-m", "pip", "install", "-q", "ray"], check=True)
    return python


def main():
    toile = str(pathlib.Path(sys.argv[1]).resolve())
    is_right = True
    seed = int(time.time())
    random.seed(seed)
    print(f"seed {seed}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        python = with_ray(folder / "ray") if "--ray" in sys.argv else None
        for kind, spec in (("quick", QUICK), ("drapes", DRAPES)):
            spec["patterns"] = [str(ROOT / "patterns" / pathlib.Path(one).name) for one in spec["patterns"]]
            file = folder / f"{kind}.json"
            file.write_text(json.dumps(spec), encoding="utf-8")
            whole = folder / f"{kind}-whole"
            before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
            is_right &= begin(toile, file, whole).wait() == 0
            wall = time.monotonic() - start
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            print(f"{kind}: {wall:.1f} s, {cpu / wall:.2f} processors busy")
            expected = lasting(whole)
            torn = folder / f"{kind}-torn"
            is_right &= killed(toile, file, torn, wall * 2 / KILLS)
            is_right &= compared(f"{kind}, killed {KILLS} times", torn, expected)
            if python:
                rayed, shared = folder / f"{kind}-ray", folder / f"{kind}-shared"
                is_right &= by_ray(python, toile, file, rayed).wait() == 0
                is_right &= compared(f"{kind}, by Ray", rayed, expected)
                ray, own = by_ray(python, toile, file, shared), begin(toile, file, shared)
                is_right &= own.wait() == 0 and ray.wait() == 0
                is_right &= compared(f"{kind}, by Ray and by itself", shared, expected)
    return 0 if is_right else 1


sys.exit(main())
