#!/usr/bin/env python3
"""Prints every shipped pattern on every paper, in one size and in all, and reads the files back by
programs of others (poppler): number and size of pages, their words, the box to measure, and that no
page is blank.

usage: prints.py TOILE [PATTERN...]
"""

import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

# Sizes of a sheet [mm]; nothing for one page as large as it takes.
PAPERS = {"a4": (210.0, 297.0), "letter": (215.9, 279.4), "a0": (841.0, 1189.0), "page": None}
POINT = 25.4 / 72.0
# pdfinfo tells sizes to a hundredth of a point or six digits [mm].
SIZE_WITHIN = 0.01
# The box to measure [mm], and the white between its lines and the rows that are scanned.
BOX = (100.0, 50.0)
# Pixels an inch: of the pages looked over for anything black, and of the box.
PAGE_DPI = 100
BOX_DPI = 300
# A pixel of the raster; the middle of an anti-aliased line is found to a fraction of it [mm].
BOX_WITHIN = 25.4 / BOX_DPI
# Darker than the grey of frames and crosses.
BLACK = 110
# Fewer black pixels are a speck.
MIN_BLACK = 8


class Fault(Exception):
    """Something that does not hold."""


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True)
    if done.returncode != 0:
        words = done.stderr.decode(errors="replace").strip()
        raise Fault(f"{' '.join(str(word) for word in command)}: {words}")
    return done.stdout


def raster(pdf, page, dpi, crop=None):
    """A page, or a part of it as (left, top, width, height) [mm], in grey: width, height, bytes."""
    command = ["pdftoppm", "-gray", "-r", dpi, "-f", page, "-l", page]
    if crop:
        for option, length in zip(("-x", "-y", "-W", "-H"), crop):
            command += [option, round(length / 25.4 * dpi)]
    image = run(*command, pdf)
    head = re.match(rb"P5\s+(\d+)\s+(\d+)\s+255\s", image)
    if not head:
        raise Fault("pdftoppm gave no grey picture")
    width, height = int(head[1]), int(head[2])
    return width, height, image[head.end():]


def blacks(data):
    return len(data) - len(data.translate(None, bytes(range(BLACK))))


def words_of(pdf, page):
    """The words of a page with their boxes, from above: left, top, right, bottom [mm], word."""
    text = run("pdftotext", "-bbox", "-f", page, "-l", page, pdf, "-").decode()
    number = r'="([\d.]+)"'
    found = re.findall(f"xMin{number} yMin{number} xMax{number} yMax{number}>([^<]*)<", text)
    return [(*(float(side) * POINT for side in word[:4]), word[4]) for word in found]


def check_not_blank(pdf, page):
    """Words say nothing of the drawing: a page with its row and column alone is blank."""
    width, height, data = raster(pdf, page, PAGE_DPI)
    data = bytearray(data)
    for left, top, right, bottom, _ in words_of(pdf, page):
        sides = [round(side / 25.4 * PAGE_DPI) for side in (left, top, right, bottom)]
        first, last = max(sides[0] - 2, 0), min(sides[2] + 2, width)
        for y in range(max(sides[1] - 2, 0), min(sides[3] + 2, height)):
            data[y * width + first:y * width + last] = b"\xff" * (last - first)
    black = blacks(bytes(data))
    if black < MIN_BLACK:
        raise Fault(f"page {page} is blank: {black} black pixels")


def line_at(levels, start, step):
    """The middle of the first dark line from a place on, in pixels; levels are 0 black to 255."""
    k = start
    while 0 <= k < len(levels) and levels[k] > 200:
        k += step
    weight = moment = 0.0
    while 0 <= k < len(levels) and levels[k] < 250:
        weight += 255 - levels[k]
        moment += (255 - levels[k]) * (k + 0.5)
        k += step
    if not weight:
        raise Fault("the box to measure has a side that is not drawn")
    return moment / weight


def measure_box(pdf, page):
    """Width and height of the box to measure in the raster [mm]. It is found by its words."""
    words = words_of(pdf, page)
    for k in range(len(words) - 3):
        if [word[4] for word in words[k:k + 4]] == ["50", "x", "100", "mm"]:
            left, right = words[k][0], words[k + 3][2]
            low = max(word[3] for word in words[k:k + 4])
            break
    else:
        raise Fault("the words of the box to measure are not found")
    # The words stand in the middle across, their line about the middle up.
    centre = ((left + right) / 2.0, low)
    margin = 10.0
    crop = (centre[0] - BOX[0] / 2.0 - margin, centre[1] - BOX[1] / 2.0 - margin,
            BOX[0] + 2.0 * margin, BOX[1] + 2.0 * margin)
    width, height, data = raster(pdf, page, BOX_DPI, crop)
    pixels = BOX_DPI / 25.4
    # A row above all words, and a column right of them.
    y = height // 2 - round(17.0 * pixels)
    x = width // 2 + round(45.0 * pixels)
    row = data[y * width:(y + 1) * width]
    column = data[x::width]
    across = line_at(row, width // 2, 1) - line_at(row, width // 2, -1)
    up = line_at(column, height // 2, 1) - line_at(column, height // 2, -1)
    return across / pixels, up / pixels


def check_print(toile, pattern, paper, all_sizes, folder):
    name = f"{pattern.name.split('.')[0]}-{paper}-{'all' if all_sizes else 'one'}"
    pdf = folder / f"{name}.pdf"
    sizes = ["--all-sizes"] if all_sizes else []
    told = json.loads(run(toile, "--json", "print", pattern, "--paper", paper, *sizes, "--out", pdf))
    info = run("pdfinfo", "-f", 1, "-l", 9999, pdf).decode()
    count = int(re.search(r"^Pages:\s+(\d+)", info, re.M)[1])
    if count != told["sheets"] or paper == "page" and count != 1:
        raise Fault(f"{name}: {count} pages, {told['sheets']} were told")
    wanted = PAPERS[paper] or told["sheet_mm"]
    pages = re.findall(r"^Page\s+\d+ size:\s+([\d.]+) x ([\d.]+) pts", info, re.M)
    if len(pages) != count:
        raise Fault(f"{name}: pdfinfo tells the size of {len(pages)} of {count} pages")
    for page, size in enumerate(pages, 1):
        for length, right in zip(size, wanted):
            if abs(float(length) * POINT - right) > SIZE_WITHIN:
                raise Fault(f"{name}, page {page}: {size} pt are not {wanted} mm")
    with_box = []
    for page in range(1, count + 1):
        words = run("pdftotext", "-f", page, "-l", page, pdf, "-").decode()
        if PAPERS[paper] and not re.search(r"row \d+, column \d+", words):
            raise Fault(f"{name}, page {page} does not say its row and column")
        if "50 x 100 mm" in words:
            with_box.append(page)
        check_not_blank(pdf, page)
    if len(with_box) != 1:
        raise Fault(f"{name}: the box to measure is on the pages {with_box}")
    if all_sizes:
        words = run("pdftotext", pdf, "-").decode().split()
        missing = [size for size in told["sizes"] if size not in words]
        if missing:
            raise Fault(f"{name}: no word of size {missing}")
    box = measure_box(pdf, with_box[0])
    for length, right in zip(box, BOX):
        if abs(length - right) > BOX_WITHIN:
            raise Fault(f"{name}: the box measures {box[0]:.3f} x {box[1]:.3f} mm")
    return name, count, box


def main(arguments):
    if not arguments:
        sys.exit(__doc__)
    toile = pathlib.Path(arguments[0]).resolve()
    shipped = sorted(pathlib.Path(__file__).resolve().parent.parent.glob("patterns/*.toile.json"))
    patterns = [pathlib.Path(name) for name in arguments[1:]] or shipped
    if not toile.is_file():
        sys.exit(f"{toile} is not built")
    jobs = [(pattern, paper, all_sizes)
            for pattern in patterns for paper in PAPERS for all_sizes in (False, True)]
    faults = []
    with tempfile.TemporaryDirectory() as folder, \
            concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        folder = pathlib.Path(folder)
        asked = [pool.submit(check_print, toile, *job, folder) for job in jobs]
        for job, one in zip(jobs, asked):
            try:
                name, count, box = one.result()
                print(f"{name}: {count} pages, box {box[0]:.2f} x {box[1]:.2f} mm")
            except Fault as fault:
                faults.append(f"{job[0].name}, {job[1]}: {fault}")
    for fault in faults:
        print(f"FAULT {fault}", file=sys.stderr)
    print(f"{len(jobs) - len(faults)} of {len(jobs)} prints are as they should be")
    sys.exit(1 if faults or not jobs else 0)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except FileNotFoundError as missing:
        sys.exit(f"prints.py: {missing.filename} is not there: install poppler-utils")
