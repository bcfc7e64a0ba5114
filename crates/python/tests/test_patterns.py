"""Patterns: read in every way, changed into new ones, checked, written; errors with place and remedy."""

import json
from pathlib import Path

import pytest
import toile


def test_a_file_its_bytes_and_a_sample_are_the_same_pattern(shirt, patterns):
    path = patterns / "t-shirt.toile.json"
    for other in [toile.read(str(path)), toile.read(path.read_bytes()), toile.read("sample:t-shirt")]:
        assert other.name == shirt.name
        assert other.sizes == shirt.sizes and other.panels == shirt.panels
        assert other.format == "native" and other.guesses == [] and other.losses == []
    written = json.loads(path.read_text())
    assert shirt.sizes == [size["name"] for size in written["sizes"]]
    assert shirt.panels == [panel["name"] for panel in written["panels"]]


def test_a_pattern_does_not_change(shirt):
    for name in ["name", "sizes", "panels", "project", "anything"]:
        with pytest.raises(AttributeError):
            setattr(shirt, name, None)
    before = shirt.sizes
    shirt.sizes.append("huge")
    assert shirt.sizes == before
    areas = [piece.area for piece in shirt.draft().pieces]
    other = shirt.with_measurements({"bust": 1.2, "waist": 1.1, "hips": 1.25})
    assert other is not shirt and other.size is None
    assert [piece.area for piece in shirt.draft().pieces] == areas
    assert [piece.area for piece in other.draft().pieces] != areas
    with pytest.raises(TypeError):
        toile.Pattern()


def test_measurements_are_metres_and_those_left_out_are_predicted(shirt):
    other = shirt.with_measurements({"bust": 0.96})
    assert other.measurements["bust"] == 0.96
    assert 0.5 < other.measurements["waist"] < 1.0
    with pytest.raises(toile.Error, match="did you mean bust"):
        shirt.with_measurements({"busst": 0.96})
    with pytest.raises(toile.Error, match="above 0"):
        shirt.with_measurements({"bust": -1.0})


def test_a_variable_takes_a_value_in_metres(shirt):
    name, value = next((n, v) for n, v in shirt.variables.items() if v)
    other = shirt.with_variable(name, value + 0.0125)
    assert other.variables[name] == value + 0.0125
    assert shirt.variables[name] == value
    with pytest.raises(toile.Error, match=name):
        shirt.with_variable("unheard of", 1.0)
    with pytest.raises(toile.Error, match="finite"):
        shirt.with_variable(name, float("nan"))


def test_a_wrong_file_says_where_and_what_to_do(tmp_path):
    file = tmp_path / "broken.toile.json"
    file.write_text('{"toile": 2,\n "name": "skirt",\n "panels": [,]}')
    with pytest.raises(toile.FormatError) as caught:
        toile.read(file)
    error = caught.value
    assert error.path == str(file) and "line 3" in error.place
    assert error.what and error.hint
    assert str(error) == f"{file}: {error.place}: {error.what}; {error.hint}"
    assert isinstance(error, toile.Error) and isinstance(error, Exception)
    with pytest.raises(toile.FormatError):
        toile.read(file.read_bytes())
    with pytest.raises(toile.FormatError, match="marker|pattern"):
        toile.read(b"\x89PNG\r\n\x1a\n")
    with pytest.raises(toile.Error, match="check the spelling"):
        toile.read(tmp_path / "nothing.dxf")
    with pytest.raises(toile.Error, match="no format \"dxf\"; choose one of native"):
        toile.read(file, format="dxf")
    with pytest.raises(TypeError):
        toile.read(12)


def test_faults_of_a_pattern_are_listed(patterns):
    text = (patterns / "t-shirt.toile.json").read_text()
    assert text.count('"neck_half * 0.85"') == 1
    broken = toile.read(text.replace('"neck_half * 0.85"', '"unheard_of * 0.85"').encode())
    found = broken.check()
    assert any(one.severity == "error" for one in found)
    assert all(one.message and one.place for one in found)
    with pytest.raises(toile.PatternError) as caught:
        broken.draft()
    assert any("unheard_of" in fault for fault in caught.value.diagnostics)
    with pytest.raises(toile.PatternError):
        toile.drape(broken, quality="preview")


def test_an_unknown_size_is_refused_by_name(shirt):
    for wrong in [lambda: shirt.draft(size="XXS-"), lambda: toile.drape(shirt, size="XXS-")]:
        with pytest.raises(toile.Error, match=shirt.sizes[0]):
            wrong()


def test_a_sound_pattern_has_no_errors_in_any_size(shirt):
    assert all(one.severity != "error" for one in shirt.check())
    assert all(one.severity != "error" for one in shirt.check(sizes=shirt.sizes[0]))


def test_what_a_format_cannot_carry_is_returned(shirt, tmp_path):
    path = tmp_path / "shirt.dxf"
    losses = toile.write(shirt, path, format="dxf-astm", sizes=shirt.sizes)
    assert path.exists()
    assert any(loss.what == "seams" and loss.count > 0 for loss in losses)
    back = toile.read(path, unit="mm")
    assert len(back.panels) > 0 and back.format.startswith("dxf")
    assert sorted(back.sizes) == sorted(shirt.sizes)
    native = tmp_path / "shirt.toile.json"
    assert toile.write(shirt, native) == []
    assert toile.read(native).panels == shirt.panels
    with pytest.raises(toile.Error, match="nothing is written"):
        toile.write(shirt, tmp_path / "shirt.xyz")


def test_a_guess_names_the_argument_that_overrides_it(shirt, tmp_path):
    path = tmp_path / "shirt.dxf"
    toile.write(shirt, path, format="dxf-aama")
    text = path.read_bytes()
    # A file that states inches for millimetres: its largest piece would be 18 m.
    assert text.count(b"METRIC") == 1
    path.write_bytes(text.replace(b"METRIC", b"ENGLISH"))
    wrong = toile.read(path)
    [guess] = [one for one in wrong.guesses if one.what == "unit"]
    assert guess.option == "unit" and guess.chosen == "mm" and guess.because
    assert str(guess) == guess.words
    right = toile.read(path, unit="mm")
    assert all(one.what != "unit" for one in right.guesses)
    assert right.draft().pieces[0].area == wrong.draft().pieces[0].area
