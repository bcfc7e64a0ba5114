"""Drapes a pattern in two fabrics on one body and writes both: drape_fabrics.py PATTERN."""

import sys

import numpy as np
import toile


def tell(stage: str, share: float, words: str) -> None:
    print(f"\r{stage} {100 * share:3.0f} %", end="", file=sys.stderr)


pattern = toile.read(sys.argv[1])
body = toile.body("woman", measurements={"height": 1.68, "bust": 0.92, "waist": 0.76, "hips": 1.0})  # metres
for fabric in ["poplin", "denim"]:
    garment = toile.drape(pattern, body=body, fabric=fabric, quality="preview", progress=tell)
    low = np.min(garment.vertices[:, 1])  # y is up
    strain = garment.report["strain_p99"]
    print(f"{fabric}: the hem hangs {100 * low:.1f} cm above the floor, strain {strain}")
    if not garment.sound:
        print("\n".join(garment.warnings))
    garment.write(f"{fabric}.obj")
