#!/usr/bin/env python3
"""The Python module in a fresh environment: formatted, free of lints, built once and installed as a wheel, its tests
passed; its stubs equal the module (stubtest), its examples are typed (mypy --strict) and run.

usage: python.py TOILE [TARGET]

TOILE is the command, of the same sources: drapes from Python equal its to the byte. TARGET is the folder to build in.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import time
import venv

ROOT = pathlib.Path(__file__).resolve().parent.parent
CRATE = ROOT / "crates" / "python"
PACKAGES = ["maturin>=1.16,<2", "numpy", "mypy", "pytest"]
# Examples that need what is not installed here.
APART = ["batch_ray.py"]


def main(arguments):
    if len(arguments) not in (1, 2):
        sys.exit(__doc__)
    toile = pathlib.Path(arguments[0]).resolve()
    usual = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "python"
    target = pathlib.Path(arguments[1]).resolve() if len(arguments) == 2 else usual.resolve()
    home = target / "environment"
    wheels = target / "wheels"
    venv.create(home, clear=True, with_pip=True)
    shutil.rmtree(wheels, ignore_errors=True)
    python = home / ("Scripts" if os.name == "nt" else "bin") / "python"
    path = os.pathsep.join([str(python.parent), os.environ["PATH"]])
    around = dict(os.environ, PATH=path, VIRTUAL_ENV=str(home), PYO3_PYTHON=str(python), CARGO_TARGET_DIR=str(target))
    around["TOILE"] = str(toile)

    def step(name, *command, within=CRATE):
        start = time.monotonic()
        done = subprocess.run([str(word) for word in command], cwd=within, env=around)
        print(f"{name}: {time.monotonic() - start:.0f} s", flush=True)
        if done.returncode != 0:
            sys.exit(f"{name}: failed")

    pip = [python, "-m", "pip", "--disable-pip-version-check", "install", "-q"]
    step("packages", *pip, *PACKAGES)
    step("formatting", "cargo", "fmt", "--check")
    step("lints", "cargo", "clippy", "--locked", "--", "-D", "warnings")
    # The numbers of the profile for tests: what they run through is optimised there too.
    step("wheel", python, "-m", "maturin", "build", "-q", "--profile", "dev", "--locked", "--out", wheels)
    [wheel] = wheels.glob("toile-*.whl")
    step("install", *pip, wheel)
    scratch = target / "scratch"
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    step("tests", python, "-m", "pytest", "-q", "-p", "no:cacheprovider", CRATE / "tests", within=scratch)
    step("stubs", python, "-m", "mypy.stubtest", "toile", within=scratch)
    examples = sorted(path for path in (ROOT / "docs" / "examples").glob("*.py") if path.name not in APART)
    step("types", python, "-m", "mypy", "--strict", "--cache-dir", os.devnull, *examples, within=scratch)
    for example in examples:
        step(example.name, python, example, ROOT / "patterns" / "poncho.toile.json", within=scratch)


if __name__ == "__main__":
    main(sys.argv[1:])
