"""Drapes, bodies and flat panels; drapes to the byte as the command makes them."""

import json
import math
import subprocess

import numpy as np
import pytest
import toile


@pytest.fixture(scope="session")
def draped(poncho):
    return toile.drape(poncho, body=toile.body("woman"), quality="preview")


def test_a_garment_is_one_mesh_with_places_in_its_pieces(draped):
    vertices, triangles = draped.vertices, draped.triangles
    assert vertices.dtype == np.float64 and vertices.shape[1] == 3
    assert triangles.dtype == np.uint32 and triangles.shape[1] == 3
    assert triangles.max() < len(vertices)
    assert draped.uv.shape[1] == 2 and draped.uv_triangles.shape == triangles.shape
    assert draped.uv_triangles.max() < len(draped.uv)
    assert np.allclose(np.linalg.norm(draped.normals, axis=1), 1.0)
    assert draped.report["vertices"] == len(vertices) and draped.report["triangles"] == len(triangles)
    rows = [draped.pieces[name] for name in draped.pieces]
    assert sum(piece.stop - piece.start for piece in rows) == len(triangles)
    # Cloth is hardly stretched: the mesh is as large as its pieces.
    a, b, c = (draped.uv[draped.uv_triangles[:, k]] for k in range(3))
    flat = 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum()
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    worn = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    assert math.isclose(flat, worn, rel_tol=0.1)
    for array in [vertices, triangles, draped.normals, draped.uv, draped.uv_triangles]:
        assert not array.flags.writeable


def test_a_drape_equals_the_commands_to_the_byte(draped, command, patterns, tmp_path):
    path = patterns / "poncho.toile.json"
    options = ["--body", "woman", "--quality", "preview", "--formats", "obj,glb,drape,report"]
    subprocess.run(
        [command, "drape", str(path), *options, "--out", str(tmp_path)],
        check=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    for name, kind in [("garment.obj", "obj"), ("garment.glb", "glb"), ("drape.png", "png")]:
        assert (tmp_path / name).read_bytes() == draped.to_bytes(kind), name
    assert json.loads((tmp_path / "report.json").read_text()) == draped.report
    draped.write(tmp_path / "own.obj")
    assert (tmp_path / "own.obj").read_bytes() == (tmp_path / "garment.obj").read_bytes()


def test_a_marker_equals_the_commands_to_the_byte(poncho, command, patterns, tmp_path):
    path = patterns / "poncho.toile.json"
    options = ["--width", "1.4m", "--evaluations", "3000", "--seed", "2", "--out", str(tmp_path)]
    subprocess.run([command, "nest", str(path), *options], check=True, stdout=subprocess.DEVNULL)
    laid = toile.nest(poncho, width=1.4, evaluations=3000, seed=2)
    assert (tmp_path / "marker.json").read_bytes() == laid.to_bytes("json")
    assert (tmp_path / "marker.svg").read_bytes() == laid.to_bytes("svg")


def test_wrong_words_are_refused_with_those_that_are_known(poncho, draped, tmp_path):
    for wrong, known in [
        (lambda: toile.drape(poncho, quality="best"), "preview, fit, final"),
        (lambda: toile.drape(poncho, fabric="unobtainium"), "poplin"),
        (lambda: toile.body("giant"), "dress-form"),
        (lambda: draped.to_bytes("stl"), "obj, glb, png"),
        (lambda: draped.write(tmp_path / "garment"), "obj, glb, png"),
        (lambda: toile.body(measurements={"bust": 0.9}, file="x.json"), "one of them"),
    ]:
        with pytest.raises(toile.Error, match=known):
            wrong()


def test_a_body_is_measured_as_it_was_asked_for(tmp_path):
    body = toile.body("woman", measurements={"height": 1.7, "bust": 0.96, "waist": 0.78})
    assert body.figure == "woman"
    assert abs(body.measurements["bust"] - 0.96) < 0.005
    assert abs(body.measurements["waist"] - 0.78) < 0.005
    vertices, triangles = body.vertices, body.triangles
    assert abs(vertices[:, 1].max() - 1.7) < 0.01 and abs(vertices[:, 1].min()) < 0.01
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
    assert 0.04 < volume < 0.12
    body.write(tmp_path / "body.json")
    same = toile.body(file=tmp_path / "body.json")
    assert np.allclose(same.vertices, vertices, atol=1e-6)
    with pytest.raises(toile.Error):
        toile.body(measurements={"height": -1.0})


def cylinder(cells, radius=0.2, angle=1.0, height=0.3):
    turn, up = np.meshgrid(np.linspace(0, angle, cells + 1), np.linspace(0, height, cells + 1))
    places = np.stack([radius * np.sin(turn), up, radius * np.cos(turn)], axis=-1).reshape(-1, 3)
    k = np.arange(cells * (cells + 1)).reshape(cells, cells + 1)[:, :-1].ravel()
    a, b, c, d = k, k + 1, k + cells + 2, k + cells + 1
    return places, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def test_a_cylinder_is_flattened_to_a_rectangle():
    places, triangles = cylinder(20)
    flat = toile.flatten(places, triangles, fabric="poplin", strain=0.02)
    assert math.isclose(flat.report["panel_area_m2"], 0.2 * 0.3, rel_tol=5e-4)
    assert np.abs(flat.stretch).max() < 1e-3
    assert flat.vertices.shape == (len(places), 2) and flat.surface.shape == places.shape
    [piece] = flat.pattern.draft().pieces
    assert math.isclose(piece.area, flat.report["panel_area_m2"], rel_tol=1e-3)
    size = flat.vertices.max(axis=0) - flat.vertices.min(axis=0)
    assert np.allclose(size, [0.2, 0.3], rtol=1e-3)


def test_surfaces_that_are_no_disk_are_refused():
    places, triangles = cylinder(4)
    for wrong, words in [
        ((places, triangles + 100), "vertex"),
        ((places, triangles - 1), "from 0 to"),
        ((places[:, :2], triangles), "three"),
        ((np.full_like(places, np.nan), triangles), "finite|number"),
        ((np.eye(3), [[0, 1, 2], [0, 2, 1]]), "; "),
    ]:
        with pytest.raises(toile.Error, match=words):
            toile.flatten(*wrong)
