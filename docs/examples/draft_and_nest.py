"""Drafts a pattern in every size and lays it on fabric: draft_and_nest.py PATTERN."""

import sys

import toile

pattern = toile.read(sys.argv[1])
for guess in pattern.guesses:
    print("guessed:", guess)
sizes: list[str | None] = [*pattern.sizes] or [None]
for size in sizes:
    draft = pattern.draft(size=size)
    cloth = sum(piece.area for piece in draft.pieces)  # m2
    outline = draft.pieces[0].outline(tolerance=1e-4)  # (n, 2), metres
    print(f"{size}: {len(draft.pieces)} pieces, {cloth:.3f} m2, {len(outline)} points in {draft.pieces[0].name}")
laid = toile.nest(pattern, width=1.5, evaluations=5_000, seed=1)
print(f"{laid.length:.2f} m of fabric, {100 * laid.efficiency:.0f} % used")
laid.write("marker.svg")
