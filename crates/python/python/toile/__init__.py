"""The module toile: everything is made in Rust, and this file gives it its name."""

from . import _toile
from ._toile import *
from ._toile import __version__

__all__ = [
    "Body",
    "Cancelled",
    "Diagnostic",
    "Draft",
    "Edge",
    "Error",
    "Flat",
    "FormatError",
    "Garment",
    "Guess",
    "Loss",
    "Marker",
    "Nest",
    "Notch",
    "Pattern",
    "PatternError",
    "Piece",
    "Seam",
    "body",
    "drape",
    "flatten",
    "nest",
    "read",
    "write",
    "__version__",
]

__doc__ = _toile.__doc__
