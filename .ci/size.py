#!/usr/bin/env python3
"""Counts the lines of the sources by crate: those of `crates/*/src` and `ui/src` that are neither blank nor
a comment nor in a module that is built for tests only.

usage: size.py [FOLDER]

FOLDER is the root of a tree, this one where none is given. Ends with 1 where there are more than MAX_TOTAL,
or where a file has more than MAX_FILE lines of any kind.
"""

import pathlib
import re
import sys

# Lines of all crates together. Formats of other programs make it larger; all else makes it smaller.
MAX_TOTAL = 178_900
MAX_FILE = 600

ROOT = pathlib.Path(__file__).resolve().parent.parent
COMMENT = re.compile(r"\s*//")
TEST = re.compile(r"#\[cfg\(test\)\]")
ATTRIBUTE = re.compile(r"#\[")
MODULE = re.compile(r"(?:pub(?:\([a-z]+\))? )?mod (\w+)\s*([;{])(.*)")


def divided(text):
    """The lines that are no module of tests, and the names of modules of tests in files of their own."""
    lines, names = [], []
    waiting = []
    rest = iter(text.splitlines())
    for line in rest:
        if TEST.match(line) or (waiting and ATTRIBUTE.match(line)):
            waiting.append(line)
            continue
        module = MODULE.match(line) if waiting else None
        if module is None:
            # Something else that is built for tests only, an import or a function, is counted.
            lines += [*waiting, line]
        elif module[2] == ";":
            names.append(module[1])
        elif "}" not in module[3]:
            # The module ends with the brace of the first column.
            for inside in rest:
                if inside.startswith("}"):
                    break
        waiting = []
    return lines + waiting, names


def counted(source):
    """The number of lines of a folder of sources, and the complaints about its files."""
    kept, apart, complaints = {}, set(), []
    for path in sorted(source.rglob("*.rs")):
        text = path.read_text(encoding="utf-8")
        if len(text.splitlines()) > MAX_FILE:
            complaints.append(f"{path} has {len(text.splitlines())} lines, and may have {MAX_FILE}")
        if "#![cfg(test)]" in text.splitlines():
            continue
        kept[path], names = divided(text)
        # A module of `lib.rs`, `main.rs` and `mod.rs` lies beside them, that of another file in its folder.
        own = path.parent if path.stem in ("lib", "main", "mod") else path.with_suffix("")
        apart.update(own / name for name in names)
    total = 0
    for path, lines in kept.items():
        if not any(place in apart for place in (path.with_suffix(""), *path.parents)):
            total += sum(1 for line in lines if line.strip() and not COMMENT.match(line))
    return total, complaints


def main(arguments):
    if len(arguments) > 1:
        sys.exit(__doc__)
    root = pathlib.Path(arguments[0]) if arguments else ROOT
    total, complaints = 0, []
    for source in sorted([*root.glob("crates/*/src"), root / "ui/src"]):
        lines, wrong = counted(source)
        total += lines
        complaints += wrong
        print(f"{source.parent.name:12} {lines:7}")
    print(f"{'total':12} {total:7} of at most {MAX_TOTAL}")
    if total > MAX_TOTAL:
        complaints.append(f"the sources have {total} lines, and may have {MAX_TOTAL}: make a part of them shorter")
    for complaint in complaints:
        print(f"size.py: {complaint}", file=sys.stderr)
    sys.exit(1 if complaints or not total else 0)


if __name__ == "__main__":
    main(sys.argv[1:])
