"""Flattens a cap of a sphere of 10 cm to a panel with darts: flatten_cap.py."""

import numpy as np
import toile

n = 16
u, v = np.meshgrid(np.radians(np.linspace(-30, 30, n + 1)), np.radians(np.linspace(-30, 30, n + 1)))
cap = 0.1 * np.stack([np.cos(v) * np.sin(u), np.sin(v), np.cos(v) * np.cos(u)], axis=-1).reshape(-1, 3)  # metres
k = np.arange(n * (n + 1)).reshape(n, n + 1)[:, :-1].ravel()
quads = np.stack([k, k + 1, k + n + 2, k + n + 1], axis=1)
triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
flat = toile.flatten(cap, triangles, fabric="poplin", strain=0.03, darts=2)
print(f"{len(flat.report['darts'])} darts, {100 * flat.report['stretch_99']:.1f} % on 99 % of the area")
toile.write(flat.pattern, "cap.dxf", format="dxf-astm")
