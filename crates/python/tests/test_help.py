"""Every public name has help, and what holds numbers says units and shapes."""

import inspect
import re

import pytest
import toile

NAMES = [name for name in dir(toile) if not name.startswith("_")]

#: What says the unit or the shape of a value, or that it has none.
SAID = re.compile(
    r"metres|radians|\(m2\)|\(n, [23]\)|\(n,\)|\(m, [23]\)|\(k, 2\)|0 to 1|\(text\)|\(int\)|\(bool\)|\(list\b|\(dict\b"
    r"|\btexts?\b|pair|list of|as bytes|bytes of|Returns a|as a Pattern|of slices"
)


def members():
    for name in NAMES:
        value = getattr(toile, name)
        yield name, value
        if inspect.isclass(value) and not issubclass(value, Exception):
            for own in vars(value):
                if not own.startswith("_"):
                    yield f"{name}.{own}", getattr(value, own)


@pytest.mark.parametrize("name,value", list(members()))
def test_a_public_name_has_help(name, value):
    words = inspect.getdoc(value)
    assert words and len(words) > 15, name
    if "." in name and name.split(".")[1] not in ("write", "words", "with_variable", "with_measurements"):
        assert SAID.search(words), f"{name}: {words}"


def test_functions_name_every_argument():
    for name, value in members():
        if not callable(value) or inspect.isclass(value):
            continue
        words = inspect.getdoc(value)
        for argument in inspect.signature(value).parameters:
            if argument not in ("self", "pattern", "path"):
                assert re.search(rf"\b{argument}\b", words), f"{name} does not say {argument}"


def test_errors_have_one_base():
    for error in [toile.FormatError, toile.PatternError, toile.Cancelled]:
        assert issubclass(error, toile.Error) and issubclass(error, Exception)
    assert toile.FormatError("x").place == "" and tuple(toile.PatternError("x").diagnostics) == ()
