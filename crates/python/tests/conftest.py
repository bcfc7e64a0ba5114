"""What the tests share: the shipped patterns, a small drape, the command."""

import os
from pathlib import Path

import pytest
import toile

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def patterns() -> Path:
    return ROOT / "patterns"


@pytest.fixture(scope="session")
def shirt(patterns: Path) -> toile.Pattern:
    return toile.read(patterns / "t-shirt.toile.json")


@pytest.fixture(scope="session")
def poncho(patterns: Path) -> toile.Pattern:
    return toile.read(patterns / "poncho.toile.json")


@pytest.fixture(scope="session")
def command() -> str:
    """Path of the command, of the same sources."""
    path = os.environ.get("TOILE")
    if path is None:
        pytest.skip("TOILE does not name the command")
    return path
