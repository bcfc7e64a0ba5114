"""Drafts and markers: values against closed forms."""

import math

import numpy as np
import pytest
import toile


def area(ring):
    x, y = ring.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def test_outlines_are_arrays_of_metres_that_come_nearer_with_the_tolerance(shirt):
    draft = shirt.draft(size=shirt.sizes[0])
    assert draft.size == shirt.sizes[0]
    for piece in draft.pieces:
        coarse, fine = piece.outline(tolerance=1e-3), piece.outline(tolerance=1e-6)
        assert coarse.dtype == np.float64 and coarse.shape[1] == 2
        assert len(fine) >= len(coarse)
        assert abs(area(fine) - piece.area) < 5e-6 <= piece.area
        assert abs(area(coarse) - piece.area) < 5e-3
        assert math.isclose(area(piece.cut_line), piece.cut_area, rel_tol=1e-9)
        assert piece.cut_area > piece.area
        around = sum(edge.length for edge in piece.edges)
        chords = float(np.sum(np.linalg.norm(fine - np.roll(fine, -1, axis=0), axis=1)))
        assert math.isclose(around, chords, rel_tol=1e-4)
        assert not coarse.flags.writeable
    with pytest.raises(toile.Error, match="above 0"):
        draft.pieces[0].outline(tolerance=0.0)


def test_sizes_grow(shirt):
    whole = [sum(piece.area for piece in shirt.draft(size).pieces) for size in shirt.sizes]
    assert whole == sorted(whole) and whole[0] < whole[-1]


def test_seams_name_pieces_and_lengths(shirt):
    draft = shirt.draft()
    names = {piece.name for piece in draft.pieces}
    assert draft.seams
    for seam in draft.seams:
        assert {piece for side in seam.sides for piece, _ in side} <= names
        assert seam.gathered or abs(seam.lengths[0] - seam.lengths[1]) < 0.05
    notches = [notch for piece in draft.pieces for notch in piece.notches]
    assert notches and {notch.kind for notch in notches} <= {"slit", "v", "castle", "t", "check"}


def test_a_marker_lies_within_its_fabric_and_is_the_same_again(shirt):
    laid = toile.nest([shirt], width=1.5, evaluations=20_000, seed=1)
    again = toile.nest(shirt, width=1.5, evaluations=20_000, seed=1, threads=1)
    assert laid.placements.dtype.names == ("marker", "piece", "copy", "x", "y", "turn", "mirrored")
    assert np.array_equal(laid.placements, again.placements)
    [marker] = laid.markers
    assert marker.sound and marker.missing == [] and marker.width == 1.5
    assert len(laid.placements) == len(laid.outlines) == marker.pieces
    cut = sum(abs(area(ring)) for ring in laid.outlines)
    assert math.isclose(marker.utilisation, cut / (1.5 * laid.length), rel_tol=1e-6)
    assert laid.efficiency == marker.efficiency > 0.4
    for ring in laid.outlines:
        assert ring.min() >= 0.0 and ring[:, 1].max() <= 1.5 and ring[:, 0].max() <= laid.length
    pieces = {piece.name for piece in shirt.draft().pieces}
    assert set(laid.placements["piece"]) <= pieces
    with pytest.raises(ValueError, match="read-only"):
        laid.placements["x"] = 0.0


def test_sizes_are_laid_together(shirt):
    one = toile.nest(shirt, sizes=shirt.sizes[0], evaluations=5_000)
    two = toile.nest(shirt, sizes={shirt.sizes[0]: 2}, evaluations=5_000)
    both = toile.nest([shirt, shirt], sizes=shirt.sizes[:1], evaluations=5_000)
    assert len(two.placements) == len(both.placements) == 2 * len(one.placements)


def test_a_marker_is_written_by_the_ending_of_its_name(shirt, tmp_path):
    laid = toile.nest(shirt, evaluations=2_000)
    for kind in ["svg", "json", "dxf", "pdf", "plt"]:
        path = tmp_path / f"marker.{kind}"
        laid.write(path)
        assert path.read_bytes() == laid.to_bytes(kind) != b""
    with pytest.raises(toile.Error, match="svg"):
        laid.to_bytes("png")
    with pytest.raises(toile.Error, match="numbered from 0"):
        laid.to_bytes("svg", marker=3)


def test_wrong_widths_are_refused(shirt):
    for width in [-1.0, 0.0, float("nan"), 1e-3]:
        with pytest.raises(toile.Error):
            toile.nest(shirt, width=width, evaluations=1_000)
