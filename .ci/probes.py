#!/usr/bin/env python3
"""Holds that one more thing of a kind touches few files. Each `tests/probes/*.patch` adds one more operation,
figure or rule, with a test of it, and says in its first line how many sources it may touch.

usage: probes.py [TARGET]

Every patch is tried by itself on the last commit, and the files it touches in `src` folders are counted. Then
all of them together are built and tested in one copy of that commit. TARGET is the folder of cargo's output,
that of the tree where none is given: its dependencies serve, and the copy lies in it.
"""

import io
import os
import pathlib
import re
import subprocess
import sys
import tarfile
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PATCHES = ROOT / "tests" / "probes"
LIMIT = re.compile(r"# files: (\d+)\n")
SOURCE = re.compile(r"(crates/[^/]+|ui)/src/")
TEST = re.compile(r".*/tests/(\w+)\.rs")
VERSION = re.compile(r'^version = "([^"]+)"$', re.MULTILINE)


def git_apply(tree, patch, *options):
    """Runs `git apply` in a folder that belongs to no repository, though it may lie within one."""
    alone = {**os.environ, "GIT_CEILING_DIRECTORIES": str(tree.parent)}
    words = ["git", "apply", *options, str(patch)]
    return subprocess.run(words, cwd=tree, env=alone, capture_output=True, text=True)


def touched(tree, patch):
    """The files that a patch changes, adds or removes."""
    told = git_apply(tree, patch, "--numstat").stdout
    return [line.split("\t")[2] for line in told.splitlines()]


def tried(tree, patch):
    """Tries one patch on a tree as committed: the line that reports it, and a complaint or nothing."""
    limit = LIMIT.match(patch.read_text(encoding="utf-8"))
    checked = git_apply(tree, patch, "--check")
    paths = touched(tree, patch)
    sources = [path for path in paths if SOURCE.match(path)]
    complaint = None
    if not limit:
        complaint = "its first line does not say '# files: N'"
    elif checked.returncode:
        complaint = f"it does not apply: make it anew\n{checked.stderr}"
    elif not sources or len(sources) > int(limit[1]):
        complaint = f"it touches {len(sources)} sources:\n  " + "\n  ".join(sources)
    elif not any(map(TEST.fullmatch, paths)):
        complaint = "it has no test"
    most = limit[1] if limit else "?"
    return f"{patch.stem:12} {len(sources):5} {most:>5}  {'no' if complaint else 'ok'}", complaint


def made_alike(copy, tree):
    """Makes a folder like a tree; files that are the same keep their time, by which cargo knows them."""
    wanted = {path.relative_to(tree) for path in tree.rglob("*") if path.is_file()}
    for path in [path for path in copy.rglob("*") if path.is_file()]:
        if path.relative_to(copy) not in wanted:
            path.unlink()
    for name in wanted:
        content, place = (tree / name).read_bytes(), copy / name
        if not place.is_file() or place.read_bytes() != content:
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(content)


def renamed(tree):
    """Gives the packages of a tree another version: cargo takes packages of one name and version in one folder of
    output for the same, and would build on with those of the probes."""
    manifest = tree / "Cargo.toml"
    text, count = VERSION.subn(r'version = "\1-probe"', manifest.read_text(encoding="utf-8"), count=1)
    manifest.write_text(text, encoding="utf-8")
    return None if count else "Cargo.toml gives its packages no version"


def built(copy, target, tests):
    """Builds the libraries and programs of a copy and runs these tests; a complaint or nothing."""
    names = [word for name in tests for word in ("--test", name)]
    # Of the whole workspace and with tests, so that dependencies serve as the steps before this have built them.
    for words in (["test", "--workspace", *names], ["check", "--workspace", "--lib", "--bins", *names]):
        done = subprocess.run(
            # The copy's own packages have other versions than in its lock; no other package may change.
            ["cargo", *words, "--offline"],
            cwd=copy,
            env={**os.environ, "CARGO_TARGET_DIR": str(target)},
            capture_output=True,
            text=True,
        )
        if done.returncode:
            return f"cargo {' '.join(words)}:\n{done.stdout}{done.stderr}"
        passed = sum(int(count) for count in re.findall(r"(\d+) passed", done.stdout))
        if words[0] == "test":
            print(f"all together: {passed} tests of {len(tests)} files passed", flush=True)
    return None


def main(arguments):
    if len(arguments) > 1:
        sys.exit(__doc__)
    target = arguments[0] if arguments else os.environ.get("CARGO_TARGET_DIR", ROOT / "target")
    target = pathlib.Path(target).resolve()
    begun = time.monotonic()
    patches = sorted(PATCHES.glob("*.patch"))
    complaints = [] if patches else [f"no patch in {PATCHES}"]
    with tempfile.TemporaryDirectory() as folder:
        tree = pathlib.Path(folder).resolve() / "tree"
        archive = subprocess.run(["git", "archive", "HEAD"], cwd=ROOT, check=True, capture_output=True).stdout
        tarfile.open(fileobj=io.BytesIO(archive)).extractall(tree, filter="data")
        print(f"{'probe':12} {'files':>5} {'limit':>5}")
        for patch in patches:
            line, complaint = tried(tree, patch)
            print(line, flush=True)
            complaints += [f"{patch.name}: {complaint}"] if complaint else []
        tests = sorted({m[1] for patch in patches for m in map(TEST.fullmatch, touched(tree, patch)) if m})
        if not complaints:
            for patch in patches:
                applied = git_apply(tree, patch)
                if applied.returncode:
                    complaints.append(f"{patch.name} does not apply after those before it\n{applied.stderr}")
        if not complaints:
            copy = target / "probes"
            complaint = renamed(tree)
            made_alike(copy, tree)
            complaint = complaint or built(copy, target, tests)
            complaints += [complaint] if complaint else []
    for complaint in complaints:
        print(f"probes.py: {complaint}", file=sys.stderr)
    print(f"{len(patches)} probes in {time.monotonic() - begun:.0f} s")
    sys.exit(1 if complaints else 0)


if __name__ == "__main__":
    main(sys.argv[1:])
